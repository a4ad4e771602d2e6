//! What the model lacks: compare it with the measurement, find the missing effect, its place and its size.
//!
//! The comparison is made on what was measured: complex amplitudes `Y_c,h` of every response channel of every run, the
//! measured harmonics of the force being the input (exciters are never pure). With `X_h` the displacements of the model
//! and `q` the number of times a channel differentiates, the residual of a run is
//!
//! ```text
//! e_c,h = Y_c,h - (i h w)^q X_c,h,        covariance  S_h = diag(s_c,h^2) + sum_f a_f,h s_f,h^2 a_f,h^H
//! ```
//!
//! where `a_f` is the response to the force channel `f`, whose noise reaches every channel alike. All fits minimise
//! `chi^2 = sum e^H S^-1 e`. The search goes *place before law*: a free complex force at a place explains the residual
//! whatever the law (`localisation`); the law is read from that force against the motion ([`candidates`]); the short list is fitted
//! on the response itself (`selection`) and ranked by evidence ([`diagnose()`]).

pub mod candidates;
pub mod channels;
pub(crate) mod combined;
pub mod compare;
pub mod component;
pub mod diagnose;
mod errors_on_all_runs;
pub(crate) mod localisation;
pub(crate) mod points;
pub mod records;
pub mod residual;
pub mod result;
pub mod run_fault;
pub(crate) mod selection;
mod unreliable_runs;
pub mod updating;

pub use compare::{Comparison, compare};
pub use diagnose::diagnose;
pub use residual::data::{DiagnosisError, Problem};
pub use result::Diagnosis;
