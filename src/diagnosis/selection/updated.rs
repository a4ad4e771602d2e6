//! The model with its updating parameters moved to where the data ask for them, and linearised there.

use crate::diagnosis::residual::data::{Data, DiagnosisError, RunData, if_possible};
use crate::diagnosis::residual::energy_balance::scaled_factors;
use crate::diagnosis::residual::prediction::{FINAL, RunPrediction};
use crate::diagnosis::selection::estimator::Starts;
use crate::diagnosis::selection::fit_problem::{RunSlopes, run_slopes};
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::diagnosis::selection::search_result::{agrees, most_of_noise};
use crate::diagnosis::selection::solver_settings::settings_for;
use crate::diagnosis::updating::measured_motion::MeasuredMotion;
use crate::diagnosis::updating::noise_model::{Derivatives, Linearisation, amplitudes, of_channel};
use crate::diagnosis::updating::parameters::Updating;
use crate::diagnosis::updating::scales::Scales;
use crate::effects::Source;
use crate::math::statistics::sum_of_squares;
use crate::response::harmonic_balance::Settings;
use crate::response::sensitivity::Unknown;
use faer::c64;
use std::sync::Arc;

/// Steps of the fit of the updating parameters alone.
const STEPS: usize = 8;
/// Gain of the squared residual per datum below which the fit has arrived.
const ARRIVED: f64 = 1e-3;
/// Squared residual per datum of the model with rigid supports from which on it is looked at with supports that give way.
const SUPPORTED: f64 = 4.0;
/// Rounds in which scales and effects are fitted in turn.
const ROUNDS: usize = 3;
/// Steps of the effects in each.
pub(super) const REFITTED: usize = 4;
/// Factor of the measured over the predicted motion, off one, up to which derivatives are taken at the predicted one.
const NEAR: f64 = 0.3;
/// Bounds of the factor by which the measured motion may differ from the predicted one where derivatives are corrected for it.
const FIELD: [f64; 2] = [0.02, 50.0];

