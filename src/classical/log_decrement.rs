//! Logarithmic decrement (3.1-3.8): peaks of a free decay fall by the same ratio each period,
//!
//! ```text
//! delta = ln(x_0 / x_n) = 2 pi n zeta / sqrt(1 - zeta^2)        zeta = d / sqrt(4 pi^2 + d^2), d = delta / n
//! ```
//!
//! with `d` from a straight line through the logarithms of all peaks, which are read from parabolas through three samples.
//! **Needs** a free decay of one mode. **Limits**: one mode at a time (filter the others out); damping that is
//! not viscous bends the line, which is reported.

use super::data::DecayRecord;
use super::error::ClassicalError;
use crate::math::fill::filled;
use crate::math::least_squares::LeastSquares;
use std::f64::consts::TAU;

/// What the peaks of a decay show.
#[derive(Debug, Clone, PartialEq)]
pub struct Decrement {
    /// Damping ratio.
    pub damping_ratio: f64,
    /// Frequency of the damped oscillation, Hz.
    pub frequency_hz: f64,
    /// Times of the peaks, s, and their sizes, positive and negative ones.
    pub peaks: Vec<(f64, f64)>,
    /// Root mean square distance of the logarithms from the line: much more than noise means that the damping depends on
    /// the amplitude.
    pub scatter: f64,
}

/// Damping ratio of a decay whose rest position is 0; for callers of the library, as decays of a project are read by windows.
///
/// ```
/// use dashpot::classical::{DecayRecord, log_decrement::log_decrement};
/// let decay = |i: i32| (-0.02 * f64::from(i) * 0.1).exp() * (f64::from(i) * 0.1).cos();
/// let found = log_decrement(&DecayRecord { step: 0.1, samples: (0..600).map(decay).collect() })?;
/// assert!((found.damping_ratio - 0.02).abs() < 1e-4);
/// # Ok::<(), dashpot::classical::ClassicalError>(())
/// ```
///
/// # Errors
/// [`ClassicalError::Few`] below three peaks.
pub fn log_decrement(record: &DecayRecord) -> Result<Decrement, ClassicalError> {
    let peaks = peaks(record);
    if peaks.len() < 3 {
        return Err(ClassicalError::Few { what: "peaks of a free decay", needed: 3, found: peaks.len() });
    }
    // Half periods between successive peaks of either sign.
    let rows = filled(peaks.len(), 2, |k, j| if j == 0 { 1.0 } else { 0.5 * k as f64 });
    let fit = LeastSquares::new(rows.as_ref())?;
    let line = fit.solve(&peaks.iter().map(|(_, x)| x.abs().ln()).collect::<Vec<_>>())?;
    let times = fit.solve(&peaks.iter().map(|(t, _)| *t).collect::<Vec<_>>())?;
    let d = -line.x[1];
    Ok(Decrement {
        damping_ratio: ratio(d, 1.0),
        frequency_hz: 1.0 / times.x[1],
        scatter: line.residual_norm / (peaks.len() as f64).sqrt(),
        peaks,
    })
}

/// Damping ratio from the decrement `delta` over `periods` periods, inverted without the approximation of (3.9).
pub fn ratio(delta: f64, periods: f64) -> f64 {
    let d = delta / periods;
    d / (TAU * TAU + d * d).sqrt()
}

fn peaks(record: &DecayRecord) -> Vec<(f64, f64)> {
    let x = &record.samples;
    let top = |i: usize| {
        let sign = x[i].signum();
        sign * x[i] > sign * x[i - 1] && sign * x[i] >= sign * x[i + 1] && x[i] != 0.0
    };
    (1..x.len().saturating_sub(1))
        .filter(|&i| top(i))
        .map(|i| {
            let (slope, curvature) = (0.5 * (x[i + 1] - x[i - 1]), x[i + 1] - 2.0 * x[i] + x[i - 1]);
            let shift = -slope / curvature;
            ((i as f64 + shift) * record.step, x[i] + 0.5 * slope * shift)
        })
        .collect()
}
