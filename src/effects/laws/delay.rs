//! Delay of a channel: recorded `Y_h = exp(-i w delay)` times the true one at `w = h omega`; above 0, recorded late.

use crate::effects::{ChannelLaw, Parameter};
use faer::c64;

/// A channel that is recorded late (or early, if negative).
#[derive(Debug)]
pub struct Delay;

const PARAMETER: Parameter =
    Parameter { linear: false, typical: 0.0, ..Parameter::coefficient("delay", "s", "tau").of_any_sign() };

impl ChannelLaw for Delay {
    fn parameter(&self) -> &'static Parameter {
        &PARAMETER
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
}
