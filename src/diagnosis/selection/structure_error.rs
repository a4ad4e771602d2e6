//! What the updated model leaves of the response with all runs alike, as `compare` tells it of a project in which it is taken over.

use crate::diagnosis::residual::branch::{distance, nearest};
use crate::diagnosis::residual::data::DiagnosisError;
use crate::diagnosis::residual::prediction::{FINAL, Predictor, RunPrediction};
use crate::diagnosis::selection::estimator::{Estimator, Starts};
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::effects::Source;
use crate::math::statistics::root_mean_square;
use crate::response::harmonic_balance::ResponseError;

/// Relative error of a run from which on it may be on another branch than the measured one.
const FAR: f64 = 0.1;
/// Share of the runs that may lie beyond a jump: near a fold a frequency that moves by less than tests repeat takes a run to another
/// branch, which is no error of what is told.
const JUMPED: f64 = 0.125;

impl ReferenceModel<'_> {
    /// Relative error of this model with `effects`, all runs alike.
    pub(crate) fn error_of_structure(&self, effects: &[Source], starts: &Starts) -> Result<f64, DiagnosisError> {
        let predictor = self.of_structure()?;
        let estimator = Estimator { predictor: &predictor, ..self.estimator() };
        Ok(estimator.error(&self.predictions_of_structure(&predictor, effects, starts)?, effects))
    }

    /// The same of `effects` that jump, beside the few runs of which it leaves most; of a linear model all runs count.
    pub(super) fn error_beside_jumps(&self, effects: &[Source], starts: &Starts) -> Result<f64, DiagnosisError> {
        let predictor = self.of_structure()?;
        let estimator = Estimator { predictor: &predictor, ..self.estimator() };
        let predictions = self.predictions_of_structure(&predictor, effects, starts)?;
        let mut errors: Vec<f64> =
            estimator.errors(&predictions, effects).iter().map(|run| root_mean_square(run)).collect();
        errors.sort_by(f64::total_cmp);
        let linear = effects.iter().chain(predictor.known()).all(|source| source.effect.is_linear());
        let jumped = if linear { 0 } else { (JUMPED * errors.len() as f64) as usize };
        Ok(root_mean_square(&errors[..errors.len() - jumped]))
    }

    /// Whether `effects` with the relative `error`, all runs alike, leave what `judged` finds too much beside the noise floor, and more
    /// than a few runs beyond a jump do.
    pub(super) fn leaves(
        &self,
        judged: impl Fn(f64, f64) -> bool,
        [error, floor]: [f64; 2],
        effects: &[Source],
        starts: &Starts,
    ) -> Result<bool, DiagnosisError> {
        Ok(judged(error, floor) && judged(self.error_beside_jumps(effects, starts)?, floor))
    }

    /// Predictions of `predictor`, the model with all runs alike, on the branches that `compare` looks for.
    fn predictions_of_structure(
        &self,
        predictor: &Predictor,
        effects: &[Source],
        starts: &Starts,
    ) -> Result<Vec<RunPrediction>, DiagnosisError> {
        let mut predictions = Estimator { predictor, ..self.estimator() }.predict(effects, &FINAL, starts)?;
        // A run whose motion is not that of its start any more may have ended on another branch.
        let far: Vec<usize> = (0..predictions.len())
            .filter(|&r| distance(&self.data.runs[r], &predictions[r]) > FAR * FAR)
            .filter(|_| effects.iter().chain(predictor.known()).any(|source| !source.effect.is_linear()))
            .collect();
        let near = |k: usize| nearest(predictor, far[k], &self.data.runs[far[k]], effects, self.control);
        for (near, &r) in self.control.map(far.len(), near).into_iter().zip(&far) {
            match near {
                Ok((prediction, _)) => predictions[r] = prediction,
                Err(ResponseError::Cancelled(cancelled)) => return Err(cancelled.into()),
                Err(_) => {}
            }
        }
        Ok(predictions)
    }

    /// The error with all runs alike where the responses are those that follow from `starts`.
    pub(super) fn error_of_followed(&self, effects: &[Source], starts: &Starts) -> Result<f64, DiagnosisError> {
        let predictor = self.of_structure()?;
        let estimator = Estimator { predictor: &predictor, ..self.estimator() };
        Ok(estimator.error(&estimator.predict(effects, &FINAL, starts)?, effects))
    }

    /// The updated model with all runs alike.
    pub(crate) fn of_structure(&self) -> Result<Predictor, DiagnosisError> {
        self.predictor.updated(&self.linearisation.updating.of_structure())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::diagnosis::selection::stated_chain::{hidden, with_stated};

    /// Eight runs, of which one may lie beyond a jump where there is something that jumps.
    #[test]
    fn a_run_beyond_a_jump_counts_for_a_linear_model_alone() {
        let errors = |effects: &[Source]| {
            let both = |reference: ReferenceModel| {
                let starts = Vec::new();
                let all = reference.error_of_structure(effects, &starts).unwrap();
                let beyond = |most: f64| {
                    let judged = |error: f64, _: f64| error > most;
                    reference.leaves(judged, [all, 0.0], effects, &starts).unwrap()
                };
                (beyond(0.999 * all), all)
            };
            with_stated(effects, both)
        };
        let ((linear, without), (jumps, with)) = (errors(&[]), errors(&[hidden()]));
        assert!(linear && !jumps && with < without, "{with} {without}");
    }
}
