//! Nyquist circle fit (2.2.2): the mobility of one viscous mode runs on a circle,
//!
//! ```text
//! Y = i w R / (wn^2 - w^2 + 2 i zeta wn w) + Y0        tan(angle / 2) = (wn^2 - w^2) / (2 zeta wn w)
//! ```
//!
//! The circle is fitted first (least squares of `|Y|^2 + a Re Y + b Im Y + c = 0`, Y0 is the rest of the other modes); then the
//! speed along it gives `wn` and `zeta`. **Needs** three lines or more around a resonance. **Limits**: the other modes must
//! be constant over the lines; hysteretic damping belongs on the circle of the receptance.

use super::error::ClassicalError;
use crate::math::fill::filled;
use crate::math::least_squares::LeastSquares;
use faer::c64;
use std::f64::consts::TAU;

/// Angles of resonance tried first.
const STARTS: usize = 60;
/// Steps of its refinement.
const STEPS: usize = 60;

/// What the circle shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circle {
    /// Centre, m/(N s).
    pub centre: c64,
    /// Radius, m/(N s).
    pub radius: f64,
    /// Natural frequency, rad/s.
    pub omega: f64,
    /// Damping ratio.
    pub damping_ratio: f64,
    /// Root mean square distance of the points from the circle over its radius.
    pub scatter: f64,
}

/// Fits the circle of one mode through receptance lines (m/N) around its resonance.
///
/// # Errors
/// [`ClassicalError::Few`] below three lines or where the lines do not pass a resonance.
pub fn circle_fit(omega: &[f64], receptance: &[c64]) -> Result<Circle, ClassicalError> {
    if omega.len() < 3 {
        return Err(ClassicalError::Few { what: "lines around the resonance", needed: 3, found: omega.len() });
    }
    let mobility: Vec<c64> = omega.iter().zip(receptance).map(|(&w, h)| h * c64::new(0.0, w)).collect();
    let (centre, radius) = circle(&mobility)?;
    let law = Law::new(omega, mobility.iter().map(|y| y - centre));
    // The angle at the resonance is where what the law leaves is least: a search over one unknown, coarse then fine.
    let mut best = (f64::NAN, f64::NAN, f64::INFINITY);
    let mut resonance = 0.0;
    for step in 0..STARTS {
        let candidate = TAU * step as f64 / STARTS as f64;
        let found = law.at(candidate);
        if found.2 < best.2 {
            (best, resonance) = (found, candidate);
        }
    }
    let mut width = TAU / STARTS as f64;
    for _ in 0..STEPS {
        for candidate in [resonance - width, resonance + width] {
            let found = law.at(candidate);
            if found.2 < best.2 {
                (best, resonance) = (found, candidate);
            }
        }
        width *= 0.7;
    }
    let (wn, zeta, _) = best;
    if !(wn.is_finite() && zeta.is_finite()) {
        return Err(ClassicalError::Few {
            what: "lines on both sides of the resonance",
            needed: 3,
            found: omega.len(),
        });
    }
    let off: f64 = mobility.iter().map(|y| ((y - centre).norm() - radius).powi(2)).sum();
    let scatter = (off / omega.len() as f64).sqrt() / radius;
    Ok(Circle { centre, radius, omega: wn, damping_ratio: zeta, scatter })
}

fn circle(points: &[c64]) -> Result<(c64, f64), ClassicalError> {
    let size = points.iter().map(|y| y.norm()).fold(f64::MIN_POSITIVE, f64::max);
    let rows = filled(points.len(), 3, |i, j| [points[i].re / size, points[i].im / size, 1.0][j]);
    let right: Vec<f64> = points.iter().map(|y| -y.norm_sqr() / (size * size)).collect();
    let x = LeastSquares::new(rows.as_ref())?.solve(&right)?.x;
    let centre = c64::new(-0.5 * x[0], -0.5 * x[1]);
    let radius = (centre.norm_sqr() - x[2]).max(0.0).sqrt();
    Ok((centre * size, radius * size))
}

/// An angle between -pi and pi.
fn turn(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

/// The speed along the circle: with `s, c` the sine and cosine of half the angle from the resonance,
/// `2 zeta wn w s = (wn^2 - w^2) c`, linear in `wn^2` and `zeta wn`.
struct Law {
    /// Circular frequencies over their mean, rad/s.
    scale: f64,
    ratios: Vec<f64>,
    /// Cosine and sine of half the angle of every line about the centre, and the angle itself.
    halves: Vec<[f64; 2]>,
    angles: Vec<f64>,
}

impl Law {
    fn new(omega: &[f64], from_centre: impl Iterator<Item = c64>) -> Self {
        let scale = omega.iter().sum::<f64>() / omega.len() as f64;
        let angles: Vec<f64> = from_centre.map(|y| y.im.atan2(y.re)).collect();
        let halves = angles.iter().map(|a| [(0.5 * a).cos(), (0.5 * a).sin()]).collect();
        Self { scale, ratios: omega.iter().map(|w| w / scale).collect(), halves, angles }
    }

    /// `wn`, `zeta` and the squares of the angles left for a given angle of resonance; infinite where no damped mode fits.
    fn at(&self, resonance: f64) -> (f64, f64, f64) {
        let (sin, cos) = (0.5 * resonance).sin_cos();
        // Normal equations of `u c - 2 x w s = (w^2 - 1) c`, u = wn^2 - 1, x = zeta wn, frequencies in units of their mean.
        let (mut normal, mut right) = ([0.0; 3], [0.0; 2]);
        for (w, [c, s]) in self.ratios.iter().zip(&self.halves) {
            let (a, b) = (c * cos + s * sin, -2.0 * w * (s * cos - c * sin));
            let y = (w - 1.0) * (w + 1.0) * a;
            normal = [normal[0] + a * a, normal[1] + a * b, normal[2] + b * b];
            right = [right[0] + a * y, right[1] + b * y];
        }
        let determinant = normal[0] * normal[2] - normal[1] * normal[1];
        let u = (right[0] * normal[2] - right[1] * normal[1]) / determinant;
        let x = (right[1] * normal[0] - right[0] * normal[1]) / determinant;
        if !(u > -1.0 && x > 0.0) {
            return (f64::NAN, f64::NAN, f64::INFINITY);
        }
        let expected = |w: f64| 2.0 * (u - (w - 1.0) * (w + 1.0)).atan2(2.0 * x * w);
        let lines = self.ratios.iter().zip(&self.angles);
        let left = lines.map(|(&w, a)| turn(a - resonance - expected(w)).powi(2)).sum();
        let wn = (1.0 + u).sqrt();
        (wn * self.scale, x / wn, left)
    }
}
