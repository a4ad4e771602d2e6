//! Published numbers, at the tolerance that the source supports.
#![allow(clippy::unwrap_used, reason = "tests")]

mod case_beam;
mod case_friction;
#[path = "../common/mod.rs"]
mod common;
mod comparison;
mod energy_support;
mod incompleteness;
mod structures;
mod wing;
