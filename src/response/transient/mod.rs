//! Prediction of records that are not periodic - decays, hammers, sweeps, noise - with the derivatives that a fit needs.
//!
//! ```text
//! M x'' + C x' + K x + sum_l L_l F_l(d_l, d_l', states) = B u(t),      y = S (x'', x' or x)
//! ```
//!
//! Modes in the band and residual flexibility (`reduction`); the linear part moves exactly between samples in its damped
//! modes under a polynomial of the measured force (`hold`, `system`, `step`, `changes`); local forces are implicit with their mean over a step
//! (`element`); friction is set-valued: it sticks or slips, and a reversal is located within the step (`march`).
//! Derivatives by parameters of laws, stiffness, mass and the initial state are those of the same steps, the instants of
//! reversals included.

mod assembly;
mod changes;
mod derivatives;
mod element;
mod error;
mod exponentials;
mod hold;
mod initial_memory;
mod march;
mod model;
mod perturbation;
mod reduction;
mod segment;
mod setup;
mod step;
mod system;
mod view;
mod writer;

pub use assembly::{has_exact_steps, has_force_in_time};
pub use error::TransientError;
pub use hold::Hold;
pub use model::TransientModel;
pub use perturbation::force_along;
pub use setup::{SampledForces, StepLength, TransientParameter, TransientResponse, TransientSetup};
