//! Model updating: what the model states wrongly, with priors and scales (Friswell and Mottershead 1995).

pub mod bare;
pub mod corrected;
pub mod detuning;
pub mod parameters;
