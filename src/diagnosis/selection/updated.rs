//! The model with its updating parameters moved to where the data ask for them, and linearised there.

use crate::diagnosis::residual::data::DiagnosisError;
use crate::diagnosis::residual::energy_balance::scaled_factors;
use crate::diagnosis::residual::prediction::{FINAL, RunPrediction};
use crate::diagnosis::selection::fit_problem::run_slopes;
use crate::diagnosis::selection::fitted_model::Starts;
use crate::diagnosis::selection::search::Base;
use crate::diagnosis::updating::noise_model::{Linearisation, of_channel};
use crate::diagnosis::updating::parameters::Updating;
use crate::effects::Source;
use crate::response::sensitivity::Unknown;
use faer::c64;
use std::sync::Arc;

/// Steps of the fit of the updating parameters alone.
const STEPS: usize = 8;
/// Largest change of a logarithm in one step.
const LONGEST: f64 = 0.05;
/// Gain of the squared residual per datum below which the fit has arrived.
const ARRIVED: f64 = 1e-3;
/// Bounds of the factor by which the measured motion may differ from the predicted one where derivatives are corrected
/// for it.
const FIELD: [f64; 2] = [0.02, 50.0];

impl<'a> Base<'a> {
    /// The model with its updating parameters at `updating`, linearised beside `effects`, whose responses start from
    /// `starts`.
    ///
    /// Where the model is far off, its derivatives `-A dZ X` are taken at the measured motion rather than at its own
    /// (`X` times the factor that fits the sensors best): for a single mode the relation is then exact however far off.
    pub fn updated(
        &self,
        updating: &Updating,
        effects: &[Source],
        starts: &Starts,
    ) -> Result<Base<'a>, DiagnosisError> {
        let predictor = Arc::new(self.predictor.updated(updating)?);
        let mut base = Base { predictor, predictions: Vec::new(), ..self.shallow() };
        base.predictions = base.bench().predict(&[], &FINAL, &[])?;
        let predictions = if effects.is_empty() {
            base.predictions.clone()
        } else {
            base.bench().predict(effects, &FINAL, starts)?
        };
        base.linearisation = Arc::new(base.linearised(updating, effects, &predictions));
        base.noise = Arc::new(base.noise_of(effects, &predictions)?);
        Ok(base)
    }

    fn linearised(&self, updating: &Updating, effects: &[Source], predictions: &[RunPrediction]) -> Linearisation {
        let known = self.predictor.known();
        let mut sums: Vec<Vec<(Unknown, f64)>> = (0..updating.len()).map(|k| updating.unknowns(k, known)).collect();
        sums.push(vec![(Unknown::Stiffness, 1.0)]);
        let of_run = |r: usize| {
            let (run, prediction) = (&self.data.runs[r], &predictions[r]);
            let zero = || vec![vec![c64::new(0.0, 0.0); run.harmonics]; run.responses.len()];
            let mut slopes = run_slopes(&self.predictor, r, run, effects, prediction, &sums)
                .unwrap_or_else(|| vec![zero(); sums.len()]);
            let factor = scaled_factors(run, prediction).first().copied().unwrap_or(c64::new(1.0, 0.0));
            let size = factor.norm();
            if size > 0.0 && size.is_finite() {
                let factor = factor * (size.clamp(FIELD[0], FIELD[1]) / size);
                slopes.iter_mut().flatten().for_each(|channel| channel[0] *= factor);
            }
            let stiffness = slopes.pop().unwrap_or_else(zero);
            for (slope, parameter) in slopes.iter_mut().zip(&updating.parameters) {
                if !parameter.is_of_model() {
                    *slope = of_channel(parameter, run);
                }
            }
            (slopes, stiffness)
        };
        let (common, stiffness) = self.control.map(self.data.runs.len(), of_run).into_iter().unzip();
        Linearisation { updating: updating.clone(), common, stiffness }
    }

    /// The updating parameters that fit the measurement beside `effects` with the prediction of this base; standardised.
    fn solved(&self, effects: &[Source], starts: &Starts) -> Result<(Vec<f64>, f64), DiagnosisError> {
        let predictions = self.predictions_with(effects, starts)?;
        let rows = self.bench().at_reference(&predictions);
        let u = self.noise.updating.solve(&rows);
        Ok((u, square(&self.bench().residual(&predictions))))
    }

    fn predictions_with(&self, effects: &[Source], starts: &Starts) -> Result<Vec<RunPrediction>, DiagnosisError> {
        if effects.is_empty() { Ok(self.predictions.clone()) } else { self.bench().predict(effects, &FINAL, starts) }
    }

    /// The model whose updating parameters fit the measurement best without any effect, their scales estimated.
    pub fn bare(&self) -> Result<Base<'a>, DiagnosisError> {
        let (stated, known) = self.predictor.stated();
        let all = Updating::all(stated, known, self.data);
        let mut best: Option<(f64, Base<'a>)> = None;
        let mut updating = all;
        for step in 0..STEPS {
            let base = self.updated(&updating, &[], &Vec::new())?;
            let rows = base.bench().at_reference(&base.predictions);
            let u0 = updating.standardised();
            let here = square(&rows) + square(&u0) + base.noise.cost();
            let better = best.as_ref().is_none_or(|(least, _)| here < *least);
            let gain = best.as_ref().map_or(f64::INFINITY, |(least, _)| least - here);
            let scales = if step > 0 { base.noise.scales(&rows) } else { updating.scales };
            let target = updating.at(&base.noise.updating.solve(&rows)).values;
            if better {
                best = Some((here, base));
            }
            if step > 2 && gain < ARRIVED * self.count() as f64 {
                break;
            }
            updating = towards(&updating, &target).with_scales(scales);
        }
        match best {
            Some((_, base)) => Ok(base),
            None => self.updated(&updating, &[], &Vec::new()),
        }
    }

    /// The model moved to the updating parameters that fit best beside `effects`, their scales estimated beside them.
    pub fn moved_to(&self, effects: &[Source], starts: &Starts) -> Result<Base<'a>, DiagnosisError> {
        let predictions = self.predictions_with(effects, starts)?;
        let rows = self.bench().at_reference(&predictions);
        let updating = &self.linearisation.updating;
        let scales = self.noise.scales(&rows);
        let (u, _) = self.solved(effects, starts)?;
        let target = updating.at(&u).values;
        self.updated(&towards(updating, &target).with_scales(scales), effects, starts)
    }

    /// How far `moved_to` would move the parameters of the model, in prior deviations.
    pub fn distance(&self, effects: &[Source], starts: &Starts) -> Result<f64, DiagnosisError> {
        let (u, _) = self.solved(effects, starts)?;
        let here = self.linearisation.updating.standardised();
        Ok(u.iter().zip(&here).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max))
    }
}

/// The values of `updating` moved to `target`, none by more than the longest step.
fn towards(updating: &Updating, target: &[f64]) -> Updating {
    let moved = |(k, (from, to)): (usize, (&f64, &f64))| {
        if updating.parameters[k].is_of_model() { from + (to - from).clamp(-LONGEST, LONGEST) } else { *to }
    };
    let values = updating.values.iter().zip(target).enumerate().map(moved).collect();
    Updating { values, ..updating.clone() }
}

fn square(values: &[f64]) -> f64 {
    values.iter().map(|x| x * x).sum()
}
