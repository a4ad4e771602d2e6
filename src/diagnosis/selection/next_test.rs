//! The run worth making next, at the exciter and the sensors that are there: the one that would tell two models apart best
//! (largest expected difference in units of noise), or that would pin the least certain parameter of the only one best.
//!
//! ```text
//! separation   sum_c |X_c - X'_c|^2 / s_c^2
//! pinning      sqrt [ (N + sum_c Re a_c^H a_c / s_c^2)^-1 ]_kk,     N the information so far, a_c = dX_c / d theta
//! ```

use crate::diagnosis::residual::data::{DiagnosisError, RunData};
use crate::diagnosis::residual::prediction::SEARCH;
use crate::diagnosis::result::{NextTest, TestKind};
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::selection::levenberg_marquardt::variables::Variables;
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::effects::{Effect, Kind, Source};
use crate::math::least_squares::solve_symmetric;
use crate::response::harmonic_balance::{Excitation, HarmonicForce, Response};
use dashpot_numerics::transposed_product;
use faer::{Mat, c64};
use std::f64::consts::TAU;

/// Frequencies looked at, and force levels relative to those of the tests.
const FREQUENCIES: usize = 9;
const LEVELS: [f64; 2] = [0.5, 2.0];
/// Step of a variable for the derivative of a response.
const STEP: f64 = 1e-3;
/// Least factor by which a test must narrow a parameter down to be worth naming.
const WORTH: f64 = 1.3;

/// A sine that the exciter, or the base that the structure stands on, could make.
struct Trial {
    excitation: Excitation,
    dof: usize,
    force: f64,
    /// Of a base: motion over that of the run in which it moves most.
    times: Option<f64>,
}

/// The forces of a base that drives the structure where it moves most, each with its DOF; none where exciters do.
fn base_forces(reference: &ReferenceModel) -> Option<Vec<(usize, c64)>> {
    let size = |run: &&RunData| run.forces.iter().map(|f| f.size().powi(2)).sum::<f64>();
    let driven = reference.data.runs.iter().filter(|run| run.on_moving_base);
    let most = driven.max_by(|a, b| size(a).total_cmp(&size(b)))?;
    most.forces.iter().map(|f| f.measured.first().map(|first| (f.dof, *first))).collect()
}

impl Trial {
    /// Frequencies around those of the runs, at two levels of force.
    fn all(reference: &ReferenceModel) -> Vec<Self> {
        let omegas = reference.data.runs.iter().map(|r| r.omega);
        let (low, high) = omegas.fold((f64::INFINITY, 0.0_f64), |(l, h), w| (l.min(w), h.max(w)));
        let sizes = reference.data.runs.iter().flat_map(|r| r.forces.iter().map(|f| (f.dof, f.size())));
        let Some((dof, force)) = sizes.max_by(|a, b| a.1.total_cmp(&b.1)) else { return Vec::new() };
        let omega = |k: usize| 0.9 * low * (1.1 * high / (0.9 * low)).powf(k as f64 / (FREQUENCIES - 1) as f64);
        let base = base_forces(reference);
        let trial = |k: usize, level: f64| {
            if let Some(forces) = &base {
                return Self { excitation: of_base(omega(k), forces, level), dof, force, times: Some(level) };
            }
            let force = level * force;
            Self { excitation: Excitation::sine(omega(k), dof, c64::new(force, 0.0)), dof, force, times: None }
        };
        (0..FREQUENCIES).flat_map(|k| LEVELS.map(|level| trial(k, level))).collect()
    }

    fn respond(&self, reference: &ReferenceModel, effects: &[Source], start: Option<&Response>) -> Option<Response> {
        let sources = reference.predictor.sources(effects);
        reference.predictor.run(0).respond(&sources, &self.excitation, &SEARCH, start, reference.control).ok()
    }

    fn named(&self, why: String) -> NextTest {
        let kind = self.times.map_or(TestKind::Steady, |times| TestKind::Base { times });
        let frequency_hz = self.excitation.omega / TAU;
        NextTest { kind, frequency_hz, force_dof: self.dof, force: self.force, why }
    }
}

/// So many times the forces of a base.
fn of_base(omega: f64, forces: &[(usize, c64)], times: f64) -> Excitation {
    let force = |&(dof, amplitude): &(usize, c64)| HarmonicForce { dof, mean: 0.0, harmonics: vec![amplitude * times] };
    Excitation { omega, forces: forces.iter().map(force).collect() }
}

/// The test that separates the effects `best` from those of `other`; none if nothing does.
pub(crate) fn next_test(
    reference: &ReferenceModel,
    best: &[Source],
    other: &[Source],
) -> Result<Option<NextTest>, DiagnosisError> {
    let mut found: Option<(f64, Trial)> = None;
    for trial in Trial::all(reference) {
        reference.control.check()?;
        let Some(a) = trial.respond(reference, best, None) else { continue };
        let Some(b) = trial.respond(reference, other, None) else { continue };
        let gain = difference(reference, &a, &b);
        if found.as_ref().is_none_or(|(most, _)| gain > *most) {
            found = Some((gain, trial));
        }
    }
    let name = |effects: &[Source]| -> String {
        let names: Vec<&str> = effects.iter().map(|e| Effect::title(e.effect)).collect();
        names.join(" and ")
    };
    let channel = other.iter().chain(best).any(|e| matches!(e.effect.kind(), Kind::Channel(_)));
    Ok(found.filter(|(gain, _)| *gain > 0.0 || channel).map(|(gain, trial)| {
        trial.named(format!(
            "{} and {} differ there by {gain:.1} standard deviations of the measured channels",
            name(best),
            name(other)
        ))
    }))
}

