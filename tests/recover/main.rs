//! Simulate, identify, same: models that carry their own exact answer.
#![allow(clippy::unwrap_used, reason = "tests")]

mod bad_input;
mod beam;
mod chain;
mod change;
#[path = "../common/mod.rs"]
mod common;
mod keep;
mod many;
mod noise;
mod points;
mod ratios;
mod support;
