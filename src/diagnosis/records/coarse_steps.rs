//! Long steps of the model in the course of a fit, with what they miss put right where a round of it begins (defect correction: Stetter,
//! "The defect correction principle and discretization methods", Numerische Mathematik 29, 1978).
//!
//! ```text
//! e(x) ~ e_coarse(x) + (e_fine(x_0) - e_coarse(x_0))
//! ```
//!
//! What the length of the steps does to a record hardly changes while a fit moves within a round, and is exact where it begins. Steps of
//! linear models are exact; there is nothing to put right.

use super::data::RecordDiagnosisError;
use super::fitted::FittedRecords;
use super::problem::FitProblem;
use super::steps::Steps;
use crate::response::transient::has_exact_steps;

/// What longer steps leave more than fine ones, over the noise, `[record][channel][sample]`; a record has none where both are the same.
pub(super) struct Defect(Vec<Option<Vec<Vec<f64>>>>);

impl FitProblem<'_> {
    /// That of a model.
    ///
    /// # Errors
    /// [`RecordDiagnosisError`]: a model that cannot be predicted.
    pub(super) fn defect(&self, at: &FittedRecords) -> Result<Defect, RecordDiagnosisError> {
        let exact = at.sources(self.records).iter().all(|s| has_exact_steps(s.effect));
        let defect_of_record = |r: usize| -> Result<Option<Vec<Vec<f64>>>, RecordDiagnosisError> {
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
        let list = self.control.map(self.records.list.len(), defect_of_record).into_iter().collect::<Result<_, _>>()?;
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::chain;
    use crate::common::runs::decay;
    use crate::control::Control;
    use crate::diagnosis::records::data::Records;
    use crate::diagnosis::records::problem::Free;
    use crate::effects::{Effect, Place, Source};

    /// Root mean square of the difference of what two predictions leave.
    fn apart(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
        let squares = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).powi(2));
        squares.sum::<f64>().sqrt()
    }

    /// Long steps leave what fine ones do where the defect was taken, and nearly so where the law and the start are half a per cent others;
    /// a linear model has no defect.
    #[test]
    fn long_steps_are_put_right_around_where_the_defect_was_taken() {
        let structure = chain(&[2.0, 1.0], &[800.0, 0.0], &[1500.0]);
        let wave = |dof: usize| (0..400).map(|n| 1e-2 * (0.5 * f64::from(n) + dof as f64).sin()).collect();
        let run = decay(1e-2, vec![wave(0), wave(1)]);
        let records = Records::new(&structure, &[], std::slice::from_ref(&run)).unwrap();
        let control = Control::unattended();
        let problem = FitProblem { records: &records, free: Free::all(&records), share: 1.0, control: &control };
        let fit = |effect: Effect, factor: f64, parameter: f64| {
            let mut fit = FittedRecords::start(&records, &[]);
            fit.initial[0][0] = 1e-2 * factor;
            fit.effects = vec![Source::known(effect, Place::Dofs(vec![1]), &[factor * parameter])];
            fit
        };
        let cubic = |factor: f64| fit(Effect::CubicStiffness, factor, 5e6);
        let left = |at: &FittedRecords, steps| problem.left_of(at, 0, steps).unwrap();
        let defect = problem.defect(&cubic(1.0)).unwrap();
        let error = |at: &FittedRecords| {
            let fine = left(at, Steps::Fine);
            let beside = problem.left_beside(at, &defect).unwrap().residual;
            (apart(&beside[0], &fine), apart(&left(at, Steps::Coarse), &fine))
        };
        let (there, coarse) = error(&cubic(1.0));
        assert!(coarse > 1.0 && there < 1e-9 * coarse, "{there:.1e} {coarse:.1e}");
        let (near, coarse) = error(&cubic(1.005));
        assert!(near < 0.3 * coarse, "{near:.1e} {coarse:.1e}");
        let exact = problem.defect(&fit(Effect::Viscous, 1.0, 0.5)).unwrap();
        assert!(exact.0.iter().all(Option::is_none));
    }
}
