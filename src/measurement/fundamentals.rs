//! The fundamental of every channel in a part of a record.

use super::fit::{HarmonicFit, resolvable, solve};
use super::record::Record;
use faer::c64;
use std::ops::Range;

/// The fundamentals in a part of the record.
pub(super) struct Fundamentals {
    /// Fundamental of every channel.
    #[allow(clippy::struct_field_names, reason = "what they are called")]
    pub fundamentals: Vec<c64>,
    /// Variance of a fundamental for noise of variance 1.
    pub unit_variance: f64,
    /// Variance of a fundamental from harmonics above those fitted: a part ends up to a sample beside its period, and
    /// that sample adds `2 r / n`, with `r` what repeats and was not fitted.
    pub cut: Vec<f64>,
}

/// The fundamental of every channel in a range of samples.
pub(super) fn fundamentals(record: &Record, fit: &HarmonicFit, range: Range<usize>) -> Option<Fundamentals> {
    let time = &record.time()[range.clone()];
    if time.len() < 8 {
        return None;
    }
    let harmonics = resolvable(time, fit.omega, fit.harmonics()).ok()?;
    let values: Vec<&[f64]> = record.samples.iter().map(|samples| &samples[range.clone()]).collect();
    let solved = solve(time, &values, fit.omega, harmonics).ok()?;
    let covariance = solved.amplitudes(0, fit.omega).1;
    let cut = |c: usize| {
        let unfitted = (solved.residual_variance(c) - fit.channels[c].noise.powi(2)).max(0.0);
        (2.0 / time.len() as f64).powi(2) * unfitted
    };
    Some(Fundamentals {
        fundamentals: (0..values.len()).map(|c| solved.amplitudes(c, fit.omega).0[0]).collect(),
        // The larger of both variances: the deviation of no part is then understated.
        unit_variance: covariance[(0, 0)].max(covariance[(1, 1)]),
        cut: (0..values.len()).map(cut).collect(),
    })
}
