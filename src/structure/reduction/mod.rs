//! A large sparse model reduced to the degrees of freedom of interest.
//!
//! ```text
//! x = T q,   T = [ I    0  ]  kept DOFs b         M_r = T^T M T,   K_r = T^T K T
//!                [ Psi  Phi]  inner DOFs i
//! Guyan:          Psi = -K_ii^-1 K_ib,                                   no Phi
//! Craig-Bampton:  Psi = -K_ii^-1 K_ib less its part in Phi,  Phi: modes of (K_ii, M_ii) up to a frequency
//! ```
//!
//! R. J. Guyan, AIAA J. 3 (1965) 380; R. R. Craig and M. C. C. Bampton, AIAA J. 6 (1968) 1313. Where the kept DOFs
//! leave rigid motions free, `K_ii` is singular: those motions are among `Phi`, and `Psi` is found with `K_ii + s M_ii` in steps.
//! The error is told on the modes in the band: the whole model's, by block Lanczos, against those of the reduced one.

mod check;
mod mode_check;
pub(super) mod outcome;
mod pencil;
mod reduce;
mod request;

pub(crate) use mode_check::ModeCheck;
pub(crate) use outcome::Reduction;
pub(crate) use reduce::reduce;
pub(crate) use request::{ReductionMethod, SparseSystem, Wanted};

#[cfg(test)]
mod tests;
