//! The three kinds of law: a force on a relative motion, a force over the whole structure, an error of a channel. What is
//! known of each beside its force is its [`Description`].
//!
//! Laws on a relative motion are written in the family that fits them and lifted to [`Law`]: [`super::linear`] (dynamic
//! stiffness), [`super::memoryless`] (force at one instant), [`super::masing`] (backbone of sliders),
//! [`super::internal`] (one force that follows a rate equation along the displacement).

use super::basis::Basis;
use super::description::Description;
use super::memory::Memory;
use super::motion::Motion;
use super::parameter::Parameter;
use super::set_valued::{SetValued, Steep};
use super::ways::InternalSteps;
use faer::c64;

/// Value and slopes of a force that depends on the present displacement and velocity only.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Point {
    /// Force, N.
    pub force: f64,
    /// Derivative by the displacement, N/m.
    pub by_displacement: f64,
    /// Derivative by the velocity, N s/m.
    pub by_velocity: f64,
}

/// How solvers ask a law for its force.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Manner {
    /// Harmonic by harmonic, by its dynamic stiffness.
    Linear,
    /// By displacement and velocity at one instant: [`Law::point`].
    Pointwise,
    /// By force and velocity: [`Law::set_valued`], whose force at rest is any between two bounds.
    SetValued,
    /// By force and velocity: [`Law::steep`], whose slope at rest is infinite.
    Steep,
    /// By the whole period ([`Law::force`]), or stepped through time ([`Law::memory`]).
    Memory,
}

/// From a direction to the tangent along it, both sampled.
pub(crate) type Linearised<'a> = Box<dyn Fn(&Motion, &mut [f64]) + 'a>;

/// From the number of a parameter to the derivative of the force by it, sampled.
pub type ByParameter<'a> = Box<dyn Fn(usize, &mut [f64]) + 'a>;

/// What a law of the present instant looks at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variable {
    /// The relative displacement.
    Displacement,
    /// The relative velocity.
    Velocity,
}

/// A force that depends on one relative displacement `d(t)` of the structure: `-F` acts on the first DOF, `+F` on the second.
///
/// All methods take the parameters `p` in the order of [`Law::parameters`].
pub trait Law: Sync {
    /// What is known of the law beside its force.
    fn description(&self) -> &'static Description;

