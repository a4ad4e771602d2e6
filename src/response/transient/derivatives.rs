//! The derivatives of the state by all parameters, side by side ([`dashpot_numerics::combine_rows`]), carried through the same steps as
//! the state itself. Parameters that change the linear part come first.

use super::changes::{Changes, StepForces};
use super::element::{Element, Form, Mean};
use super::view::{Piece, Receptance, Sensitivity, View};
use dashpot_numerics::{RowLu, add_to_rows, combine_rows, stride};

/// The jump of a friction force at a reversal, to be felt by the derivatives in the next piece of the step.
struct Jump {
    element: usize,
    before: f64,
    /// Derivative of its instant by each parameter.
    when: Vec<f64>,
}

/// Derivatives by all parameters.
pub(super) struct Derivatives {
    /// Number of each parameter where they were asked for, in the order in which they stand here.
    pub order: Vec<usize>,
    /// Length of the rows.
    pub stride: usize,
    /// States, a row of all parameters for each entry.
    pub states: Vec<f64>,
    /// Derivatives of the forces of the elements over the last step, a row an element.
    pub forces: Vec<f64>,
    /// Number of each parameter among those of the law of each element, where it is one of them: `[element][parameter]`.
    pub own: Vec<Vec<Option<usize>>>,
    changes: Changes,
    jump: Option<Jump>,
    /// What the elements see: displacements at the start of a step, displacements and velocities at its end without what their forces
    /// change, a row an element.
    starts: Vec<f64>,
    seen: [Vec<f64>; 2],
    explicit: Vec<f64>,
    means: Vec<Mean>,
    on_structure: Vec<f64>,
    row: Vec<f64>,
}

impl Derivatives {
    /// Of states `width` numbers long.
    pub(super) fn new(elements: &[Element], list: &[Sensitivity], changes: Changes, width: usize) -> Self {
        let (mut order, others): (Vec<usize>, Vec<usize>) = (0..list.len()).partition(|&k| list[k].changes_linear_part);
        order.extend(others);
        let own_of = |element: &Element| {
            let own_parameter = |s: &Sensitivity| s.own.filter(|(source, _)| *source == element.source).map(|(_, k)| k);
            order.iter().map(|&k| own_parameter(&list[k])).collect::<Vec<Option<usize>>>()
        };
        let (stride, count) = (stride(list.len()), elements.len());
        let mut states = vec![0.0; stride * width];
        for (p, &k) in order.iter().enumerate() {
            states.chunks_exact_mut(stride).zip(&list[k].state).for_each(|(row, x)| row[p] = *x);
        }
        let rows = || vec![0.0; stride * count];
        Self {
            own: elements.iter().map(own_of).collect(),
            forces: rows(),
            explicit: rows(),
            starts: rows(),
            seen: [rows(), rows()],
            means: Vec::with_capacity(count),
            on_structure: Vec::with_capacity(count),
            row: vec![0.0; stride],
            jump: None,
            order,
            stride,
            states,
            changes,
        }
    }

    /// Goes on with changes over steps of another length.
    pub(super) fn set_changes(&mut self, changes: Changes) {
        self.changes = changes;
    }

    /// Number of parameters.
    pub(super) fn len(&self) -> usize {
        self.order.len()
    }

    /// Adds `factor` times what a view sees of the states to a row.
    pub(super) fn add_seen(&mut self, view: &[f64], factor: f64, row: &mut [f64]) {
        combine_rows(view, &self.states, &mut self.row);
        row.iter_mut().zip(&self.row).for_each(|(row, seen)| *row += factor * seen);
    }

    /// Row `l` of a list of rows.
    fn at(&self, l: usize) -> std::ops::Range<usize> {
        l * self.stride..(l + 1) * self.stride
    }

    /// Tells element `l`, which sees `view`, that it has come to `d` in a step of `step` s.
    pub(super) fn commit(&mut self, l: usize, element: &mut Element, view: &View, d: f64, step: f64) {
        if !element.form.has_memory() {
            return;
        }
        combine_rows(&view.displacement, &self.states, &mut self.row);
        element.commit(d, step, &self.row[..self.order.len()], &self.own[l]);
    }

    /// Notes that the slip of `element` has ended at the present instant with this acceleration.
    pub(super) fn turned(&mut self, element: usize, view: &View, forces: &[f64], acceleration: f64) {
        if self.order.is_empty() {
            return;
        }
        let mut when = vec![0.0; self.stride];
        if acceleration != 0.0 {
            combine_rows(&view.velocity, &self.states, &mut when);
            when.iter_mut().for_each(|when| *when /= -acceleration);
        }
        self.jump = Some(Jump { element, before: forces[element], when });
    }

