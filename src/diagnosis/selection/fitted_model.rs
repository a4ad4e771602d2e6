//! The short list is judged on the response itself: the parameters of all added effects are fitted by Levenberg and
//! Marquardt's method to the whitened amplitudes of all channels, runs and harmonics; updating parameters are eliminated.

use crate::diagnosis::residual::data::DiagnosisError;
use crate::diagnosis::residual::prediction::{FINAL, RunPrediction};
use crate::diagnosis::selection::estimator::{Estimator, Starts, starts_of};
use crate::diagnosis::selection::fit_problem::{OnResponse, Trial};
use crate::diagnosis::selection::levenberg_marquardt::variables::Variables;
use crate::diagnosis::selection::levenberg_marquardt::{Descent, descend};
use crate::effects::{Leg, Range, Source};
use crate::response::harmonic_balance::{Response, Settings};
use faer::Mat;

/// Groups of runs that are left out in turn.
const FOLDS: usize = 4;

/// Steps of a fit whose time is up.
const HURRIED: usize = 1;

/// A set of effects fitted on the response.
#[derive(Debug, Clone)]
pub(crate) struct FittedModel {
    /// Effects with their parameters.
    pub effects: Vec<Source>,
    /// Standard deviation of every parameter, of every effect.
    pub deviations: Vec<Vec<f64>>,
    /// Squared whitened residual, the prior of updating parameters included.
    pub chi_square: f64,
    /// Number of fitted parameters of effects.
    pub parameters: usize,
    /// Relative root mean square error, as in `compare`.
    pub error: f64,
    pub(crate) starts: Starts,
    pub(crate) descent: Descent,
}

impl FittedModel {
    /// The effects that are all but a simpler law on the motion that the fit predicts at their place, each by its place in the
    /// list, with that law.
    pub(crate) fn all_but_simpler(&self) -> impl Iterator<Item = (usize, Source)> {
        let simpler = |(k, source): (usize, &Source)| Some((k, source.simpler(&self.range_at(source))?));
        self.effects.iter().enumerate().filter_map(simpler)
    }

    /// Range of the predicted relative motion at the place of `source`.
    fn range_at(&self, source: &Source) -> Range {
        let legs = source.place.legs();
        let size = |motion: &Response| {
            let of_leg = |leg: &Leg| leg.relative(|i| motion.amplitude(i, 1)).norm();
            [motion.omega, legs.iter().map(of_leg).fold(0.0, f64::max)]
        };
        Range::of_amplitudes(self.starts.iter().flatten().map(size).filter(|[_, amplitude]| *amplitude > 0.0))
    }
}

impl Estimator<'_> {
    /// Fits all parameters of `effects` from where they are.
    pub(crate) fn fit(
        &self,
        effects: &[Source],
        steps: usize,
        settings: &Settings,
        starts: &[Option<Response>],
    ) -> Result<FittedModel, DiagnosisError> {
        let steps = if self.control.is_late() { steps.min(HURRIED) } else { steps };
        let (variables, start) = Variables::new(effects);
        let (estimator, settings, starts) = (*self, *settings, starts.to_vec());
        let mut response = OnResponse { estimator, variables: &variables, settings, starts, last: None };
        let descent = descend(&mut response, &start, steps)?;
        let trial = response.trial(&descent.theta)?;
        Ok(finished(self, &variables, descent, trial))
    }

    /// Error on runs that were left out: groups of runs in turn, the parameters refitted without them (linearised).
    pub(crate) fn held_out_error(&self, fit: &FittedModel) -> Result<f64, DiagnosisError> {
        let (variables, _) = Variables::new(&fit.effects);
        let folds = FOLDS.min(self.data.runs.len());
        if folds < 2 {
            return Ok(fit.error);
        }
        let mut rows = 0;
        let mut fold_of_row = Vec::with_capacity(fit.descent.residual.len());
        for (r, noise) in self.noise.runs.iter().enumerate() {
            rows += noise.len();
            fold_of_row.resize(rows, r % folds);
        }
        // The priors of updating parameters are never left out.
        fold_of_row.resize(fit.descent.residual.len(), usize::MAX);
        let mut predictions: Vec<Option<RunPrediction>> = vec![None; self.data.runs.len()];
        for fold in 0..folds {
            let theta = without(&fit.descent, &fold_of_row, fold);
            let effects = variables.effects(&theta[..variables.len()]);
            for (r, run) in self.data.runs.iter().enumerate().filter(|(r, _)| r % folds == fold) {
                let start = fit.starts.get(r).and_then(Option::as_ref);
                let predicted = self.predictor.predict(r, run, &effects, &FINAL, start, self.control);
                predictions[r] = Some(predicted.or_else(|_| self.at_rest(r))?);
            }
        }
        Ok(self.error(&predictions.into_iter().flatten().collect::<Vec<_>>(), &fit.effects))
    }
}

fn finished(estimator: &Estimator, variables: &Variables, descent: Descent, trial: Trial) -> FittedModel {
    let effects = variables.effects(&descent.theta);
    let slopes = variables.slopes(&descent.theta);
    let all = descent.deviations();
    let mut own = all.iter().zip(&slopes).map(|(d, s)| d * s.abs());
    let deviations = effects.iter().map(|e| own.by_ref().take(e.parameters.len()).collect()).collect();
    FittedModel {
        chi_square: descent.chi_square,
        parameters: variables.len(),
        error: estimator.error(&trial.predictions, &effects),
        starts: starts_of(trial.predictions),
        effects,
        deviations,
        descent,
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

#[cfg(test)]
mod tests;
