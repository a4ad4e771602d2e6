//! What is fitted to records: the variables, how they move a model, by what they are differentiated, and their priors.
//!
//! Shared by all records: parameters of added laws (logarithms where they are positive), stiffness and known sources as
//! logarithms of factors with priors. Of a record: `2 m` entries of its initial state, free, and a logarithm of stiffness with
//! the prior of re-seating.

use super::data::{RecordData, Records};
use super::fitted::FittedRecords;
use super::part_directions::{ALL, MODE};
use super::variables::{at_variable, variable};
use crate::control::Control;
use crate::diagnosis::updating::detuning::{LIKELY_MODE_DAMPING, LIKELY_SIZE};
use crate::response::transient::TransientParameter;

/// Prior deviation of the logarithm of all stiffness, of the size of a known source or the damping of a mode, of the stiffness of one record, of that of
/// a mode, of all mass, of the shape of a mode at a sensor, of an offset over the largest sample.
pub(super) const PRIORS: [f64; 7] = [ALL, 0.15, 0.002, 0.02, 0.02, 0.02, 0.01];
/// Degrees of freedom of the distribution of damping below what is stated: the fewest whole number with which it has a variance.
const TAIL: f64 = 3.0;
/// Largest change of a logarithm in one step.
const REACH: f64 = 1.0;

/// What is free beside the initial states, the offsets of the channels of every record and the effects.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Free {
    /// All stiffness, then the size of every known source, then the damping and the stiffness of every mode, then all mass, at last the parts; none
    /// where it is empty.
    pub corrections: Vec<bool>,
    /// The shift of every record, which its parts share.
    pub shifts: bool,
    /// The shapes of the modes at the sensors.
    pub shapes: bool,
    /// The parameters of the effects.
    pub effects: bool,
}

impl Free {
    /// Initial states, offsets and effects only.
    pub(super) fn nothing() -> Self {
        Self { corrections: Vec::new(), shifts: false, shapes: false, effects: true }
    }

    /// All of it but the stiffness of single modes.
    pub(super) fn but_modes(records: &Records) -> Self {
        let mut free = Self::all(records);
        let first = 1 + records.sizes();
        free.corrections[first..first + modes(records)].fill(false);
        free.corrections[first + modes(records) + 1..].fill(false);
        free
    }

    /// All of it; the mass, beside the stiffness, stands for the gain of a measured force, where errors of the shapes do not, and for
    /// the error of a single shape.
    pub(super) fn all(records: &Records) -> Self {
        let mut corrections = vec![true; 2 + records.sizes() + modes(records) + records.parts.len()];
        let by_mass = records.has_one_shape();
        let driven = records.list.iter().any(RecordData::shows_mass);
        corrections[1 + records.sizes() + modes(records)] = by_mass || (driven && !records.parts.is_empty());
        Self { corrections, shifts: true, shapes: !by_mass, effects: true }
    }
}

/// Modes whose stiffness may be free beside that of all; none where there is only one.
pub(super) fn modes(records: &Records) -> usize {
    if records.kept > 1 { records.kept } else { 0 }
}

/// Squared corrections of stiffness, mass, modes and known sources over their prior deviations; the shapes of the modes count as
/// one, by their mean.
pub(super) fn corrected_by(fit: &FittedRecords) -> f64 {
    let square = |list: &[f64], deviation: f64| list.iter().map(|v| (v / deviation).powi(2)).sum::<f64>();
    let shapes: f64 = fit.shapes.iter().map(|list| square(list, PRIORS[5])).sum();
    let count = fit.shapes.iter().map(Vec::len).sum::<usize>().max(1) as f64;
    square(&[fit.stiffness], PRIORS[0])
        + square(&fit.known, PRIORS[1])
        + fit.damping.iter().map(|v| cost_of_damping(*v)).sum::<f64>()
        + square(&fit.modes, PRIORS[3])
        + square(&[fit.mass], PRIORS[4])
        + square(&fit.parts, 1.0)
        + shapes / count
}

