//! Effects and the updating parameters of the model fitted together, and the model linearised where they end, in turn until neither
//! moves any more.

use super::updated::REFITTED;
use crate::diagnosis::residual::data::DiagnosisError;
use crate::diagnosis::residual::prediction::FINAL;
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::selection::levenberg_marquardt::stays_above;
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::diagnosis::selection::solver_settings::{has_friction, settings_for};
use crate::math::statistics::sum_of_squares;
use crate::response::harmonic_balance::Settings;

/// Evidence that the linear fit of the updating parameters may still gain where they have converged: no decision hangs on less.
pub(super) const CONVERGED: f64 = 2.0;
/// Share of what the linear fit predicts below which a step is too slow to go on.
const SLOW: f64 = 1e-3;
/// Steps of a joint fit of effects and updating parameters.
const JOINT_STEPS: usize = 12;

impl<'a> ReferenceModel<'a> {
    /// The model moved until its updating parameters leave what their linear fit leaves, without any effect; no further where that
    /// would stay above the evidence `most`.
    pub(super) fn converged_bare(self, rounds: usize, most: f64) -> Result<ReferenceModel<'a>, DiagnosisError> {
        let mut reference = self;
        let mut here = reference.cost_at_reference(&reference.predictions);
        for _ in 0..rounds {
            let linear =
                sum_of_squares(&reference.estimator().residual(&reference.predictions)) + reference.noise.cost();
            if here - linear < CONVERGED || stays_above(here, here - linear, most) || reference.control.is_late() {
                break;
            }
            let left = most - reference.noise.cost();
            let joint = reference.joint_fit(&[], &Vec::new(), &FINAL, JOINT_STEPS, left)?;
            let there = reference.updated(&joint.updating, &[], &Vec::new())?;
            let then = there.cost_at_reference(&there.predictions);
            if then >= here {
                break;
            }
            let slow = here - then < slowest(here - linear);
            (reference, here) = (there, then);
            if slow {
                break;
            }
        }
        Ok(reference)
    }

    /// The model and the effects of `fit` moved in turn until neither moves any more: until the updating parameters at the
    /// reference leave what their linear fit leaves.
    pub(crate) fn converged(
        self,
        fit: FittedModel,
        settings: &Settings,
        rounds: usize,
    ) -> Result<(ReferenceModel<'a>, FittedModel), DiagnosisError> {
        self.converged_below(f64::INFINITY, fit, settings, rounds)
    }

    /// The same, no further where that would stay above the evidence `most`.
    pub(super) fn converged_below(
        self,
        most: f64,
        fit: FittedModel,
        settings: &Settings,
        rounds: usize,
    ) -> Result<(ReferenceModel<'a>, FittedModel), DiagnosisError> {
        let settings = settings_for(&fit, self.count(), settings);
        // What friction leaves depends on the number of harmonics.
        let fit = if has_friction(&fit.effects) { self.refitted(&fit, settings)? } else { fit };
        let (mut reference, mut fit) = (self, fit);
        let mut here = reference.cost_at_reference(&reference.predictions_with(&fit.effects, &fit.starts, settings)?);
        for _ in 0..rounds {
            let linear = fit.chi_square + reference.noise.cost();
            if here - linear < CONVERGED || stays_above(here, here - linear, most) || reference.control.is_late() {
                break;
            }
            let left = most - reference.noise.cost();
            let joint = reference.joint_fit(&fit.effects, &fit.starts, settings, JOINT_STEPS, left)?;
            let there = reference.updated_as(&joint.updating, &joint.effects, &joint.starts, settings)?;
            let again = there.estimator().fit(&joint.effects, REFITTED, settings, &joint.starts)?;
            let then = there.cost_at_reference(&there.predictions_with(&again.effects, &again.starts, settings)?);
            // Where the model was far off its own noise, the evidence at the old reference and at the new differ in kind.
            if then >= here && again.chi_square + there.noise.cost() > linear - 1.0 {
                break;
            }
            let slow = here - then < slowest(here - linear);
            (reference, fit, here) = (there, again, then);
            if slow {
                break;
            }
        }
        Ok((reference, fit))
    }
}

/// Least gain of a step towards a linear fit that predicts `more`.
fn slowest(more: f64) -> f64 {
    (SLOW * more).max(0.5 * CONVERGED)
}
