//! Weighted linear equations `A c = b` for the coefficients of all columns, in either form.

use super::outcome::Form;
use super::{problem::Problem, response_form, state::State};
use crate::balance::{Weights, weights};
use crate::math::fill::filled;
use faer::Mat;

/// Rows of unit variance where the noise is known.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct System {
    /// Rows x columns.
    pub a: Mat<f64>,
    pub b: Vec<f64>,
    /// Run (among those in use) of each row.
    pub run: Vec<usize>,
    /// Standard deviation of each row: 1 where weighted by it, unknown (`None`) where noise is not known.
    pub deviation: Option<Vec<f64>>,
}

impl System {
    /// The equation of a form at a state, with the damping ratios that stand beside it.
    pub fn of(form: Form, problem: &Problem<'_>, state: &State) -> Self {
        let all: Vec<usize> = (0..problem.columns.len()).collect();
        Self::of_set(form, problem, state, &all)
    }

    /// The same for the columns of a set alone, in its order; all others must have a coefficient of zero.
    pub fn of_set(form: Form, problem: &Problem<'_>, state: &State, set: &[usize]) -> Self {
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
    pub fn energy(problem: &Problem<'_>, state: &State, choice: Weights) -> Self {
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

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.b.len()
    }

    /// Some of the columns, of all rows but those of one run.
    pub fn part(&self, columns: &[usize], without: Option<usize>) -> (Mat<f64>, Vec<f64>) {
        let rows: Vec<usize> = (0..self.rows()).filter(|&i| Some(self.run[i]) != without).collect();
        let a = Mat::from_fn(rows.len(), columns.len(), |i, j| self.a[(rows[i], columns[j])]);
        (a, rows.iter().map(|&i| self.b[i]).collect())
    }

    /// `|A_S c - b|^2`, each row over its deviation where that is known.
    pub fn chi_square(&self, columns: &[usize], coefficients: &[f64]) -> f64 {
        (0..self.rows())
            .map(|i| {
                let model: f64 = columns.iter().zip(coefficients).map(|(&j, c)| self.a[(i, j)] * c).sum();
                let deviation = self.deviation.as_ref().map_or(1.0, |d| d[i]);
                ((model - self.b[i]) / deviation).powi(2)
            })
            .sum()
    }

    /// The least squares problem of some columns in no more rows than they are, plus one, by QR.
    pub fn compressed(&self, columns: &[usize]) -> (Mat<f64>, Vec<f64>) {
        let n = columns.len();
        if self.rows() <= n + 1 {
            return self.part(columns, None);
        }
        let entry = |i: usize, j: usize| columns.get(j).map_or(self.b[i], |&column| self.a[(i, column)]);
        let r = dashpot_numerics::triangle(filled(self.rows(), n + 1, entry).as_ref());
        (filled(n + 1, n, |i, j| r[(i, j)]), (0..=n).map(|i| r[(i, n)]).collect())
    }
}
