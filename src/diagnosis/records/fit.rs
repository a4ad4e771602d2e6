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
use super::variables::{at_variable, scales, slopes, variable};
use crate::control::Control;
use crate::effects::Source;
use crate::math::statistics::root_mean_square;
use crate::response::transient::{TransientParameter, TransientResponse};
use dashpot_numerics::Cholesky;
use faer::Mat;

/// Prior deviation of the logarithm of all stiffness, of the size of a known source, of the stiffness of one record.
const PRIORS: [f64; 4] = [0.03, 0.15, 0.002, 0.02];
/// Largest change of a logarithm in one step.
const REACH: f64 = 1.0;

/// What is free beside the initial states.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Free {
    /// All stiffness, sizes of known sources and the shift of every record.
    pub corrections: bool,
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
    /// Logarithm of the factor on the stiffness of each record.
    pub shifts: Vec<f64>,
    /// Initial state of each record.
    pub initial: Vec<Vec<f64>>,
    /// Weighted squared residual without the priors.
    pub chi_square: f64,
    /// Number of samples in it.
    pub count: usize,
    /// Standard deviations of the parameters of the effects, then of stiffness, of the known sources and of the modes, in units
    /// of the noise that was stated.
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
            shifts: vec![0.0; records.list.len()],
            initial: vec![vec![0.0; 2 * records.kept]; records.list.len()],
            chi_square: f64::INFINITY,
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
        let model = records.model(record, &self.sources(records), [factor, 1.0], &self.modes)?;
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

/// Normal equations at a point.
struct Normal {
    matrix: Mat<f64>,
    gradient: Vec<f64>,
    chi_square: f64,
    total: f64,
    count: usize,
    residual: Vec<Vec<Vec<f64>>>,
}

impl Fit<'_> {
    /// Improves a start in at most `iterations` steps.
    pub fn improve(&self, start: &FittedRecords, iterations: usize) -> Result<FittedRecords, RecordError> {
        let scales = scales(&start.effects);
        let unit = unit_of(start);
        let mut best = start.clone();
        let mut normal = self.normal(&best, &scales, unit)?;
        let mut damping = 1e-3;
        for _ in 0..iterations {
            self.control.check()?;
            let mut accepted = false;
            let mut gain = 0.0;
            for _ in 0..6 {
                let Some(change) = solve(&normal, damping) else {
                    damping *= 10.0;
                    continue;
                };
                let trial = self.moved(&best, &scales, &change);
                // A model that runs away is no step.
                match self.normal(&trial, &scales, unit) {
                    Ok(there) if there.total < normal.total => {
                        gain = (normal.total - there.total) / normal.total;
                        (best, normal) = (trial, there);
                        damping = (damping * 0.2).max(1e-12);
                        accepted = true;
                        break;
                    }
                    Ok(_) | Err(RecordError::Model { .. }) => damping = (damping * 8.0).max(1e-6),
                    Err(other) => return Err(other),
                }
            }
            if !accepted || gain < 1e-7 {
                break;
            }
        }
        self.finish(best, &scales, normal)
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
        (best.chi_square, best.count, best.residual) = (normal.chi_square, normal.count, normal.residual);
        Ok(best)
    }

    /// Number of shared variables.
    fn shared(&self, at: &FittedRecords) -> usize {
        let laws: usize = at.effects.iter().map(|e| e.parameters.len()).sum();
        laws + if self.free.corrections { 1 + at.known.len() + self.modes() } else { 0 }
    }

    /// Modes whose stiffness is free beside that of all; none where there is only one.
    fn modes(&self) -> usize {
        if self.records.kept > 1 { self.records.kept } else { 0 }
    }

    /// Variables of each record.
    fn local(&self) -> usize {
        2 * self.records.kept + usize::from(self.free.corrections)
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
        if self.free.corrections {
            next.stiffness += change[k].clamp(-0.1, 0.1);
            for (j, v) in next.known.iter_mut().enumerate() {
                *v += change[k + 1 + j].clamp(-0.5, 0.5);
            }
            for r in 0..self.modes() {
                next.modes[r] += change[k + 1 + at.known.len() + r].clamp(-0.1, 0.1);
            }
        }
        let (shared, local) = (self.shared(at), self.local());
        for r in 0..self.records.list.len() {
            let from = shared + r * local;
            for (j, p) in next.initial[r].iter_mut().enumerate() {
                *p += change[from + j];
            }
            if self.free.corrections {
                next.shifts[r] += change[from + 2 * self.records.kept].clamp(-0.05, 0.05);
            }
        }
        next
    }

    /// Parameters by which a record is differentiated, with their variable and the factor on the derivative.
    fn unknowns(&self, at: &FittedRecords, scales: &[Vec<f64>], r: usize) -> Vec<(TransientParameter, usize, f64)> {
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
        if self.free.corrections {
            list.push((TransientParameter::Stiffness, k, 1.0));
            list.push((TransientParameter::Stiffness, from + 2 * self.records.kept, 1.0));
            let sources = at.sources(self.records);
            for (source, known) in sources.iter().take(offset).enumerate() {
                for &parameter in known.effect.scaled() {
                    let unknown = TransientParameter::Source { source, parameter };
                    list.push((unknown, k + 1 + source, known.parameters[parameter]));
                }
            }
            list.extend((0..self.modes()).map(|r| (TransientParameter::Mode(r), k + 1 + offset + r, 1.0)));
        }
        list.extend((0..2 * self.records.kept).map(|j| (TransientParameter::Initial(j), from + j, 1.0)));
        list
    }

    fn normal(&self, at: &FittedRecords, scales: &[Vec<f64>], unit: f64) -> Result<Normal, RecordError> {
        let size = self.shared(at) + self.records.list.len() * self.local();
        let mut normal = Normal {
            matrix: Mat::zeros(size, size),
            gradient: vec![0.0; size],
            chi_square: 0.0,
            total: 0.0,
            count: 0,
            residual: Vec::new(),
        };
        for (r, record) in self.records.list.iter().enumerate() {
            let samples = ((self.share * record.len() as f64) as usize).clamp(16.min(record.len()), record.len());
            let unknowns = self.unknowns(at, scales, r);
            let mut parameters: Vec<TransientParameter> = Vec::new();
            for (p, ..) in &unknowns {
                if !parameters.contains(p) {
                    parameters.push(*p);
                }
            }
            let response = at.predict(self.records, r, samples, &parameters)?;
            let mut left = Vec::new();
            for c in 0..record.channels.len() {
                let (y, sigma) = (&record.samples[c], &record.sigma[c][..samples]);
                let e: Vec<f64> = (0..samples).map(|n| (y[n] - response.channels[c][n]) / sigma[n]).collect();
                let square: f64 = e.iter().map(|e| e * e).sum();
                if !square.is_finite() {
                    let (file, reason) = (record.file.clone(), crate::response::transient::TransientError::StepFailed);
                    return Err(RecordError::Model { file, reason });
                }
                normal.chi_square += square;
                normal.count += samples;
                let weighted = |theta: usize| {
                    response.derivatives[theta][c].iter().zip(sigma).map(|(d, s)| d / s).collect::<Vec<f64>>()
                };
                let own: Vec<Vec<f64>> = (0..parameters.len()).map(weighted).collect();
                normal.add(&unknowns, &parameters, &own, &e);
                left.push(e);
            }
            normal.residual.push(left);
        }
        normal.total = normal.chi_square;
        if self.free.corrections {
            self.priors(at, unit, &mut normal);
        }
        Ok(normal)
    }

    fn priors(&self, at: &FittedRecords, unit: f64, normal: &mut Normal) {
        let laws: usize = at.effects.iter().map(|e| e.parameters.len()).sum();
        let mut prior = |k: usize, value: f64, deviation: f64| {
            let weight = unit * deviation.powi(-2);
            normal.matrix[(k, k)] += weight;
            normal.gradient[k] -= weight * value;
            normal.total += weight * value * value;
        };
        prior(laws, at.stiffness, PRIORS[0]);
        for (j, v) in at.known.iter().enumerate() {
            prior(laws + 1 + j, *v, PRIORS[1]);
        }
        for r in 0..self.modes() {
            prior(laws + 1 + at.known.len() + r, at.modes[r], PRIORS[3]);
        }
        for r in 0..self.records.list.len() {
            let k = self.shared(at) + r * self.local() + 2 * self.records.kept;
            prior(k, at.shifts[r], PRIORS[2]);
        }
    }
}

