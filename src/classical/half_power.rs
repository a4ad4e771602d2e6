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
use nalgebra::{Matrix3, Vector3};

/// Fewest lines of the top of a peak, and of each flank, whose parabola evens out noise; with fewer it passes through three.
const MANY: usize = 6;
/// The top reaches down to this part of the power of the peak, a flank up to this one.
const TOP: f64 = 0.75;
const FLANK: f64 = 0.65;
/// How far beside its lines a flank may pass half the power, as they were half as many again: noise on the crest moves them.
const BESIDE: f64 = 1.5;

/// Half-power damping of every peak that stands out of its surroundings by a factor of two in power on both flanks.
///
/// `omega` ascending, rad/s; the receptance of one pair of DOFs.
pub fn peaks(omega: &[f64], receptance: &[c64]) -> Vec<HalfPower> {
    let power: Vec<f64> = receptance.iter().map(c64::norm_sqr).collect();
    (1..power.len().saturating_sub(1))
        .filter(|&i| power[i] > power[i - 1] && power[i] >= power[i + 1])
        .filter_map(|i| about(omega, receptance, &power, i))
        .collect()
}

/// Half-power damping of the highest peak, where it stands out so.
pub(super) fn highest(omega: &[f64], receptance: &[c64]) -> Option<HalfPower> {
    let power: Vec<f64> = receptance.iter().map(c64::norm_sqr).collect();
    let peak = (0..power.len()).max_by(|&i, &j| power[i].total_cmp(&power[j]))?;
    about(omega, receptance, &power, peak)
}

/// Half-power damping of the peak at a line.
fn about(omega: &[f64], receptance: &[c64], power: &[f64], peak: usize) -> Option<HalfPower> {
    let (first, last) = flanks(power, peak)?;
    let (omega, receptance) = (&omega[first..=last], &receptance[first..=last]);
    evened(omega, receptance).or_else(|| half_power(omega, receptance))
}

/// The stretch around a peak on which the power falls to less than half (with a line to spare), not passing a higher line.
fn flanks(power: &[f64], peak: usize) -> Option<(usize, usize)> {
    let enough = |&i: &usize| power[i] > power[peak] || power[i] < 0.45 * power[peak];
    let below = (0..peak).rev().find(enough)?;
    let above = (peak + 1..power.len()).find(enough)?;
    let falls = power[below] < power[peak] && power[above] < power[peak];
    falls.then(|| (below.saturating_sub(1), (above + 1).min(power.len() - 1)))
}

/// Half-power points of one peak on many lines: `1 / |H|^2` of one mode is a parabola in the squared frequency, fitted to the
/// top and to each flank by least squares, so that noise shifts neither the crest nor the points. `None` on few lines.
fn evened(omega: &[f64], receptance: &[c64]) -> Option<HalfPower> {
    let square: Vec<f64> = omega.iter().map(|w| w * w).collect();
    let inverse: Vec<f64> = receptance.iter().map(|h| 1.0 / h.norm_sqr()).collect();
    let peak = (0..inverse.len()).min_by(|&i, &j| inverse[i].total_cmp(&inverse[j]))?;
    let over = |lines: std::ops::Range<usize>, keep: &dyn Fn(f64) -> bool| {
        let kept: Vec<usize> = lines.filter(|&i| keep(inverse[peak] / inverse[i])).collect();
        let at_kept_lines = |values: &[f64]| kept.iter().map(|&i| values[i]).collect::<Vec<f64>>();
        (kept.len() >= MANY).then(|| Curve::fitted(&at_kept_lines(&square), &at_kept_lines(&inverse)))?
    };
    let (vertex, least) = over(0..inverse.len(), &|power| power > TOP)?.minimum()?;
    let middle = square.partition_point(|x| *x < vertex);
    let left = over(0..middle, &|power| power < FLANK)?.crossing(2.0 * least)?;
    let right = over(middle..inverse.len(), &|power| power < FLANK)?.crossing(2.0 * least)?;
    let ordered = left < vertex && vertex < right && left > 0.0;
    ordered.then(|| HalfPower {
        omega_peak: vertex.sqrt(),
        omega_half: [left.sqrt(), right.sqrt()],
        loss_factor: (right - left) / (2.0 * vertex),
    })
}

/// `y = a + b t + c t^2`, `t = (x - centre) / half`, from -1 to 1 over the lines.
struct Curve {
    centre: f64,
    half: f64,
    coefficients: [f64; 3],
}

impl Curve {
    /// By least squares; noise on `H` is noise on `1 / |H|^2` in proportion to `|H|^-3`, hence the weights.
    fn fitted(x: &[f64], y: &[f64]) -> Option<Self> {
        let (first, last) = (x.first()?, x.last()?);
        let (centre, half) = (0.5 * (first + last), 0.5 * (last - first));
        let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
        for (x, y) in x.iter().zip(y) {
            let t = (x - centre) / half;
            let row = Vector3::new(1.0, t, t * t);
            normal += row * row.transpose() * y.powi(-3);
            right += row * y.powi(-2);
        }
        let coefficients = normal.cholesky()?.solve(&right);
        let coefficients = [coefficients[0], coefficients[1], coefficients[2]];
        coefficients.iter().all(|c| c.is_finite()).then_some(Self { centre, half, coefficients })
    }

    fn minimum(&self) -> Option<(f64, f64)> {
        let [a, b, c] = self.coefficients;
        let (t, least) = (-0.5 * b / c, a - 0.25 * b * b / c);
        (c > 0.0 && t.abs() < 1.0 && least > 0.0).then_some((self.centre + t * self.half, least))
    }

    /// Where it takes the value `y` on the lines or just beside them.
    fn crossing(&self, y: f64) -> Option<f64> {
        let [a, b, c] = self.coefficients;
        let root = (b * b - 4.0 * c * (a - y)).max(0.0).sqrt();
        let far = -0.5 * (b + root.copysign(b));
        let found = [far / c, (a - y) / far]
            .into_iter()
            .filter(|t| t.abs() < BESIDE)
            .min_by(|s, t| s.abs().total_cmp(&t.abs()))?;
        Some(self.centre + found * self.half)
    }
}
