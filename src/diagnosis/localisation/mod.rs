//! Place before law: free forces at candidate locations and what they could explain at most.

pub mod bound;
pub mod cell;
pub mod free_force;
pub mod location;
