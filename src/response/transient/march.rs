//! Stepping: forces of all elements at once, reversals of friction located within a step, derivatives carried along
//! ([`super::derivatives`]).
//!
//! Friction slips with a given sign until its velocity passes zero at `tau`; there the force jumps from `F-` to `F+` (the
//! other side, or what keeps it at rest). With `d tau = -(v_theta) / a` the derivative of the state at the end gains
//!
//! ```text
//! S += beta (F+ - F-) d tau
//! ```
//!
//! At rest the force is that which leaves no velocity at the end of the step, as long as friction can hold it (Moreau).

use super::changes::Changes;
use super::derivatives::Derivatives;
use super::element::{Element, Form};
use super::error::TransientError;
use super::hold::{Polynomial, shifted, value};
use super::initial_memory::earlier_views;
use super::step::Step;
use super::system::{LinearChange, LinearSystem};
use super::view::{Piece, Receptance, View};
use dashpot_numerics::dot;

/// Reversals that are located within one step.
const MOST_EVENTS: usize = 6;
/// Sweeps of Gauss and Seidel.
const SWEEPS: usize = 400;

/// The march through a record.
pub(super) struct March<'a> {
    pub system: &'a LinearSystem,
    pub views: &'a [View],
    pub elements: Vec<Element>,
    pub z: Vec<f64>,
    pub derivatives: Derivatives,
    /// Sign of the slip of each element, 0 at rest.
    pub side: Vec<f64>,
    /// Mean forces over the last step, N.
    pub forces: Vec<f64>,
    step: Step,
    receptance: Receptance,
    trial: Trial,
}

/// A step that is tried.
#[derive(Default)]
struct Trial {
    /// State at its end under the drives alone; once it is taken, the state.
    free: Vec<f64>,
    /// Displacements of the elements at its ends, m, and their velocities at its end, m/s.
    before: Vec<f64>,
    after: Vec<f64>,
    speeds: Vec<f64>,
    /// Mean forces, N, and sides of slip.
    forces: Vec<f64>,
    side: Vec<f64>,
}

impl<'a> March<'a> {
    /// From the state `z` with its `derivatives`, in steps like `step`.
    pub(super) fn new(
        system: &'a LinearSystem,
        views: &'a [View],
        mut elements: Vec<Element>,
        z: Vec<f64>,
        mut derivatives: Derivatives,
        step: Step,
    ) -> Self {
        let receptance = Receptance::new(views, &step);
        let side = views.iter().map(|view| sign(dot(&view.velocity, &z))).collect();
        for (l, (element, view)) in elements.iter_mut().zip(views).enumerate() {
            if !element.form.has_memory() {
                continue;
            }
            let (earlier, step) = earlier_views(system, view, &z);
            for (n, view) in earlier.iter().chain([view]).enumerate() {
                let step = if n == 0 { f64::INFINITY } else { step };
                derivatives.commit(l, element, view, dot(&view.displacement, &z), step);
            }
        }
        let forces = vec![0.0; elements.len()];
        Self { system, views, elements, z, derivatives, side, forces, step, receptance, trial: Trial::default() }
    }

    /// Goes on in steps of `length` s under polynomials of `sample` s of so many drives.
    pub(super) fn set_step(&mut self, [length, sample]: [f64; 2], changes: &[LinearChange], drives: usize) {
        self.step = Step::new(self.system, length, sample);
        self.receptance = Receptance::new(self.views, &self.step);
        self.derivatives.set_changes(Changes::new(self.system, &self.step, changes, [self.elements.len(), drives]));
    }

    /// One step under the drives.
    pub(super) fn advance(&mut self, drives: &[Polynomial]) -> Result<(), TransientError> {
        let step = std::mem::replace(&mut self.step, Step::empty());
        let mut trial = std::mem::take(&mut self.trial);
        let done = self.advance_by(&step, &mut trial, drives);
        (self.step, self.trial) = (step, trial);
        done
    }

