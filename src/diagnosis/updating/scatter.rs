//! What the data say of each channel and of each run, beside the model with its corrections and the effects that were found:
//! gain and delay of every channel, shift of all natural frequencies and factor on the response of every run.
//!
//! The whitened residual `r` of the model is linear in the common parameters `u` (parts of the model, gains, delays) and in
//! those of each run `w_r` (its stiffness, real and imaginary part of a factor on its response), all with normal priors whose
//! scales are those most likely:
//!
//! ```text
//! u   = (1 + B^T B)^-1 B^T r                    covariance (1 + B^T B)^-1
//! w_r = (1 + V_r^T V_r)^-1 V_r^T (r_r - B_r u)   covariance (1 + V_r^T V_r)^-1, u being known
//! ```
//!
//! (Harville 1977; `Marginalisation`, `RunNuisance`). A relative change `s` of all
//! stiffness shifts all natural frequencies by `s / 2`.

use super::correction::{Correction, with_corrections};
use super::parameters::{Updating, UpdatingParameter};
use crate::control::Control;
use crate::diagnosis::residual::data::{Data, DiagnosisError, Problem};
use crate::diagnosis::residual::prediction::{FINAL, Predictor, RunPrediction};
#[cfg(doc)]
use crate::diagnosis::residual::run_nuisance::RunNuisance;
use crate::diagnosis::result::Diagnosis;
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::effects::Source;
use std::sync::Arc;

/// Rounds in which the scales of the priors are estimated.
const ROUNDS: usize = 6;

/// A value with its standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimated {
    /// The value.
    pub value: f64,
    /// Its standard deviation.
    pub deviation: f64,
}

impl Estimated {
    /// Value over deviation.
    pub fn deviations(self) -> f64 {
        if self.deviation > 0.0 { self.value / self.deviation } else { 0.0 }
    }
}

/// What the data say of one channel.
#[derive(Debug, Clone, PartialEq)]
pub struct ChannelScatter {
    /// Its name, such as `acc@7`.
    pub channel: String,
    /// Share by which it reads too large.
    pub gain: Estimated,
    /// Time by which it is recorded late, s; `None` for forces.
    pub delay: Option<Estimated>,
}

/// What the data say of one run.
#[derive(Debug, Clone, PartialEq)]
pub struct RunScatter {
    /// Index of the run in the project.
    pub run: usize,
    /// Relative shift of all natural frequencies.
    pub frequency: Estimated,
    /// Relative change of the amplitude of its response.
    pub amplitude: Estimated,
    /// Phase by which its response is turned, rad.
    pub phase: Estimated,
}

/// All of it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Scatter {
    /// Channels in the order of the runs; none where one response channel alone is measured.
    pub channels: Vec<ChannelScatter>,
    /// Used runs that fit the others.
    pub runs: Vec<RunScatter>,
}

/// What the data say of channels and runs beside the best set and the corrections of a `diagnosis`; `None` for points
/// without a model.
///
/// # Errors
/// What keeps the model from being compared.
pub fn of_diagnosis(
    problem: &Problem,
    diagnosis: &Diagnosis,
    control: &Control,
) -> Result<Option<Scatter>, DiagnosisError> {
    let last = diagnosis.steps.last();
    let effects: Vec<Source> = last.map_or_else(Vec::new, |s| s.added.iter().map(|a| a.source.clone()).collect());
    let left_out: Vec<usize> = diagnosis.run_faults.iter().map(|fault| fault.run).collect();
    without_runs(problem, &left_out, &effects, &diagnosis.corrections, control)
}

/// The same beside `effects` and `corrections`.
///
/// # Errors
/// What keeps the model from being compared.
pub fn scatter(
    problem: &Problem,
    effects: &[Source],
    corrections: &[Correction],
    control: &Control,
) -> Result<Option<Scatter>, DiagnosisError> {
    without_runs(problem, &[], effects, corrections, control)
}

/// The same of all runs but those of the numbers `left_out`.
fn without_runs(
    problem: &Problem,
    left_out: &[usize],
    effects: &[Source],
    corrections: &[Correction],
    control: &Control,
) -> Result<Option<Scatter>, DiagnosisError> {
    if problem.structure.matrices().is_none() {
        return Ok(None);
    }
    let data = Data::new(problem)?.without_runs(left_out);
    let known = problem.known();
    let updating = with_corrections(Updating::all(problem.structure, &known, &data), corrections);
    let predictor = Arc::new(Predictor::new(problem.structure, known, &data)?);
    let stated = ReferenceModel::new(predictor, &data, control, &|_| {})?;
    let mut reference = stated.updated(&updating, effects, &Vec::new())?;
    let predictions = reference.estimator().predict(effects, &FINAL, &[])?;
    for _ in 0..ROUNDS {
        reference = reference.with_scales(reference.noise.scales(&reference.estimator().at_reference(&predictions)));
    }
    Ok(Some(estimated(&reference, &predictions)))
}

fn estimated(reference: &ReferenceModel, predictions: &[RunPrediction]) -> Scatter {
    let rows = reference.estimator().at_reference(predictions);
    let updating = &reference.linearisation.updating;
    let u = reference.noise.updating.solve(&rows);
    let variances = reference.noise.updating.variances();
    let common = |wanted: &UpdatingParameter| {
        let k = updating.parameters.iter().position(|p| p == wanted)?;
        let (prior, variance) = (updating.prior(k), variances.get(k)?);
        Some(Estimated { value: prior * u[k], deviation: prior * variance.sqrt() })
    };
    let channels = updating.parameters.iter().filter_map(|p| {
        let (UpdatingParameter::Gain(channel) | UpdatingParameter::ForceGain(channel)) = p else { return None };
        let delay = common(&UpdatingParameter::Delay(channel.clone()));
        Some(ChannelScatter { channel: channel.clone(), gain: common(p)?, delay })
    });
    Scatter { channels: channels.collect(), runs: of_runs(reference, rows, &u) }
}

/// What is left beside the common parameters `u`, run by run.
fn of_runs(reference: &ReferenceModel, rows: Vec<f64>, u: &[f64]) -> Vec<RunScatter> {
    let left = reference.noise.updating.left(rows, u);
    let scales = reference.linearisation.updating.scales;
    let mut at = 0;
    let scatter_of_run = |(r, noise): (usize, &crate::diagnosis::residual::whitening::Whitening)| {
        let estimate = noise.nuisance().estimate(&left[at..at + noise.len()]);
        at += noise.len();
        let scaled_estimate = |k: usize, scale: f64| {
            let (value, variance) = (estimate.values.get(k)?, estimate.variances.get(k)?);
            Some(Estimated { value: scale * value, deviation: scale * variance.sqrt() })
        };
        Some(RunScatter {
            run: reference.data.runs[r].index,
            frequency: scaled_estimate(0, 0.5 * scales.shift)?,
            amplitude: scaled_estimate(1, scales.response)?,
            phase: scaled_estimate(2, scales.response)?,
        })
    };
    reference.noise.runs.iter().enumerate().filter_map(scatter_of_run).collect()
}
