//! Gap: `F = stiffness (|d| - gap) sgn(d)` beyond the gap, 0 within. It takes out no energy.

use crate::effects::law::Point;
use crate::effects::{Memoryless, Parameter};

/// Clearance on both sides, then a spring.
#[derive(Debug)]
pub struct Gap;

const PARAMETERS: [Parameter; 2] =
    [Parameter::coefficient("stiffness", "N/m", "k_g"), Parameter::shape("gap", "m", "g", 1e-4)];

impl Memoryless for Gap {
    fn list(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn at(&self, p: &[f64], _width: f64, d: f64, _v: f64) -> Point {
        let beyond = d.abs() - p[1];
        if beyond <= 0.0 {
            return Point::default();
        }
        Point { force: p[0] * beyond.copysign(d), by_displacement: p[0], by_velocity: 0.0 }
    }

    fn by_parameter(&self, p: &[f64], k: usize, _width: f64, d: f64, _v: f64) -> f64 {
        let beyond = d.abs() - p[1];
        if beyond <= 0.0 {
            return 0.0;
        }
        if k == 0 { beyond.copysign(d) } else { -p[0] * d.signum() }
    }

    fn cycle_energy(&self, _p: &[f64], _amplitude: f64, _omega: f64) -> Option<f64> {
        Some(0.0)
    }

    fn takes_energy(&self) -> bool {
        false
    }
}
