//! Matrices of the identified sources: `C = sum c_j L_j L_j^T` (4.17), and the viscous one that takes out as much energy.
//!
//! The energy-equivalent coefficient of source `j` in run `r` is `E_rj / sum_legs (T/2) sum_h |h w D_h|^2`; over all runs
//! both sums run over the runs too.

use crate::balance::{Expanded, Measured, action};
use crate::effects::{Constant, Effect, Source};
use crate::response::linear_matrices::unit_matrix;
use crate::structure::Structure;
use faer::Mat;

/// The matrix of one law.
#[derive(Debug, Clone, PartialEq)]
pub struct LawMatrix {
    /// The law.
    pub effect: Effect,
    /// `sum coefficient L L^T`, n x n, in the unit of the law's coefficient.
    pub matrix: Mat<f64>,
}

/// Viscous coefficients of equal energy.
#[derive(Debug, Clone, PartialEq)]
pub struct EquivalentViscous {
    /// One row a run, one value an acting source, N s/m (s for laws in proportion to stiffness, 1/s to mass).
    pub by_run: Vec<Vec<f64>>,
    /// Over all runs, one value an acting source.
    pub overall: Vec<f64>,
}

/// Whether the source is a constant damping matrix already.
fn is_viscous(effect: Effect) -> bool {
    effect.adds_to(Constant::Viscous)
}

/// Energy-equivalent viscous coefficients of all acting sources.
pub(crate) fn equivalent(structure: &Structure, runs: &[(Measured, Expanded)], acting: &[Source]) -> EquivalentViscous {
    let of_run = |(measured, expanded): &(Measured, Expanded)| -> Vec<(f64, f64)> {
        let energy = |source: &Source| action::energy(source, structure, expanded.field(measured));
        acting.iter().map(|source| (energy(source), energy(&source.unit_dashpot()))).collect()
    };
    let energies: Vec<Vec<(f64, f64)>> = runs.iter().map(of_run).collect();
    let ratio = |(energy, unit): (f64, f64)| if unit > 0.0 { energy / unit } else { 0.0 };
    let total = |j: usize| energies.iter().fold((0.0, 0.0), |sum, row| (sum.0 + row[j].0, sum.1 + row[j].1));
    EquivalentViscous {
        by_run: energies.iter().map(|row| row.iter().map(|&pair| ratio(pair)).collect()).collect(),
        // Without steady runs a dashpot is still one.
        overall: acting
            .iter()
            .enumerate()
            .map(|(j, source)| match total(j) {
                (_, unit) if unit == 0.0 && is_viscous(source.effect) => source.coefficient(),
                pair => ratio(pair),
            })
            .collect(),
    }
}

/// `sum weight_j B_j` with the place matrix `B_j` of each source; n x n. Sources without one (channels, whole-structure laws
/// without matrices) add nothing.
pub(crate) fn weighted_sum(structure: &Structure, sources: &[Source], weights: &[f64]) -> Mat<f64> {
    let n = structure.len();
    let mut sum = Mat::zeros(n, n);
    for (source, weight) in sources.iter().zip(weights) {
        if let Ok(matrix) = unit_matrix(structure, source)
            && *weight != 0.0
        {
            sum += matrix * faer::Scale(*weight);
        }
    }
    sum
}

/// The viscous damping matrix.
pub(crate) fn viscous(structure: &Structure, acting: &[Source]) -> Mat<f64> {
    let weights: Vec<f64> = acting.iter().map(|s| if is_viscous(s.effect) { s.coefficient() } else { 0.0 }).collect();
    weighted_sum(structure, acting, &weights)
}

/// One matrix for each dissipative law that is not viscous.
pub(crate) fn others(structure: &Structure, acting: &[Source]) -> Vec<LawMatrix> {
    let wanted =
        |effect: Effect| effect.dissipates() && !is_viscous(effect) && acting.iter().any(|s| s.effect == effect);
    Effect::ALL
        .into_iter()
        .filter(|&effect| wanted(effect))
        .map(|effect| {
            let weight = |s: &Source| if s.effect == effect { s.coefficient() } else { 0.0 };
            let weights: Vec<f64> = acting.iter().map(weight).collect();
            LawMatrix { effect, matrix: weighted_sum(structure, acting, &weights) }
        })
        .collect()
}
