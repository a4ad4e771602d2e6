//! Kernels against closed forms, optimality conditions and slower routes.
#![allow(clippy::unwrap_used, reason = "tests")]

mod beams;
mod damped;
mod frequency_response;
mod least_squares;
mod random;
mod subsets;
