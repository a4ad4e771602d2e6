//! Long steps of the model in the course of a fit, with what they miss put right where a round of it begins (defect correction: Stetter,
//! "The defect correction principle and discretization methods", Numerische Mathematik 29, 1978).
//!
//! ```text
//! e(x) ~ e_coarse(x) + (e_fine(x_0) - e_coarse(x_0))
//! ```
//!
//! What the length of the steps does to a record hardly changes while a fit moves within a round, and is exact where it begins. Steps of
//! linear models are exact; there is nothing to put right.

use super::data::{RecordError, Steps};
use super::fitted::FittedRecords;
use super::problem::FitProblem;
use crate::response::transient::has_exact_steps;

/// What longer steps leave more than fine ones, over the noise, `[record][channel][sample]`; a record has none where both are the same.
pub(super) struct Defect(Vec<Option<Vec<Vec<f64>>>>);

impl FitProblem<'_> {
    /// That of a model.
    ///
    /// # Errors
    /// [`RecordError`]: a model that cannot be predicted.
    pub(super) fn defect(&self, at: &FittedRecords) -> Result<Defect, RecordError> {
        let exact = at.sources(self.records).iter().all(|s| has_exact_steps(s.effect));
        let of = |r: usize| -> Result<Option<Vec<Vec<f64>>>, RecordError> {
            if exact || !self.records.list[r].has_coarse_steps() {
                return Ok(None);
            }
            let [fine, mut coarse] = [Steps::Fine, Steps::Coarse].map(|steps| self.left_of(at, r, steps));
            let fine = fine?;
            if let Ok(coarse) = &mut coarse {
                for (coarse, fine) in coarse.iter_mut().zip(&fine) {
                    coarse.iter_mut().zip(fine).for_each(|(coarse, fine)| *coarse -= fine);
                }
            }
            coarse.map(Some)
        };
        let list = self.control.map(self.records.list.len(), of).into_iter().collect::<Result<_, _>>()?;
        Ok(Defect(list))
    }
}

impl Defect {
    /// Puts right what longer steps leave of record `r`.
    pub(super) fn take_from(&self, r: usize, left: &mut [Vec<f64>]) {
        let Some(defect) = &self.0[r] else { return };
        for (left, defect) in left.iter_mut().zip(defect) {
            left.iter_mut().zip(defect).for_each(|(left, defect)| *left -= defect);
        }
    }
}
