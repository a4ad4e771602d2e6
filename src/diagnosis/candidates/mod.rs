//! Laws regressed on the identified force of a place: start grids, special cases, fingerprints.

mod eliminator;
pub mod fingerprint;
pub mod fingerprint_plot;
pub mod friction;
pub mod generalisations;
pub mod identified_force;
pub(crate) mod law_force;
pub mod restoring_force;
pub mod special_cases;
pub mod start;
mod thinning;
