//! Stepping: forces of all elements at once, reversals of friction located within a step, derivatives carried along.
//!
//! Friction slips with a given sign until its velocity passes zero at `tau`; there the force jumps from `F-` to `F+` (the
//! other side, or what keeps it at rest). With `d tau = -(v_theta) / a` the derivative of the state at the end gains
//!
//! ```text
//! S += beta (F+ - F-) d tau
//! ```
//!
//! At rest the force is that which leaves no velocity at the end of the step, as long as friction can hold it (Moreau).

use super::element::{Element, Form};
use super::model::TransientError;
use super::step::{Step, StepForces};
use super::system::{Functional, LinearChange, LinearSystem};
use dashpot_numerics::RowLu;
use faer::c64;

/// Reversals that are located within one step.
const MOST_EVENTS: usize = 6;
/// Sweeps of Gauss and Seidel.
const SWEEPS: usize = 400;

/// What an element sees.
pub(super) struct View {
    pub displacement: Functional,
    pub velocity: Functional,
    pub acceleration: Functional,
}

/// A parameter on its way through the steps.
pub(super) struct Sensitivity {
    /// Derivative of the damped modes.
    pub modes: Vec<c64>,
    /// Source and number of a parameter of a law.
    pub own: Option<(usize, usize)>,
    /// Change of the linear part.
    pub change: Option<LinearChange>,
    /// Derivatives of the forces of the elements over the last step.
    pub forces: Vec<f64>,
}

impl Sensitivity {
    fn own_of(&self, element: &Element) -> Option<usize> {
        self.own.filter(|(source, _)| *source == element.source).map(|(_, k)| k)
    }
}

/// The jump of a friction force at a reversal, to be felt by the derivatives in the next piece of the step.
struct Jump {
    element: usize,
    before: f64,
    /// Derivative of its instant by each parameter.
    when: Vec<f64>,
}

/// Receptances between elements over a step, row by row.
struct Receptance {
    displacement: Vec<f64>,
    velocity: Vec<f64>,
}

/// The march through a record.
pub(super) struct March<'a> {
    pub system: &'a LinearSystem,
    pub views: &'a [View],
    pub elements: Vec<Element>,
    pub z: Vec<c64>,
    pub sensitivities: Vec<Sensitivity>,
    /// Sign of the slip of each element, 0 at rest.
    pub side: Vec<f64>,
    /// Mean forces over the last step, N.
    pub forces: Vec<f64>,
    step: Step,
    receptance: Receptance,
    jump: Option<Jump>,
    linear: bool,
}

impl<'a> March<'a> {
    pub fn new(
        system: &'a LinearSystem,
        views: &'a [View],
        mut elements: Vec<Element>,
        z: Vec<c64>,
        sensitivities: Vec<Sensitivity>,
        length: f64,
    ) -> Self {
        let linear = sensitivities.iter().any(|s| s.change.is_some());
        let step = Step::new(system, length, linear);
        let receptance = Receptance::new(system, views, &step);
        let side = views.iter().map(|view| sign(view.velocity.at(&z))).collect();
        for (element, view) in elements.iter_mut().zip(views) {
            let change = |theta: usize| view.displacement.at(&sensitivities[theta].modes);
            // A law with memory comes from rest to where the record begins.
            let own: Vec<Option<usize>> = sensitivities.iter().map(|s| s.own_of(element)).collect();
            element.commit(view.displacement.at(&z), f64::INFINITY, change, |theta| own[theta]);
        }
        let forces = vec![0.0; elements.len()];
        Self { system, views, elements, z, sensitivities, side, forces, step, receptance, jump: None, linear }
    }

