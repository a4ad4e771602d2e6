//! The fit of a model to records by prediction with derivatives: Levenberg and Marquardt over parameters that all records
//! share and, of each record, its initial state and a shift of its stiffness.
//!
//! ```text
//! chi^2 = sum_records sum_channels,samples ((y - y_model) / sigma)^2 + u sum_k (v_k / s_k)^2
//! ```
//!
//! `u` is 1 where the model leaves noise, more where it leaves more ([`super::evidence`]).
//!
//! Shared: parameters of added laws (logarithms where they are positive), stiffness and known sources as logarithms of
//! factors with priors. Of a record: `2 m` entries of its initial state, free, and a logarithm of stiffness with the prior of
//! re-seating. Short parts are fitted first, so that a long record does not lose the phase.

use super::data::{RecordError, Records};
use super::errors::channel_errors;
use super::evidence::scale;
use super::normal::{Left, Normal, solve};
use super::variables::{at_variable, scales, slopes, variable};
use crate::control::Control;
use crate::effects::Source;
use crate::math::statistics::root_mean_square;
use crate::response::transient::{TransientParameter, TransientResponse};
use dashpot_numerics::Cholesky;
use faer::Mat;

/// Prior deviation of the logarithm of all stiffness, of the size of a known source, of the stiffness of one record, of that of
/// a mode, of all mass.
pub(super) const PRIORS: [f64; 5] = [0.03, 0.15, 0.002, 0.02, 0.02];
/// Largest change of a logarithm in one step.
const REACH: f64 = 1.0;
/// Dampings that are tried for a step, and the share of what is left below which a fit has ended.
const ATTEMPTS: usize = 6;
const LEAST_GAIN: f64 = 1e-7;

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

/// A model with the parameters that were fitted.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedRecords {
    /// Added effects.
    pub effects: Vec<Source>,
    /// Logarithm of the factor on all stiffness.
    pub stiffness: f64,
    /// Logarithms of the factors on the known sources.
    pub known: Vec<f64>,
    /// Logarithms of the factors on the stiffness of the followed modes.
    pub modes: Vec<f64>,
    /// Logarithm of the factor on all mass.
    pub mass: f64,
    /// Logarithm of the factor on the stiffness of each record.
    pub shifts: Vec<f64>,
    /// Initial state of each record.
    pub initial: Vec<Vec<f64>>,
    /// Weighted squared residual without the priors.
    pub chi_square: f64,
    /// Squared corrections over their prior deviations.
    pub prior: f64,
    /// Number of samples in it.
    pub count: usize,
    /// Standard deviations of the parameters of the effects, then of stiffness, of the known sources, of the modes and of mass, in
    /// units of the noise that was stated.
    pub deviations: Vec<f64>,
    /// What is left, over the noise: `[record][channel][sample]`.
    pub residual: Vec<Vec<Vec<f64>>>,
}

impl FittedRecords {
    /// The model as it is, at rest.
    pub fn start(records: &Records, effects: &[Source]) -> Self {
        Self {
            effects: effects.to_vec(),
            stiffness: 0.0,
            known: vec![0.0; records.known.len()],
            modes: vec![0.0; records.kept],
            mass: 0.0,
            shifts: vec![0.0; records.list.len()],
            initial: vec![vec![0.0; 2 * records.kept]; records.list.len()],
            chi_square: f64::INFINITY,
            prior: 0.0,
            count: 0,
            deviations: Vec::new(),
            residual: Vec::new(),
        }
    }

    /// Known sources at their factors, then the effects.
    pub(crate) fn sources(&self, records: &Records) -> Vec<Source> {
        let sized = |(source, v): (&Source, &f64)| {
            let mut source = source.clone();
            source.effect.scaled().iter().for_each(|&k| source.parameters[k] *= v.exp());
            source
        };
        records.known.iter().zip(&self.known).map(sized).chain(self.effects.iter().cloned()).collect()
    }

    /// The record of number `r` that the model gives over `samples` samples.
    pub(crate) fn predict(
        &self,
        records: &Records,
        r: usize,
        samples: usize,
        parameters: &[TransientParameter],
    ) -> Result<TransientResponse, RecordError> {
        let record = &records.list[r];
        let factor = (self.stiffness + self.shifts[r]).exp();
        let model = records.model(record, &self.sources(records), [factor, self.mass.exp()], &self.modes)?;
        let forces = record.excitation(samples, model.is_linear());
        model
            .predict(&forces, &self.initial[r], parameters)
            .map_err(|reason| RecordError::Model { file: record.file.clone(), reason })
    }

