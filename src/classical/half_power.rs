//! Half-power points (3.11-3.21, with the errata of 3.18 and 3.19): from the width of a resonance peak of a receptance,
//!
//! ```text
//! eta = (w2^2 - w1^2) / (2 wn^2)        zeta = eta / 2        |H(w1)|^2 = |H(w2)|^2 = |H|^2_max / 2
//! ```
//!
//! exact for one hysteretically damped mode. **Needs** a receptance with lines on both flanks of the peak. **Limits**: modes
//! closer than a few half-power widths spoil each other; a viscous mode is exact only as `zeta -> 0` (the peak lies at
//! `wn sqrt(1 - 2 zeta^2)`, and the ratio is `zeta sqrt(1 - zeta^2) / (1 - 2 zeta^2)`, too large by `1.5 zeta^2` of itself); leakage and coarse lines widen the peak.

pub use crate::response::frequency_response::HalfPower;
use crate::response::frequency_response::half_power;
use faer::c64;

/// Half-power damping of every peak that stands out of its surroundings by a factor of two in power on both flanks.
///
/// `omega` ascending, rad/s; the receptance of one pair of DOFs.
pub fn peaks(omega: &[f64], receptance: &[c64]) -> Vec<HalfPower> {
    let power: Vec<f64> = receptance.iter().map(c64::norm_sqr).collect();
    (1..power.len().saturating_sub(1))
        .filter(|&i| power[i] > power[i - 1] && power[i] >= power[i + 1])
        .filter_map(|i| {
            let (first, last) = flanks(&power, i)?;
            half_power(&omega[first..=last], &receptance[first..=last])
        })
        .collect()
}

/// The stretch around a peak on which the power falls to less than half (with a line to spare), not passing a higher line.
fn flanks(power: &[f64], peak: usize) -> Option<(usize, usize)> {
    let enough = |&i: &usize| power[i] > power[peak] || power[i] < 0.45 * power[peak];
    let below = (0..peak).rev().find(enough)?;
    let above = (peak + 1..power.len()).find(enough)?;
    let falls = power[below] < power[peak] && power[above] < power[peak];
    falls.then(|| (below.saturating_sub(1), (above + 1).min(power.len() - 1)))
}