    /// One step from the drives `u0` to `u1`.
    pub fn advance(&mut self, u0: &[f64], u1: &[f64]) -> Result<(), TransientError> {
        let step = self.step.clone();
        if self.elements.is_empty() {
            self.accept(&step, u0, u1, &[], &[], None);
            return Ok(());
        }
        let (mut from, mut remaining) = (u0.to_vec(), step.length);
        for event in 0..=MOST_EVENTS {
            let own = (event > 0).then(|| Step::new(self.system, remaining, self.linear));
            let piece = own.as_ref().unwrap_or(&step);
            let (forces, side) = self.balance(piece, &from, u1)?;
            let reversal = if event < MOST_EVENTS { self.reversal(piece, &from, u1, &forces, &side) } else { None };
            let Some((element, tau)) = reversal else {
                self.accept(piece, &from, u1, &forces, &side, None);
                return Ok(());
            };
            let share = tau / remaining;
            let at: Vec<f64> = from.iter().zip(u1).map(|(a, b)| a + share * (b - a)).collect();
            self.accept(&Step::new(self.system, tau, self.linear), &from, &at, &forces, &side, Some(element));
            (from, remaining) = (at, remaining - tau);
            if remaining <= 1e-12 * step.length {
                return Ok(());
            }
        }
        Ok(())
    }

    /// Forces of the elements over a step, and the sides on which friction slips.
    fn balance(&self, step: &Step, u0: &[f64], u1: &[f64]) -> Result<(Vec<f64>, Vec<f64>), TransientError> {
        let count = self.elements.len();
        let own;
        let w = if step.length == self.step.length {
            &self.receptance
        } else {
            own = Receptance::new(self.system, self.views, step);
            &own
        };
        let mut free = self.z.clone();
        step.decay(&mut free);
        for (i, (a, b)) in u0.iter().zip(u1).enumerate() {
            step.drive(&self.system.beta[count + i], *a, *b, &mut free);
        }
        let before: Vec<f64> = self.views.iter().map(|v| v.displacement.at(&self.z)).collect();
        let (mut forces, mut side) = (self.forces.clone(), self.side.clone());
        let mut greatest = 0.0_f64;
        for _ in 0..SWEEPS {
            let mut change = 0.0_f64;
            for l in 0..count {
                let row = l * count;
                let others =
                    |table: &[f64]| (0..count).filter(|&k| k != l).map(|k| table[row + k] * forces[k]).sum::<f64>();
                let x = self.views[l].displacement.at(&free) - before[l] - others(&w.displacement);
                let element = &self.elements[l];
                let mut new = None;
                if element.form == Form::Friction && self.side[l] == 0.0 {
                    let held = (self.views[l].velocity.at(&free) - others(&w.velocity)) / w.velocity[row + l];
                    let holds = held.abs() <= element.static_force();
                    side[l] = if holds { 0.0 } else { held.signum() };
                    new = holds.then_some(held);
                }
                let solve = || element.solve(before[l], w.displacement[row + l], x, step.length, side[l], forces[l]);
                let new = new.unwrap_or_else(solve);
                change = change.max((new - forces[l]).abs());
                greatest = greatest.max(new.abs());
                forces[l] = new;
            }
            if count == 1 || change <= 1e-12 * greatest {
                break;
            }
        }
        if forces.iter().all(|f| f.is_finite()) { Ok((forces, side)) } else { Err(TransientError::StepFailed) }
    }

    /// The first element whose slip ends within the step, and when.
    fn reversal(&self, step: &Step, u0: &[f64], u1: &[f64], forces: &[f64], side: &[f64]) -> Option<(usize, f64)> {
        let mut first: Option<(usize, f64)> = None;
        for l in 0..self.elements.len() {
            if self.elements[l].form != Form::Friction || side[l] == 0.0 {
                continue;
            }
            let start = self.views[l].velocity.at(&self.z) * side[l];
            let end = self.velocity_at(l, step, step.length, u0, u1, forces) * side[l];
            if self.side[l] == side[l] && start > 0.0 && end < 0.0 {
                let tau = self.crossing(l, step, u0, u1, forces, [start * side[l], end * side[l]]);
                if first.is_none_or(|(_, t)| tau < t) {
                    first = Some((l, tau));
                }
            }
        }
        first
    }

