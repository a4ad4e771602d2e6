//! What the structure is predicted to do: frequency response, periodic steady state, records of it.

pub mod dynamic_stiffness;
mod equivalent_viscous;
pub mod frequency_response;
pub(crate) mod hammer;
pub mod harmonic_balance;
pub mod linear_matrices;
mod observation;
pub mod portrait;
pub mod recording;
pub mod sensitivity;
pub mod simulation;
pub mod simulation_in_time;
pub mod steady_state;
pub mod synthesis;
pub mod time_integration;
pub mod transient;
