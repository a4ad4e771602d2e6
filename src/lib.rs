//! Dashpot tells a vibration engineer where a structure loses its energy, how much, by which mechanism, and what the
//! model still lacks.
//!
//! # The problem in equations
//!
//! A structure with mass `M` and stiffness `K` is driven by a periodic force `f(t)` of period `T = 2 pi / omega`:
//!
//! ```text
//! M x'' + K x + sum_j F_j(d_j, d_j') L_j = f(t),      d_j = L_j^T x
//! ```
//!
//! Over one period the conservative terms do no work, so the exciter's work equals what the sources take out (4.5):
//!
//! ```text
//! e_r = integral v . f dt = sum_j c_j G_rj,      G_rj = integral d_j' q_j(d_j, d_j') dt      (4.22)
//! ```
//!
//! one equation a run `r`, one column a source `j` of unit-coefficient force law `q_j`.
//!
//! # Notation
//!
//! Every periodic quantity is `y(t) = y0 + Re sum_h Y_h exp(i h omega t)`; a complex amplitude `Y = a - i b` stands for
//! `a cos + b sin`. SI units throughout the library. Bracketed numbers are equations of M. Prandina, *Spatial Damping
//! Identification*, Liverpool 2010.
//!
//! # The floors
//!
//! Dependence runs downwards only (`tests/floors.rs` holds it): [`control`], [`math`] - [`structure`], [`effects`],
//! [`measurement`] - [`response`], [`balance`] - [`identify`], [`classical`], [`diagnosis`] - [`exchange`],
//! [`session`], [`display`] - [`plots`] - [`report`] - [`cli`].
//!
//! # As a library
//!
//! Four questions, ten lines each: [`identify::identify`] (which sources damp a structure), [`diagnosis::compare()`] (how far a
//! model is from its measurement), [`diagnosis::diagnose()`] (what it lacks) and [`response::simulation::Simulator`] (how it
//! moves). A project is read by [`exchange::project::load()`]; structures and sources can be made without files as well.

#[cfg(test)]
extern crate self as dashpot;
#[cfg(test)]
#[path = "../tests/common/mod.rs"]
mod common;

pub mod balance;
pub mod classical;
pub mod cli;
pub mod control;
pub mod diagnosis;
pub mod display;
pub mod effects;
pub mod exchange;
pub mod identify;
pub mod math;
pub mod measurement;
pub mod plots;
pub mod report;
pub mod response;
pub mod session;
pub mod structure;
#[cfg(feature = "window")]
pub mod window;
