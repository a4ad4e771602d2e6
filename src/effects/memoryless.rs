//! Laws without memory, `F(t) = F(d(t), d'(t))`: written at one instant, lifted to samples of a period here.
//!
//! A law that jumps with the velocity is written with `sgn v -> v / sqrt(v^2 + width^2)`, whose limit for `width -> 0` is
//! the law itself with `F = 0` at `v = 0`. The error in the force is `width^2 / (2 v^2)` where it slips.

use super::law::Point;
use super::{Law, Motion, Parameter};
use faer::c64;

/// A force that depends on the present displacement and velocity only. Every such type is a [`Law`].
pub trait Memoryless: Sync {
    /// As [`Law::parameters`].
    fn list(&self) -> &'static [Parameter];

    /// Force and its slopes at displacement `d` (m) and velocity `v` (m/s); `width` (m/s) smooths jumps, 0 leaves them.
    fn at(&self, p: &[f64], width: f64, d: f64, v: f64) -> Point;

    /// Derivative of the force by parameter number `k`.
    fn by_parameter(&self, p: &[f64], k: usize, width: f64, d: f64, v: f64) -> f64;

    /// As [`Law::energy_per_cycle`].
    fn cycle_energy(&self, p: &[f64], amplitude: f64, omega: f64) -> Option<f64>;

    /// As [`Law::dynamic_stiffness`].
    fn stiffness_at(&self, p: &[f64], omega: f64) -> Option<c64> {
        let _ = (p, omega);
        None
    }

    /// Energy over one period of any motion, where it is known better than by the trapezoidal rule.
    fn exact_energy(&self, p: &[f64], motion: &Motion) -> Option<f64> {
        let _ = (p, motion);
        None
    }

    /// As [`Law::jumps`].
    fn is_discontinuous(&self) -> bool {
        false
    }

    /// As [`Law::dissipates`].
    fn takes_energy(&self) -> bool {
        true
    }
}

impl<T: Memoryless> Law for T {
    fn parameters(&self) -> &'static [Parameter] {
        self.list()
    }

    fn dynamic_stiffness(&self, p: &[f64], omega: f64) -> Option<c64> {
        self.stiffness_at(p, omega)
    }

    fn force(&self, p: &[f64], motion: &Motion, force: &mut [f64]) {
        self.smooth_force(p, 0.0, motion, force);
    }

    fn tangent(&self, p: &[f64], motion: &Motion, direction: &Motion, tangent: &mut [f64]) {
        self.smooth_tangent(p, 0.0, motion, direction, tangent);
    }

    fn parameter_tangent(&self, p: &[f64], k: usize, motion: &Motion, tangent: &mut [f64]) {
        self.smooth_parameter_tangent(p, k, 0.0, motion, tangent);
    }

    fn energy_per_cycle(&self, p: &[f64], amplitude: f64, omega: f64) -> Option<f64> {
        self.cycle_energy(p, amplitude, omega)
    }

    fn jumps(&self) -> bool {
        self.is_discontinuous()
    }

    fn point(&self, p: &[f64], width: f64, displacement: f64, velocity: f64) -> Option<Point> {
        Some(self.at(p, width, displacement, velocity))
    }

    fn smooth_force(&self, p: &[f64], width: f64, motion: &Motion, force: &mut [f64]) {
        for (n, f) in force.iter_mut().enumerate() {
            *f = self.at(p, width, motion.displacement[n], motion.velocity[n]).force;
        }
    }

    fn smooth_tangent(&self, p: &[f64], width: f64, motion: &Motion, direction: &Motion, tangent: &mut [f64]) {
        for (n, f) in tangent.iter_mut().enumerate() {
            let point = self.at(p, width, motion.displacement[n], motion.velocity[n]);
            *f = point.by_displacement * direction.displacement[n] + point.by_velocity * direction.velocity[n];
        }
    }

    fn smooth_parameter_tangent(&self, p: &[f64], k: usize, width: f64, motion: &Motion, tangent: &mut [f64]) {
        for (n, f) in tangent.iter_mut().enumerate() {
            *f = self.by_parameter(p, k, width, motion.displacement[n], motion.velocity[n]);
        }
    }

    fn dissipates(&self) -> bool {
        self.takes_energy()
    }

    fn energy(&self, p: &[f64], motion: &Motion) -> f64 {
        if !self.takes_energy() {
            return 0.0;
        }
        self.exact_energy(p, motion).unwrap_or_else(|| {
            let power = |(d, v): (&f64, &f64)| self.at(p, 0.0, *d, *v).force * v;
            motion.displacement.iter().zip(&motion.velocity).map(power).sum::<f64>() * motion.step()
        })
    }
}

/// Smoothed sign `v / sqrt(v^2 + width^2)` and its derivative; for `width = 0` the sign itself, 0 at 0, of zero slope.
pub fn sign(v: f64, width: f64) -> (f64, f64) {
    let square = v * v + width * width;
    if square == 0.0 {
        return (0.0, 0.0);
    }
    let root = square.sqrt();
    (v / root, width * width / (square * root))
}
