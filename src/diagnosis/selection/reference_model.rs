//! One model with its data and noise that a search starts from, and how sets of effects fitted beside it are ranked.

use super::short_list::{EXTRA, is_real};
use crate::control::Control;
use crate::diagnosis::candidates::special_cases::is_allowed;
use crate::diagnosis::localisation::location::turns_a_moving_node;
use crate::diagnosis::residual::data::{Data, DiagnosisError, RunData};
use crate::diagnosis::residual::prediction::{FINAL, Predictor, RunPrediction};
use crate::diagnosis::residual::transfers::transfers;
use crate::diagnosis::residual::whitening::{Transfers, Whitening};
use crate::diagnosis::result::{Early, Step};
use crate::diagnosis::selection::estimator::Estimator;
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::updating::linearisation_error::{linearisation_error, unpredictable};
use crate::diagnosis::updating::noise_model::{Linearisation, NoiseModel};
use crate::effects::Source;
use crate::math::statistics::{bayesian_information, evidence_weights, root_mean_square, sum_of_squares};
use std::sync::Arc;

/// What a place costs that is the rotation of a node which moves: of fifty effects one is there, `2 ln 50`.
const ROTATION: f64 = 8.0;
/// What a law costs that is fitted next to a simpler one: records are not so exact that they could tell.
const BESIDE_SIMPLER: f64 = 20.0;

/// Everything that a search needs about one reference model.
#[derive(Clone)]
pub(crate) struct ReferenceModel<'a> {
    /// The known model, its updating parameters at their reference.
    pub predictor: Arc<Predictor>,
    pub data: &'a Data,
    pub control: &'a Control,
    /// What updating parameters do, at their reference.
    pub linearisation: Arc<Linearisation>,
    /// Predictions of the reference model.
    pub predictions: Vec<RunPrediction>,
    /// Noise of the residuals.
    pub noise: Arc<NoiseModel>,
    /// Who is told of the first suggestions.
    pub early: &'a Early<'a>,
}

impl<'a> ReferenceModel<'a> {
    /// The known model itself.
    pub(crate) fn new(
        predictor: Arc<Predictor>,
        data: &'a Data,
        control: &'a Control,
        early: &'a Early<'a>,
    ) -> Result<Self, DiagnosisError> {
        let (linearisation, noise) = (Arc::default(), Arc::default());
        let mut reference = Self { predictor, data, control, linearisation, predictions: Vec::new(), noise, early };
        reference.predictions = reference.estimator().predict(&[], &FINAL, &[])?;
        reference.noise = Arc::new(reference.noise_of(&[], &reference.predictions)?);
        Ok(reference)
    }

