//! The equations of a form at a state: energies or responses, windows of records, damping ratios.

use super::outcome::Form;
use super::{problem::Problem, response_form, state::IdentificationState, system::System};
use crate::balance::{Weights, weights};
use crate::math::fill::filled;
use faer::Mat;

impl System {
    /// The equation of a form at a state, with the damping ratios that stand beside it.
    pub(super) fn of(form: Form, problem: &Problem<'_>, state: &IdentificationState) -> Self {
        let all: Vec<usize> = (0..problem.columns.len()).collect();
        Self::of_set(form, problem, state, &all)
    }

    /// The same for the columns of a set alone, in its order; all others must have a coefficient of zero.
    pub(super) fn of_set(form: Form, problem: &Problem<'_>, state: &IdentificationState, set: &[usize]) -> Self {
        let system = match form {
            Form::Energy => {
                let whole = Self::energy(problem, state, problem.settings.weights);
                let a = filled(whole.rows(), set.len(), |i, j| whole.a[(i, set[j])]);
                Self { a, ..whole }
            }
            Form::Response => response_form::system(problem, state, set),
        };
        // Without steady runs the windows are the energy equation.
        let system = if form == Form::Energy && problem.measured.is_empty() {
            system
        } else {
            problem.windows.append(system, set)
        };
        match &problem.ratios {
            Some(ratios) => ratios.append(problem, state, form, system, set),
            None => system,
        }
    }

    /// The energy equation, each row weighted.
    pub(super) fn energy(problem: &Problem<'_>, state: &IdentificationState, choice: Weights) -> Self {
        let (structure, equation) = (problem.structure, &state.equation);
        let acting = problem.acting(&state.coefficients);
        let choice = weights::resolve(choice, &state.runs);
        // Without any coefficient yet the noise of G is unknown; the energy then is the better guide.
        let unknown = state.coefficients.iter().all(|c| *c == 0.0) && problem.known.is_empty();
        let used = if choice == Weights::Noise && unknown { Weights::Energy } else { choice };
        let factors = weights::factors(used, structure, &state.runs, &equation.input[..state.runs.len()], &acting);
        let rows = factors.len();
        let deviation = problem.is_noisy().then(|| {
            let row = |r: usize| weights::residual_deviation(structure, &state.runs[r].0, &state.runs[r].1, &acting);
            (0..rows).map(|r| row(r) * factors[r]).collect()
        });
        let system = Self {
            a: Mat::from_fn(rows, equation.g.ncols(), |r, j| equation.g[(r, j)] * factors[r]),
            b: equation.e.iter().zip(&factors).map(|(e, w)| e * w).collect(),
            run: (0..rows).collect(),
            deviation,
        };
        if rows > 0 {
            return system;
        }
        problem.windows.append(system, &(0..equation.g.ncols()).collect::<Vec<usize>>())
    }
}
