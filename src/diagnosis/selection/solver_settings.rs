//! How exactly responses are computed while effects and model are fitted.

use crate::diagnosis::candidates::friction::friction;
use crate::diagnosis::residual::prediction::{FINAL, RUBBING};
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::effects::Source;
use crate::response::harmonic_balance::Settings;

/// Squared residual per datum from which on it is not the truncation of [`RUBBING`] that a fit leaves.
const COARSE: f64 = 10.0;

/// How exactly responses with the effects of `fit`, to so many data, are computed: friction that sticks in a part of the cycle
/// takes many harmonics, and even more where it leaves so little that their truncation would show.
pub(super) fn settings_for<'s>(fit: &FittedModel, count: usize, settings: &'s Settings) -> &'s Settings {
    match has_friction(&fit.effects) {
        true if fit.chi_square < COARSE * count as f64 => &FINAL,
        true => &RUBBING,
        false => settings,
    }
}

/// Whether there is friction among `effects`.
pub(super) fn has_friction(effects: &[Source]) -> bool {
    effects.iter().any(|e| friction(e.effect).is_some())
}
