//! Time integration: the independent judge of harmonic balance, and the way to transients.
//!
//! ```text
//! M x'' + C x' + K x + sum_l L_l F_l(t) = f(t)
//! ```
//!
//! The linear rest moves exactly over a step under forces that are constant in it (`propagator`); nonlinear forces are
//! implicit, friction is set-valued (time stepping with complementarity, `element`); the periodic motion is the fixed
//! point of one period (`settle`). Smooth laws and laws with memory are of second order in the step, friction of first
//! order with a small constant, since a reversal falls anywhere within a step.
//!
//! Linear dashpots, springs, masses and proportional damping belong to the linear rest. Laws that are defined harmonic
//! by harmonic (hysteretic, fractional, loss factor) have no force in time and are refused.

mod element;
mod model;
pub(crate) mod propagator;
mod settle;

pub use model::{TimeError, TimeModel};
pub use settle::{Samples, Settling};
