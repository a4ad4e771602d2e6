//! Dense factorisations of the matrices of Newton's method: plain kernels where a general library's set-up would cost more
//! than the work, faer above.

use dashpot_numerics::{RealLu, RowLu};
use faer::{Mat, c64};

/// Sizes up to here are factorised in place by the plain algorithm.
const SMALL: usize = 200;

/// LU factors of a real square matrix with row exchanges.
pub(crate) enum Lu {
    Small(RowLu),
    Large { size: usize, lu: RealLu },
}

impl Lu {
    /// Factors of the `size x size` matrix given row by row; `None` if it is singular or not finite.
    pub(crate) fn new(size: usize, matrix: Vec<f64>) -> Option<Self> {
        if size <= SMALL {
            return RowLu::new(size, matrix).map(Self::Small);
        }
        if matrix.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let lu = RealLu::new(Mat::from_fn(size, size, |i, j| matrix[i * size + j]).as_ref());
        if (0..size).any(|i| lu.pivot(i) == 0.0) {
            return None;
        }
        Some(Self::Large { size, lu })
    }

    /// Replaces `rhs` by the solution.
    pub(crate) fn solve(&self, rhs: &mut [f64]) {
        match self {
            Self::Small(lu) => lu.solve(rhs),
            Self::Large { size, lu } => {
                let mut column = Mat::from_fn(*size, 1, |i, _| rhs[i]);
                lu.solve_in_place(column.as_mut());
                rhs.iter_mut().enumerate().for_each(|(i, x)| *x = column[(i, 0)]);
            }
        }
    }

    /// Sign of the determinant, -1 or 1.
    pub(crate) fn sign(&self) -> f64 {
        match self {
            Self::Small(lu) => lu.sign(),
            Self::Large { size, lu } => {
                let diagonal = (0..*size).fold(1.0, |s, i| s * lu.pivot(i).signum());
                diagonal * permutation_sign(lu.order())
            }
        }
    }
}

/// Sign of a permutation by its cycles.
fn permutation_sign(order: &[usize]) -> f64 {
    let mut seen = vec![false; order.len()];
    let mut sign = 1.0;
    for start in 0..order.len() {
        let (mut at, mut length) = (start, 0);
        while !seen[at] {
            seen[at] = true;
            at = order[at];
            length += 1;
        }
        if length > 0 && length % 2 == 0 {
            sign = -sign;
        }
    }
    sign
}

/// Inverse of a small complex matrix given row by row, by Gauss and Jordan with row exchanges; `None` if singular.
pub(crate) fn invert(n: usize, mut a: Vec<c64>) -> Option<Vec<c64>> {
    let (zero, one) = (c64::new(0.0, 0.0), c64::new(1.0, 0.0));
    let mut inverse: Vec<c64> = (0..n * n).map(|k| if k / n == k % n { one } else { zero }).collect();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a[i * n + k].norm_sqr().total_cmp(&a[j * n + k].norm_sqr()))?;
        let value = a[pivot * n + k];
        if value.norm_sqr() == 0.0 || !value.re.is_finite() || !value.im.is_finite() {
            return None;
        }
        for j in 0..n {
            a.swap(pivot * n + j, k * n + j);
            inverse.swap(pivot * n + j, k * n + j);
            a[k * n + j] /= value;
            inverse[k * n + j] /= value;
        }
        for i in (0..n).filter(|&i| i != k) {
            let factor = a[i * n + k];
            for j in 0..n {
                let (x, y) = (a[k * n + j], inverse[k * n + j]);
                a[i * n + j] -= factor * x;
                inverse[i * n + j] -= factor * y;
            }
        }
    }
    Some(inverse)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    fn example(n: usize) -> Vec<f64> {
        (0..n * n).map(|k| ((k * k + 3 * k) as f64 * 0.7).sin() + if k % (n + 1) == 2 { 2.0 } else { 0.0 }).collect()
    }

    #[test]
    fn both_kernels_solve_and_agree_on_the_sign() {
        for n in [3, 9, 210] {
            let a = example(n);
            let x: Vec<f64> = (0..n).map(|i| i as f64 - 1.5).collect();
            let mut b: Vec<f64> = a.chunks_exact(n).map(|row| row.iter().zip(&x).map(|(p, q)| p * q).sum()).collect();
            let lu = Lu::new(n, a.clone()).unwrap();
            lu.solve(&mut b);
            for (p, q) in b.iter().zip(&x) {
                assert!((p - q).abs() < 1e-9, "{n}: {p} {q}");
            }
            let determinant = Mat::from_fn(n, n, |i, j| a[i * n + j]).determinant();
            assert_eq!(lu.sign(), determinant.signum(), "{n}");
        }
        assert!(Lu::new(2, vec![1.0, 2.0, 2.0, 4.0]).is_none());
    }

    #[test]
    fn the_inverse_multiplies_to_one() {
        let a: Vec<c64> = example(9).iter().zip(example(9).iter().rev()).map(|(&p, &q)| c64::new(p, q)).collect();
        let b = invert(3, a[..9].to_vec()).unwrap();
        for i in 0..3 {
            for j in 0..3 {
                let sum = (0..3).fold(c64::new(0.0, 0.0), |s, k| s + a[i * 3 + k] * b[k * 3 + j]);
                let expected = if i == j { 1.0 } else { 0.0 };
                assert!((sum - expected).norm() < 1e-12);
            }
        }
    }
}
