//! Laws without memory, `F(t) = F(d(t), d'(t))`: written at one instant, lifted to samples of a period here.
//!
//! A force that jumps at rest is 0 there and has no slope; solvers ask such laws by [`SetValued`] or [`Steep`].

use super::description::Description;
use super::law::{Law, Manner, Point, Variable};
use super::motion::Motion;
use super::set_valued::{SetValued, Steep};

/// A force that depends on the present displacement or velocity only.
pub trait MemorylessLaw: Sync {
    /// As [`Law::description`].
    fn description(&self) -> &'static Description;

    /// As [`Law::variable`].
    fn variable(&self) -> Variable;

    /// Force and its slopes at displacement `d` (m) and velocity `v` (m/s).
    fn at(&self, p: &[f64], d: f64, v: f64) -> Point;

    /// Derivative of the force by parameter number `k`.
    fn by_parameter(&self, p: &[f64], k: usize, d: f64, v: f64) -> f64;

    /// As [`Law::energy_per_cycle`]; 0 for laws that take out none.
    fn cycle_energy(&self, p: &[f64], amplitude: f64, omega: f64) -> Option<f64> {
        let _ = (p, amplitude, omega);
        None
    }

    /// Energy over one period of any motion, where it is known better than by the trapezoidal rule.
    fn exact_energy(&self, p: &[f64], motion: &Motion) -> Option<f64> {
        let _ = (p, motion);
        None
    }

    /// As [`Law::set_valued`].
    fn set_valued(&self) -> Option<&dyn SetValued> {
        None
    }

    /// As [`Law::steep`], where these parameters make it so.
    fn steep(&self) -> Option<&dyn Steep> {
        None
    }

    /// Whether the slope at rest is infinite at these parameters.
    fn is_steep(&self, p: &[f64]) -> bool {
        let _ = p;
        false
    }
}

/// A memoryless law as a [`Law`].
#[derive(Debug)]
pub(crate) struct Memoryless<T>(pub T);

impl<T: MemorylessLaw> Law for Memoryless<T> {
    fn description(&self) -> &'static Description {
        self.0.description()
    }

    fn manner(&self, p: &[f64]) -> Manner {
        if self.0.set_valued().is_some() {
            Manner::SetValued
        } else if self.0.is_steep(p) {
            Manner::Steep
        } else {
            Manner::Pointwise
        }
    }

    fn force(&self, p: &[f64], motion: &Motion, force: &mut [f64]) {
        for (n, f) in force.iter_mut().enumerate() {
            *f = self.0.at(p, motion.displacement[n], motion.velocity[n]).force;
        }
    }

    fn tangent(&self, p: &[f64], motion: &Motion, direction: &Motion, tangent: &mut [f64]) {
        for (n, f) in tangent.iter_mut().enumerate() {
            let point = self.0.at(p, motion.displacement[n], motion.velocity[n]);
            *f = point.by_displacement * direction.displacement[n] + point.by_velocity * direction.velocity[n];
        }
    }

    fn parameter_tangent(&self, p: &[f64], k: usize, motion: &Motion, tangent: &mut [f64]) {
        for (n, f) in tangent.iter_mut().enumerate() {
            *f = self.0.by_parameter(p, k, motion.displacement[n], motion.velocity[n]);
        }
    }

    fn energy_per_cycle(&self, p: &[f64], amplitude: f64, omega: f64) -> Option<f64> {
        if self.description().dissipates { self.0.cycle_energy(p, amplitude, omega) } else { Some(0.0) }
    }

    fn point(&self, p: &[f64], displacement: f64, velocity: f64) -> Option<Point> {
        Some(self.0.at(p, displacement, velocity))
    }

    fn variable(&self) -> Variable {
        self.0.variable()
    }

    fn set_valued(&self) -> Option<&dyn SetValued> {
        self.0.set_valued()
    }

    fn steep(&self) -> Option<&dyn Steep> {
        self.0.steep()
    }

    fn energy(&self, p: &[f64], motion: &Motion) -> f64 {
        if !self.description().dissipates {
            return 0.0;
        }
        self.0.exact_energy(p, motion).unwrap_or_else(|| {
            let power = |(d, v): (&f64, &f64)| self.0.at(p, *d, *v).force * v;
            motion.displacement.iter().zip(&motion.velocity).map(power).sum::<f64>() * motion.step()
        })
    }
}

/// Sign of `v`, 0 at rest.
pub(crate) fn sign(v: f64) -> f64 {
    if v == 0.0 { 0.0 } else { v.signum() }
}
