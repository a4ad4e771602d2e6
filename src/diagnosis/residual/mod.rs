//! What was measured, what the model predicts, and what is left, whitened.

pub mod branch;
pub mod breakdown;
pub mod data;
pub mod energy_balance;
pub mod prediction;
pub mod run_nuisance;
pub mod whiteness;
pub mod whitening;
