//! Cholesky factor of a small Hermitian covariance, `S = L L^H`, and whitening by it: `L^-1 v` has unit covariance.

use faer::c64;

/// Lower factor, row by row.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct HermitianFactor {
    l: Vec<c64>,
    size: usize,
}

impl HermitianFactor {
    /// Factor of `s`, n x n row by row. A pivot below `least` times its diagonal entry is rounding and is raised to that, so
    /// that no certain channel is made of one that is not.
    pub(crate) fn new(s: &[c64], least: f64) -> Self {
        let size = s.len().isqrt();
        let mut l = vec![c64::new(0.0, 0.0); size * size];
        for i in 0..size {
            for j in 0..=i {
                let rest = (0..j).fold(s[i * size + j], |x, k| x - l[i * size + k] * l[j * size + k].conj());
                l[i * size + j] = if i == j {
                    let pivot = rest.re.max(least * s[i * size + i].re).max(f64::MIN_POSITIVE);
                    c64::new(pivot.sqrt(), 0.0)
                } else {
                    rest / l[j * size + j].re
                };
            }
        }
        Self { l, size }
    }

    /// `ln det S`.
    pub(crate) fn log_determinant(&self) -> f64 {
        (0..self.size).map(|i| 2.0 * self.l[i * self.size + i].re.ln()).sum()
    }

    /// `v := L^-1 v`.
    pub(crate) fn whiten(&self, v: &mut [c64]) {
        for i in 0..self.size {
            let rest = (0..i).fold(v[i], |x, k| x - self.l[i * self.size + k] * v[k]);
            v[i] = rest / self.l[i * self.size + i].re;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_factor_rebuilds_the_matrix_and_whitens() {
        let lower = |i: usize, j: usize| match i.cmp(&j) {
            std::cmp::Ordering::Equal => c64::new(1.0 + i as f64, 0.0),
            std::cmp::Ordering::Greater => c64::new(0.3, 0.2 * i as f64),
            std::cmp::Ordering::Less => c64::new(0.0, 0.0),
        };
        let entry = |i: usize, j: usize| (0..3).map(|k| lower(i, k) * lower(j, k).conj()).sum::<c64>();
        let s: Vec<c64> = (0..9).map(|at| entry(at / 3, at % 3)).collect();
        let factor = HermitianFactor::new(&s, 1e-12);
        let mut v: Vec<c64> = (0..3).map(|i| (0..=i).map(|j| lower(i, j) * (j as f64 + 1.0)).sum()).collect();
        factor.whiten(&mut v);
        assert!((0..3).all(|i| (v[i] - (i as f64 + 1.0)).norm() < 1e-14));
        assert!((0..9).all(|at| (factor.l[at] - lower(at / 3, at % 3)).norm() < 1e-14));
    }
}
