//! Laws regressed on the identified force of a place: start grids, special cases, fingerprints.

mod eliminator;
pub(crate) mod fingerprint;
pub(crate) mod fingerprint_plot;
mod force_matching;
pub(crate) mod friction;
pub(crate) mod generalisations;
pub(crate) mod identified_force;
pub(crate) mod law_force;
pub mod restoring_force;
pub(crate) mod special_cases;
pub(crate) mod start;
mod subsample;
pub(crate) mod two_laws;
