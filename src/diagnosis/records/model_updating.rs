//! Model updating on the shortest segments of the records, without further effects: the start of all fits with effects.

use super::data::RecordDiagnosisError;
use super::evidence::{AGREES, misfit};
use super::fitted::FittedRecords;
use super::regression::Regression;
use super::search::Search;

/// Rounds and steps of a fit.
const UPDATING: [usize; 2] = [3, 4];
/// Rounds in which the model is updated again, and the share of the squared residual of the one before that ends them.
const ROUNDS: usize = 4;
const ENDED: f64 = 0.8;
/// Shares of every segment that are fitted one after the other.
pub(super) const SHARES: [f64; 3] = [0.15, 0.4, 1.0];

impl Search<'_> {
    /// The fit of growing shares of every segment of a level: the highest modes of a model that is off lose the phase within a segment.
    fn fit_growing(&self, level: usize, start: &FittedRecords) -> Result<FittedRecords, RecordDiagnosisError> {
        let mut fitted = start.clone();
        for share in SHARES {
            fitted = self.fit(level, &fitted, share, UPDATING)?;
        }
        Ok(fitted)
    }

    /// The model updated on the shortest segments, where a frequency that is off does not lose the phase.
    pub(super) fn updated_model(&self, bare: &FittedRecords) -> Result<FittedRecords, RecordDiagnosisError> {
        let mut fitted = self.fit(0, bare, 1.0, UPDATING)?;
        // The motion itself may know better how far the model is off.
        if let Some(regression) = Regression::new(self.records, bare, self.control) {
            // Corrections by a measured motion are not bent to what the model leaves: priors weigh what noise demands.
            let start = FittedRecords { count: 0, ..regression.tuned(bare, None) };
            if let Ok(other) = self.fit(0, &start, 1.0, UPDATING)
                && other.chi_square < fitted.chi_square
            {
                fitted = other;
            }
        }
        if misfit(&fitted) > AGREES
            && let Ok(other) = self.fit_growing(0, bare)
            && other.chi_square < fitted.chi_square
        {
            fitted = other;
        }
        // What is left decides what priors weigh: while a round leaves much less, they are asked again.
        for _ in 0..ROUNDS {
            let next = self.fit(0, &fitted, 1.0, UPDATING)?;
            let ended = next.chi_square > ENDED * fitted.chi_square;
            fitted = next;
            if ended {
                break;
            }
        }
        Ok(fitted)
    }
}
