//! Kernels against closed forms, optimality conditions and slower routes.
#![allow(clippy::unwrap_used, reason = "tests")]

mod random;
mod subsets;
