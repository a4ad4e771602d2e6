//! Place before law: free forces at candidate locations and what they could explain at most.

pub(crate) mod bound;
pub(crate) mod cell;
pub(crate) mod free_force;
pub(crate) mod location;
