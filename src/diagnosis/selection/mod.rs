//! Fits on the response, stepwise selection of effects, conclusions, the next test.

mod beside_corrections;
pub mod conclusion;
pub mod estimator;
mod exactness;
pub mod fit_problem;
pub mod fits;
pub mod fitted_model;
mod followed;
pub(crate) mod found;
mod joint_fit;
mod left_out;
pub mod levenberg_marquardt;
mod localised;
pub mod next_test;
mod pairs;
pub mod reference_model;
pub mod search;
pub mod sentences;
mod short_list;
mod single_change;
mod singles;
pub mod stepwise;
pub mod updated;
mod weighing;
