//! Cholesky factors of a matrix with its diagonal scaled to 1: variables of very different units do not spoil the digits.
//!
//! ```text
//! S A S + ridge 1 = L L^T,    S = diag(A)^-1/2  (diagonal equilibration, Jacobi scaling)
//! ```
//!
//! All that is solved is solved of `A + ridge S^-2`: the ridge is a share of every entry of the diagonal.

use super::factor::Cholesky;
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Mat, MatRef, Par};

/// Entry of a diagonal below which a variable counts as one that the matrix does not know.
const LEAST: f64 = 1e-300;

/// Factors of a symmetric positive definite matrix, n x n, its diagonal scaled to 1.
#[derive(Debug, Clone)]
pub struct EquilibratedCholesky {
    factor: Cholesky,
    /// Diagonal of `S`.
    scale: Vec<f64>,
}

impl EquilibratedCholesky {
    /// Factors of `a` with `ridge` added to the scaled diagonal; `None` if that is not positive definite.
    pub fn new(a: MatRef<'_, f64>, ridge: f64) -> Option<Self> {
        Self::bounded(a, ridge, 0.0)
    }

    /// The same where entries of the diagonal below the share `least` of the greatest are scaled as if they were that: a variable that the
    /// matrix hardly knows stays small beside the ridge.
    pub fn bounded(a: MatRef<'_, f64>, ridge: f64, least: f64) -> Option<Self> {
        let n = a.nrows();
        let greatest = (0..n).map(|k| a[(k, k)]).fold(0.0, f64::max);
        let scale: Vec<f64> = (0..n).map(|k| a[(k, k)].max(least * greatest).max(LEAST).sqrt().recip()).collect();
        let scaled = Mat::from_fn(n, n, |i, j| a[(i, j)] * scale[i] * scale[j] + if i == j { ridge } else { 0.0 });
        Some(Self { factor: Cholesky::new(scaled.as_ref())?, scale })
    }

    /// `A^-1 b`.
    pub fn solve(&self, b: &[f64]) -> Vec<f64> {
        let scaled = Mat::from_fn(b.len(), 1, |i, _| b[i] * self.scale[i]);
        let x = self.factor.solve(scaled.as_ref());
        self.scale.iter().zip(x.col_as_slice(0)).map(|(s, x)| s * x).collect()
    }

    /// `x^T S^-2 x`, the square of `x` in units of the diagonal: what the ridge weighs.
    pub fn scaled_square(&self, x: &[f64]) -> f64 {
        self.scale.iter().zip(x).map(|(s, x)| (x / s).powi(2)).sum()
    }

    /// `A^-1`, symmetric to the last digit.
    pub fn inverse(&self) -> Mat<f64> {
        let (inverse, scale) = (self.scaled_inverse(), &self.scale);
        Mat::from_fn(scale.len(), scale.len(), |i, j| 0.5 * (inverse[(i, j)] + inverse[(j, i)]) * scale[i] * scale[j])
    }

    /// Square roots of the diagonal of `A^-1`: standard deviations where `A` is the inverse of a covariance.
    pub fn deviations(&self) -> Vec<f64> {
        let inverse = self.scaled_inverse();
        self.scale.iter().enumerate().map(|(i, s)| s * inverse[(i, i)].max(0.0).sqrt()).collect()
    }

    /// `L^-1 S B`: columns made independent and of unit variance where `A` is their covariance.
    pub fn whiten(&self, mut b: Mat<f64>) -> Mat<f64> {
        for j in 0..b.ncols() {
            b.col_as_slice_mut(j).iter_mut().zip(&self.scale).for_each(|(x, s)| *x *= s);
        }
        solve_lower_triangular_in_place(self.factor.factor(), b.as_mut(), Par::Seq);
        b
    }

    /// Least share of a variable that those before it do not explain, from 0 to 1.
    pub fn independence(&self) -> f64 {
        let factor = self.factor.factor();
        (0..self.scale.len()).map(|i| factor[(i, i)].powi(2)).fold(1.0, f64::min)
    }

