//! Frequency response functions: receptance `H(omega) = Z(omega)^-1`, directly or as a sum over modes,
//!
//! ```text
//! viscous:    H = sum_r psi_r psi_r^T / (i omega - lambda_r) + conjugate      psi^T (2 lambda M + C) psi = 1   (3.70)
//! hysteretic: H = sum_r psi_r psi_r^T / (omega_r^2 (1 + i eta_r) - omega^2)   psi^T M psi = 1
//! ```
//!
//! and the damping that its half-power points show (3.18, 3.19 as corrected):
//! `eta = (w2^2 - w1^2) / (2 wn^2)`, exact for hysteretic damping; `zeta = eta / 2`.

use super::dynamic_stiffness::{DynamicStiffness, DynamicStiffnessError};
use crate::control::Control;
use crate::structure::damped_modes::DampedMode;
use faer::c64;
use serde::{Deserialize, Serialize};

/// What is divided by the force.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ResponseForm {
    /// Displacement over force, m/N.
    Receptance,
    /// Velocity over force, m/(N s).
    Mobility,
    /// Acceleration over force, m/(N s^2).
    Accelerance,
}

impl ResponseForm {
    /// Ratio to the receptance at `omega` (rad/s): 1, `i omega`, `-omega^2`.
    pub fn factor(self, omega: f64) -> c64 {
        match self {
            Self::Receptance => c64::new(1.0, 0.0),
            Self::Mobility => c64::new(0.0, omega),
            Self::Accelerance => c64::new(-omega * omega, 0.0),
        }
    }

    /// Unit of the ratio.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Receptance => "m/N",
            Self::Mobility => "m/s/N",
            Self::Accelerance => "m/s^2/N",
        }
    }
}

/// Frequency response between two DOFs at each of `omega` (rad/s), by factorising `Z` at each.
///
/// # Errors
/// [`DynamicStiffnessError::Singular`] at an undamped resonance, or cancellation.
pub fn direct(
    stiffness: &DynamicStiffness<'_>,
    response: usize,
    excitation: usize,
    omega: &[f64],
    quantity: ResponseForm,
    control: &Control,
) -> Result<Vec<c64>, DynamicStiffnessError> {
    let mut values = Vec::with_capacity(omega.len());
    for (k, &w) in omega.iter().enumerate() {
        control.check()?;
        control.report(k as f64 / omega.len() as f64);
        values.push(stiffness.factorise(w).receptance_column(excitation)?[response] * quantity.factor(w));
    }
    Ok(values)
}

/// Receptance between two DOFs at `omega` (rad/s) as a sum over viscously damped modes (all, or the lowest only).
///
/// # Errors
/// [`DynamicStiffnessError::RigidBody`] when a mode has the pole 0, which is a double one or normalised otherwise.
pub fn modal(
    modes: &[DampedMode],
    response: usize,
    excitation: usize,
    omega: f64,
) -> Result<c64, DynamicStiffnessError> {
    let at = c64::new(0.0, omega);
    let mut sum = c64::new(0.0, 0.0);
    for mode in modes {
        if mode.lambda.norm() == 0.0 {
            return Err(DynamicStiffnessError::RigidBody);
        }
        let residue = mode.shape[response] * mode.shape[excitation];
        sum += residue / (at - mode.lambda);
        if !mode.is_overdamped() {
            sum += residue.conj() / (at - mode.lambda.conj());
        }
    }
    Ok(sum)
}

/// What the half-power points of a resonance peak show.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfPower {
    /// Circular frequency of the peak, rad/s.
    pub omega_peak: f64,
    /// Circular frequencies at which the squared magnitude is half of the peak's, rad/s.
    pub omega_half: [f64; 2],
    /// `(w2^2 - w1^2) / (2 wn^2)`.
    pub loss_factor: f64,
}

impl HalfPower {
    /// Damping ratio, half of the loss factor.
    pub fn damping_ratio(&self) -> f64 {
        0.5 * self.loss_factor
    }
}

/// Half-power damping of the highest peak of a receptance sampled at ascending `omega` (rad/s).
///
/// `1 / |H|^2` of one mode is a parabola in `omega^2`; it is interpolated so, which is exact for a single mode at any
/// spacing. `None` when the peak or one of its half-power points lies outside the samples.
pub fn half_power(omega: &[f64], receptance: &[c64]) -> Option<HalfPower> {
    let square: Vec<f64> = omega.iter().map(|w| w * w).collect();
    let inverse: Vec<f64> = receptance.iter().map(|h| 1.0 / h.norm_sqr()).collect();
    if square.len() != inverse.len() || square.len() < 3 {
        return None;
    }
    let peak = (0..inverse.len()).min_by(|&i, &j| inverse[i].total_cmp(&inverse[j]))?;
    if peak == 0 || peak + 1 == inverse.len() {
        return None;
    }
    let top = Parabola::through(&square, &inverse, peak)?;
    let (vertex, least) = top.minimum()?;
    let below = (0..peak).rev().find(|&i| inverse[i] >= 2.0 * least)?;
    let above = (peak + 1..inverse.len()).find(|&i| inverse[i] >= 2.0 * least)?;
    let last = inverse.len() - 2;
    let left = Parabola::through(&square, &inverse, (below + 1).clamp(1, last))?.crossing(
        2.0 * least,
        square[below],
        square[below + 1],
    )?;
    let right = Parabola::through(&square, &inverse, (above - 1).clamp(1, last))?.crossing(
        2.0 * least,
        square[above - 1],
        square[above],
    )?;
    Some(HalfPower {
        omega_peak: vertex.sqrt(),
        omega_half: [left.sqrt(), right.sqrt()],
        loss_factor: (right - left) / (2.0 * vertex),
    })
}

/// `y = y0 + s (x - x0) + c (x - x0)^2`.
struct Parabola {
    x0: f64,
    y0: f64,
    slope: f64,
    curvature: f64,
}

impl Parabola {
    /// Through samples `k - 1`, `k`, `k + 1`.
    fn through(x: &[f64], y: &[f64], k: usize) -> Option<Self> {
        let (a, b) = (x[k - 1] - x[k], x[k + 1] - x[k]);
        let (p, q) = ((y[k - 1] - y[k]) / a, (y[k + 1] - y[k]) / b);
        let curvature = (q - p) / (b - a);
        let fit = Self { x0: x[k], y0: y[k], slope: p - curvature * a, curvature };
        (fit.slope.is_finite() && curvature.is_finite()).then_some(fit)
    }

    fn minimum(&self) -> Option<(f64, f64)> {
        let step = -0.5 * self.slope / self.curvature;
        let value = self.y0 + 0.5 * self.slope * step;
        (self.curvature > 0.0 && self.x0 + step > 0.0 && value > 0.0).then_some((self.x0 + step, value))
    }

    /// Where the parabola takes the value `y` between `low` and `high`.
    fn crossing(&self, y: f64, low: f64, high: f64) -> Option<f64> {
        let c = self.y0 - y;
        let root = (self.slope * self.slope - 4.0 * self.curvature * c).max(0.0).sqrt();
        let half = -0.5 * (self.slope + root.copysign(self.slope));
        let slack = 1e-9 * (high - low);
        [half / self.curvature, c / half]
            .into_iter()
            .map(|step| self.x0 + step)
            .find(|x| *x >= low - slack && *x <= high + slack)
    }
}
