//! Random problems that are the same on every machine.

use faer::Mat;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Generator for a seed.
pub(crate) fn generator(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

/// Entries uniform between `low` and `high`.
pub(crate) fn matrix(rng: &mut ChaCha8Rng, rows: usize, columns: usize, low: f64, high: f64) -> Mat<f64> {
    Mat::from_fn(rows, columns, |_, _| low + (high - low) * rng.random::<f64>())
}

/// Values uniform between `low` and `high`.
pub(crate) fn vector(rng: &mut ChaCha8Rng, count: usize, low: f64, high: f64) -> Vec<f64> {
    (0..count).map(|_| low + (high - low) * rng.random::<f64>()).collect()
}

/// Symmetric positive definite matrix with eigenvalues of at least `shift`.
pub(crate) fn positive(rng: &mut ChaCha8Rng, n: usize, shift: f64) -> Mat<f64> {
    let a = matrix(rng, n, n, -1.0, 1.0);
    &a * a.transpose() + Mat::from_fn(n, n, |i, j| if i == j { shift } else { 0.0 })
}
