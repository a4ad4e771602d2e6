//! Which periodic motion was measured, where the model has several: the stable one nearest to the measurement.

use crate::control::Control;
use crate::diagnosis::candidates::start::start;
use crate::diagnosis::residual::data::RunData;
use crate::diagnosis::residual::prediction::{FINAL, Predictor, RunPrediction};
use crate::diagnosis::updating::modal_expansion::ModalExpansion;
use crate::effects::Source;
use crate::response::harmonic_balance::{ResponseError, Settings};
use faer::{Mat, c64};

/// Truncation error as a share of the smallest noise of a channel's fundamental.
const SHARE: f64 = 0.1;
/// Largest truncation error, relative to the largest amplitude.
const COARSEST: f64 = 1e-3;

/// Difference of the fundamental, relative, within which two motions are one.
const SAME: f64 = 1e-3;

/// The branch on which the model was compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Branch {
    /// Its place among the stable motions by size, from 0, the smallest.
    pub number: usize,
    /// Number of stable motions.
    pub stable: usize,
    /// Number of all motions found, unstable ones included.
    pub all: usize,
}

impl Branch {
    /// `lower`, `upper`, or `branch 2` among more than two.
    pub fn name(&self) -> String {
        match (self.number, self.stable) {
            (0, 2) => "lower".to_owned(),
            (1, 2) => "upper".to_owned(),
            (n, _) => format!("branch {}", n + 1),
        }
    }
}

/// The prediction of run number `r` that is nearest to what was measured, and its branch where there are several.
pub(crate) fn nearest(
    predictor: &Predictor,
    r: usize,
    run: &RunData,
    effects: &[Source],
    control: &Control,
) -> Result<(RunPrediction, Option<Branch>), ResponseError> {
    let settings = settings(run);
    let mut found = predictor.branches(r, run, effects, &settings, control)?;
    if let Some(near) = at_measured_motion(predictor, r, run, effects, &found, &settings, control)? {
        found.push(near);
    }
    if found.len() < 2 {
        let first = found.into_iter().next().map(|(prediction, _)| prediction);
        let prediction = first.map_or_else(|| predictor.predict(r, run, effects, &settings, None, control), Ok)?;
        return Ok((predictor.refined(r, run, effects, prediction, control)?, None));
    }
    let all = found.len();
    let any_stable = found.iter().any(|(_, stable)| *stable);
    let mut stable: Vec<RunPrediction> =
        found.into_iter().filter(|(_, stable)| *stable || !any_stable).map(|(prediction, _)| prediction).collect();
    stable.sort_by(|a, b| largest(a).total_cmp(&largest(b)));
    let distances: Vec<f64> = stable.iter().map(|prediction| distance(run, prediction)).collect();
    let number = (0..stable.len()).min_by(|&a, &b| distances[a].total_cmp(&distances[b])).unwrap_or(0);
    let branch = Branch { number, stable: stable.len(), all };
    Ok((stable.swap_remove(number), (all > 1).then_some(branch)))
}

/// The motion that the model settles to from the measured one, with whether it is stable; none where that is one of those found.
/// Branches are followed in the force, so that one that is not joined to rest below the force of the run is not among them.
fn at_measured_motion(
    predictor: &Predictor,
    r: usize,
    run: &RunData,
    effects: &[Source],
    found: &[(RunPrediction, bool)],
    settings: &Settings,
    control: &Control,
) -> Result<Option<(RunPrediction, bool)>, ResponseError> {
    let Some((first, _)) = found.first() else { return Ok(None) };
    let n = predictor.structure().len();
    let mut field = Mat::from_fn(n, run.harmonics, |dof, h| first.response.amplitude(dof, h + 1));
    for h in 1..=run.harmonics {
        if let Some(expansion) = ModalExpansion::new(predictor, (r, h), run, first) {
            expansion.correct(run, h, field.col_as_slice_mut(h - 1));
        }
    }
    let Some(start) = start(&predictor.sources(effects), run.omega, &field) else { return Ok(None) };
    let near = match predictor.settled(r, run, effects, settings, &start, control) {
        Err(ResponseError::Cancelled(cancelled)) => return Err(cancelled.into()),
        near => near.ok(),
    };
    let size = near.as_ref().map_or(0.0, |(near, _)| largest(near));
    let fresh = |near: &(RunPrediction, bool)| {
        let differs = |(other, _): &(RunPrediction, bool)| {
            let dofs = 0..n;
            let most = dofs.map(|d| (other.response.amplitude(d, 1) - near.0.response.amplitude(d, 1)).norm());
            most.fold(0.0, f64::max) > SAME * size
        };
        found.iter().all(differs)
    };
    Ok(near.filter(fresh))
}

/// No more harmonics than the noise of the run lets see; what is cut off counts as noise.
fn settings(run: &RunData) -> Settings {
    let relative_noise = |c: &usize| {
        let channel = &run.responses[*c];
        channel.deviation.first().map_or(0.0, |d| d / channel.size())
    };
    let noise = run.alive.iter().map(relative_noise).filter(|n| n.is_finite()).fold(f64::INFINITY, f64::min);
    let seen = if noise.is_finite() { SHARE * noise } else { 0.0 };
    Settings { truncation: seen.clamp(FINAL.truncation, COARSEST), patience: usize::MAX, ..FINAL }
}

/// Greatest fundamental displacement of the response.
fn largest(prediction: &RunPrediction) -> f64 {
    (0..prediction.response.mean.len()).fold(0.0, |m, dof| m.max(prediction.response.amplitude(dof, 1).norm()))
}

/// Sum over the channels of the squared relative errors.
pub(crate) fn distance(run: &RunData, prediction: &RunPrediction) -> f64 {
    let squared_error = |c: usize| {
        let pairs = run.responses[c].measured.iter().zip(&prediction.channels[c]);
        let difference: f64 = pairs.map(|(y, m): (&c64, &c64)| (y - m).norm_sqr()).sum();
        let scale = run.scale(c);
        if scale > 0.0 { difference / (scale * scale) } else { 0.0 }
    };
    (0..run.responses.len()).map(squared_error).sum()
}

#[cfg(test)]
mod tests;