    /// Parameters in the order of `p`. The first linear one is the coefficient that identification solves for.
    fn parameters(&self) -> &'static [Parameter] {
        self.description().parameters
    }

    /// How solvers ask the law at these parameters.
    fn manner(&self, p: &[f64]) -> Manner;

    /// Whether the force is a linear function of the motion, harmonic by harmonic, whatever the parameters.
    fn is_linear(&self) -> bool {
        false
    }

    /// Dynamic stiffness `F_h / D_h` in N/m at the circular frequency `omega` (rad/s), for laws that are linear in `d`;
    /// `None` for all others.
    fn dynamic_stiffness(&self, p: &[f64], omega: f64) -> Option<c64> {
        let _ = (p, omega);
        None
    }

    /// Derivative of [`Law::dynamic_stiffness`] by parameter `k`.
    fn dynamic_stiffness_by(&self, p: &[f64], k: usize, omega: f64) -> Option<c64> {
        let _ = (p, k, omega);
        None
    }

    /// Force in N at every sample of one period of the motion, in steady state (memory laws march until periodic).
    /// `force.len() == motion.len()`.
    fn force(&self, p: &[f64], motion: &Motion, force: &mut [f64]);

    /// Directional (Gateaux) derivative of [`Law::force`] at `motion` along the periodic `direction`, N at every sample.
    fn tangent(&self, p: &[f64], motion: &Motion, direction: &Motion, tangent: &mut [f64]);

    /// [`Law::tangent`] for many directions along one motion: gives the tangent of each. What a law computes of the motion
    /// alone is computed once.
    fn linearised<'a>(&'a self, p: &'a [f64], motion: &'a Motion) -> Linearised<'a> {
        Box::new(move |direction, tangent| self.tangent(p, motion, direction, tangent))
    }

    /// [`Law::force`] and [`Law::linearised`] of one motion. What both need is computed once.
    fn force_and_tangent<'a>(&'a self, p: &'a [f64], motion: &'a Motion, force: &mut [f64]) -> Linearised<'a> {
        self.force(p, motion, force);
        self.linearised(p, motion)
    }

    /// Derivative of [`Law::force`] by parameter number `k`, N per unit of that parameter at every sample.
    fn parameter_tangent(&self, p: &[f64], k: usize, motion: &Motion, tangent: &mut [f64]);

    /// [`Law::parameter_tangent`] for all parameters along one motion. What a law computes of the motion alone is computed
    /// once.
    fn by_parameters<'a>(&'a self, p: &'a [f64], motion: &'a Motion) -> ByParameter<'a> {
        Box::new(move |k, tangent| self.parameter_tangent(p, k, motion, tangent))
    }

    /// Energy in J taken out per cycle of `d = amplitude cos(omega t)`, where a closed form exists.
    fn energy_per_cycle(&self, p: &[f64], amplitude: f64, omega: f64) -> Option<f64> {
        let _ = (p, amplitude, omega);
        None
    }

    /// The force at one instant, for laws without memory and inertia; `None` for all others.
    fn point(&self, p: &[f64], displacement: f64, velocity: f64) -> Option<Point> {
        let _ = (p, displacement, velocity);
        None
    }

    /// What a law of the present instant looks at.
    fn variable(&self) -> Variable {
        Variable::Displacement
    }

    /// The law as a set of forces at rest, for friction (alone or behind a spring, see [`Law::series_stiffness`]).
    fn set_valued(&self) -> Option<&dyn SetValued> {
        None
    }

    /// Stiffness (N/m) of the spring in series with the friction of [`Law::set_valued`]; `None` where there is no spring.
    fn series_stiffness(&self, p: &[f64]) -> Option<f64> {
        let _ = p;
        None
    }

    /// The law as a force of infinite slope at rest.
    fn steep(&self) -> Option<&dyn Steep> {
        None
    }

    /// The law with memory at rest at the origin, to be stepped through time. `None` for laws without memory (see
    /// [`Law::point`]), for mass, and for hysteretic and fractional damping, which exist in steady state only.
    fn memory(&self, p: &[f64]) -> Option<Box<dyn Memory>> {
        let _ = p;
        None
    }

    /// The law as one internal force that follows the displacement, at its parameters; `None` for all others.
    fn internal(&self, p: &[f64]) -> Option<Box<dyn InternalSteps>> {
        let _ = p;
        None
    }

    /// Energy in J taken out over one period of `motion`: `integral d' F dt` by the trapezoidal rule, which is spectrally
    /// accurate for smooth periodic integrands. Laws with jumps override it with an exact formula.
    fn energy(&self, p: &[f64], motion: &Motion) -> f64 {
        let mut force = vec![0.0; motion.len()];
        self.force(p, motion, &mut force);
        motion.work(&force)
    }
}

/// A force over the whole structure, `F_h = factor(p, h omega) B X_h` with `B` the mass or stiffness matrix.
pub trait WholeLaw: Sync {
    /// What is known of the law beside its force.
    fn description(&self) -> &'static Description;

    /// Matrix that is multiplied.
    fn basis(&self) -> Basis;

    /// Complex factor of that matrix, proportional to the only parameter, at circular frequency `omega` (rad/s).
    fn factor(&self, value: f64, omega: f64) -> c64;
}

/// An error of a measuring channel: recorded amplitude = `transfer` x true amplitude.
pub trait ChannelLaw: Sync {
    /// What is known of the law beside its transfer.
    fn description(&self) -> &'static Description;

    /// Ratio of recorded to true complex amplitude at circular frequency `omega` (rad/s).
    fn transfer(&self, value: f64, omega: f64) -> c64;

    /// Derivative of [`ChannelLaw::transfer`] by the parameter.
    fn transfer_derivative(&self, value: f64, omega: f64) -> c64;

    /// Value at which the channel is without error.
    fn neutral(&self) -> f64;

    /// The value of two such errors one after the other.
    fn joined(&self, first: f64, second: f64) -> f64;

    /// Whether it turns the phase in proportion to frequency and leaves amplitudes alone, rather than the reverse.
    fn turns_phase(&self) -> bool;

    /// A change of the value that is small at `omega` (rad/s), for difference quotients.
    fn small_step(&self, omega: f64) -> f64;
}