/// What the prior takes for the logarithm of a factor on the damping of a mode:
///
/// ```text
/// (v / s)^2 for v > 0,     k ln(1 + v^2 / (k s^2)) for v < 0,     s = 0.15, k = 3
/// ```
///
/// Damping beyond what is stated is what a missing effect takes out, and is plausible as far as damping is known. Damping below it is no
/// missing effect, for none puts energy in: there the stated law is wrong in kind, as one in proportion to stiffness is at high modes by
/// several times, so that the tail is that of Student's distribution (Gelman et al. 2013, Bayesian Data Analysis, section 17.2).
pub(super) fn cost_of_damping(v: f64) -> f64 {
    let square = (v / PRIORS[1]).powi(2);
    if v < 0.0 { TAIL * (square / TAIL).ln_1p() } else { square }
}

/// What the prior takes for the logarithm of the factor on the size of a known source.
pub(super) fn cost_of_size(v: f64) -> f64 {
    (v / PRIORS[1]).powi(2)
}

/// The deviation of a normal distribution of the same slope.
fn damping_deviation(v: f64) -> f64 {
    if v < 0.0 { PRIORS[1].hypot(v / TAIL.sqrt()) } else { PRIORS[1] }
}

/// A fit without the corrections that are no more than their priors allow: nobody was asked what else they stand for.
pub(super) fn beyond_priors(fit: &FittedRecords) -> FittedRecords {
    let told = |v: f64, prior: f64| if v.abs() > prior { v } else { 0.0 };
    let each = |list: &[f64], prior: f64| list.iter().map(|v| told(*v, prior)).collect::<Vec<f64>>();
    FittedRecords {
        stiffness: told(fit.stiffness, PRIORS[0]),
        known: each(&fit.known, PRIORS[1]),
        damping: each(&fit.damping, PRIORS[1]),
        modes: each(&fit.modes, PRIORS[3]),
        mass: told(fit.mass, PRIORS[4]),
        parts: each(&fit.parts, 1.0),
        ..fit.clone()
    }
}

