//! What is fitted to records: the variables, how they move a model, by what they are differentiated, and their priors.
//!
//! Shared by all records: parameters of added laws (logarithms where they are positive), stiffness and known sources as
//! logarithms of factors with priors. Of a record: `2 m` entries of its initial state, free, and a logarithm of stiffness with
//! the prior of re-seating.

use super::data::Records;
use super::fitted::FittedRecords;
use super::variables::{at_variable, variable};
use crate::control::Control;
use crate::response::transient::TransientParameter;

/// Prior deviation of the logarithm of all stiffness, of the size of a known source, of the stiffness of one record, of that of
/// a mode, of all mass.
const PRIORS: [f64; 5] = [0.03, 0.15, 0.002, 0.02, 0.02];
/// Largest change of a logarithm in one step.
const REACH: f64 = 1.0;

/// What is free beside the initial states and the effects.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Free {
    /// All stiffness, then the size of every known source, then the stiffness of every mode, at last all mass; none where it is
    /// empty.
    pub corrections: Vec<bool>,
    /// The shift of every record.
    pub shifts: bool,
}

impl Free {
    /// Initial states and effects only.
    pub fn nothing() -> Self {
        Self { corrections: Vec::new(), shifts: false }
    }

    /// All of it but the stiffness of single modes.
    pub fn but_modes(records: &Records) -> Self {
        let mut free = Self::all(records);
        let first = 1 + records.known.len();
        free.corrections[first..first + modes(records)].fill(false);
        free
    }

    /// All of it.
    pub fn all(records: &Records) -> Self {
        let mut corrections = vec![true; 2 + records.known.len() + modes(records)];
        // A motion without a force shows no mass.
        let last = corrections.len() - 1;
        corrections[last] = records.list.iter().any(|r| !r.forces.is_empty());
        Self { corrections, shifts: true }
    }
}

/// Modes whose stiffness may be free beside that of all; none where there is only one.
pub(super) fn modes(records: &Records) -> usize {
    if records.kept > 1 { records.kept } else { 0 }
}

/// A fit to the first part of every record.
pub(crate) struct FitProblem<'a> {
    pub records: &'a Records<'a>,
    pub free: Free,
    /// Share of every record that is used.
    pub share: f64,
    pub control: &'a Control,
}

impl FitProblem<'_> {
    /// Number of shared variables.
    pub(super) fn shared(&self, at: &FittedRecords) -> usize {
        let laws: usize = at.effects.iter().map(|e| e.parameters.len()).sum();
        laws + self.free.corrections.len()
    }

    /// Variables of each record.
    pub(super) fn local(&self) -> usize {
        2 * self.records.kept + usize::from(self.free.shifts)
    }

    /// `at` moved by a change of all variables.
    pub(super) fn moved(&self, at: &FittedRecords, scales: &[Vec<f64>], change: &[f64]) -> FittedRecords {
        let mut next = at.clone();
        let mut k = 0;
        for (effect, scales) in next.effects.iter_mut().zip(scales) {
            for (j, parameter) in effect.effect.parameters().iter().enumerate() {
                let now = variable(parameter, scales[j], effect.parameters[j]);
                let reach = if parameter.least.is_finite() { REACH } else { f64::INFINITY };
                effect.parameters[j] = at_variable(parameter, scales[j], now + change[k].clamp(-reach, reach))[0];
                k += 1;
            }
        }
        if !self.free.corrections.is_empty() {
            next.stiffness += change[k].clamp(-0.1, 0.1);
            for (j, v) in next.known.iter_mut().enumerate() {
                *v += change[k + 1 + j].clamp(-0.5, 0.5);
            }
            for r in 0..modes(self.records) {
                next.modes[r] += change[k + 1 + at.known.len() + r].clamp(-0.1, 0.1);
            }
            next.mass += change[k + self.free.corrections.len() - 1].clamp(-0.1, 0.1);
        }
        let (shared, local) = (self.shared(at), self.local());
        for r in 0..self.records.list.len() {
            let from = shared + r * local;
            for (j, p) in next.initial[r].iter_mut().enumerate() {
                *p += change[from + j];
            }
            if self.free.shifts {
                next.shifts[r] += change[from + 2 * self.records.kept].clamp(-0.05, 0.05);
            }
        }
        next
    }

    /// Parameters by which a record is differentiated, with their variable and the factor on the derivative.
    pub(super) fn unknowns(
        &self,
        at: &FittedRecords,
        scales: &[Vec<f64>],
        r: usize,
    ) -> Vec<(TransientParameter, usize, f64)> {
        let mut list = Vec::new();
        let offset = self.records.known.len();
        let mut k = 0;
        for (source, slopes) in at.effects.iter().enumerate().map(|(e, _)| (offset + e, &scales[e])) {
            let effect = &at.effects[source - offset];
            for (parameter, law) in effect.effect.parameters().iter().enumerate() {
                let now = variable(law, slopes[parameter], effect.parameters[parameter]);
                let slope = at_variable(law, slopes[parameter], now)[1];
                list.push((TransientParameter::Source { source, parameter }, k, slope));
                k += 1;
            }
        }
        let from = self.shared(at) + r * self.local();
        if self.free.shifts {
            list.push((TransientParameter::Stiffness, from + 2 * self.records.kept, 1.0));
        }
        if !self.free.corrections.is_empty() {
            let free = |j: usize| self.free.corrections[j];
            if free(0) {
                list.push((TransientParameter::Stiffness, k, 1.0));
            }
            let sources = at.sources(self.records);
            for (source, known) in sources.iter().take(offset).enumerate().filter(|(s, _)| free(1 + s)) {
                for &parameter in known.effect.scaled() {
                    let unknown = TransientParameter::Source { source, parameter };
                    list.push((unknown, k + 1 + source, known.parameters[parameter]));
                }
            }
            let modes = (0..modes(self.records)).filter(|r| free(1 + offset + r));
            list.extend(modes.map(|r| (TransientParameter::Mode(r), k + 1 + offset + r, 1.0)));
            let mass = self.free.corrections.len() - 1;
            if free(mass) {
                list.push((TransientParameter::Mass, k + mass, 1.0));
            }
        }
        list.extend((0..2 * self.records.kept).map(|j| (TransientParameter::Initial(j), from + j, 1.0)));
        list
    }

    /// Corrections with their prior deviations: number of the variable, value, deviation.
    pub(super) fn priors(&self, at: &FittedRecords) -> Vec<(usize, f64, f64)> {
        let laws = self.shared(at) - self.free.corrections.len();
        let mut list = Vec::new();
        if !self.free.corrections.is_empty() {
            list.push((laws, at.stiffness, PRIORS[0]));
            list.extend(at.known.iter().enumerate().map(|(j, v)| (laws + 1 + j, *v, PRIORS[1])));
            list.extend((0..modes(self.records)).map(|r| (laws + 1 + at.known.len() + r, at.modes[r], PRIORS[3])));
            list.push((laws + self.free.corrections.len() - 1, at.mass, PRIORS[4]));
            list.retain(|(k, ..)| self.free.corrections[k - laws]);
        }
        if self.free.shifts {
            let at_record = |r: usize| self.shared(at) + r * self.local() + 2 * self.records.kept;
            list.extend(at.shifts.iter().enumerate().map(|(r, v)| (at_record(r), *v, PRIORS[2])));
        }
        list
    }
}