    fn advance_by(&mut self, step: &Step, trial: &mut Trial, drives: &[Polynomial]) -> Result<(), TransientError> {
        let ahead = self.balance(step, true, trial, drives)?;
        if ahead.is_none() {
            self.accept(step, true, trial, drives, None);
            return Ok(());
        }
        let (mut drives, mut remaining) = (drives.to_vec(), step.length);
        for event in 0..=MOST_EVENTS {
            let own = (event > 0).then(|| Step::new(self.system, remaining, step.sample));
            let piece = own.as_ref().unwrap_or(step);
            let full = event == 0;
            let ahead = if full { ahead } else { self.balance(piece, full, trial, &drives)? };
            let reversal = match ahead {
                Some(_) if event < MOST_EVENTS => self.reversal(piece, trial, &drives),
                _ => None,
            };
            let Some((element, tau)) = reversal else {
                self.accept(piece, full, trial, &drives, None);
                return Ok(());
            };
            let part = Step::new(self.system, tau, step.sample);
            self.moved(&part, &drives, &mut trial.free);
            self.accept(&part, false, trial, &drives, Some(element));
            drives.iter_mut().for_each(|drive| *drive = shifted(drive, part.share()));
            remaining -= tau;
            if remaining <= 1e-12 * step.length {
                return Ok(());
            }
        }
        Ok(())
    }

