//! Modes at resonance, set apart so that nothing is lost there.
//!
//! Where a harmonic meets a natural frequency of the almost undamped structure, `Z` is almost singular and sources taken
//! into account afterwards would cancel all digits of its inverse. The receptance is therefore that of a structure whose
//! resonant modes are damped, `Z~ = Z + sum_r i d w_r^2 (M phi_r)(M phi_r)^T`, and the damping is taken back exactly by
//! one more leg for each such mode: pattern `v = M phi_r / s`, force `p = -i d w_r^2 s^2 v^T x`. These forces are unknowns
//! beside those of the nonlinear legs.

use super::modal_basis::ModalBasis;
use crate::effects::Leg;
use faer::c64;

/// A mode is at resonance where its dynamic stiffness is below this share of its static one.
const NEAR: f64 = 0.01;
/// Loss factor given to modes at resonance.
const LOSS: f64 = 0.05;

/// One mode at resonance with one harmonic.
#[derive(Debug)]
pub(crate) struct Resonant {
    /// `v`, n; its largest entry is 1.
    pub pattern: Vec<f64>,
    /// `Z~^-1 v`, n.
    pub column: Vec<c64>,
    /// What the leg's force is over its motion, N/m: takes the damping back.
    pub stiffness: c64,
}

impl Resonant {
    /// The mode without its column, from `M phi_r` and the square of its natural circular frequency (rad^2/s^2).
    pub(crate) fn new(weighted: Vec<f64>, square: f64) -> Self {
        let mut pattern = weighted;
        let size = pattern.iter().fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs()));
        pattern.iter_mut().for_each(|v| *v /= size);
        let stiffness = c64::new(0.0, -LOSS * square * size * size);
        Self { pattern, column: Vec::new(), stiffness }
    }

    /// Motion of the mode's leg, `v^T x`.
    pub(crate) fn motion(&self, x: &[c64]) -> c64 {
        self.pattern.iter().zip(x).fold(c64::new(0.0, 0.0), |sum, (v, x)| sum + *x * *v)
    }
}

/// Modes at resonance for the factors of `K` and `M` in `Z`.
pub(crate) fn near(basis: &ModalBasis, [fk, fm]: [c64; 2]) -> Vec<usize> {
    let close = |r: &usize| (fk * basis.square(*r) + fm).norm() < NEAR * basis.square(*r);
    (0..basis.len()).filter(close).collect()
}

/// What damps mode `r` beside its own stiffness, N/(m kg).
pub(crate) fn damping(basis: &ModalBasis, r: usize) -> c64 {
    c64::new(0.0, LOSS * basis.square(r))
}

/// Where a generalised force acts and a generalised motion is read.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Pattern {
    /// One DOF or the difference of two.
    Leg(Leg),
    /// Number of a mode at resonance in the list of its harmonic.
    Resonant(usize),
}