    /// The same model where higher harmonics are doubted as far as the model is.
    #[must_use]
    pub(crate) fn doubting_harmonics(&self) -> ReferenceModel<'a> {
        let linearisation = Linearisation { doubts_harmonics: true, ..(*self.linearisation).clone() };
        ReferenceModel { linearisation: Arc::new(linearisation), ..self.clone() }
    }

    /// The same model where higher harmonics count for nothing, as it is updated next.
    pub(super) fn of_fundamentals(&self) -> ReferenceModel<'a> {
        let linearisation = Linearisation { of_fundamentals: true, ..(*self.linearisation).clone() };
        ReferenceModel { linearisation: Arc::new(linearisation), noise: self.noise.clone(), ..self.shallow() }
    }

    /// Noise of the residual of a model with `effects` and its predictions.
    pub(crate) fn noise_of(&self, effects: &[Source], of: &[RunPrediction]) -> Result<NoiseModel, DiagnosisError> {
        let whitening = |(r, run): (usize, &RunData), a: &Transfers| Whitening::new(run, a, &of[r].truncation);
        Ok(NoiseModel::new(self.whitened_runs(effects, whitening)?, &self.linearisation, self.control))
    }

    /// The same where higher harmonics of which the model can say nothing count for nothing.
    pub(super) fn noise_of_predictable(
        &self,
        effects: &[Source],
        of: &[RunPrediction],
    ) -> Result<NoiseModel, DiagnosisError> {
        let errors = unpredictable(self.data, &self.linearisation, of);
        Ok(NoiseModel::new(self.noise_beside(effects, of, &errors)?, &self.linearisation, self.control))
    }

    /// Noise of the residual of each run in which places are looked for, with what derivatives by the model leave of its higher
    /// harmonics; nothing of it eliminated.
    pub(super) fn noise_of_places(
        &self,
        effects: &[Source],
        of: &[RunPrediction],
    ) -> Result<Vec<Whitening>, DiagnosisError> {
        self.noise_beside(effects, of, &linearisation_error(self.data, &self.linearisation, of))
    }

    /// Noise of the residual of each run with `errors` of the prediction beside those of truncation, `[run][channel][harmonic - 1]`.
    fn noise_beside(
        &self,
        effects: &[Source],
        of: &[RunPrediction],
        errors: &[Vec<Vec<f64>>],
    ) -> Result<Vec<Whitening>, DiagnosisError> {
        self.whitened_runs(effects, |(r, run), a| Whitening::new(run, a, &quadrature(&of[r].truncation, &errors[r])))
    }

    /// What `whitening` makes of each run and the response of its channels to its forces.
    fn whitened_runs(
        &self,
        effects: &[Source],
        whitening: impl Fn((usize, &RunData), &Transfers) -> Whitening + Sync,
    ) -> Result<Vec<Whitening>, DiagnosisError> {
        let whitened_run = |r: usize| {
            let run = &self.data.runs[r];
            let failed = |reason| DiagnosisError::of_response(format!("number {}", run.index + 1), reason);
            let a = transfers(&self.predictor, r, run, effects, self.control).map_err(failed)?;
            Ok(whitening((r, run), &a))
        };
        self.control.map(self.data.runs.len(), whitened_run).into_iter().collect()
    }

    /// What fits on the response are made with.
    pub(crate) fn estimator(&self) -> Estimator<'_> {
        Estimator { predictor: &self.predictor, data: self.data, noise: &self.noise, control: self.control }
    }

    /// Number of real data.
    pub(crate) fn count(&self) -> usize {
        self.noise.count()
    }

    /// The same model and data without what was computed of them.
    pub(crate) fn shallow(&self) -> ReferenceModel<'a> {
        ReferenceModel {
            predictor: self.predictor.clone(),
            data: self.data,
            control: self.control,
            linearisation: self.linearisation.clone(),
            predictions: Vec::new(),
            noise: Arc::default(),
            early: self.early,
        }
    }

    /// The same model of other `data`, without what was computed.
    pub(super) fn with_data<'b>(&'b self, data: &'b Data) -> ReferenceModel<'b> {
        ReferenceModel { data, early: &|_| {}, ..self.shallow() }
    }

    /// `ln det` of the noise of all runs.
    pub(super) fn noise_determinant(&self) -> f64 {
        self.noise.runs.iter().map(Whitening::log_determinant).sum()
    }

    /// Information criterion of a fit, its squared residual scaled by what the best model leaves beyond the noise.
    pub(crate) fn evidence(&self, fit: &FittedModel, scale: f64) -> f64 {
        let turning = fit.effects.iter().filter(|e| turns_a_moving_node(self.predictor.structure(), &e.place)).count();
        bayesian_information(fit.chi_square / scale.max(1.0), fit.parameters, self.count())
            + Self::complexity(fit)
            + ROTATION * turning as f64
    }

    /// What the laws of a fit cost in evidence for their kind, whatever the data.
    pub(crate) fn complexity(fit: &FittedModel) -> f64 {
        let extra: usize = fit.effects.iter().map(|e| e.parameters.len() - 1).sum();
        EXTRA * extra as f64 + Self::cost_beside_simpler(fit)
    }

    /// The part of it that laws cost which are all but a simpler one.
    pub(crate) fn cost_beside_simpler(fit: &FittedModel) -> f64 {
        BESIDE_SIMPLER * fit.all_but_simpler().count() as f64
    }

    /// Probability of each fit by its evidence, their squared residuals scaled by what the best leaves.
    pub(crate) fn probabilities(&self, fits: &[FittedModel]) -> Vec<f64> {
        let scale = scale_of(fits, self.count());
        evidence_weights(&fits.iter().map(|fit| self.evidence(fit, scale)).collect::<Vec<f64>>())
    }

    /// Best first; none of more parameters than runs.
    pub(crate) fn ranked(&self, mut fits: Vec<FittedModel>) -> Vec<FittedModel> {
        let allowed = |(e, d): (&Source, &Vec<f64>)| !e.is_disguised() && is_allowed(&self.data.excluded, e, d);
        let few = |r: &FittedModel| r.parameters <= self.data.runs.len();
        fits.retain(|r| {
            r.chi_square.is_finite()
                && few(r)
                && r.effects.iter().zip(&r.deviations).all(allowed)
                && r.effects.iter().zip(&r.deviations).all(|(e, d)| is_real(e, d))
        });
        let scale = scale_of(&fits, self.count());
        fits.sort_by(|a, b| self.evidence(a, scale).total_cmp(&self.evidence(b, scale)));
        fits
    }

    /// How far the model agrees with the data as it is, as a first step.
    pub(crate) fn agreement(&self) -> Step {
        let estimator = self.estimator();
        let before = sum_of_squares(&estimator.residual(&self.predictions));
        Step {
            added: Vec::new(),
            error: estimator.error(&self.predictions, &[]),
            misfit: before / self.count().max(1) as f64,
        }
    }

    /// Error that noise and truncation alone would leave.
    pub(crate) fn noise_floor(&self, effects: &[Source], predictions: &[RunPrediction]) -> f64 {
        let Ok(noise) = self.noise_of(effects, predictions) else { return f64::NAN };
        let mut floors = Vec::new();
        for ((run, noise), prediction) in self.data.runs.iter().zip(&noise.runs).zip(predictions) {
            let residual = |k: usize, h: usize| run.responses[k].measured[h - 1] - prediction.channels[k][h - 1];
            for c in 0..run.responses.len() {
                let scale = run.scale(c);
                floors.push(if scale > 0.0 { noise.expected_given(c, residual).sqrt() / scale } else { 0.0 });
            }
        }
        root_mean_square(&floors)
    }
}

/// Roots of the sums of squares, entry by entry; what `a` has no entries for is 0.
fn quadrature(a: &[Vec<f64>], b: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let entry = |c: usize, h: usize| a.get(c).and_then(|list| list.get(h)).copied().unwrap_or(0.0);
    let channel = |(c, list): (usize, &Vec<f64>)| list.iter().enumerate().map(|(h, e)| e.hypot(entry(c, h))).collect();
    b.iter().enumerate().map(channel).collect()
}

/// Squared residual per datum of the best fit, at least 1.
pub(crate) fn scale_of(fits: &[FittedModel], count: usize) -> f64 {
    let least = fits.iter().map(|r| r.chi_square / count.saturating_sub(r.parameters).max(1) as f64);
    least.fold(f64::INFINITY, f64::min).clamp(1.0, 1e12)
}