    fn scaled_inverse(&self) -> Mat<f64> {
        self.factor.solve(Mat::identity(self.scale.len(), self.scale.len()).as_ref())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use faer::linalg::solvers::DenseSolveCore;

    /// A matrix of units sixteen powers of ten apart: `D C D` with a correlation of some strength.
    fn matrix(n: usize) -> Mat<f64> {
        let unit = |i: usize| 10.0_f64.powi(8 - 16 * i as i32 / n as i32);
        Mat::from_fn(n, n, |i, j| unit(i) * unit(j) * if i == j { 1.0 } else { 0.4 / (1.0 + i.abs_diff(j) as f64) })
    }

    /// Inverse, deviations, solution and whitening against the direct inverse of the same matrix with a ridge.
    #[test]
    fn all_is_that_of_the_direct_inverse() {
        for (n, ridge) in [(1, 0.0), (4, 0.0), (7, 0.3)] {
            let mut a = matrix(n);
            let factor = EquilibratedCholesky::new(a.as_ref(), ridge).unwrap();
            (0..n).for_each(|i| a[(i, i)] *= 1.0 + ridge);
            let direct = a.partial_piv_lu().inverse();
            let (inverse, deviations) = (factor.inverse(), factor.deviations());
            let b: Vec<f64> = (0..n).map(|i| a[(i, i)].sqrt() * (i as f64 - 1.5)).collect();
            let x = factor.solve(&b);
            let white = factor.whiten(Mat::identity(n, n));
            for i in 0..n {
                let size = direct[(i, i)].sqrt();
                assert!((deviations[i] / size - 1.0).abs() < 1e-9, "{n} {i}");
                let expected: f64 = (0..n).map(|j| direct[(i, j)] * b[j]).sum();
                assert!((x[i] - expected).abs() < 1e-9 * size, "{n} {i}: {} for {expected}", x[i]);
                for j in 0..n {
                    let unit = size * direct[(j, j)].sqrt();
                    let square: f64 = (0..n).map(|k| white[(k, i)] * white[(k, j)]).sum();
                    assert!((inverse[(i, j)] - direct[(i, j)]).abs() < 1e-9 * unit, "{n} {i} {j}");
                    assert!((square - direct[(i, j)]).abs() < 1e-9 * unit, "{n} {i} {j}");
                }
            }
            let expected: f64 = (0..n).map(|i| x[i] * x[i] * a[(i, i)] / (1.0 + ridge)).sum();
            assert!((factor.scaled_square(&x) / expected - 1.0).abs() < 1e-12);
        }
    }

    /// The share of the last of two unit columns at an angle that the first does not explain is the square of its sine.
    #[test]
    fn independence_is_the_square_of_a_sine() {
        let (angle, size) = (0.1_f64, 1e7);
        let a = Mat::from_fn(2, 2, |i, j| if i == j { [1.0, size * size][i] } else { size * angle.cos() });
        let factor = EquilibratedCholesky::new(a.as_ref(), 0.0).unwrap();
        assert!((factor.independence() / angle.sin().powi(2) - 1.0).abs() < 1e-12);
    }

    /// Nothing is made of matrices that are indefinite or no numbers; a variable that the matrix does not know has the ridge alone.
    #[test]
    fn indefinite_matrices_have_no_factors() {
        let symmetric = |a: [f64; 3]| Mat::from_fn(2, 2, |i, j| a[i + j]);
        for bad in [[1.0, 2.0, 1.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 1.0], [f64::NAN, 0.0, 1.0], [f64::INFINITY, 0.0, 1.0]]
        {
            assert!(EquilibratedCholesky::new(symmetric(bad).as_ref(), 0.0).is_none(), "{bad:?}");
        }
        let unknown = EquilibratedCholesky::new(symmetric([0.0, 0.0, 4.0]).as_ref(), 1e-10).unwrap();
        assert!((unknown.solve(&[0.0, 4.0])[1] - 1.0).abs() < 1e-9 && unknown.deviations()[0] > 1e150);
        let bounded = EquilibratedCholesky::bounded(symmetric([0.0, 0.0, 4.0]).as_ref(), 1.0, 0.25).unwrap();
        assert!((bounded.deviations()[0] - 1.0).abs() < 1e-12);
    }
}