impl<'a> ReferenceModel<'a> {
    /// The model with its updating parameters at `updating`, linearised beside `effects`, whose responses start from `starts`.
    ///
    /// Where the model is far off, its derivatives `-A dZ X` are taken at the measured motion rather than at its own
    /// (`X` times the factor that fits the sensors best): for a single mode the relation is then exact however far off.
    pub(crate) fn updated(
        &self,
        updating: &Updating,
        effects: &[Source],
        starts: &Starts,
    ) -> Result<ReferenceModel<'a>, DiagnosisError> {
        self.updated_as(updating, effects, starts, &FINAL)
    }

    /// The same with the responses of the effects as exact as `settings`.
    pub(super) fn updated_as(
        &self,
        updating: &Updating,
        effects: &[Source],
        starts: &Starts,
        settings: &Settings,
    ) -> Result<ReferenceModel<'a>, DiagnosisError> {
        let updating = &updating.of_model().with_common_damping_shared(self.predictor.stated().1);
        let predictor = Arc::new(self.predictor.updated(updating)?);
        let mut reference = ReferenceModel { predictor, predictions: Vec::new(), ..self.shallow() };
        reference.predictions = reference.estimator().predict(&[], &FINAL, &[])?;
        let predictions = if effects.is_empty() {
            reference.predictions.clone()
        } else {
            reference.estimator().predict(effects, settings, starts)?
        };
        reference.linearisation = Arc::new(reference.linearised(updating, effects, &predictions));
        reference.noise = Arc::new(reference.noise_of_predictable(effects, &predictions)?);
        Ok(reference)
    }

    fn linearised(&self, updating: &Updating, effects: &[Source], predictions: &[RunPrediction]) -> Linearisation {
        let known = self.predictor.known();
        let linear = effects.is_empty() && known.iter().all(|source| source.effect.is_linear());
        let doubts_harmonics = self.linearisation.doubts_harmonics;
        let highest = if doubts_harmonics { usize::MAX } else { 1 };
        let seen = || MeasuredMotion::new(&self.predictor, self.data, predictions, highest, self.control);
        let seen = linear.then(seen).flatten();
        let runs = self.data.runs.iter().zip(predictions);
        let amplitudes: Vec<Vec<Vec<c64>>> = runs.map(|(run, p)| amplitudes(run, &p.channels)).collect();
        let of_run = |r: usize| {
            let run = &self.data.runs[r];
            let mut sums: Vec<Vec<(Unknown, f64)>> =
                (0..updating.len()).map(|k| updating.unknowns(k, known, run)).collect();
            sums.push(vec![(Unknown::Stiffness, 1.0)]);
            let (mut slopes, level) = if let Some(seen) = &seen {
                (seen.slopes(r, &sums), None)
            } else {
                sums.push((0..run.forces.len()).map(|force| (Unknown::ForceScale(force), 1.0)).collect());
                let mut slopes = self.model_slopes(r, effects, &predictions[r], &sums);
                let level = slopes.pop();
                (slopes, level.filter(|level| is_felt(level)))
            };
            let mut stiffness = slopes.pop().unwrap_or_default();
            if seen.is_some() {
                fundamentals_alone(&mut stiffness);
            }
            for (k, (slope, parameter)) in slopes.iter_mut().zip(&updating.parameters).enumerate() {
                if !updating.acts_in(k, r) {
                    slope.iter_mut().flatten().for_each(|value| *value = c64::new(0.0, 0.0));
                }
                if !parameter.is_of_model() {
                    *slope = of_channel(parameter, run, &amplitudes[r]);
                }
            }
            (slopes, [stiffness, level.unwrap_or_default()])
        };
        let (mut common, own): (Vec<RunSlopes>, Vec<_>) =
            self.control.map(self.data.runs.len(), of_run).into_iter().unzip();
        let (stiffness, level) = own.into_iter().map(|[stiffness, level]| (stiffness, level)).unzip();
        let at_motion = if seen.is_some() && doubts_harmonics { common.clone() } else { Vec::new() };
        // Beside effects the model is fitted on the response itself: what harmonics tell of it is told there.
        for slopes in common.iter_mut().filter(|_| seen.is_some()) {
            let of_model = slopes.iter_mut().zip(&updating.parameters).filter(|(_, parameter)| parameter.is_of_model());
            of_model.for_each(|(slope, _)| fundamentals_alone(slope));
        }
        let leverage = if seen.is_some() { leverage(self.data, updating, &common, predictions) } else { Vec::new() };
        let expansions = seen.map_or_else(Vec::new, |seen| seen.expansions);
        Linearisation {
            updating: updating.clone(),
            derivatives: Arc::new(Derivatives {
                common,
                at_motion,
                stiffness,
                level,
                expansions,
                amplitudes,
                leverage,
            }),
            doubts_harmonics,
            of_fundamentals: self.linearisation.of_fundamentals,
        }
    }

    /// Derivatives of the model with `effects` at its own motion times the factor that fits the sensors best.
    fn model_slopes(
        &self,
        r: usize,
        effects: &[Source],
        prediction: &RunPrediction,
        sums: &[Vec<(Unknown, f64)>],
    ) -> RunSlopes {
        let run = &self.data.runs[r];
        let zero = || vec![vec![c64::new(0.0, 0.0); run.harmonics]; run.responses.len()];
        let mut slopes =
            run_slopes(&self.predictor, r, run, effects, prediction, sums).unwrap_or_else(|| vec![zero(); sums.len()]);
        let factor = scaled_factors(run, prediction).first().copied().unwrap_or(c64::new(1.0, 0.0));
        let size = factor.norm();
        if size > 0.0 && size.is_finite() && (factor - 1.0).norm() > NEAR {
            let factor = factor * (size.clamp(FIELD[0], FIELD[1]) / size);
            slopes.iter_mut().flatten().for_each(|channel| channel[0] *= factor);
        }
        slopes
    }

    pub(super) fn predictions_with(
        &self,
        effects: &[Source],
        starts: &Starts,
        settings: &Settings,
    ) -> Result<Vec<RunPrediction>, DiagnosisError> {
        if effects.is_empty() {
            Ok(self.predictions.clone())
        } else {
            self.estimator().predict(effects, settings, starts)
        }
    }

    /// The updating parameters of this model moved to the standardised `target`, none by more than the longest step.
    pub(super) fn towards(&self, target: &[f64]) -> Updating {
        let updating = &self.linearisation.updating;
        updating.towards(&updating.at(target).values)
    }

    /// The model whose updating parameters fit the measurement best without any effect: from supports that are rigid, and, where
    /// that leaves much, from supports that give way.
    pub(crate) fn bare(&self) -> Result<ReferenceModel<'a>, DiagnosisError> {
        let (stated, known) = self.predictor.stated();
        let rigid = Updating::all(stated, known, self.data);
        let stepped = |updating: Updating| self.stepped(updating, &[], &Vec::new(), &FINAL);
        let mut best = stepped(rigid.clone())?;
        if best.as_ref().is_none_or(|(left, _)| *left > SUPPORTED * self.count() as f64) {
            for updating in rigid.giving_way() {
                let other = stepped(updating)?;
                let lower = |(left, _): &(f64, _)| best.as_ref().is_none_or(|(least, _)| left < least);
                best = if other.as_ref().is_some_and(lower) { other } else { best };
            }
        }
        match best {
            Some((_, reference)) => reference.converged_bare(STEPS, f64::INFINITY),
            None => self.updated(&rigid, &[], &Vec::new()),
        }
    }

    /// The model fitted in limited steps from `updating` on beside `effects`, which are as they are, with its squared residual at its
    /// reference; none where there is no such model.
    pub(super) fn stepped(
        &self,
        mut updating: Updating,
        effects: &[Source],
        starts: &Starts,
        settings: &Settings,
    ) -> Result<Option<(f64, ReferenceModel<'a>)>, DiagnosisError> {
        let mut best: Option<(f64, ReferenceModel<'a>)> = None;
        for step in 0..STEPS {
            let Some(reference) = if_possible(self.updated_as(&updating, effects, starts, settings))? else { break };
            let rows = reference.estimator().at_reference(&reference.predictions_with(effects, starts, settings)?);
            let here = sum_of_squares(&rows);
            let misfit = (here / self.count() as f64).max(1.0);
            let target = updating.at(&reference.noise.updating.solve_with_misfit(&rows, misfit)).values;
            let least = best.as_ref().map_or(f64::INFINITY, |(least, _)| *least);
            if here < least {
                best = Some((here, reference));
            }
            if (step > 2 && least - here < ARRIVED * least) || self.control.is_late() {
                break;
            }
            updating = updating.towards(&target);
        }
        Ok(best)
    }

    /// This model with the scales that are most likely without any effect, and its evidence: without gains and differences
    /// from run to run, or without those alone, where that agrees with the data; else the best of these and of the scales
    /// that are estimated. It is not followed where its evidence would stay above `most`.
    pub(crate) fn likely(&self, most: f64) -> Result<(ReferenceModel<'a>, f64), DiagnosisError> {
        let alike = Scales { shift: Scales::LEAST.shift, response: Scales::LEAST.response, ..Scales::SEARCH };
        let exact = Scales { gain: Scales::LEAST.gain, phase: Scales::LEAST.phase, ..alike };
        let start = self.updated(&self.linearisation.updating.without_force_gains_and_shifts(), &[], &Vec::new())?;
        let strict = |scales: Scales| -> Result<(ReferenceModel<'a>, f64, bool), DiagnosisError> {
            let strict = start.with_scales(scales);
            let most = most_of_noise(&strict, 0) + strict.noise.cost();
            let strict = strict.converged_bare(STEPS, most)?;
            let left = sum_of_squares(&strict.estimator().residual(&strict.predictions));
            let (cost, enough) = (left + strict.noise.cost(), agrees(&strict, left, 0));
            Ok((strict, cost, enough))
        };
        let first = strict(exact)?;
        if first.2 {
            return Ok((first.0, first.1));
        }
        let estimated = || self.estimated(most).map(|(r, cost)| (r, cost, false));
        let other = |k: usize| if k == 0 { strict(alike) } else { estimated() };
        let mut tried = vec![first];
        for other in self.control.map(2, other) {
            tried.push(other?);
        }
        let agreeing = tried.iter().position(|(_, _, enough)| *enough);
        let cost = |k: &usize| tried[*k].1;
        let best = agreeing.or_else(|| (0..tried.len()).min_by(|a, b| cost(a).total_cmp(&cost(b)))).unwrap_or(0);
        let (reference, cost, _) = tried.swap_remove(best);
        Ok((reference, cost))
    }

    /// Squared residual per datum without any effect.
    pub(super) fn misfit(&self) -> f64 {
        sum_of_squares(&self.estimator().residual(&self.predictions)) / self.count().max(1) as f64
    }

    /// This model settled with the scales that are estimated without any effect, and its evidence; no further where that would stay
    /// above `most`.
    pub(super) fn estimated(&self, most: f64) -> Result<(ReferenceModel<'a>, f64), DiagnosisError> {
        let converged = self.with_likely_scales(None, &FINAL)?.0.converged_bare(STEPS, most)?;
        let estimated = converged.with_likely_scales(None, &FINAL)?.0;
        let cost = sum_of_squares(&estimated.estimator().residual(&estimated.predictions)) + estimated.noise.cost();
        Ok((estimated, cost))
    }

    /// Evidence of predictions with the updating parameters of the model at their reference, priors included.
    pub(super) fn cost_at_reference(&self, predictions: &[RunPrediction]) -> f64 {
        self.noise.updating.left_by_channels(&self.estimator().at_reference(predictions)) + self.noise.cost()
    }

    pub(super) fn refitted(&self, fit: &FittedModel, settings: &Settings) -> Result<FittedModel, DiagnosisError> {
        self.estimator().fit(&fit.effects, REFITTED, settings, &fit.starts)
    }

    /// The same model with other scales of the priors.
    pub(crate) fn with_scales(&self, scales: Scales) -> ReferenceModel<'a> {
        let updating = self.linearisation.updating.with_scales(scales);
        let linearisation = Linearisation { updating, ..(*self.linearisation).clone() };
        let noise = self.noise.rescaled(&linearisation);
        ReferenceModel { linearisation: Arc::new(linearisation), noise: Arc::new(noise), ..self.clone() }
    }

    /// The model with the scales that are most likely beside the effects of `fit` (none: the model alone), and the
    /// effects fitted with them.
    pub(crate) fn with_likely_scales(
        &self,
        fit: Option<&FittedModel>,
        settings: &Settings,
    ) -> Result<(ReferenceModel<'a>, Option<FittedModel>), DiagnosisError> {
        let settings = fit.map_or(settings, |fit| settings_for(fit, self.count(), settings));
        let (mut reference, mut fitted) = (self.with_scales(self.linearisation.updating.scales), fit.cloned());
        for _ in 0..ROUNDS {
            if reference.control.is_late() {
                break;
            }
            let predictions = match &fitted {
                Some(fit) => reference.estimator().predict(&fit.effects, settings, &fit.starts)?,
                None => reference.predictions.clone(),
            };
            for _ in 0..ROUNDS {
                reference =
                    reference.with_scales(reference.noise.scales(&reference.estimator().at_reference(&predictions)));
            }
            let Some(fit) = &fitted else { break };
            fitted = Some(reference.refitted(fit, settings)?);
        }
        Ok((reference, fitted))
    }
}

