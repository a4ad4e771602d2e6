//! The short list is judged on the response itself: the parameters of all added effects are fitted by Levenberg and
//! Marquardt's method to the whitened amplitudes of all channels, runs and harmonics.

use super::data::{Data, ExplainError, size};
use super::descent::{Descent, Residual, Variables, descend};
use super::noise::Whitening;
use super::predict::{FINAL, Predictor, RunPrediction, SEARCH};
use crate::control::Control;
use crate::effects::Source;
use crate::math::statistics::root_mean_square;
use crate::response::harmonic_balance::{Response, ResponseError, Settings};
use faer::{Mat, c64};

/// Step of a variable for derivatives by differences.
const STEP: f64 = 1e-4;
/// Groups of runs that are left out in turn.
const FOLDS: usize = 4;

/// A model to be fitted: the predictor with its data and noise.
#[derive(Clone, Copy)]
pub(crate) struct Bench<'a> {
    pub predictor: &'a Predictor,
    pub data: &'a Data,
    pub noise: &'a [Whitening],
    pub control: &'a Control,
}

/// A set of effects fitted on the response.
#[derive(Debug, Clone)]
pub struct Refit {
    /// Effects with their parameters.
    pub effects: Vec<Source>,
    /// Standard deviation of every parameter, of every effect.
    pub deviations: Vec<Vec<f64>>,
    /// Squared whitened residual.
    pub chi_square: f64,
    /// Number of fitted parameters.
    pub parameters: usize,
    /// Relative root mean square error, as in `compare`.
    pub error: f64,
    pub(crate) descent: Descent,
}

impl Bench<'_> {
    /// Number of real data.
    pub fn count(&self) -> usize {
        self.noise.iter().map(Whitening::len).sum()
    }

    /// Predicts every run; a run without a periodic answer is predicted to rest, and so fits nothing.
    pub fn predict(
        &self,
        effects: &[Source],
        settings: &Settings,
        starts: &[Option<Response>],
    ) -> Result<Vec<RunPrediction>, ExplainError> {
        self.data
            .runs
            .iter()
            .enumerate()
            .map(|(r, run)| {
                self.control.check()?;
                let start = starts.get(r).and_then(Option::as_ref);
                match self.predictor.predict(r, run, effects, settings, start, self.control) {
                    Ok(prediction) => Ok(prediction),
                    Err(ResponseError::Cancelled(cancelled)) => Err(cancelled.into()),
                    Err(_) => self.at_rest(r),
                }
            })
            .collect()
    }

    fn at_rest(&self, r: usize) -> Result<RunPrediction, ExplainError> {
        let run = &self.data.runs[r];
        let mut silent = run.clone();
        silent.forces.iter_mut().for_each(|f| f.measured.fill(c64::new(0.0, 0.0)));
        let file = format!("number {}", run.index + 1);
        let failed = |reason| ExplainError::Response { file, reason };
        self.predictor.predict(r, &silent, &[], &SEARCH, None, self.control).map_err(failed)
    }

    /// Whitened residual of all runs, real and imaginary parts.
    pub fn residual(&self, predictions: &[RunPrediction]) -> Vec<f64> {
        let mut rows = Vec::with_capacity(self.count());
        for ((run, noise), prediction) in self.data.runs.iter().zip(self.noise).zip(predictions) {
            for h in 1..=run.harmonics {
                let e = noise.apply(h, |c| run.responses[c].measured[h - 1] - prediction.channels[c][h - 1]);
                rows.extend(e.iter().flat_map(|e| [e.re, e.im]));
            }
        }
        rows
    }

    /// Relative root mean square error of predictions over runs and channels.
    pub fn error(&self, predictions: &[RunPrediction]) -> f64 {
        let mut errors = Vec::new();
        for (run, prediction) in self.data.runs.iter().zip(predictions) {
            for (c, channel) in run.responses.iter().enumerate() {
                let pairs = channel.measured.iter().zip(&prediction.channels[c]);
                let difference: Vec<c64> = pairs.map(|(y, m)| y - m).collect();
                let scale = run.scale(c);
                errors.push(if scale > 0.0 { size(&difference) / scale } else { 0.0 });
            }
        }
        root_mean_square(&errors)
    }

    /// Fits all parameters of `effects` from where they are.
    pub fn refit(&self, effects: &[Source], steps: usize, settings: &Settings) -> Result<Refit, ExplainError> {
        let (variables, start) = Variables::new(effects);
        let mut response = OnResponse { bench: *self, variables: &variables, settings: *settings, starts: Vec::new() };
        let descent = descend(&mut response, &start, steps)?;
        let starts = std::mem::take(&mut response.starts);
        let effects = variables.effects(&descent.theta);
        let error = self.error(&self.predict(&effects, settings, &starts)?);
        let slopes = variables.slopes(&descent.theta);
        let all: Vec<f64> = descent.deviations().iter().zip(&slopes).map(|(d, s)| d * s.abs()).collect();
        let mut rest = &all[..];
        let deviations = effects
            .iter()
            .map(|effect| {
                let (own, others) = rest.split_at(effect.parameters.len());
                rest = others;
                own.to_vec()
            })
            .collect();
        let parameters = variables.len();
        Ok(Refit { effects, deviations, chi_square: descent.chi_square, parameters, error, descent })
    }

    /// Error on runs that were left out: groups of runs in turn, the parameters refitted without them (linearised).
    pub fn held_out_error(&self, refit: &Refit) -> Result<f64, ExplainError> {
        let (variables, _) = Variables::new(&refit.effects);
        let folds = FOLDS.min(self.data.runs.len());
        if folds < 2 {
            return Ok(refit.error);
        }
        let mut rows = 0;
        let mut fold_of_row = Vec::with_capacity(refit.descent.residual.len());
        for (r, noise) in self.noise.iter().enumerate() {
            rows += noise.len();
            fold_of_row.resize(rows, r % folds);
        }
        let mut predictions: Vec<Option<RunPrediction>> = vec![None; self.data.runs.len()];
        for fold in 0..folds {
            let theta = without(&refit.descent, &fold_of_row, fold);
            let effects = variables.effects(&theta);
            for (r, run) in self.data.runs.iter().enumerate().filter(|(r, _)| r % folds == fold) {
                let predicted = self.predictor.predict(r, run, &effects, &FINAL, None, self.control);
                predictions[r] = Some(predicted.or_else(|_| self.at_rest(r))?);
            }
        }
        Ok(self.error(&predictions.into_iter().flatten().collect::<Vec<_>>()))
    }
}