/// Whether a known source is off, or a mode damped more than stated, by more than is plausible without looking for an effect: then it stands
/// for something else.
pub(super) fn is_strained(fit: &FittedRecords) -> bool {
    fit.known.iter().any(|v| v.abs() > LIKELY_SIZE) || fit.damping.iter().any(|v| *v > LIKELY_MODE_DAMPING)
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
        laws + self.free.corrections.len() + self.shapes()
    }

    /// Number of errors of shapes that are free, those of a sensor one behind the other: the last of the shared variables.
    pub(super) fn shapes(&self) -> usize {
        if self.free.shapes { self.records.sensors() * self.records.kept } else { 0 }
    }

    /// Number of the first correction among the variables, which follow those of the laws.
    pub(super) fn first_correction(&self, at: &FittedRecords) -> usize {
        self.shared(at) - self.shapes() - self.free.corrections.len()
    }

    /// Number of the variable of all mass, which those of the parts follow.
    pub(super) fn mass_variable(&self, at: &FittedRecords) -> usize {
        self.first_correction(at) + 1 + self.records.sizes() + modes(self.records)
    }

    /// Number of the variable of the shape of mode 0 at a sensor; none where shapes are held.
    pub(super) fn shape_variable(&self, at: &FittedRecords, sensor: usize) -> Option<usize> {
        self.free.shapes.then(|| self.shared(at) - self.shapes() + sensor * self.records.kept)
    }

    /// Variables of each record.
    pub(super) fn local(&self) -> usize {
        2 * self.records.kept + usize::from(self.free.shifts) + self.offsets()
    }

    /// Offsets of each record, the last of its variables.
    pub(super) fn offsets(&self) -> usize {
        self.records.most_channels()
    }

    /// Number of the variable of the offset of channel 0 of a record.
    pub(super) fn offset_variable(&self, at: &FittedRecords, r: usize) -> usize {
        self.shared(at) + (r + 1) * self.local() - self.offsets()
    }

    /// Number of the variable of the shift of a record: that of its first part, so that none stands for a frequency that follows the amplitude.
    pub(super) fn shift_variable(&self, at: &FittedRecords, r: usize) -> usize {
        let list = &self.records.list;
        let first = list.iter().position(|other| other.index == list[r].index).unwrap_or(r);
        self.own_shift(at, first)
    }

    fn own_shift(&self, at: &FittedRecords, r: usize) -> usize {
        self.shared(at) + r * self.local() + 2 * self.records.kept
    }

    /// Variables of shifts of parts that share that of another.
    pub(super) fn unused_shifts(&self, at: &FittedRecords) -> Vec<usize> {
        let all = if self.free.shifts { self.records.list.len() } else { 0 };
        (0..all)
            .map(|r| self.own_shift(at, r))
            .zip(0..)
            .filter(|(k, r)| *k != self.shift_variable(at, *r))
            .map(|(k, _)| k)
            .collect()
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
            for (j, v) in next.known.iter_mut().chain(&mut next.damping).enumerate() {
                *v += change[k + 1 + j].clamp(-0.5, 0.5);
            }
            for r in 0..modes(self.records) {
                next.modes[r] += change[k + 1 + self.records.sizes() + r].clamp(-0.1, 0.1);
            }
            let mass = self.mass_variable(at);
            next.mass += change[mass].clamp(-0.1, 0.1);
            next.parts.iter_mut().zip(&change[mass + 1..]).for_each(|(v, c)| *v += c.clamp(-3.0, 3.0));
        }
        for (sensor, errors) in next.shapes.iter_mut().enumerate() {
            let Some(first) = self.shape_variable(at, sensor) else { break };
            errors.iter_mut().zip(&change[first..]).for_each(|(e, c)| *e += c.clamp(-0.1, 0.1));
        }
        let (shared, local) = (self.shared(at), self.local());
        for r in 0..self.records.list.len() {
            let from = shared + r * local;
            for (j, p) in next.initial[r].iter_mut().enumerate() {
                *p += change[from + j];
            }
            if self.free.shifts {
                next.shifts[r] += change[self.shift_variable(at, r)].clamp(-0.05, 0.05);
            }
            let first = self.offset_variable(at, r);
            next.offsets[r].iter_mut().zip(&change[first..]).for_each(|(o, c)| *o += c);
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
                if self.free.effects {
                    list.push((TransientParameter::Source { source, parameter }, k, slope));
                }
                k += 1;
            }
        }
        let from = self.shared(at) + r * self.local();
        if self.free.shifts {
            list.push((TransientParameter::Stiffness, self.shift_variable(at, r), 1.0));
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
            let damped = (0..self.records.damped()).filter(|r| free(1 + offset + r));
            list.extend(damped.map(|r| (TransientParameter::ModeDamping(r), k + 1 + offset + r, 1.0)));
            let first = 1 + self.records.sizes();
            let modes = (0..modes(self.records)).filter(|r| free(first + r));
            list.extend(modes.map(|r| (TransientParameter::Mode(r), k + first + r, 1.0)));
            let mass = self.mass_variable(at) - k;
            if free(mass) {
                list.push((TransientParameter::Mass, k + mass, 1.0));
            }
            let parts = (0..at.parts.len()).filter(|p| free(mass + 1 + p));
            list.extend(parts.map(|p| (TransientParameter::Direction(p), k + mass + 1 + p, 1.0)));
        }
        list.extend((0..2 * self.records.kept).map(|j| (TransientParameter::Initial(j), from + j, 1.0)));
        list
    }

    /// Prior deviation of the stiffness or of the shape of a mode, `alone` where no errors of parts are free beside it.
    fn beside_parts(&self, alone: f64) -> f64 {
        let mut parts = self.free.corrections.iter().rev().take(self.records.parts.len());
        if parts.any(|free| *free) && self.records.structure.supports().is_empty() { MODE } else { alone }
    }

    /// What the priors take for the corrections that are free, with their [`Self::priors`].
    pub(super) fn prior_cost(&self, at: &FittedRecords, priors: &[(usize, f64, f64)]) -> f64 {
        let first = self.first_correction(at) + 1 + at.known.len();
        let damping = first..first + at.damping.len();
        let cost = |(k, value, deviation): &(usize, f64, f64)| {
            if damping.contains(k) { cost_of_damping(*value) } else { (value / deviation).powi(2) }
        };
        priors.iter().map(cost).sum()
    }

    /// Corrections with their prior deviations: number of the variable, value, deviation.
    pub(super) fn priors(&self, at: &FittedRecords) -> Vec<(usize, f64, f64)> {
        let laws = self.first_correction(at);
        let mut list = Vec::new();
        if !self.free.corrections.is_empty() {
            let mode = self.beside_parts(PRIORS[3]);
            list.push((laws, at.stiffness, PRIORS[0]));
            let known = at.known.iter().map(|v| (*v, PRIORS[1]));
            let sizes = known.chain(at.damping.iter().map(|v| (*v, damping_deviation(*v)))).enumerate();
            list.extend(sizes.map(|(j, (v, deviation))| (laws + 1 + j, v, deviation)));
            let first = laws + 1 + self.records.sizes();
            list.extend((0..modes(self.records)).map(|r| (first + r, at.modes[r], mode)));
            let mass = self.mass_variable(at);
            list.push((mass, at.mass, PRIORS[4]));
            list.extend(at.parts.iter().enumerate().map(|(p, v)| (mass + 1 + p, *v, 1.0)));
            list.retain(|(k, ..)| self.free.corrections[k - laws]);
        }
        let shape = self.beside_parts(PRIORS[5]);
        for (sensor, errors) in at.shapes.iter().enumerate() {
            let Some(first) = self.shape_variable(at, sensor) else { break };
            list.extend(errors.iter().enumerate().map(|(r, e)| (first + r, *e, shape)));
        }
        for r in 0..self.records.list.len() {
            let first = self.offset_variable(at, r);
            let offset = |c: usize| at.offsets[r].get(c).copied().unwrap_or(0.0);
            let deviation = |c: usize| PRIORS[6].max(self.records.list[r].mean_share(c));
            list.extend((0..self.offsets()).map(|c| (first + c, offset(c), deviation(c))));
        }
        if self.free.shifts {
            let own =
                at.shifts.iter().enumerate().map(|(r, v)| (self.own_shift(at, r), self.shift_variable(at, r), *v));
            list.extend(own.filter(|(own, shared, _)| own == shared).map(|(k, _, v)| (k, v, PRIORS[2])));
        }
        list
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::super::search::Search;
    use super::*;
    use crate::common::models::oscillator;
    use crate::common::runs::decay;

    /// The normal equations take the slope of the cost of damping: by central differences.
    #[test]
    fn damping_below_what_is_stated_costs_little() {
        for v in [-3.0, -0.4, -0.05, 0.05, 0.4] {
            let slope = (cost_of_damping(v + 1e-6) - cost_of_damping(v - 1e-6)) / 2e-6;
            let normal = 2.0 * v / damping_deviation(v).powi(2);
            assert!((slope / normal - 1.0).abs() < 1e-6, "{v}: {slope} and {normal}");
        }
        assert!((cost_of_damping(0.3) - 4.0).abs() < 1e-12);
        // A fifth of what is stated; five times would cost 115.
        assert!((cost_of_damping(-1.609) - 11.0).abs() < 0.2, "{}", cost_of_damping(-1.609));
    }

    /// Parts of two records of one oscillator, the second 0.3 % stiffer: the parts of a record have one shift, which tells the two apart.
    #[test]
    fn parts_of_a_record_share_its_shift() {
        let structure = oscillator(1.0, 400.0);
        let wave = |n: usize, stiffer: f64| {
            let t = 1e-2 * n as f64;
            1e-2 * (-0.02 * t).exp() * (20.0 * stiffer.sqrt() * t).cos() + 4e-6 * (n as f64 * 7.13).sin()
        };
        let runs = [1.0, 1.003].map(|stiffer| decay(1e-2, vec![(0..8000).map(|n| wave(n, stiffer)).collect()]));
        let (records, control) = (Records::new(&structure, &[], &runs).unwrap(), Control::unattended());
        let search = Search::new(&records, &records, &[], &structure, &[], &control);
        let whole = search.levels.len() - 1;
        let start = FittedRecords::start(&search.levels[whole], &[]);
        let start = search.carried(&start, whole, 0).unwrap();
        let parts = &search.levels[0];
        let fit = search.problem(0, 1.0).improve(&start, 20).unwrap();
        let shifts_of_record = |index: usize| -> Vec<f64> {
            parts.list.iter().zip(&fit.shifts).filter(|(r, _)| r.index == index).map(|(_, shift)| *shift).collect()
        };
        let (first, second) = (shifts_of_record(0), shifts_of_record(1));
        assert!(first.len() > 1 && second.len() > 1, "{first:?} {second:?}");
        assert!(first.iter().all(|s| *s == first[0]) && second.iter().all(|s| *s == second[0]), "{first:?} {second:?}");
        assert!((second[0] - first[0] - 0.003).abs() < 6e-4, "{first:?} {second:?}");
        assert_eq!(search.problem(0, 1.0).unused_shifts(&fit).len(), parts.list.len() - 2);
    }
}
