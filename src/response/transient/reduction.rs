//! Modes in the band and residual flexibility: a basis of few coordinates in which forces at chosen places are followed.
//!
//! ```text
//! x = sum_r phi_r p_r + sum_s psi_s p_s,     psi = (K + sigma M)^-1 b - sum_r phi_r (phi_r^T b) / (omega_r^2 + sigma)
//! ```
//!
//! The residual attachment modes `psi` carry what the modes above the band do at the place of a force (MacNeal 1971, Rubin
//! 1975); they are orthogonal to the kept modes and are made so among themselves, so that mass is the identity and
//! stiffness diagonal. Their own motion lies above the band and is given a little damping, so that it does not ring on.

use super::error::TransientError;
use crate::math::eigen::generalised_symmetric;
use crate::structure::SystemMatrices;
use crate::structure::modes::Modes;
use dashpot_numerics::{Cholesky, product, transposed_product};
use faer::Mat;

/// Damping ratio of residual coordinates.
pub(super) const RESIDUAL_DAMPING: f64 = 0.02;
/// Share of the flexibility at a place below which nothing is left beyond the kept modes.
const NEGLIGIBLE: f64 = 1e-7;

/// Basis and natural frequencies.
#[derive(Debug, Clone)]
pub(super) struct Reduction {
    /// Mass-normalised shapes, n x coordinates: kept modes, then residual ones.
    pub basis: Mat<f64>,
    /// Natural circular frequency of each coordinate, rad/s.
    pub omega: Vec<f64>,
    /// Number of kept modes.
    pub kept: usize,
}

impl Reduction {
    /// Keeps the lowest `kept` of `modes` and the residual flexibility under `patterns` (n x count).
    pub(super) fn new(
        matrices: &SystemMatrices,
        modes: &Modes,
        kept: usize,
        patterns: &Mat<f64>,
    ) -> Result<Self, TransientError> {
        let kept = kept.min(modes.len());
        if patterns.ncols() == 0 {
            let basis = modes.shapes.subcols(0, kept).to_owned();
            return Ok(Self { basis, omega: modes.omega[..kept].to_vec(), kept });
        }
        let mut omega = modes.omega[..kept].to_vec();
        let phi = modes.shapes.subcols(0, kept);
        let lowest = omega.iter().copied().find(|w| *w > 0.0).unwrap_or(1.0);
        let sigma = f64::powi(0.1 * lowest, 2);
        let n = matrices.mass.nrows();
        let shifted = Mat::from_fn(n, n, |i, j| matrices.stiffness[(i, j)] + sigma * matrices.mass[(i, j)]);
        let factor = Cholesky::new(shifted.as_ref()).ok_or(TransientError::NotPositive)?;
        let flexible = factor.solve(patterns.as_ref());
        let shares = transposed_product(phi, patterns.as_ref());
        let scaled = Mat::from_fn(kept, patterns.ncols(), |r, k| shares[(r, k)] / (omega[r].powi(2) + sigma));
        let residual = &flexible - product(phi, scaled.as_ref());
        let along = |a: &Mat<f64>, k: usize| (0..n).map(|i| patterns[(i, k)] * a[(i, k)]).sum::<f64>();
        let worth: Vec<usize> =
            (0..patterns.ncols()).filter(|&k| along(&residual, k) > NEGLIGIBLE * along(&flexible, k)).collect();
        let residual = Mat::from_fn(n, worth.len(), |i, k| residual[(i, worth[k])]);
        let (shapes, own) = orthogonal(matrices, &residual)?;
        let basis =
            Mat::from_fn(n, kept + own.len(), |i, r| if r < kept { phi[(i, r)] } else { shapes[(i, r - kept)] });
        omega.extend(own);
        Ok(Self { basis, omega, kept })
    }
}

/// Shapes within the span of `vectors` that are orthogonal in mass and stiffness, with their frequencies.
fn orthogonal(matrices: &SystemMatrices, vectors: &Mat<f64>) -> Result<(Mat<f64>, Vec<f64>), TransientError> {
    let unit = independent(matrices, vectors);
    if unit.ncols() == 0 {
        return Ok((unit, Vec::new()));
    }
    let projected = |a: &Mat<f64>| transposed_product(unit.as_ref(), product(a.as_ref(), unit.as_ref()).as_ref());
    let eigen = generalised_symmetric(projected(&matrices.stiffness).as_ref(), projected(&matrices.mass).as_ref())
        .map_err(|_| TransientError::NotPositive)?;
    let omega = eigen.values.iter().map(|v| v.max(0.0).sqrt()).collect();
    Ok((product(unit.as_ref(), eigen.vectors.as_ref()), omega))
}

/// An orthonormal set (in mass) that spans the columns, those left out that say the same as others.
fn independent(matrices: &SystemMatrices, vectors: &Mat<f64>) -> Mat<f64> {
    let n = vectors.nrows();
    let weighted = |x: &[f64]| -> Vec<f64> {
        let column = Mat::from_fn(n, 1, |i, _| x[i]);
        product(matrices.mass.as_ref(), column.as_ref()).col(0).iter().copied().collect()
    };
    let inner = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    let mut found: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
    for k in 0..vectors.ncols() {
        let mut x: Vec<f64> = vectors.col(k).iter().copied().collect();
        let before = inner(&x, &weighted(&x));
        for _ in 0..2 {
            for (y, weight) in &found {
                let share = inner(&x, weight);
                x.iter_mut().zip(y).for_each(|(x, y)| *x -= share * y);
            }
        }
        let after = inner(&x, &weighted(&x));
        if after > 1e-8 * before && after > 0.0 {
            x.iter_mut().for_each(|x| *x /= after.sqrt());
            let weight = weighted(&x);
            found.push((x, weight));
        }
    }
    Mat::from_fn(n, found.len(), |i, k| found[k].0[i])
}
