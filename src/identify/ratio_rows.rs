//! Damping ratios as rows beside the energies (proposed as future work in chapter 7 of the source).
//!
//! ```text
//! sum_j (d zeta_r / d c_j) c_j = zeta_measured - zeta_r(c0) + sum_j (d zeta_r / d c_j) c0_j
//! ```
//!
//! the ratio of a damped mode of the model, linearised at the present coefficients; iterated with them it is exact. Each row is
//! weighted by the ratio's standard deviation. A ratio says nothing of laws whose damping depends on the amplitude (friction), so
//! it cannot join where such a law is known or a candidate.

use super::outcome::Form;
use super::ratios::{Ratios, is_hysteretic};
use super::{problem::Problem, state::IdentificationState, system::System};
use crate::effects::Source;
use crate::math::fill::filled;
use crate::math::statistics::root_mean_square;
use crate::measurement::MeasuredRatio;
use crate::response::linear_matrices::unit_matrix;
use crate::structure::Structure;
use crate::structure::damped_modes::DampedMode;

/// Least deviation of a ratio, relative to it: rounding.
const LEAST: f64 = 1e-9;
/// Relative error that the energies are taken to have where their noise is not known.
const UNKNOWN: f64 = 0.01;

impl Ratios {
    /// Adds the rows to the system of a form at a state, whose columns are those of `set`.
    pub(super) fn append(
        &self,
        problem: &Problem<'_>,
        state: &IdentificationState,
        form: Form,
        system: System,
        set: &[usize],
    ) -> System {
        let acting = problem.acting(&state.coefficients);
        let Some(damped) = self.damped(problem.structure, &acting) else { return system };
        let weigh = Weigh::new(&system, form);
        let row = |(ratio, mode): (&MeasuredRatio, &DampedMode)| {
            let by = |s: &Source| slope(problem.structure, mode, s);
            let slopes: Vec<f64> = set.iter().map(|&j| by(&problem.columns[j])).collect();
            let hysteretic = acting.iter().filter(|s| is_hysteretic(s.effect));
            let present = mode.damping_ratio + hysteretic.map(|s| by(s) * s.coefficient()).sum::<f64>();
            let linear: f64 = slopes.iter().zip(set).map(|(a, &j)| a * state.coefficients[j]).sum();
            let deviation = ratio.deviation.max(LEAST * ratio.ratio);
            Row {
                slopes,
                right: ratio.ratio - present + linear,
                factor: weigh.factor(ratio.ratio, deviation),
                deviation,
            }
        };
        let rows: Vec<Row> = self.list.iter().zip(&damped).map(row).collect();
        extended(system, &rows)
    }
}

/// `d zeta / d coefficient` of a source at a damped mode.
fn slope(structure: &Structure, mode: &DampedMode, source: &Source) -> f64 {
    let form = if source.place.legs().is_empty() {
        unit_matrix(structure, source).map_or(faer::c64::new(0.0, 0.0), |b| mode.quadratic_form(b.as_ref()))
    } else {
        source.place.legs().iter().map(|leg| leg.relative(|dof| mode.shape[dof])).map(|d| d * d).sum()
    };
    let equivalent = if is_hysteretic(source.effect) { 1.0 / mode.lambda.norm() } else { 1.0 };
    mode.sensitivity(form).damping_ratio * equivalent
}

/// How the rows of a system are weighted.
struct Weigh {
    form: Form,
    /// Root mean square of the deviations of its rows, where they are known.
    deviation: Option<f64>,
    /// The same of its right side.
    size: f64,
}

impl Weigh {
    fn new(system: &System, form: Form) -> Self {
        let deviation = system.deviation.as_deref().map(root_mean_square);
        Self { form, deviation, size: root_mean_square(&system.b) }
    }

    /// A row of deviation `deviation` counts as one of the energies' or the response's of as many times its own.
    fn factor(&self, ratio: f64, deviation: f64) -> f64 {
        match (self.deviation, self.form) {
            (Some(typical), _) => typical / deviation,
            (None, Form::Response) => 1.0 / deviation,
            (None, Form::Energy) => self.size / ratio * (UNKNOWN * ratio / deviation).min(1.0),
        }
    }
}

/// One ratio as a row.
struct Row {
    slopes: Vec<f64>,
    right: f64,
    factor: f64,
    deviation: f64,
}

/// The system with more rows, each as if of a run of its own.
fn extended(system: System, rows: &[Row]) -> System {
    let (first, next) = (system.rows(), system.run.last().map_or(0, |r| r + 1));
    let a = filled(first + rows.len(), system.a.ncols(), |i, j| match i.checked_sub(first) {
        None => system.a[(i, j)],
        Some(k) => rows[k].slopes[j] * rows[k].factor,
    });
    let mut extended = System { a, ..system };
    for (k, row) in rows.iter().enumerate() {
        extended.b.push(row.right * row.factor);
        extended.run.push(next + k);
        if let Some(deviations) = &mut extended.deviation {
            deviations.push(row.deviation * row.factor);
        }
    }
    extended
}
