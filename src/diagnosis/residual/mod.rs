//! What was measured, what the model predicts, and what is left, whitened.

pub(crate) mod branch;
pub mod breakdown;
pub mod comparison;
pub mod data;
pub(crate) mod energy_balance;
mod left_out_runs;
pub(crate) mod levels;
pub mod prediction;
pub(crate) mod run_nuisance;
pub(crate) mod run_selection;
pub(crate) mod transfers;
pub mod whiteness;
pub(crate) mod whitening;
