//! Periodic steady state by harmonic balance with alternating frequency and time.
//!
//! ```text
//! Z(h w) X_h + sum_l L_l F_l,h = F_ext,h,     h = 0..H,      F_l = P f_l(d_l, d_l'),     d_l = L_l^T x
//! ```
//!
//! The linear rest is condensed exactly to the relative motions of the nonlinear sources (`condense`), whose forces are
//! found by a damped Newton method with analytic Jacobian (`iterate`, `newton`, `legs`). Friction is set-valued, not regularised.
//! Harmonics are added until the response no longer changes (`solve`); turning points are passed by arc length
//! (`continuation`); stability is that of Floquet's multipliers (`stability`).

mod answers;
mod arc;
mod compliance;
mod condense;
mod continuation;
mod dense;
mod error;
mod excitation;
mod fourier;
mod friction;
mod iterate;
mod kept;
mod level;
mod linear_leg;
mod modal_basis;
mod model;
mod newton;
mod nonlinear_leg;
mod outcome;
mod prepared;
mod resonant;
mod solve;
mod stability;

pub(crate) use compliance::LinearPart;
pub(crate) use condense::Condensed;
pub(crate) use dense::Lu;
pub(crate) use fourier::add_amplitude;
pub(crate) use newton::Balance;
pub(crate) use prepared::Prepared;
pub(crate) use solve::richardson;

pub use continuation::{Sweep, SweepEnd, SweepPoint, SweepSettings, branches, nearest, sweep};
pub use error::{ModelError, ResponseError};
pub use excitation::{Excitation, HarmonicForce};
pub use model::{ForwardModel, RunModel};
pub use outcome::{Attempt, Response, SourceForce, Status, Step};
pub use stability::{is_stable, multipliers};

use crate::control::Control;

/// How many harmonics, and how exactly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Harmonics of the first solution.
    pub harmonics: usize,
    /// Most harmonics; no more than `harmonics` keeps their number fixed and estimates the truncation error only.
    pub most_harmonics: usize,
    /// Harmonics whose change decides whether there are enough.
    pub watched: usize,
    /// Largest change of a watched harmonic from one number of harmonics to the next, relative to the largest amplitude.
    pub truncation: f64,
    /// Whether to estimate the truncation error where only one number of harmonics is solved (costs as much again).
    pub estimate: bool,
    /// Relative residual of the force balance.
    pub tolerance: f64,
    /// Newton steps for one number of harmonics from which on no new attempt is made and the response is given up.
    pub patience: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            harmonics: 7,
            most_harmonics: 127,
            watched: 7,
            truncation: 5e-5,
            estimate: true,
            tolerance: 1e-10,
            patience: usize::MAX,
        }
    }
}

impl Settings {
    /// Whether to make no further attempt after so many Newton steps: patience is at its end, or somebody who has little of
    /// it waits for the best so far.
    pub(crate) fn gives_up(&self, steps: usize, control: &Control) -> bool {
        steps > self.patience || (self.patience < usize::MAX && control.is_late())
    }

    /// A fixed number of harmonics.
    pub fn fixed(harmonics: usize) -> Self {
        Self { harmonics, most_harmonics: harmonics, ..Self::default() }
    }
}
