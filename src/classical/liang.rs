//! Liang's energy balance of every DOF (3.119-3.125): what the forces on one DOF do over a period, with the elastic and
//! inertial exchange between DOFs taken from the model,
//!
//! ```text
//! sum_j c_j tau_ij = beta_i        tau_ij = work of the unit source j on DOF i
//! beta_i = work of (f_i - sum_{l != i} (k_il x_l + m_il x_l'')) at x_i'
//! ```
//!
//! rows are DOFs x periods, plain least squares. A period is that of a run, or of one line of frequency responses under a unit force.
//! **Needs** mass and stiffness and the motion of all DOFs under steady periodic forces, and a pattern of sources. (Liang asks for a diagonal mass matrix; its other entries are no obstacle and are
//! taken along.) **Limits**: energy that DOFs pass to each other is far larger than what is lost, so small errors
//! of stiffness or phase ruin single rows; only their sum over all DOFs, the energy balance of the whole, is robust.

use super::data::{Damping, LoadCase};
use super::error::ClassicalError;
use crate::balance::action::{self, Field};
use crate::balance::{Expanded, Measured};
use crate::effects::Source;
use crate::math::fill::filled_complex;
use crate::math::least_squares::LeastSquares;
use crate::structure::Structure;
use faer::{Mat, c64};

/// Part of the largest coefficient that is rounding.
const ROUNDING: f64 = 1e-9;

/// What the balance of every DOF gives.
#[derive(Debug, Clone, PartialEq)]
pub struct Balanced {
    /// Coefficient of each source, in its unit; may be negative.
    pub coefficients: Vec<f64>,
    /// The viscous ones as a matrix.
    pub damping: Damping,
}

/// One period of a steady motion of all DOFs.
#[derive(Debug, Clone, PartialEq)]
pub struct Period {
    /// Fundamental circular frequency, rad/s.
    omega: f64,
    /// Number of each harmonic.
    numbers: Vec<usize>,
    /// Displacement, n x harmonics, m.
    x: Mat<c64>,
    /// Force of the exciters, n x harmonics, N.
    force: Mat<c64>,
}

impl Period {
    /// That of a run with its motion at all DOFs.
    ///
    /// # Errors
    /// [`ClassicalError::Missing`] where the motion of a DOF is not known.
    pub fn of_run(measured: &Measured, expanded: &Expanded) -> Result<Self, ClassicalError> {
        if expanded.known.iter().any(|known| !known) {
            return Err(ClassicalError::Missing { what: "the motion of every DOF in every run".to_string() });
        }
        let mut force = Mat::zeros(expanded.x.nrows(), measured.harmonics());
        for (s, &dof) in measured.forces.dofs.iter().enumerate() {
            for k in 0..measured.harmonics() {
                force[(dof, k)] += measured.forces.values[(s, k)];
            }
        }
        Ok(Self { omega: measured.omega, numbers: measured.numbers.clone(), x: expanded.x.clone(), force })
    }

    /// That of a harmonic load.
    pub fn of_load(load: &LoadCase) -> Self {
        let column = |values: &[c64]| filled_complex(values.len(), 1, |i, _| values[i]);
        Self { omega: load.omega, numbers: vec![1], x: column(&load.displacement), force: column(&load.force) }
    }

    fn field(&self) -> Field<'_> {
        Field { omega: self.omega, numbers: &self.numbers, x: &self.x }
    }
}

/// Coefficients of `columns` (taken at unit coefficient) from the work at every DOF, less that of the `known` sources at
/// their values; these are in the matrix too.
///
/// # Errors
/// [`ClassicalError::Missing`] without matrices, columns or periods; those of the linear algebra.
pub fn liang(
    structure: &Structure,
    periods: &[Period],
    columns: &[Source],
    known: &[Source],
) -> Result<Balanced, ClassicalError> {
    let missing = |what: &str| Err(ClassicalError::Missing { what: what.to_string() });
    if structure.matrices().is_none() {
        return missing("mass and stiffness matrices");
    }
    if columns.is_empty() {
        return missing("candidate sources: the pattern whose coefficients are sought");
    }
    if periods.is_empty() {
        return missing("steady motion of every DOF");
    }
    let n = structure.len();
    let units: Vec<Source> = columns.iter().map(|source| source.with_coefficient(1.0)).collect();
    let mut rows = Mat::zeros(n * periods.len(), columns.len());
    let mut right: Vec<f64> = Vec::with_capacity(n * periods.len());
    for (r, period) in periods.iter().enumerate() {
        let field = period.field();
        for (j, source) in units.iter().enumerate() {
            for (dof, force) in action::force(source, structure, field) {
                rows[(n * r + dof, j)] += field.work(dof, &force);
            }
        }
        let first = right.len();
        right.extend(remaining(structure, period));
        for source in known {
            for (dof, force) in action::force(source, structure, field) {
                right[first + dof] -= field.work(dof, &force);
            }
        }
    }
    let problem = LeastSquares::new(rows.as_ref())?;
    let coefficients = problem.solve(&right)?.x;
    let values: Vec<f64> = known.iter().map(Source::coefficient).collect();
    let mut damping = Damping::viscous(matrix(&units, &coefficients, n) + matrix(known, &values, n));
    if problem.rank() < columns.len() {
        let note = format!("{} of {} coefficients are fixed by the data", problem.rank(), columns.len());
        damping.notes.push(note);
    }
    let largest = coefficients.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
    if coefficients.iter().any(|&c| c < -ROUNDING * largest) {
        damping.notes.push("some coefficients are negative, which no damper is".to_string());
    }
    Ok(Balanced { coefficients, damping })
}

/// `beta_i` of one period.
fn remaining(structure: &Structure, period: &Period) -> Vec<f64> {
    let Some(matrices) = structure.matrices() else { return Vec::new() };
    let (n, field) = (structure.len(), period.field());
    let force = |i: usize, k: usize| {
        let square = (period.numbers[k] as f64 * period.omega).powi(2);
        let exchanged = (0..n)
            .filter(|&l| l != i)
            .map(|l| field.x[(l, k)] * (matrices.stiffness[(i, l)] - square * matrices.mass[(i, l)]))
            .sum::<c64>();
        period.force[(i, k)] - exchanged
    };
    let harmonics = 0..period.numbers.len();
    (0..n).map(|i| field.work(i, &harmonics.clone().map(|k| force(i, k)).collect::<Vec<c64>>())).collect()
}

/// `sum c_j L_j L_j^T` of the viscous sources.
fn matrix(units: &[Source], coefficients: &[f64], n: usize) -> Mat<f64> {
    let mut c = Mat::zeros(n, n);
    for (source, &value) in units.iter().zip(coefficients).filter(|(source, _)| source.effect.is_dashpot()) {
        for leg in source.place.legs() {
            c[(leg.first, leg.first)] += value;
            if let Some(second) = leg.second {
                c[(second, second)] += value;
                c[(leg.first, second)] -= value;
                c[(second, leg.first)] -= value;
            }
        }
    }
    c
}
