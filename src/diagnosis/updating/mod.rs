//! Model updating: what the model states wrongly, with priors and scales (Friswell and Mottershead 1995).

pub(crate) mod absorbed_damping;
pub(crate) mod base_load;
pub(crate) mod common_damping;
pub(crate) mod correction;
pub(crate) mod detuning;
pub(crate) mod limited_step;
pub(crate) mod linearisation_error;
pub(crate) mod marginalisation;
pub(crate) mod measured_motion;
pub(crate) mod modal_expansion;
pub(crate) mod noise_model;
pub mod parameters;
pub(crate) mod part_error;
pub(crate) mod parts;
pub(crate) mod plausibility;
pub mod scales;
pub mod scatter;
pub(crate) mod serial_correlation;
pub(crate) mod size_factor;
