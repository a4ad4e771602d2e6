//! Records that are not steady - decays, hammers, sweeps, noise - compared with the model, and what the model lacks in them.
//!
//! The model's record follows from the measured force and an initial state that is fitted with it (`fit`); a free force at
//! a place, on the spectrum of the whole record with its end states as unknowns, says where (`localisation`); laws at the
//! places that matter are fitted on the record itself, short parts of it first (`diagnose`); frequency and damping ratio against
//! amplitude are read by one estimator from record and model ([`amplitude`]).

pub mod amplitude;
mod backward_elimination;
mod channel_delays;
pub(crate) mod channel_noise;
mod chord_steps;
mod coarse_steps;
pub(crate) mod compare;
mod conclusion;
mod corrections_alone;
pub(crate) mod data;
mod decays;
pub(crate) mod diagnose;
mod equal_work;
mod errors;
mod evidence;
mod fit;
mod fit_motion;
mod fitted;
mod force_noise;
mod free_force;
mod freed_corrections;
mod frequencies;
mod generalisations;
mod initial_states;
mod laws;
mod lengthening;
pub(crate) mod localisation;
mod long_steps;
mod missing_force;
mod modal_equations;
mod mode_damping;
mod model_errors;
mod model_updating;
mod moving_base;
mod multi_start;
mod multiple_shooting;
mod neighbouring_places;
mod next_test;
mod normal_equations;
mod observable_modes;
mod part_directions;
mod probability;
mod problem;
mod pruning;
mod regression;
mod restrictions;
mod score;
mod search;
mod shape_errors;
mod single_change;
mod special_cases;
pub mod spectrum;
mod starts;
mod stated_fit;
mod stated_sizes;
mod steps;
mod suggestions;
mod supports;
pub(crate) mod variables;
mod weights;

pub use compare::{RecordComparison, compare_records};
pub use data::{RecordDiagnosisError, Records};
pub(crate) use diagnose::agreement_with_records;
pub use diagnose::diagnose_records;
pub use missing_force::missing_force;
