//! Gain of a channel: recorded `Y_h = gain` times the true one at every frequency.

use crate::effects::{ChannelLaw, Parameter};
use faer::c64;

/// A channel that reads too large or too small.
#[derive(Debug)]
pub struct Gain;

const PARAMETER: Parameter = Parameter::coefficient("gain", "", "g").above(0.0);

impl ChannelLaw for Gain {
    fn parameter(&self) -> &'static Parameter {
        &PARAMETER
    }

    fn transfer(&self, value: f64, _omega: f64) -> c64 {
        c64::new(value, 0.0)
    }

    fn transfer_derivative(&self, _value: f64, _omega: f64) -> c64 {
        c64::new(1.0, 0.0)
    }

    fn neutral(&self) -> f64 {
        1.0
    }
}