/// Variables of the linearised fit without the rows of one fold.
fn without(descent: &Descent, fold_of_row: &[usize], fold: usize) -> Vec<f64> {
    let n = descent.theta.len();
    let kept = |column: &[f64], other: &[f64]| -> f64 {
        let rows = column.iter().zip(other).zip(fold_of_row);
        rows.filter(|(_, f)| **f != fold).map(|((a, b), _)| a * b).sum()
    };
    let j = |k: usize| descent.jacobian.col_as_slice(k);
    let normal = Mat::from_fn(n, n, |a, b| kept(j(a), j(b)) + if a == b { 1e-12 } else { 0.0 });
    let gradient = Mat::from_fn(n, 1, |k, _| kept(j(k), &descent.residual));
    match crate::math::least_squares::solve_symmetric(normal.as_ref(), gradient.as_ref()) {
        Ok(step) => (0..n).map(|k| descent.theta[k] - step[(k, 0)].clamp(-0.5, 0.5)).collect(),
        Err(_) => descent.theta.clone(),
    }
}

/// The residual on the response as a function of the variables of the effects.
struct OnResponse<'a> {
    bench: Bench<'a>,
    variables: &'a Variables,
    settings: Settings,
    /// Responses of the last residual, from which the next ones start.
    starts: Vec<Option<Response>>,
}

impl Residual for OnResponse<'_> {
    type Error = ExplainError;

    fn residual(&mut self, theta: &[f64]) -> Result<Vec<f64>, ExplainError> {
        let predictions = self.bench.predict(&self.variables.effects(theta), &self.settings, &self.starts)?;
        let residual = self.bench.residual(&predictions);
        self.starts = predictions.into_iter().map(|p| Some(p.response)).collect();
        Ok(residual)
    }

    fn jacobian(&mut self, theta: &[f64], at: &[f64]) -> Result<Mat<f64>, ExplainError> {
        let mut jacobian = Mat::zeros(at.len(), theta.len());
        for k in 0..theta.len() {
            let mut moved = theta.to_vec();
            moved[k] += STEP;
            let predictions = self.bench.predict(&self.variables.effects(&moved), &self.settings, &self.starts)?;
            let column = jacobian.col_as_slice_mut(k);
            for (out, (after, before)) in column.iter_mut().zip(self.bench.residual(&predictions).iter().zip(at)) {
                *out = (after - before) / STEP;
            }
        }
        Ok(jacobian)
    }
}
