//! Is the model detuned, or does it lack an effect? What the corrections of what it states (all stiffness, all mass, the
//! sizes of known sources, within what models are usually wrong by) would do to the residual on their own.
//!
//! ```text
//! share = (chi^2 - chi^2 with corrections) / (chi^2 - N)
//! ```

use crate::control::Control;
use crate::diagnosis::residual::data::{Data, DiagnosisError, Problem};
use crate::diagnosis::residual::prediction::Predictor;
use crate::diagnosis::selection::conclusion::corrections;
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::diagnosis::selection::search_result::agrees;
use crate::diagnosis::updating::correction::Correction;
use crate::diagnosis::updating::parameters::UpdatingParameter;
use crate::math::statistics::sum_of_squares;
use crate::structure::Part;
use std::sync::Arc;

/// Share of the squared residual from which on corrections explain most of it.
const MOST: f64 = 0.9;

/// Share of the error of the response that is left by corrections which are worth telling.
const MOST_OF_ERROR: f64 = 0.9;
/// Error that is still that of noise, in noise floors: the floor is a mean, noise scatters.
const OF_NOISE: f64 = 1.1;

/// What a comparison says of the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Reading {
    /// It agrees with the data as it is.
    Agrees,
    /// Corrections of what it states bring it down to the noise.
    Detuned,
    /// They explain most, but not all.
    DetunedAndMissing,
    /// They do not explain it, or only by more than models are wrong by.
    Missing,
    /// They explain it where the search predicts, but leave as much of the error as there is without them.
    Undecided,
}

impl Reading {
    /// Word in files.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::Detuned => "detuned",
            Self::DetunedAndMissing => "detuned and missing",
            Self::Missing => "missing",
            Self::Undecided => "undecided",
        }
    }

    /// The same in a sentence.
    pub(crate) fn sentence(self) -> &'static str {
        match self {
            Self::Agrees => "the model agrees with the data to the noise",
            Self::Detuned => {
                "the model is detuned: its own numbers, corrected, bring it down to the noise; no effect is missing"
            }
            Self::DetunedAndMissing => "the model is detuned, and beyond that an effect is missing",
            Self::Missing => {
                "an effect is missing: no likely correction of the model's own numbers explains the difference"
            }
            Self::Undecided => {
                "corrections of the model's own numbers leave as much of the difference as there is: whether it is detuned or lacks \
                 an effect is not known; `dashpot diagnose` searches for both"
            }
        }
    }
}

/// What corrections alone would do.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Detuning {
    /// What that says.
    pub reading: Reading,
    /// Share of the squared residual beyond the noise that they explain, 0 to 1.
    pub share: f64,
    /// Relative error with them.
    pub error_after: f64,
    /// The corrections.
    pub corrections: Vec<Correction>,
}

impl Detuning {
    /// The reading beside the error and the noise floor of the comparison that it is shown with. Corrections are found where
    /// the search predicts, on a response that folds perhaps on another branch: those that leave as much as there is without
    /// them explain nothing.
    #[must_use]
    pub(crate) fn beside(self, error: f64, noise_floor: f64) -> Self {
        if self.reading == Reading::Agrees || self.error_after <= MOST_OF_ERROR * error {
            return self;
        }
        let reading = match self.reading {
            _ if error <= OF_NOISE * noise_floor => Reading::Agrees,
            Reading::Missing => Reading::Missing,
            _ => Reading::Undecided,
        };
        Self { reading, share: 0.0, error_after: error, corrections: Vec::new() }
    }
}

/// Tells a detuned model from one that lacks an effect; none for `points`, which state nothing to correct.
///
/// # Errors
/// What keeps the model from being compared.
pub(crate) fn detuning(problem: &Problem, control: &Control) -> Result<Option<Detuning>, DiagnosisError> {
    if problem.structure.matrices().is_none() {
        return Ok(None);
    }
    let data = Data::new(problem)?;
    let predictor = Arc::new(Predictor::new(problem.structure, problem.known(), &data)?);
    let reference = ReferenceModel::new(predictor, &data, control, &|_| {})?;
    let estimator = reference.estimator();
    let before = sum_of_squares(&estimator.residual(&reference.predictions));
    if agrees(&reference, before, 0) {
        let error_after = estimator.error(&reference.predictions, &[]);
        return Ok(Some(Detuning { reading: Reading::Agrees, share: 0.0, error_after, corrections: Vec::new() }));
    }
    let bare = reference.bare()?;
    let after = sum_of_squares(&bare.estimator().residual(&bare.predictions));
    let noise = reference.count() as f64;
    let share = ((before - after) / (before - noise).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    let reading = match (is_likely(&bare), agrees(&bare, after, 0)) {
        (true, true) => Reading::Detuned,
        (true, false) if share > MOST => Reading::DetunedAndMissing,
        _ => Reading::Missing,
    };
    let error_after = bare.estimator().error(&bare.predictions, &[]);
    Ok(Some(Detuning { reading, share, error_after, corrections: corrections(&bare) }))
}

/// Largest correction of a number of the model, as a logarithm, that is plausible without looking for an effect.
const LIKELY: f64 = 0.1;
/// The same for the size of a known source: a factor of 1.65.
pub(crate) const LIKELY_SIZE: f64 = 0.5;
/// The same for the damping of a single mode, also an octave above it: a factor of two, as measured modal damping scatters about any
/// law of the whole structure, and as lies between structural and viscous damping.
pub(crate) const LIKELY_MODE_DAMPING: f64 = 0.7;

/// The same for a support.
const LIKELY_SUPPORT: f64 = 1.5;

/// Whether no updating parameter is farther from nothing than models are wrong: else an effect may pass for a correction.
pub(crate) fn is_likely(reference: &ReferenceModel) -> bool {
    let updating = &reference.linearisation.updating;
    updating.parameters.iter().zip(&updating.values).enumerate().all(|(k, (parameter, v))| match parameter {
        UpdatingParameter::Structure(Part::Support(_)) => v.abs() < LIKELY_SUPPORT,
        UpdatingParameter::Structure(Part::ModeDamping(_) | Part::ModeDampingPerOctave(_)) => {
            v.abs() < LIKELY_MODE_DAMPING
        }
        UpdatingParameter::Known(_) => updating.factor(k).ln().abs() < LIKELY_SIZE,
        UpdatingParameter::Structure(_) => v.abs() < LIKELY,
        UpdatingParameter::Gain(_)
        | UpdatingParameter::ForceGain(_)
        | UpdatingParameter::Delay(_)
        | UpdatingParameter::Session(_) => true,
    })
}

#[cfg(test)]
mod tests {
    use super::{Detuning, Reading};

    #[test]
    fn corrections_that_leave_more_than_there_is_are_not_told() {
        let told = |reading, error_after, [error, floor]: [f64; 2]| {
            let detuning = Detuning { reading, share: 1.0, error_after, corrections: Vec::new() }.beside(error, floor);
            (detuning.reading, detuning.share)
        };
        assert_eq!(told(Reading::Detuned, 0.1055, [0.01017, 0.00956]), (Reading::Agrees, 0.0));
        assert_eq!(told(Reading::Detuned, 4.135, [0.8, 0.01]), (Reading::Undecided, 0.0));
        assert_eq!(told(Reading::Missing, 0.98, [0.9, 0.01]), (Reading::Missing, 0.0));
        assert_eq!(told(Reading::Detuned, 0.0101, [0.2, 0.01]), (Reading::Detuned, 1.0));
    }
}
