//! Projects with a hidden effect: the comparison sees it, the diagnosis names it.
#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests")]

#[path = "../common/mod.rs"]
mod common;
mod common_factor;
mod comparison;
mod energy_rows;
mod force_gain;
mod frequency_responses;
mod hidden;
mod hysteresis;
mod level_series;
mod missing_force;
mod points;
mod quiet_sensors;
#[path = "../../examples/hidden_effects/random.rs"]
#[allow(dead_code, reason = "shared with the example, which uses all of it")]
mod random;
#[path = "../../examples/hidden_effects/records.rs"]
mod records;
mod robust;
mod samples;
#[path = "../../examples/hidden_effects/sizing.rs"]
mod sizing;
#[path = "../../examples/hidden_effects/specimen.rs"]
#[allow(dead_code, reason = "shared with the example, which uses all of it")]
mod specimen;
mod stops;
#[path = "../../examples/hidden_effects/suite.rs"]
#[allow(dead_code, reason = "shared with the example, which uses all of it")]
mod suite;
mod two_laws;
mod unreliable_data;
