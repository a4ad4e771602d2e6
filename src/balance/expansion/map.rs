//! How the motion of all DOFs follows from the channels of a run, at one harmonic.

use faer::{Mat, c64};

/// A matrix, n x channels. Where every sensor tells of its own DOF alone only its entries are kept: a scan of hundreds of points
/// would else be as many squared complex numbers a run.
#[derive(Debug, Clone, PartialEq)]
pub enum Map {
    /// All entries.
    Full(Mat<c64>),
    /// The entries that are not zero: DOF, channel, value.
    Few {
        /// Number of DOFs.
        rows: usize,
        /// The entries, those of one DOF in the order of the channels.
        entries: Vec<(usize, usize, f64)>,
    },
}

impl Map {
    /// Nothing follows from the channels.
    pub(super) fn zero(rows: usize) -> Self {
        Self::Few { rows, entries: Vec::new() }
    }

    /// The motion, one entry a DOF, that column `k` of the channels' `values` gives.
    pub(super) fn times(&self, values: &Mat<c64>, k: usize) -> Vec<c64> {
        match self {
            Self::Full(map) => {
                let mut motion = vec![c64::new(0.0, 0.0); map.nrows()];
                for s in 0..map.ncols() {
                    motion.iter_mut().enumerate().for_each(|(i, sum)| *sum += map[(i, s)] * values[(s, k)]);
                }
                motion
            }
            Self::Few { rows, entries } => {
                let mut motion = vec![c64::new(0.0, 0.0); *rows];
                entries.iter().for_each(|&(i, s, value)| motion[i] += values[(s, k)] * value);
                motion
            }
        }
    }

    /// Variances of the motion by the deviations of independent channels.
    pub(super) fn variances(&self, deviations: &Mat<f64>, k: usize) -> Vec<f64> {
        match self {
            Self::Full(map) => {
                let mut variances = vec![0.0; map.nrows()];
                for s in 0..map.ncols() {
                    let variance = deviations[(s, k)].powi(2);
                    variances.iter_mut().enumerate().for_each(|(i, sum)| *sum += map[(i, s)].norm_sqr() * variance);
                }
                variances
            }
            Self::Few { rows, entries } => {
                let mut variances = vec![0.0; *rows];
                entries.iter().for_each(|&(i, s, value)| variances[i] += (value * deviations[(s, k)]).powi(2));
                variances
            }
        }
    }

    /// `to[:, k] += map^H gradient[:, k]`.
    pub(crate) fn add_adjoint(&self, gradient: &Mat<c64>, k: usize, to: &mut Mat<c64>) {
        match self {
            Self::Full(map) => {
                for s in 0..map.ncols() {
                    to[(s, k)] += (0..map.nrows()).map(|i| map[(i, s)].conj() * gradient[(i, k)]).sum::<c64>();
                }
            }
            Self::Few { entries, .. } => {
                entries.iter().for_each(|&(i, s, value)| to[(s, k)] += gradient[(i, k)] * value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two sensors at one DOF, one at another, none at the third: the few entries do what the full matrix does.
    #[test]
    fn few_entries_act_as_their_full_matrix() {
        let entries = vec![(0, 0, 0.25), (0, 2, 0.75), (2, 1, 1.0)];
        let mut full = Mat::zeros(3, 3);
        entries.iter().for_each(|&(i, s, value)| full[(i, s)] = c64::new(value, 0.0));
        let values = Mat::from_fn(3, 2, |i, k| c64::new(1.5 + i as f64, k as f64 - 0.3 * i as f64));
        let deviations = Mat::from_fn(3, 2, |i, k| 0.1 + 0.2 * i as f64 + k as f64);
        let (few, full) = (Map::Few { rows: 3, entries }, Map::Full(full));
        let near = |a: f64, b: f64| (a - b).abs() < 1e-14;
        for k in 0..2 {
            let (a, b) = (few.times(&values, k), full.times(&values, k));
            assert!(a.iter().zip(&b).all(|(a, b)| (*a - *b).norm() < 1e-14), "{a:?} {b:?}");
            let (a, b) = (few.variances(&deviations, k), full.variances(&deviations, k));
            assert!(a.iter().zip(&b).all(|(a, b)| near(*a, *b)), "{a:?} {b:?}");
        }
        let (mut a, mut b) = (Mat::zeros(3, 2), Mat::zeros(3, 2));
        few.add_adjoint(&values, 1, &mut a);
        full.add_adjoint(&values, 1, &mut b);
        assert!((0..3).all(|s| (a[(s, 1)] - b[(s, 1)]).norm() < 1e-14 && a[(s, 0)] == c64::new(0.0, 0.0)));
    }
}
