//! Fits on the response, stepwise selection of effects, conclusions, the next test.

mod backward_elimination;
mod beside_corrections;
mod candidate_order;
mod common_factor;
mod competing_model;
pub(crate) mod conclusion;
mod cross_validation;
pub(crate) mod estimator;
pub(crate) mod fit_problem;
pub(crate) mod fits;
pub(crate) mod fitted_model;
mod joint_fit;
pub(crate) mod levenberg_marquardt;
mod localised;
pub(crate) mod next_test;
pub(crate) mod one_level;
mod pairs;
pub(crate) mod reference_model;
mod refinement;
pub(crate) mod search;
pub(crate) mod search_result;
pub(crate) mod sentences;
mod sessions_alike;
mod short_list;
mod single_change;
mod singles;
mod solver_settings;
#[cfg(test)]
mod stated_chain;
pub(crate) mod stepwise;
mod structure_error;
mod successive_linearisation;
mod two_laws;
mod unreliable_channel;
pub(crate) mod updated;
mod weighing;
