//! Gain of a channel: recorded `Y_h = gain` times the true one at every frequency.

use crate::effects::description::Description;
use crate::effects::law::ChannelLaw;
use crate::effects::parameter::Parameter;
use crate::effects::symbol::{Mark, Tone};
use faer::c64;

/// A channel that reads too large or too small.
#[derive(Debug)]
pub(crate) struct Gain;

const DESCRIPTION: Description = Description {
    dissipates: false,
    symbol: &[
        // A triangle in the line: the channel reads too much or too little.
        Mark::Line(&[(-0.5, 0.0), (-0.28, 0.0)]),
        Mark::Area(&[(-0.28, -8.0), (0.3, 0.0), (-0.28, 8.0)], Tone::Faint),
        Mark::Line(&[(0.3, 0.0), (0.5, 0.0)]),
    ],
    ..Description::new(
        "channel gain",
        "g y(t)",
        "A channel that reads too large or too small: a wrong sensitivity.",
        &[Parameter::coefficient("gain", "", "g").above(0.0)],
    )
};

impl ChannelLaw for Gain {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
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

    fn joined(&self, first: f64, second: f64) -> f64 {
        first * second
    }

    fn turns_phase(&self) -> bool {
        false
    }

    fn small_step(&self, _omega: f64) -> f64 {
        1e-5
    }
}
