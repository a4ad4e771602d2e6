//! What the structure is predicted to do: frequency response and steady state.
pub mod frequency_response;
pub mod steady_state;
