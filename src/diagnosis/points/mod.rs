//! The same questions for measured points without a model: energies alone.

pub mod balance;
pub mod energies;
pub mod search;
mod uncertainty;
