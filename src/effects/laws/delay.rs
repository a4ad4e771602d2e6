//! Under construction.
use super::viscous::Viscous;
use crate::effects::{ChannelLaw, Law, Parameter};
use faer::c64;

/// Delay.
#[derive(Debug)]
pub struct Delay;

impl ChannelLaw for Delay {
    fn parameter(&self) -> &'static Parameter {
        &Viscous.parameters()[0]
    }
    fn transfer(&self, value: f64, omega: f64) -> c64 {
        c64::new(0.0, omega * value)
    }
    fn transfer_derivative(&self, value: f64, omega: f64) -> c64 {
        c64::new(0.0, omega * value)
    }
    fn neutral(&self) -> f64 {
        0.0
    }
}
