//! Records that are not steady: prediction with derivatives, exact spectrum, amplitude curves, what the model lacks.
#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests")]

mod amplitude;
#[path = "../common/mod.rs"]
mod common;
mod complete;
mod diagnose;
mod hidden_mass;
mod measured;
mod motor_drive;
mod prediction;
mod spectrum;
mod structural_damping;
