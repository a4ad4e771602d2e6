//! Periodic steady state by harmonic balance with alternating frequency and time.
//!
//! ```text
//! Z(h w) X_h + sum_l L_l F_l,h = F_ext,h,     h = 0..H,      F_l = P f_l(d_l, d_l'),     d_l = L_l^T x
//! ```
//!
//! The linear rest is condensed exactly to the relative motions of the nonlinear sources (`condense`), whose forces are
//! found by a damped Newton method with analytic Jacobian (`iterate`, `newton`, `legs`). Friction is set-valued, not regularised.
//! Harmonics are added until the response no longer changes (`solve`); turning points are passed by arc length
//! (`continuation`: `sweep` over frequency, `arc` over the level of the force; `branches` at one force); stability is that of Floquet's
//! multipliers (`stability`).

mod arc;
mod branches;
mod compliance;
mod condense;
mod continuation;
mod dense;
mod error;
mod excitation;
mod fourier;
mod friction;
mod harmonic_system;
mod iterate;
mod law_evaluation;
mod linear_leg;
mod modal_basis;
mod model;
mod newton;
mod nonlinear_leg;
mod outcome;
mod prepared;
mod resonant;
mod settings;
mod solve;
mod stability;
mod sweep;
mod unknown_subset;

pub(crate) use compliance::LinearPart;
pub(crate) use condense::Condensed;
pub(crate) use dense::Lu;
pub(crate) use fourier::add_amplitude;
pub(crate) use newton::Balance;
pub(crate) use prepared::Prepared;
pub(crate) use solve::richardson;

pub use error::{ModelError, ResponseError};
pub use excitation::{Excitation, HarmonicForce};
pub use model::{ForwardModel, RunModel};
pub use outcome::{Attempt, ConvergenceStep, Response, SourceForce, Status};
pub use settings::Settings;
pub use stability::{is_stable, multipliers};
pub use sweep::{Sweep, SweepEnd, SweepPoint, SweepSettings, branches, sweep};
