//! What the structure is predicted to do: frequency response and steady state.
pub mod dynamic_stiffness;
pub mod frequency_response;
pub mod harmonic_balance;
pub mod linear_matrices;
pub mod sensitivity;
pub mod steady_state;
pub mod time_integration;
