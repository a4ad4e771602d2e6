//! The response equation: `Y_h = S H (F_h + D X_h - sum_j c_j q_j,h(X))`, with `H = (K - w^2 M + D)^-1`, `D` the stand-in
//! stiffness of all sources at the present coefficients, and `q_j` the force of source `j` at unit coefficient on the
//! present motion `X`.
//!
//! It is exact in `c` at the true motion, and at the present coefficients its Jacobian is that of the response (for linear
//! laws). Rows are whitened by the covariance `sigma_Y^2 + S H sigma_F^2 H^H S^T` of sensors and force, so that least squares
//! iterated with the motion is the maximum likelihood estimate with the true force as a nuisance.

use super::{problem::Problem, solve, state::IdentificationState, system::System};
use crate::balance::action::{self, DofForce, Field};
use crate::balance::{Expanded, Measured};
use crate::effects::Source;
use crate::math::hermitian::HermitianFactor;
use crate::math::statistics::chi_square_quantile;
use faer::{Mat, c64};

/// Probability of a larger residual below which the model does not agree with the data.
const DISAGREES: f64 = 1e-6;
/// Residual per freedom that is let pass in any case: the noise is itself estimated.
const TOLERATED: f64 = 1.5;
/// Relative misfit up to which the form is used where the noise is not known.
const SMALL_MISFIT: f64 = 0.05;

/// All rows of all runs, for the columns of `set`.
pub(super) fn system(problem: &Problem<'_>, state: &IdentificationState, set: &[usize]) -> System {
    let acting = problem.acting(&state.coefficients);
    let parts = problem.control.map(state.runs.len(), |r| {
        let (measured, expanded) = &state.runs[r];
        let forces = Forces::new(problem, measured, expanded, &acting, set);
        (0..measured.harmonics()).map(|k| harmonic_rows(measured, expanded, &forces, k)).collect::<Vec<Rows>>()
    });
    let rows: usize = parts.iter().flatten().map(|part| part.b.len()).sum();
    let mut a = Mat::zeros(rows, set.len());
    let (mut b, mut run) = (Vec::with_capacity(rows), Vec::with_capacity(rows));
    for (r, part) in parts.iter().enumerate().flat_map(|(r, parts)| parts.iter().map(move |part| (r, part))) {
        a.subrows_mut(b.len(), part.b.len()).copy_from(&part.a);
        b.extend(&part.b);
        run.resize(b.len(), r);
    }
    System { a, b, run, deviation: problem.is_noisy().then(|| vec![1.0; rows]) }
}

/// Rows of one harmonic of one run: real and imaginary part of every sensor in turn.
struct Rows {
    a: Mat<f64>,
    b: Vec<f64>,
}

/// Forces at the present motion of one run.
struct Forces {
    /// Of each column at unit coefficient.
    columns: Vec<Vec<DofForce>>,
    /// `F + D X` less the known sources' forces, n x harmonics.
    driving: Vec<DofForce>,
}

impl Forces {
    fn new(problem: &Problem<'_>, measured: &Measured, expanded: &Expanded, acting: &[Source], set: &[usize]) -> Self {
        let field = expanded.field(measured);
        let force = |&j: &usize| action::force(&problem.columns[j], problem.structure, field);
        let columns = set.iter().map(force).collect();
        let mut driving: Vec<DofForce> = (0..measured.forces.len())
            .map(|j| {
                let values = (0..measured.harmonics()).map(|k| measured.forces.values[(j, k)]).collect();
                (measured.forces.dofs[j], values)
            })
            .collect();
        for source in acting {
            driving.extend(secant_force(problem, source, field));
        }
        for source in &problem.known {
            let negated = |(dof, f): DofForce| (dof, f.iter().map(|v| -v).collect());
            driving.extend(action::force(source, problem.structure, field).into_iter().map(negated));
        }
        Self { columns, driving }
    }
}

/// `D X` of one source.
fn secant_force(problem: &Problem<'_>, source: &Source, field: Field<'_>) -> Vec<DofForce> {
    if source.effect.is_linear() {
        action::force(source, problem.structure, field)
    } else {
        action::secant_force(source, field)
    }
}

/// `S H` times a force at harmonic `k`, one value a sensor.
fn at_sensors(receptance: &Mat<c64>, force: &[DofForce], k: usize) -> Vec<c64> {
    (0..receptance.ncols()).map(|s| force.iter().map(|(dof, f)| receptance[(*dof, s)] * f[k]).sum()).collect()
}

fn harmonic_rows(measured: &Measured, expanded: &Expanded, forces: &Forces, k: usize) -> Rows {
    let receptance = &expanded.receptance[k];
    let s = measured.sensors.len();
    // Positive up to rounding: the sensors' own variance is in the diagonal.
    let factor = HermitianFactor::new(&covariance(measured, receptance, k), f64::EPSILON);
    let predicted = at_sensors(receptance, &forces.driving, k);
    let mut residual: Vec<c64> = (0..s).map(|i| measured.sensors.values[(i, k)] - predicted[i]).collect();
    factor.whiten(&mut residual);
    let mut a = Mat::zeros(2 * s, forces.columns.len());
    for (j, force) in forces.columns.iter().enumerate() {
        let mut column = at_sensors(receptance, force, k);
        factor.whiten(&mut column);
        for (i, value) in column.iter().enumerate() {
            a[(2 * i, j)] = -value.re;
            a[(2 * i + 1, j)] = -value.im;
        }
    }
    Rows { a, b: residual.iter().flat_map(|v| [v.re, v.im]).collect() }
}

/// Covariance (per real part) of the sensors' residual, row by row.
fn covariance(measured: &Measured, receptance: &Mat<c64>, k: usize) -> Vec<c64> {
    let s = measured.sensors.len();
    let entry = |a: usize, b: usize| {
        let own = if a == b { measured.sensors.deviations[(a, k)].powi(2) } else { 0.0 };
        let force: c64 = (0..measured.forces.len())
            .map(|j| {
                let dof = measured.forces.dofs[j];
                receptance[(dof, a)] * receptance[(dof, b)].conj() * measured.forces.deviations[(j, k)].powi(2)
            })
            .sum();
        force + own
    };
    (0..s * s).map(|at| entry(at / s, at % s)).collect()
}

/// What all columns together leave.
pub(super) fn chi_square(problem: &Problem<'_>, system: &System, coefficients: &[f64]) -> f64 {
    let used: Vec<usize> = (0..problem.columns.len()).filter(|&j| coefficients[j] != 0.0).collect();
    system.chi_square(&used, &used.iter().map(|&j| coefficients[j]).collect::<Vec<f64>>())
}

/// Whether all columns together bring the model to the data, given what they leave.
pub(super) fn is_adequate(problem: &Problem<'_>, system: &System, coefficients: &[f64], chi_square: f64) -> bool {
    if problem.is_noisy() {
        let freedom = solve::freedom(system.rows(), coefficients.iter().filter(|c| **c > 0.0).count());
        return chi_square < (TOLERATED * freedom as f64).max(chi_square_quantile(1.0 - DISAGREES, freedom));
    }
    // Without known noise the deviations are nominal: the same part of every channel.
    let nominal = crate::balance::measured::NOMINAL;
    (chi_square / system.rows() as f64).sqrt() * nominal < SMALL_MISFIT
}
