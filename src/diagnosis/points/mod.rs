//! The same questions for measured points without a model: energies alone.

pub mod balance;
mod conclusion;
pub mod energies;
mod evidence;
pub mod search;
mod uncertainty;