    /// Relative velocity of element `l` after the time `t` of a step under constant forces.
    fn velocity_at(&self, l: usize, step: &Step, t: f64, u0: &[f64], u1: &[f64], forces: &[f64]) -> f64 {
        let own;
        let part = if t == step.length {
            step
        } else {
            own = Step::new(self.system, t, false);
            &own
        };
        let share = t / step.length;
        let end: Vec<f64> = u0.iter().zip(u1).map(|(a, b)| a + share * (b - a)).collect();
        self.views[l].velocity.at(&self.moved(part, u0, &end, forces))
    }

    /// Instant at which the velocity of element `l` passes zero, by regula falsi (Illinois).
    fn crossing(&self, l: usize, step: &Step, u0: &[f64], u1: &[f64], forces: &[f64], ends: [f64; 2]) -> f64 {
        let ([mut a, mut b], [mut at_a, mut at_b]) = ([0.0, step.length], ends);
        let mut last = 0;
        for _ in 0..60 {
            let t = (a * at_b - b * at_a) / (at_b - at_a);
            let value = self.velocity_at(l, step, t, u0, u1, forces);
            if value == 0.0 || b - a <= 1e-13 * step.length || value.abs() <= 1e-14 * ends[0].abs().max(ends[1].abs()) {
                return t;
            }
            if value * at_a > 0.0 {
                (a, at_a) = (t, value);
                at_b *= if last == 1 { 0.5 } else { 1.0 };
                last = 1;
            } else {
                (b, at_b) = (t, value);
                at_a *= if last == 2 { 0.5 } else { 1.0 };
                last = 2;
            }
        }
        0.5 * (a + b)
    }

    /// State after a step under forces.
    fn moved(&self, step: &Step, u0: &[f64], u1: &[f64], forces: &[f64]) -> Vec<c64> {
        let mut z = self.z.clone();
        step.decay(&mut z);
        for (i, (a, b)) in u0.iter().zip(u1).enumerate() {
            step.drive(&self.system.beta[forces.len() + i], *a, *b, &mut z);
        }
        for (l, force) in forces.iter().enumerate() {
            step.push(&self.system.beta[l], -force, &mut z);
        }
        z
    }

    /// Takes a step that is decided: state, derivatives and memories move on. `turned` is the element that comes to rest.
    fn accept(&mut self, step: &Step, u0: &[f64], u1: &[f64], forces: &[f64], side: &[f64], turned: Option<usize>) {
        let next = self.moved(step, u0, u1, forces);
        let before: Vec<f64> = self.views.iter().map(|v| v.displacement.at(&self.z)).collect();
        let after: Vec<f64> = self.views.iter().map(|v| v.displacement.at(&next)).collect();
        if !self.sensitivities.is_empty() {
            self.differentiate(step, u0, u1, forces, side, &before, &after);
        }
        self.z = next;
        self.side.clear();
        self.side.extend_from_slice(side);
        self.forces.clear();
        self.forces.extend_from_slice(forces);
        for l in 0..forces.len() {
            let slipped = self.elements[l].form == Form::Friction && side[l] != 0.0;
            if slipped && self.views[l].velocity.at(&self.z) * side[l] <= 0.0 {
                self.side[l] = 0.0;
            }
            let (element, list) = (&mut self.elements[l], &self.sensitivities);
            let own: Vec<Option<usize>> = list.iter().map(|s| s.own_of(element)).collect();
            let changes: Vec<f64> = list.iter().map(|s| self.views[l].displacement.at(&s.modes)).collect();
            element.commit(after[l], step.length, |theta| changes[theta], |theta| own[theta]);
        }
        if let Some(element) = turned {
            self.side[element] = 0.0;
            self.jump = (!self.sensitivities.is_empty()).then(|| self.jump_at(element, u1, forces));
        }
    }

