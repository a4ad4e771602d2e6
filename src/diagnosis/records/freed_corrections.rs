//! Fits whose corrections are freed: on the way to a fit the priors hold them by all that was left there, and what they would take away
//! stays ([`super::problem::FitProblem`]).

use super::data::RecordDiagnosisError;
use super::evidence::{AGREES, evidence, misfit, scale};
use super::fitted::FittedRecords;
use super::search::{MOST_LEFT, NOISE, Search, add_begun};

/// Rounds and steps of such a fit.
const FREEING: [usize; 2] = [2, 6];

impl Search<'_> {
    /// Fits, best first, the first of them begun once more with corrections that are free where it leaves more than noise; of a model of a
    /// single shape, or a body that floats, the special cases of its law, too.
    pub(super) fn with_best_freed(
        &self,
        level: usize,
        mut found: Vec<FittedRecords>,
    ) -> Result<Vec<FittedRecords>, RecordDiagnosisError> {
        if let Some(best) = found.first().filter(|f| misfit(f) > AGREES && !self.control.is_late())
            && let Some(freed) = self.freed(level, best)?
        {
            let unit = scale(best).min(scale(&freed));
            if evidence(&freed, unit) < evidence(best, unit) {
                found[0] = freed;
            }
        }
        if (self.records.has_one_shape() || self.records.floats()) && !self.control.is_late() {
            let starts = self.special_case_starts(level, &found);
            let fits = self.control.map(starts.len(), |k| self.freed(level, &starts[k]));
            let fits: Vec<Option<FittedRecords>> = fits.into_iter().collect::<Result<_, _>>()?;
            let least = found.first().map_or(0.0, |best| MOST_LEFT[0] * best.chi_square.max(NOISE * best.count as f64));
            add_begun(&mut found, fits.into_iter().map(|fit| fit.filter(|fit| fit.chi_square < least)).collect());
        }
        Ok(self.sorted(level, found))
    }

    /// Whether corrections are freed at every length: those of a single mode, or of a body that floats, stand for much of what a law does.
    pub(super) fn is_freed_early(&self) -> bool {
        self.records.kept == 1 || self.records.floats()
    }

    /// A fit begun at `start` with corrections that are free; `None` where it runs away.
    pub(super) fn freed(
        &self,
        level: usize,
        start: &FittedRecords,
    ) -> Result<Option<FittedRecords>, RecordDiagnosisError> {
        match self.problem(level, 1.0).freed(start, FREEING) {
            Err(RecordDiagnosisError::Singular | RecordDiagnosisError::Model { .. }) => Ok(None),
            other => other.map(Some),
        }
    }
}