/// Whether derivatives, `[channel][harmonic - 1]`, are not all zero.
fn is_felt(slope: &[Vec<c64>]) -> bool {
    slope.iter().flatten().any(|value| *value != c64::new(0.0, 0.0))
}

/// Drops the higher harmonics of derivatives, `[channel][harmonic - 1]`.
fn fundamentals_alone(slope: &mut [Vec<c64>]) {
    slope.iter_mut().for_each(|channel| channel[1..].fill(c64::new(0.0, 0.0)));
}

/// Share of a run that the model misses below which its derivatives are those of the measured motion.
const CLOSE: f64 = 0.1;

/// Error of the measured motion, relative: gains of sensors, and what modes do not show between them.
const MOTION: f64 = 0.01;

/// What an error of the measured motion makes of the derivatives of each run, as a factor on its response: the larger, the
/// more the parameters of the model would change it within their priors, and the more of it the model does not predict yet.
fn leverage(data: &Data, updating: &Updating, common: &[RunSlopes], predictions: &[RunPrediction]) -> Vec<f64> {
    let of_model: Vec<usize> = (0..updating.len()).filter(|&k| updating.parameters[k].is_of_model()).collect();
    let of_run = |((run, slopes), prediction): ((&RunData, &RunSlopes), &RunPrediction)| {
        let (mut moved, mut missing, mut size) = (0.0, 0.0, 0.0);
        for &c in &run.alive {
            let (weight, y) = (run.scale(c).powi(-2), run.responses[c].measured[0]);
            size += weight * y.norm_sqr();
            missing += weight * (y - prediction.channels[c][0]).norm_sqr();
            moved += weight * of_model.iter().map(|&k| (slopes[k][c][0] * updating.prior(k)).norm_sqr()).sum::<f64>();
        }
        let missing = (missing / size).sqrt().min(1.0);
        if size > 0.0 && missing > CLOSE { MOTION * (moved / size).sqrt() * missing } else { 0.0 }
    };
    data.runs.iter().zip(common).zip(predictions).map(of_run).collect()
}

#[cfg(test)]
mod tests;
