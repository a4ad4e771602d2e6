//! The same questions for measured points without a model: energies alone.

pub(crate) mod balance;
mod conclusion;
pub(crate) mod energies;
mod evidence;
mod measured_runs;
pub(crate) mod search;
mod uncertainty;
