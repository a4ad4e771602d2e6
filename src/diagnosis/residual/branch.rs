//! Which periodic motion was measured, where the model has several: the stable one nearest to the measurement, or one that is
//! unstable under a constant force where that is clearly the one.
//!
//! Stability is judged with the forces held as they were measured. An exciter of finite impedance changes its force as the
//! structure moves, a phase-locked loop and control-based continuation do it on purpose: with either in the loop the motion
//! between the two folds of a response, unstable under a constant force, is stable and is measured like any other (Sieber and
//! Krauskopf 2008; Peter and Leine 2017). A model that is a little wrong may pass near any motion by chance, most of all about a
//! fold, where two of them meet: an unstable one is taken only where it fits and no stable one is nearly as near.

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

/// Error, relative, up to which an unstable motion fits what was measured: the distance of motions about folds.
const FITS: f64 = 0.1;
/// Error of the nearest stable motion, at least, and over that of the unstable one: what is left of it beside a wrong model or about a fold
/// is less than that.
const STRAYS: f64 = 0.1;
const CLEARLY: f64 = 3.0;

/// Difference of the fundamental, relative, within which two motions are one.
const SAME: f64 = 1e-3;

/// The branch on which the model was compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Branch {
    /// Its place by size, from 0, the smallest: among the stable motions, or among the unstable ones where it is one of these.
    pub number: usize,
    /// Number of stable motions.
    pub stable: usize,
    /// Number of all motions found, unstable ones included.
    pub all: usize,
    /// Whether it is unstable under a constant force: an exciter that yields, or a controller, held it.
    pub held: bool,
}

impl Branch {
    /// `lower`, `upper`, or `branch 2` among more than two; `middle` for an unstable one between two stable ones.
    pub fn name(&self) -> String {
        match (self.held, self.number, self.stable) {
            (true, 0, 2) if self.all == 3 => "middle".to_owned(),
            (true, n, _) => format!("unstable branch {}", n + 1),
            (false, 0, 2) => "lower".to_owned(),
            (false, 1, 2) => "upper".to_owned(),
            (false, n, _) => format!("branch {}", n + 1),
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
    let motions = found.iter().map(|(motion, stable)| Motion::new(run, motion, *stable)).collect::<Vec<_>>();
    let (chosen, branch) = measured(&motions);
    Ok((found.swap_remove(chosen).0, Some(branch)))
}

/// One of several motions of the model beside what was measured.
struct Motion {
    /// Whether it is stable under a constant force.
    stable: bool,
    /// Greatest fundamental displacement, m or rad.
    size: f64,
    /// Error of the channels, root mean square, relative.
    error: f64,
}

impl Motion {
    fn new(run: &RunData, prediction: &RunPrediction, stable: bool) -> Self {
        let error = (distance(run, prediction) / run.responses.len().max(1) as f64).sqrt();
        Self { stable, size: largest(prediction), error }
    }
}

/// Which of the motions was measured, and its branch; there is one at least.
fn measured(motions: &[Motion]) -> (usize, Branch) {
    let nearest = |stable: bool| {
        let alike = (0..motions.len()).filter(|&k| motions[k].stable == stable);
        alike.min_by(|&a, &b| motions[a].error.total_cmp(&motions[b].error))
    };
    let chosen = match (nearest(true), nearest(false)) {
        (Some(stable), Some(other)) if is_held(motions[other].error, motions[stable].error) => other,
        (Some(stable), _) => stable,
        (None, other) => other.unwrap_or(0),
    };
    let own = &motions[chosen];
    let smaller = motions.iter().filter(|motion| motion.stable == own.stable && motion.size < own.size).count();
    let stable = motions.iter().filter(|motion| motion.stable).count();
    (chosen, Branch { number: smaller, stable, all: motions.len(), held: !own.stable })
}

/// Whether a motion that is unstable under a constant force was clearly the one measured, by its error and that of the nearest stable one.
fn is_held(error: f64, of_stable: f64) -> bool {
    error < FITS && of_stable > STRAYS && CLEARLY * error < of_stable
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
        if let Some(expansion) = ModalExpansion::new(predictor, r, h, run, first) {
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