/// The test that narrows the least certain parameter of `best` down most; none if none narrows it down much.
pub(crate) fn pinning_test(reference: &ReferenceModel, best: &FittedModel) -> Result<Option<NextTest>, DiagnosisError> {
    let Some((effect, parameter)) = least_certain(best) else { return Ok(None) };
    let at = best.effects[..effect].iter().map(|e| e.parameters.len()).sum::<usize>() + parameter;
    let Some(known) = information(best) else { return Ok(None) };
    let Some(before) = deviation(&known, at) else { return Ok(None) };
    let mut found: Option<(f64, Trial)> = None;
    for trial in Trial::all(reference) {
        reference.control.check()?;
        let Some(more) = trial_information(reference, best, &trial) else { continue };
        let together = Mat::from_fn(known.nrows(), known.ncols(), |i, j| known[(i, j)] + more[(i, j)]);
        let Some(after) = deviation(&together, at) else { continue };
        if found.as_ref().is_none_or(|(least, _)| after < *least) {
            found = Some((after, trial));
        }
    }
    let source = &best.effects[effect];
    let relative = best.deviations[effect][parameter] / source.parameters[parameter].abs();
    Ok(found.filter(|(after, _)| *after * WORTH < before).map(|(after, trial)| {
        trial.named(format!(
            "{} of {} is the least certain number; one run there would narrow its deviation from {:.2} % to {:.2} %",
            source.effect.parameters()[parameter].name,
            source.effect.title(),
            100.0 * relative,
            100.0 * relative * after / before
        ))
    }))
}

/// The parameter of the largest relative deviation among those of effects on the structure.
fn least_certain(best: &FittedModel) -> Option<(usize, usize)> {
    let on_structure = |e: &Source| !matches!(e.effect.kind(), Kind::Channel(_));
    let effects = best.effects.iter().zip(&best.deviations).enumerate().filter(|(_, (e, _))| on_structure(e));
    let all = effects.flat_map(|(i, (effect, deviations))| {
        let pairs = effect.parameters.iter().zip(deviations).enumerate();
        pairs.map(move |(k, (value, deviation))| ((i, k), deviation / value.abs()))
    });
    all.filter(|(_, d)| d.is_finite()).max_by(|a, b| a.1.total_cmp(&b.1)).map(|(at, _)| at)
}

/// What the runs say of the variables of the effects, the corrections of the model being free too.
fn information(best: &FittedModel) -> Option<Mat<f64>> {
    let jacobian = best.descent.jacobian.as_ref();
    let (normal, n) = (transposed_product(jacobian, jacobian), best.parameters);
    let size = normal.nrows();
    let covariance = solve_symmetric(normal.as_ref(), Mat::<f64>::identity(size, size).as_ref()).ok()?;
    let own = Mat::from_fn(n, n, |i, j| covariance[(i, j)]);
    solve_symmetric(own.as_ref(), Mat::<f64>::identity(n, n).as_ref()).ok()
}

/// Deviation of variable `k` for this information.
fn deviation(information: &Mat<f64>, k: usize) -> Option<f64> {
    let n = information.nrows();
    let covariance = solve_symmetric(information.as_ref(), Mat::<f64>::identity(n, n).as_ref()).ok()?;
    Some(covariance[(k, k)].sqrt()).filter(|d| d.is_finite() && *d > 0.0)
}

/// What one run of the trial would say.
fn trial_information(reference: &ReferenceModel, best: &FittedModel, trial: &Trial) -> Option<Mat<f64>> {
    let (variables, theta) = Variables::new(&best.effects);
    let here = trial.respond(reference, &best.effects, None)?;
    let mut slopes: Vec<Vec<c64>> = Vec::with_capacity(theta.len());
    for k in 0..theta.len() {
        let mut moved = theta.clone();
        moved[k] += STEP;
        let there = trial.respond(reference, &variables.effects(&moved), Some(&here))?;
        slopes.push(reference.data.runs[0].alive.iter().map(|&c| seen(reference, c, &here, &there) / STEP).collect());
    }
    let product = |i: usize, j: usize| slopes[i].iter().zip(&slopes[j]).map(|(a, b)| (a.conj() * b).re).sum::<f64>();
    Some(Mat::from_fn(theta.len(), theta.len(), product))
}

/// Change of a sensor of the first run from one response to another, in units of the noise that its channel had.
fn seen(reference: &ReferenceModel, c: usize, a: &Response, b: &Response) -> c64 {
    let (run, noise) = (&reference.data.runs[0], &reference.noise.runs[0]);
    let channel = &run.responses[c];
    let relative = noise.deviation(c, 1) / channel.size().max(f64::MIN_POSITIVE);
    let (x, y) = (a.amplitude(channel.dof, 1), b.amplitude(channel.dof, 1));
    let size = x.norm().max(y.norm());
    if size > 0.0 && relative > 0.0 { (y - x) / (relative * size) } else { c64::new(0.0, 0.0) }
}

/// Difference of two responses at the sensors of the first run, in units of the noise that its channels had.
fn difference(reference: &ReferenceModel, a: &Response, b: &Response) -> f64 {
    let alive = reference.data.runs[0].alive.iter();
    alive.map(|&c| seen(reference, c, a, b).norm_sqr()).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests;
