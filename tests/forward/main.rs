//! The forward model against independent routes: time stepping, closed forms, finite differences.
#![allow(clippy::unwrap_used, reason = "tests")]

mod against_time;
mod case_three;
mod closed_forms;
#[path = "../common/mod.rs"]
mod common;
mod comparison;
mod derivatives;
mod folds;
mod harmonic_laws;
mod hysteresis;
mod portrait;
mod recorded;
mod resonance;
mod robustness;
mod support;
mod transients;
