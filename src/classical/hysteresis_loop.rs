//! Area of the hysteresis loop (2.2.3): what a force does over one period of the motion it acts on,
//!
//! ```text
//! area = loop integral f dx = pi sum_h h Im(conj(X_h) F_h)        c = area / (pi w |X|^2)        eta = area / (pi k |X|^2)
//! ```
//!
//! **Needs** force and displacement at one DOF in steady state; a stiffness for the loss factor. **Limits**: an equivalent at
//! this amplitude and frequency; on a structure the drive point's loop holds all that is lost anywhere.

use crate::balance::action::work;
use faer::c64;
use std::f64::consts::PI;

/// What a loop shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopProperties {
    /// Area, J.
    pub area: f64,
    /// Equivalent viscous coefficient, N s/m.
    pub viscous: f64,
    /// Loss factor for the stiffness given.
    pub loss_factor: f64,
}

/// From complex amplitudes of harmonics 1, 2, ... of displacement (m) and force (N), frequency in rad/s, stiffness in N/m.
pub fn from_harmonics(omega: f64, displacement: &[c64], force: &[c64], stiffness: f64) -> LoopProperties {
    let area = work((1..).zip(displacement).zip(force).map(|((h, x), f)| (h, *x, *f)));
    let speed: f64 = displacement.iter().enumerate().map(|(h, x)| ((h + 1) as f64).powi(2) * x.norm_sqr()).sum();
    let size: f64 = displacement.iter().map(c64::norm_sqr).sum();
    LoopProperties { area, viscous: area / (PI * omega * speed), loss_factor: area / (PI * stiffness * size) }
}