    /// The reversal of an element at the present instant.
    fn jump_at(&self, element: usize, u: &[f64], forces: &[f64]) -> Jump {
        let view = &self.views[element];
        let inputs = forces.iter().map(|f| -f).chain(u.iter().copied());
        let pushed: f64 = view.acceleration.inputs.iter().zip(inputs).map(|(c, f)| c * f).sum();
        let acceleration = view.acceleration.at(&self.z) + pushed;
        let when = |s: &Sensitivity| {
            if acceleration == 0.0 { 0.0 } else { -view.velocity.at(&s.modes) / acceleration }
        };
        Jump { element, before: forces[element], when: self.sensitivities.iter().map(when).collect() }
    }

    /// Derivatives of the state and of the forces over a step.
    #[expect(clippy::too_many_arguments, reason = "one decided step")]
    fn differentiate(
        &mut self,
        step: &Step,
        u0: &[f64],
        u1: &[f64],
        forces: &[f64],
        side: &[f64],
        before: &[f64],
        after: &[f64],
    ) {
        let count = self.elements.len();
        let jump = self.jump.take();
        let own;
        let w = if step.length == self.step.length {
            &self.receptance
        } else {
            own = Receptance::new(self.system, self.views, step);
            &own
        };
        let held = |l: usize, elements: &[Element]| elements[l].form == Form::Friction && side[l] == 0.0;
        let mean = |l: usize| self.elements[l].mean(before[l], after[l] - before[l], step.length, side[l]);
        let means: Vec<_> = (0..count).map(mean).collect();
        let matrix = (0..count * count).map(|at| {
            let (l, k) = (at / count, at % count);
            let unit = f64::from(u8::from(l == k));
            if held(l, &self.elements) { w.velocity[at] } else { unit + means[l].by_step * w.displacement[at] }
        });
        let solver = (count > 0).then(|| RowLu::new(count, matrix.collect())).flatten();
        let on_structure: Vec<f64> = forces.iter().map(|f| -f).collect();
        for theta in 0..self.sensitivities.len() {
            let s = &mut self.sensitivities[theta];
            if let Some(jump) = &jump {
                let size = (forces[jump.element] - jump.before) * jump.when[theta];
                s.modes.iter_mut().zip(&self.system.beta[jump.element]).for_each(|(s, b)| *s += b * size);
            }
            let starts: Vec<f64> = self.views.iter().map(|v| v.displacement.at(&s.modes)).collect();
            step.decay(&mut s.modes);
            if let Some(change) = &s.change {
                let all = StepForces { elements: &on_structure, start: u0, end: u1 };
                step.change(self.system, change, &self.z, &all, &mut s.modes);
            }
            let Some(solver) = &solver else { continue };
            let mut rhs: Vec<f64> = Vec::with_capacity(count);
            for l in 0..count {
                let view = &self.views[l];
                if held(l, &self.elements) {
                    rhs.push(view.velocity.at(&s.modes));
                    continue;
                }
                let moved = view.displacement.at(&s.modes) - starts[l];
                let element = &mut self.elements[l];
                let own = s.own_of(element);
                let explicit = element.by_parameter(theta, own, before[l], after[l] - before[l], step.length, side[l]);
                rhs.push(means[l].by_step * moved + means[l].by_start * starts[l] + explicit);
            }
            solver.solve(&mut rhs);
            for (l, force) in rhs.iter().enumerate() {
                step.push(&self.system.beta[l], -force, &mut s.modes);
            }
            s.forces = rhs;
        }
    }
}

impl Receptance {
    fn new(system: &LinearSystem, views: &[View], step: &Step) -> Self {
        let table = |of: &dyn Fn(&View) -> &Functional| {
            let row = |view: &View| {
                let modes = of(view).modes.clone();
                (0..views.len()).map(|k| step.receptance(&system.beta[k], &modes)).collect::<Vec<f64>>()
            };
            views.iter().flat_map(row).collect()
        };
        Self { displacement: table(&|v| &v.displacement), velocity: table(&|v| &v.velocity) }
    }
}

fn sign(v: f64) -> f64 {
    if v == 0.0 { 0.0 } else { v.signum() }
}
