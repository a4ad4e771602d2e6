//! Delay of a channel: recorded `Y_h = exp(-i w delay)` times the true one at `w = h omega`; above 0, recorded late.

use crate::effects::description::Description;
use crate::effects::law::ChannelLaw;
use crate::effects::parameter::Parameter;
use crate::effects::symbol::Mark;
use faer::c64;

/// A channel that is recorded late (or early, if negative).
#[derive(Debug)]
pub(crate) struct Delay;

const DESCRIPTION: Description = Description {
    dissipates: false,
    symbol: &[
        // A clock in the line: the channel is late.
        Mark::Line(&[(-0.5, 0.0), (-0.3, 0.0)]),
        Mark::Line(&[(0.3, 0.0), (0.5, 0.0)]),
        Mark::Ring(0.3, 8.4),
        Mark::Line(&[(0.0, -5.5), (0.0, 0.0), (0.15, 2.5)]),
    ],
    ..Description::new(
        "channel delay",
        "y(t - tau)",
        "A channel recorded late against the others: filters, multiplexing, cables.",
        &[Parameter { linear: false, typical: 0.0, ..Parameter::coefficient("delay", "s", "tau").of_any_sign() }],
    )
};

impl ChannelLaw for Delay {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn transfer(&self, value: f64, omega: f64) -> c64 {
        let (sin, cos) = (omega * value).sin_cos();
        c64::new(cos, -sin)
    }

    fn transfer_derivative(&self, value: f64, omega: f64) -> c64 {
        c64::new(0.0, -omega) * self.transfer(value, omega)
    }

    fn neutral(&self) -> f64 {
        0.0
    }

    fn joined(&self, first: f64, second: f64) -> f64 {
        first + second
    }

    fn turns_phase(&self) -> bool {
        true
    }

    fn small_step(&self, omega: f64) -> f64 {
        1e-5 / omega.max(1e-3)
    }
}
