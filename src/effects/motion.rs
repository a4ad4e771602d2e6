//! One period of a relative motion, as harmonics and as equally spaced samples of displacement, velocity, acceleration.

use faer::c64;
use std::f64::consts::{PI, TAU};

/// A periodic motion `d(t) = mean + Re sum_h D_h exp(i h omega t)` with its samples over one period.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// Fundamental circular frequency, rad/s.
    pub omega: f64,
    /// Static offset, m.
    pub mean: f64,
    /// Complex amplitudes of harmonics 1, 2, ... in m.
    pub harmonics: Vec<c64>,
    /// Displacement, m, at `t_n = n T / N`.
    pub displacement: Vec<f64>,
    /// Velocity, m/s.
    pub velocity: Vec<f64>,
    /// Acceleration, m/s^2.
    pub acceleration: Vec<f64>,
}

impl Motion {
    /// Number of samples in the period.
    pub fn len(&self) -> usize {
        self.displacement.len()
    }

    /// Whether there is no sample at all.
    pub fn is_empty(&self) -> bool {
        self.displacement.is_empty()
    }

    /// Period, s.
    pub fn period(&self) -> f64 {
        TAU / self.omega
    }

    /// Time from one sample to the next, s.
    pub fn step(&self) -> f64 {
        self.period() / self.len() as f64
    }

    /// Displacement (m), velocity and acceleration at any time `t` in s.
    pub fn at(&self, t: f64) -> [f64; 3] {
        let mut state = [self.mean, 0.0, 0.0];
        for (index, d) in self.harmonics.iter().enumerate() {
            let w = (index + 1) as f64 * self.omega;
            let (sin, cos) = (w * t).sin_cos();
            let in_phase = d.re * cos - d.im * sin;
            state[0] += in_phase;
            state[1] -= w * (d.re * sin + d.im * cos);
            state[2] -= w * w * in_phase;
        }
        state
    }

    /// Work in J of `force` (N, one value a sample) over one period: `integral d' F dt`.
    pub fn work(&self, force: &[f64]) -> f64 {
        self.velocity.iter().zip(force).map(|(v, f)| v * f).sum::<f64>() * self.step()
    }

    /// Fills `force` with `Re sum_h z(h omega) D_h exp(i h omega t)` plus `z(0)` times the mean, for a linear law of
    /// dynamic stiffness `z`. Nothing is allocated: each harmonic turns by a constant angle from sample to sample.
    pub fn apply_linear(&self, z: impl Fn(f64) -> c64, force: &mut [f64]) {
        let constant = if self.mean == 0.0 { 0.0 } else { z(0.0).re * self.mean };
        force.fill(constant);
        let turn = TAU / self.len() as f64;
        for (index, d) in self.harmonics.iter().enumerate() {
            let h = (index + 1) as f64;
            let (sin, cos) = (h * turn).sin_cos();
            let mut phasor = z(h * self.omega) * d;
            for f in force.iter_mut() {
                *f += phasor.re;
                phasor = c64::new(phasor.re * cos - phasor.im * sin, phasor.re * sin + phasor.im * cos);
            }
        }
    }

    /// Energy in J over one period of a linear law of dynamic stiffness `z` (N/m at rad/s): `pi sum_h h Im z(h omega) |D_h|^2`.
    pub fn linear_energy(&self, z: impl Fn(f64) -> c64) -> f64 {
        let term = |(index, d): (usize, &c64)| {
            let h = (index + 1) as f64;
            h * z(h * self.omega).im * d.norm_sqr()
        };
        PI * self.harmonics.iter().enumerate().map(term).sum::<f64>()
    }
}