    /// Relative error of the model over samples `from..to` (shares of the length of every record).
    pub(crate) fn error(&self, records: &Records, from: f64, to: f64) -> Result<f64, RecordError> {
        let mut errors = Vec::new();
        for (r, record) in records.list.iter().enumerate() {
            let last = (to * record.len() as f64) as usize;
            let first = (from * record.len() as f64) as usize;
            let response = self.predict(records, r, last.max(2), &[])?;
            errors.extend(channel_errors(record, &response.channels, first..last.max(2)));
        }
        Ok(root_mean_square(&errors))
    }
}

/// A fit on the first part of every record.
pub(crate) struct Fit<'a> {
    pub records: &'a Records<'a>,
    pub free: Free,
    /// Share of every record that is used.
    pub share: f64,
    pub control: &'a Control,
}

/// What the priors weigh: what the start leaves demands it, so that many samples of one error do not bend what is known.
fn unit_of(start: &FittedRecords) -> f64 {
    if start.count > 0 { scale(start) } else { 1.0 }
}

impl Fit<'_> {
    /// Improves a start in at most `iterations` steps; fewer where time is up.
    pub fn improve(&self, start: &FittedRecords, iterations: usize) -> Result<FittedRecords, RecordError> {
        let scales = scales(&start.effects);
        let unit = unit_of(start);
        let mut best = start.clone();
        let mut normal = self.normal(&best, &scales, unit)?;
        let mut damping = 1e-3;
        for _ in 0..iterations {
            self.control.check()?;
            if self.control.is_late() {
                break;
            }
            let before = normal.left.total(unit);
            let Some((next, there)) = self.step(&best, &scales, unit, &normal, &mut damping)? else { break };
            let gain = (before - there.left.total(unit)) / before;
            (best, normal) = (next, there);
            if gain < LEAST_GAIN {
                break;
            }
        }
        self.finish(best, &scales, normal)
    }

    /// One step that leaves less, with the equations there; `None` where none does.
    fn step(
        &self,
        best: &FittedRecords,
        scales: &[Vec<f64>],
        unit: f64,
        normal: &Normal,
        damping: &mut f64,
    ) -> Result<Option<(FittedRecords, Normal)>, RecordError> {
        let before = normal.left.total(unit);
        for attempt in 0..ATTEMPTS {
            let Some(change) = solve(normal, *damping) else {
                *damping *= 10.0;
                continue;
            };
            let trial = self.moved(best, scales, &change);
            // The first step is mostly one that leaves less; later ones are looked at without derivatives.
            let there = if attempt == 0 {
                self.normal(&trial, scales, unit).map(|there| (there.left.total(unit), Some(there)))
            } else {
                self.left(&trial).map(|there| (there.total(unit), None))
            };
            match there {
                Ok((total, there)) if total < before => {
                    *damping = (*damping * 0.2).max(1e-12);
                    let there = there.map_or_else(|| self.normal(&trial, scales, unit), Ok)?;
                    return Ok(Some((trial, there)));
                }
                // A model that runs away is no step.
                Ok(_) | Err(RecordError::Model { .. }) => *damping = (*damping * 8.0).max(1e-6),
                Err(other) => return Err(other),
            }
            if self.control.is_late() {
                break;
            }
        }
        Ok(None)
    }

    /// Adds deviations and what is left.
    fn finish(
        &self,
        mut best: FittedRecords,
        scales: &[Vec<f64>],
        normal: Normal,
    ) -> Result<FittedRecords, RecordError> {
        let size = normal.gradient.len();
        let shared = self.shared(&best);
        let scaling: Vec<f64> = (0..size).map(|k| normal.matrix[(k, k)].max(1e-300).sqrt().recip()).collect();
        let unit = Mat::from_fn(size, size, |i, j| {
            let ridge = if i == j { 1e-11 } else { 0.0 };
            normal.matrix[(i, j)] * scaling[i] * scaling[j] + ridge
        });
        let identity = Mat::<f64>::identity(size, size);
        let inverse = Cholesky::new(unit.as_ref()).ok_or(RecordError::Singular)?.solve(identity.as_ref());
        let slopes = slopes(&best.effects, scales);
        let deviation =
            |k: usize| inverse[(k, k)].max(0.0).sqrt() * scaling[k] * slopes.get(k).copied().unwrap_or(1.0).abs();
        best.deviations = (0..shared).map(deviation).collect();
        let Left { chi_square, prior, count, residual } = normal.left;
        (best.chi_square, best.prior, best.count, best.residual) = (chi_square, prior, count, residual);
        Ok(best)
    }

    /// Number of shared variables.
    pub(super) fn shared(&self, at: &FittedRecords) -> usize {
        let laws: usize = at.effects.iter().map(|e| e.parameters.len()).sum();
        laws + self.free.corrections.len()
    }

    /// Variables of each record.
    pub(super) fn local(&self) -> usize {
        2 * self.records.kept + usize::from(self.free.shifts)
    }

    fn moved(&self, at: &FittedRecords, scales: &[Vec<f64>], change: &[f64]) -> FittedRecords {
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
}
