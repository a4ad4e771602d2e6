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
const STARTS: usize = 180;
/// Steps of its refinement.
const STEPS: usize = 80;

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
    let angles: Vec<f64> = mobility.iter().map(|y| (y - centre).im.atan2((y - centre).re)).collect();
    // The angle at the resonance is where what the law leaves is least: a search over one unknown, coarse then fine.
    let mut best = (f64::NAN, f64::NAN, f64::INFINITY);
    let mut resonance = 0.0;
    for step in 0..STARTS {
        let candidate = TAU * step as f64 / STARTS as f64;
        let found = law(omega, &angles, candidate)?;
        if found.2 < best.2 {
            (best, resonance) = (found, candidate);
        }
    }
    let mut width = TAU / STARTS as f64;
    for _ in 0..STEPS {
        for candidate in [resonance - width, resonance + width] {
            let found = law(omega, &angles, candidate)?;
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

/// The law for a given angle of resonance: with `s, c` the sine and cosine of half the angle from there,
/// `2 zeta wn w s = (wn^2 - w^2) c`, linear in `wn^2` and `zeta wn`. Gives `wn`, `zeta` and the squares of the angles left;
/// infinite where no damped mode fits.
fn law(omega: &[f64], angles: &[f64], resonance: f64) -> Result<(f64, f64, f64), ClassicalError> {
    let scale = omega.iter().sum::<f64>() / omega.len() as f64;
    let half: Vec<f64> = angles.iter().map(|a| 0.5 * turn(a - resonance)).collect();
    let rows = filled(omega.len(), 2, |i, j| {
        let w = omega[i] / scale;
        if j == 0 { half[i].cos() } else { -2.0 * w * half[i].sin() }
    });
    let right: Vec<f64> = omega.iter().zip(&half).map(|(w, h)| (w / scale).powi(2) * h.cos()).collect();
    let x = LeastSquares::new(rows.as_ref())?.solve(&right)?.x;
    if !(x[0] > 0.0 && x[1] > 0.0) {
        return Ok((f64::NAN, f64::NAN, f64::INFINITY));
    }
    let expected = |w: f64| (x[0] - w * w).atan2(2.0 * x[1] * w);
    let left = omega.iter().zip(&half).map(|(w, h)| turn(2.0 * (h - expected(w / scale))).powi(2)).sum();
    let wn = x[0].sqrt();
    Ok((wn * scale, x[1] / wn, left))
}
