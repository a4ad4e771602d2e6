//! One component in a testing machine, say a damper: its displacement is imposed, its force measured. No equation of motion is
//! needed; whole loops over amplitudes and frequencies are predicted by its laws and compared.
//!
//! ```text
//! F(t) = m d'' + sum_j f_j(d, d', states) + F_0
//! ```
//!
//! `m` is the mass that moves with the force cell (0 unless the project gives it), `F_0` the zero of the force cell, one a
//! record. Laws with memory start from rest where the record starts ([`crate::balance::loops`]). Every law, and every sum of two, is scaled to
//! the force on a grid of its shapes, a third law is added where two leave much, the best are fitted, and what predicts loops that were left out wins (`search`).

mod compare;
mod fit;
mod ranking;
mod search;
mod sums;

pub use crate::balance::loops::{ComponentError, Loops};
pub use compare::compare_component;
pub use search::diagnose_component;
