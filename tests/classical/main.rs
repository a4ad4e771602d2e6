//! The classical methods on data whose answer is known: exact where theory says so, else the error that theory gives.
#![allow(clippy::unwrap_used, reason = "tests")]

mod all_methods;
#[path = "../common/mod.rs"]
mod common;
mod energy_methods;
mod extraction;
mod modal_methods;
mod receptance_methods;
mod single_degree;
mod support;