    /// Forces of the elements over a step, and the sides on which friction slips; an element that turns within it, if any.
    fn balance(
        &self,
        step: &Step,
        full: bool,
        trial: &mut Trial,
        drives: &[Polynomial],
    ) -> Result<Option<usize>, TransientError> {
        let count = self.elements.len();
        let own;
        let w = if full {
            &self.receptance
        } else {
            own = Receptance::new(self.views, step);
            &own
        };
        self.moved(step, drives, &mut trial.free);
        let Trial { free, before, forces, side, speeds, .. } = trial;
        before.clear();
        before.extend(self.views.iter().map(|v| dot(&v.displacement, &self.z)));
        forces.clone_from(&self.forces);
        side.clone_from(&self.side);
        let mut greatest = 0.0_f64;
        for _ in 0..SWEEPS {
            let mut change = 0.0_f64;
            for l in 0..count {
                let row = l * count;
                let others =
                    |table: &[f64]| (0..count).filter(|&k| k != l).map(|k| table[row + k] * forces[k]).sum::<f64>();
                let x = dot(&self.views[l].displacement, free) - before[l] - others(&w.displacement);
                let element = &self.elements[l];
                let mut new = None;
                if element.form == Form::Friction && self.side[l] == 0.0 {
                    let held = (dot(&self.views[l].velocity, free) - others(&w.velocity)) / w.velocity[row + l];
                    let [low, high] = element.static_forces();
                    let holds = (low..=high).contains(&held);
                    side[l] = match held {
                        _ if holds => 0.0,
                        _ if held > high => 1.0,
                        _ => -1.0,
                    };
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
        if !forces.iter().all(|f| f.is_finite()) {
            return Err(TransientError::StepFailed);
        }
        speeds.clear();
        let at_end = |l: usize| {
            let given = (0..count).map(|k| w.velocity[l * count + k] * forces[k]).sum::<f64>();
            dot(&self.views[l].velocity, free) - given
        };
        speeds.extend((0..count).map(at_end));
        Ok((0..count).find(|&l| self.turns_within(trial, l)))
    }

    /// Whether the slip of element `l` ends within the step that was tried.
    fn turns_within(&self, trial: &Trial, l: usize) -> bool {
        let side = trial.side[l];
        self.elements[l].form == Form::Friction
            && side != 0.0
            && self.side[l] == side
            && trial.speeds[l] * side < 0.0
            && dot(&self.views[l].velocity, &self.z) * side > 0.0
    }

    /// The first element whose slip ends within the step, and when.
    fn reversal(&self, step: &Step, trial: &Trial, drives: &[Polynomial]) -> Option<(usize, f64)> {
        let turning = (0..self.elements.len()).filter(|&l| self.turns_within(trial, l));
        let when = |l: usize| {
            let start = dot(&self.views[l].velocity, &self.z);
            (l, self.crossing(l, step, drives, &trial.forces, [start, trial.speeds[l]]))
        };
        turning.map(when).min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Relative velocity of element `l` after the time `t` of a step under constant forces.
    fn velocity_at(&self, l: usize, step: &Step, t: f64, drives: &[Polynomial], forces: &[f64]) -> f64 {
        let part = Step::new(self.system, t, step.sample);
        let mut z = Vec::new();
        self.moved(&part, drives, &mut z);
        forces.iter().enumerate().for_each(|(l, force)| part.push(l, -force, &mut z));
        dot(&self.views[l].velocity, &z)
    }

    /// Instant at which the velocity of element `l` passes zero, by regula falsi (Illinois).
    fn crossing(&self, l: usize, step: &Step, drives: &[Polynomial], forces: &[f64], ends: [f64; 2]) -> f64 {
        let ([mut a, mut b], [mut at_a, mut at_b]) = ([0.0, step.length], ends);
        let mut last = 0;
        for _ in 0..60 {
            let t = (a * at_b - b * at_a) / (at_b - at_a);
            let value = self.velocity_at(l, step, t, drives, forces);
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

    /// State after a step under the drives alone.
    fn moved(&self, step: &Step, drives: &[Polynomial], z: &mut Vec<f64>) {
        z.clone_from(&self.z);
        step.decay(z);
        for (i, drive) in drives.iter().enumerate() {
            step.drive(self.elements.len() + i, drive, z);
        }
    }

    /// Takes a step that is decided: state, derivatives and memories move on. `turned` is the element that comes to rest.
    fn accept(&mut self, step: &Step, full: bool, trial: &mut Trial, drives: &[Polynomial], turned: Option<usize>) {
        let Trial { free: next, before, after, forces, side, .. } = trial;
        forces.iter().enumerate().for_each(|(l, force)| step.push(l, -force, next));
        after.clear();
        after.extend(self.views.iter().map(|v| dot(&v.displacement, next)));
        let piece = Piece { step, full, drives, forces, side, states: [&self.z, next], before, after };
        let patterns = &self.system.patterns[..];
        self.derivatives.advance(&piece, &mut self.elements, self.views, patterns, &self.receptance);
        std::mem::swap(&mut self.z, next);
        self.side.clone_from(side);
        self.forces.clone_from(forces);
        for l in 0..forces.len() {
            let slipped = self.elements[l].form == Form::Friction && side[l] != 0.0;
            if slipped && dot(&self.views[l].velocity, &self.z) * side[l] <= 0.0 {
                self.side[l] = 0.0;
            }
            self.derivatives.commit(l, &mut self.elements[l], &self.views[l], after[l], step.length);
        }
        if let Some(element) = turned {
            self.side[element] = 0.0;
            let end: Vec<f64> = drives.iter().map(|drive| value(drive, step.share())).collect();
            let acceleration = self.acceleration(element, &end, forces);
            self.derivatives.turned(element, &self.views[element], forces, acceleration);
        }
    }

    /// Relative acceleration of an element at the present instant.
    fn acceleration(&self, element: usize, u: &[f64], forces: &[f64]) -> f64 {
        let view = &self.views[element].acceleration;
        let inputs = forces.iter().map(|f| -f).chain(u.iter().copied());
        let pushed: f64 = view.inputs.iter().zip(inputs).map(|(c, f)| c * f).sum();
        dot(&view.row, &self.z) + pushed
    }
}

fn sign(v: f64) -> f64 {
    if v == 0.0 { 0.0 } else { v.signum() }
}