    /// Derivatives of the state and of the forces over a piece of a step; `patterns` are the modal patterns of the inputs.
    pub(super) fn advance(
        &mut self,
        piece: &Piece,
        elements: &mut [Element],
        views: &[View],
        patterns: &[Vec<f64>],
        receptance: &Receptance,
    ) {
        if self.order.is_empty() {
            return;
        }
        self.jump_on(piece, patterns);
        let stride = self.stride;
        for (view, starts) in views.iter().zip(self.starts.chunks_exact_mut(stride)) {
            combine_rows(&view.displacement, &self.states, starts);
        }
        piece.step.decay_rows(&mut self.states, stride);
        self.change(piece);
        if elements.is_empty() {
            return;
        }
        let own;
        let w = if piece.full {
            receptance
        } else {
            own = Receptance::new(views, piece.step);
            &own
        };
        self.change_means(piece, elements);
        let held = |l: usize| elements[l].form == Form::Friction && piece.side[l] == 0.0;
        let Some(inverse) = inverse(&self.means, w, &held) else { return };
        let [displacements, velocities] = &mut self.seen;
        for (l, view) in views.iter().enumerate() {
            let row = l * stride..(l + 1) * stride;
            combine_rows(&view.displacement, &self.states, &mut displacements[row.clone()]);
            combine_rows(&view.velocity, &self.states, &mut velocities[row]);
        }
        for l in 0..views.len() {
            self.ask(l, held(l));
        }
        self.answer(&inverse);
        for l in 0..views.len() {
            self.row.iter_mut().zip(&self.forces[l * stride..]).for_each(|(row, force)| *row = -force);
            add_to_rows(piece.step.unit(l), &self.row, &mut self.states);
        }
    }

    /// What element `l` asks of its force without what the forces themselves change: that no velocity is left where friction holds it.
    /// It takes the place of what the element sees.
    fn ask(&mut self, l: usize, held: bool) {
        let at = self.at(l);
        let Mean { by_step, by_start, .. } = self.means[l];
        let [displacements, velocities] = &mut self.seen;
        let asked = &mut displacements[at.clone()];
        if held {
            asked.copy_from_slice(&velocities[at]);
            return;
        }
        let known = self.starts[at.clone()].iter().zip(&self.explicit[at]);
        for (asked, (start, explicit)) in asked.iter_mut().zip(known) {
            *asked = by_step * (*asked - start) + by_start * start + explicit;
        }
    }

    /// Forces by the inverse of what they do to each other, row by row.
    fn answer(&mut self, inverse: &[f64]) {
        let (stride, count) = (self.stride, self.means.len());
        self.forces.fill(0.0);
        for (forces, inverse) in self.forces.chunks_exact_mut(stride).zip(inverse.chunks_exact(count)) {
            for (asked, factor) in self.seen[0].chunks_exact(stride).zip(inverse) {
                forces.iter_mut().zip(asked).for_each(|(force, asked)| *force += factor * asked);
            }
        }
    }

    /// What the jump of a friction force has done.
    fn jump_on(&mut self, piece: &Piece, patterns: &[Vec<f64>]) {
        let Some(mut jump) = self.jump.take() else { return };
        let size = piece.forces[jump.element] - jump.before;
        jump.when.iter_mut().for_each(|when| *when *= size);
        add_to_rows(&patterns[jump.element], &jump.when, &mut self.states);
    }

    /// What changes of the linear part do.
    fn change(&mut self, piece: &Piece) {
        if self.changes.is_empty() {
            return;
        }
        self.on_structure.clear();
        self.on_structure.extend(piece.forces.iter().map(|f| -f));
        let forces = StepForces { elements: &self.on_structure, drives: piece.drives };
        if piece.full {
            self.changes.over_full_step(piece.states[0], &forces, &mut self.states, self.stride);
        } else {
            self.changes.over_piece(piece.step, piece.states, &forces, &mut self.states, self.stride);
        }
    }

    /// Slopes of the mean forces, and their derivatives by the parameters at a fixed motion.
    fn change_means(&mut self, piece: &Piece, elements: &mut [Element]) {
        self.means.clear();
        for (l, element) in elements.iter_mut().enumerate() {
            let (d, side, step) = (piece.before[l], piece.side[l], piece.step.length);
            let x = piece.after[l] - d;
            self.means.push(element.mean(d, x, step, side));
            let explicit = &mut self.explicit[l * self.stride..][..self.order.len()];
            element.by_parameters([d, x, step, side], &self.own[l], explicit);
        }
    }
}

/// Inverse, row by row, of what the forces of elements do to what each of them asks; none where it is singular.
fn inverse(means: &[Mean], w: &Receptance, held: &dyn Fn(usize) -> bool) -> Option<Vec<f64>> {
    let count = means.len();
    let entry = |at: usize| {
        let (l, k) = (at / count, at % count);
        let unit = f64::from(u8::from(l == k));
        if held(l) { w.velocity[at] } else { unit + means[l].by_step * w.displacement[at] }
    };
    if count == 1 {
        let inverse = entry(0).recip();
        return inverse.is_finite().then(|| vec![inverse]);
    }
    let solver = RowLu::new(count, (0..count * count).map(entry).collect())?;
    let mut inverse = vec![0.0; count * count];
    let mut column = vec![0.0; count];
    for k in 0..count {
        column.fill(0.0);
        column[k] = 1.0;
        solver.solve(&mut column);
        column.iter().enumerate().for_each(|(l, x)| inverse[l * count + k] = *x);
    }
    Some(inverse)
}
