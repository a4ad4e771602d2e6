//! The derivatives of the state by all parameters, one flat state behind the other, carried through the same steps as the
//! state itself.

use super::changes::{Changes, StepForces};
use super::element::{Element, Form, Mean};
use super::view::{Piece, Receptance, Sensitivity, View};
use dashpot_numerics::{RowLu, dot, scalar_products};

/// The jump of a friction force at a reversal, to be felt by the derivatives in the next piece of the step.
struct Jump {
    element: usize,
    before: f64,
    /// Derivative of its instant by each parameter.
    when: Vec<f64>,
}

/// Derivatives by all parameters.
pub(super) struct Derivatives {
    /// States, one behind the other.
    pub states: Vec<f64>,
    /// Derivatives of the forces of the elements over the last step, elements of the first parameter first.
    pub forces: Vec<f64>,
    /// Number of each parameter among those of the law of each element, where it is one of them: `[element][parameter]`.
    pub own: Vec<Vec<Option<usize>>>,
    /// Number of the change of the linear part of each parameter.
    pub changed: Vec<Option<usize>>,
    changes: Changes,
    width: usize,
    /// What the elements see, displacements and then velocities, row by row.
    displacements: Vec<f64>,
    velocities: Vec<f64>,
    jump: Option<Jump>,
    starts: Vec<f64>,
    seen: [Vec<f64>; 2],
    explicit: Vec<Vec<f64>>,
    on_structure: Vec<f64>,
    moved: Vec<f64>,
}

impl Derivatives {
    pub(super) fn new(
        views: &[View],
        elements: &[Element],
        list: Vec<Sensitivity>,
        changes: Changes,
        width: usize,
    ) -> Self {
        let own_of = |element: &Element| {
            let own_parameter = |s: &Sensitivity| s.own.filter(|(source, _)| *source == element.source).map(|(_, k)| k);
            list.iter().map(own_parameter).collect::<Vec<Option<usize>>>()
        };
        Self {
            own: elements.iter().map(own_of).collect(),
            forces: vec![0.0; list.len() * elements.len()],
            explicit: vec![vec![0.0; list.len()]; elements.len()],
            moved: vec![0.0; list.len()],
            changed: list.iter().map(|s| s.change).collect(),
            states: list.into_iter().flat_map(|s| s.state).collect(),
            changes,
            width,
            displacements: views.iter().flat_map(|v| v.displacement.iter().copied()).collect(),
            velocities: views.iter().flat_map(|v| v.velocity.iter().copied()).collect(),
            jump: None,
            starts: Vec::new(),
            seen: Default::default(),
            on_structure: Vec::new(),
        }
    }

    /// Number of parameters.
    pub(super) fn len(&self) -> usize {
        self.changed.len()
    }

    /// The derivative of the state by a parameter.
    pub(super) fn state(&self, theta: usize) -> &[f64] {
        &self.states[theta * self.width..(theta + 1) * self.width]
    }

    /// Tells element `l` that it has come to `d` in a step of `step` s.
    pub(super) fn commit(&mut self, l: usize, element: &mut Element, d: f64, step: f64) {
        if element.form == Form::Smooth || element.form == Form::Friction {
            return;
        }
        let view = &self.displacements[l * self.width..(l + 1) * self.width];
        for (theta, moved) in self.moved.iter_mut().enumerate() {
            *moved = dot(view, &self.states[theta * self.width..(theta + 1) * self.width]);
        }
        element.commit(d, step, &self.moved, &self.own[l]);
    }

    /// Notes that the slip of `element` has ended at the present instant with this acceleration.
    pub(super) fn turned(&mut self, element: usize, view: &View, forces: &[f64], acceleration: f64) {
        let when = |theta: usize| {
            if acceleration == 0.0 { 0.0 } else { -dot(&view.velocity, self.state(theta)) / acceleration }
        };
        let when: Vec<f64> = (0..self.len()).map(when).collect();
        self.jump = (!when.is_empty()).then(|| Jump { element, before: forces[element], when });
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
        if self.changed.is_empty() {
            return;
        }
        let (count, width) = (elements.len(), self.width);
        self.jump_on(piece, patterns);
        scalar_products(&self.displacements, &self.states, width, &mut self.starts);
        piece.step.decay(&mut self.states);
        self.change(piece);
        if count == 0 {
            return;
        }
        let own;
        let w = if piece.full {
            receptance
        } else {
            own = Receptance::new(views, piece.step);
            &own
        };
        let means = self.means(piece, elements);
        let held = |l: usize| elements[l].form == Form::Friction && piece.side[l] == 0.0;
        let matrix = (0..count * count).map(|at| {
            let (l, k) = (at / count, at % count);
            let unit = f64::from(u8::from(l == k));
            if held(l) { w.velocity[at] } else { unit + means[l].by_step * w.displacement[at] }
        });
        let Some(solver) = RowLu::new(count, matrix.collect()) else { return };
        let [displacement, velocity] = &mut self.seen;
        scalar_products(&self.displacements, &self.states, width, displacement);
        scalar_products(&self.velocities, &self.states, width, velocity);
        for theta in 0..self.changed.len() {
            let rhs = &mut self.forces[theta * count..(theta + 1) * count];
            for (l, force) in rhs.iter_mut().enumerate() {
                let at = theta * count + l;
                *force = if held(l) {
                    velocity[at]
                } else {
                    let moved = displacement[at] - self.starts[at];
                    means[l].by_step * moved + means[l].by_start * self.starts[at] + self.explicit[l][theta]
                };
            }
            if count == 1 && !held(0) {
                rhs[0] /= 1.0 + means[0].by_step * w.displacement[0];
            } else {
                solver.solve(rhs);
            }
            let state = &mut self.states[theta * width..(theta + 1) * width];
            rhs.iter().enumerate().for_each(|(l, force)| piece.step.push(l, -force, state));
        }
    }

    /// What the jump of a friction force has done.
    fn jump_on(&mut self, piece: &Piece, patterns: &[Vec<f64>]) {
        let Some(jump) = self.jump.take() else { return };
        let beta = &patterns[jump.element];
        for (state, when) in self.states.chunks_exact_mut(self.width).zip(&jump.when) {
            let size = (piece.forces[jump.element] - jump.before) * when;
            state.iter_mut().zip(beta).for_each(|(s, b)| *s += b * size);
        }
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
            self.changes.over_full_step(piece.states[0], &forces);
        } else {
            self.changes.over_piece(piece.step, piece.states, &forces);
        }
        for (state, change) in self.states.chunks_exact_mut(self.width).zip(&self.changed) {
            if let Some(c) = change {
                let added = &self.changes.added[c * self.width..(c + 1) * self.width];
                state.iter_mut().zip(added).for_each(|(s, a)| *s += a);
            }
        }
    }

    /// Slopes of the mean forces, and their derivatives by the parameters at a fixed motion.
    fn means(&mut self, piece: &Piece, elements: &mut [Element]) -> Vec<Mean> {
        let mut means = Vec::with_capacity(elements.len());
        for (l, element) in elements.iter_mut().enumerate() {
            let (d, side, step) = (piece.before[l], piece.side[l], piece.step.length);
            let x = piece.after[l] - d;
            means.push(element.mean(d, x, step, side));
            element.by_parameters([d, x, step, side], &self.own[l], &mut self.explicit[l]);
        }
        means
    }
}