impl Normal {
    fn add(
        &mut self,
        unknowns: &[(TransientParameter, usize, f64)],
        parameters: &[TransientParameter],
        derivatives: &[Vec<f64>],
        e: &[f64],
    ) {
        let of = |p: &TransientParameter| parameters.iter().position(|q| q == p).unwrap_or(0);
        let list: Vec<(usize, usize, f64)> = unknowns.iter().map(|(p, k, s)| (of(p), *k, *s)).collect();
        let count = parameters.len();
        let mut products = vec![0.0; count * count];
        let mut against = vec![0.0; count];
        for a in 0..count {
            against[a] = dashpot_numerics::dot(&derivatives[a], e);
            for b in 0..=a {
                let value = dashpot_numerics::dot(&derivatives[a], &derivatives[b]);
                products[a * count + b] = value;
                products[b * count + a] = value;
            }
        }
        for (p, k, s) in &list {
            self.gradient[*k] += s * against[*p];
            for (q, l, t) in &list {
                self.matrix[(*k, *l)] += s * t * products[p * count + q];
            }
        }
    }
}

/// Step of Levenberg and Marquardt in scaled variables.
fn solve(normal: &Normal, damping: f64) -> Option<Vec<f64>> {
    let size = normal.gradient.len();
    let greatest = (0..size).map(|k| normal.matrix[(k, k)]).fold(0.0, f64::max);
    let scale: Vec<f64> =
        (0..size).map(|k| normal.matrix[(k, k)].max(1e-20 * greatest).max(1e-300).sqrt().recip()).collect();
    let matrix = Mat::from_fn(size, size, |i, j| {
        let extra = if i == j { damping } else { 0.0 };
        normal.matrix[(i, j)] * scale[i] * scale[j] + extra
    });
    let rhs = Mat::from_fn(size, 1, |i, _| normal.gradient[i] * scale[i]);
    let x = Cholesky::new(matrix.as_ref())?.solve(rhs.as_ref());
    let change: Vec<f64> = (0..size).map(|i| x[(i, 0)] * scale[i]).collect();
    change.iter().all(|x| x.is_finite()).then_some(change)
}
