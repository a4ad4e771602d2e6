//! Quadratic spring: `F = stiffness d^2`, an asymmetry. It takes out no energy.

use crate::effects::law::Point;
use crate::effects::{Memoryless, Parameter};

/// Asymmetric spring.
#[derive(Debug)]
pub struct QuadraticStiffness;

const PARAMETERS: [Parameter; 1] = [Parameter::coefficient("stiffness", "N/m^2", "k_2").of_any_sign()];

impl Memoryless for QuadraticStiffness {
    fn list(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn at(&self, p: &[f64], _width: f64, d: f64, _v: f64) -> Point {
        Point { force: p[0] * d * d, by_displacement: 2.0 * p[0] * d, by_velocity: 0.0 }
    }

    fn by_parameter(&self, _p: &[f64], _k: usize, _width: f64, d: f64, _v: f64) -> f64 {
        d * d
    }

    fn cycle_energy(&self, _p: &[f64], _amplitude: f64, _omega: f64) -> Option<f64> {
        Some(0.0)
    }

    fn takes_energy(&self) -> bool {
        false
    }
}
