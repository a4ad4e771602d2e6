//! Kernels against closed forms, optimality conditions and slower routes.
#![allow(clippy::unwrap_used, reason = "tests")]

mod beams;
#[path = "../common/mod.rs"]
mod common;
mod damped;
mod frequency_response;
mod least_squares;
mod random;
mod subsets;
