//! The motion of all runs at given coefficients, and the energy equation there.

use super::error::IdentifyError;
use super::problem::Problem;
use crate::balance::expansion::Acting;
use crate::balance::{EnergyEquation, Expanded, Measured};

/// Misfit at the sensors, in deviations, that a sensible model error leaves.
const FITTED: f64 = 1.2;

/// Where the iteration stands.
#[derive(Debug, Clone)]
pub(crate) struct IdentificationState {
    pub runs: Vec<(Measured, Expanded)>,
    pub equation: EnergyEquation,
    /// Of all columns.
    pub coefficients: Vec<f64>,
    /// Relative error of the model in `dynamic` expansion.
    pub model_error: f64,
}

impl IdentificationState {
    /// The motion when nothing is known of the sources but those given.
    pub(super) fn start(problem: &Problem<'_>) -> Result<Self, IdentifyError> {
        let runs = problem.control.map(problem.measured.len(), |r| {
            let acting = Acting { sources: &problem.known, motion: None, model_error: 1.0 };
            let measured = &problem.measured[r];
            Ok((measured.clone(), problem.expander.expand(measured, acting)?))
        });
        let runs = runs.into_iter().collect::<Result<_, IdentifyError>>()?;
        Self::with(problem, runs, vec![0.0; problem.columns.len()], 1.0)
    }

    fn with(
        problem: &Problem<'_>,
        runs: Vec<(Measured, Expanded)>,
        coefficients: Vec<f64>,
        model_error: f64,
    ) -> Result<Self, IdentifyError> {
        let equation =
            EnergyEquation::new(problem.structure, &runs, &problem.columns, &problem.known, &problem.control)?;
        let equation = problem.windows.behind(equation);
        Ok(Self { runs, equation, coefficients, model_error })
    }

    /// The motion at other coefficients. Expansions that do not look at them are kept.
    pub(super) fn moved_to(
        &self,
        problem: &Problem<'_>,
        coefficients: Vec<f64>,
        model_error: f64,
    ) -> Result<Self, IdentifyError> {
        let moved = self.in_motion(problem, coefficients, model_error)?;
        if moved.is_fixed() { Ok(moved) } else { moved.balanced(problem) }
    }

    /// The same with the energy equation of before, where only the response is asked: with thousands of columns the energies
    /// cost more than the motion. [`Self::balanced`] makes it good.
    pub(super) fn in_motion(
        &self,
        problem: &Problem<'_>,
        coefficients: Vec<f64>,
        model_error: f64,
    ) -> Result<Self, IdentifyError> {
        if self.is_fixed() {
            return Ok(Self { coefficients, model_error, ..self.clone() });
        }
        let sources = problem.acting(&coefficients);
        let runs = problem.control.map(self.runs.len(), |r| {
            let (measured, before) = &self.runs[r];
            let acting = Acting { sources: &sources, motion: Some(&before.x), model_error };
            Ok((measured.clone(), problem.expander.expand(measured, acting)?))
        });
        let runs = runs.into_iter().collect::<Result<_, IdentifyError>>()?;
        Ok(Self { runs, equation: self.equation.clone(), coefficients, model_error })
    }

    /// The energy equation at the present motion.
    pub(super) fn balanced(self, problem: &Problem<'_>) -> Result<Self, IdentifyError> {
        Self::with(problem, self.runs, self.coefficients, self.model_error)
    }

    /// Whether the motion does not depend on the coefficients.
    fn is_fixed(&self) -> bool {
        self.runs.iter().all(|(_, expanded)| expanded.receptance.is_empty())
    }

    /// The least model error with which the expansion follows the sensors to their noise.
    pub(super) fn adequate_model_error(&self, problem: &Problem<'_>) -> Result<f64, IdentifyError> {
        let mut model_error = 1e-6;
        while problem.is_noisy() && model_error < 1.0 {
            problem.control.check()?;
            let moved = self.in_motion(problem, self.coefficients.clone(), model_error)?;
            let squares: f64 = moved.runs.iter().map(|(_, e)| e.misfit.powi(2)).sum();
            if (squares / moved.runs.len() as f64).sqrt() < FITTED {
                return Ok(model_error);
            }
            model_error *= 3.0;
        }
        Ok(if problem.is_noisy() { 1.0 } else { 1e-2 })
    }
}
