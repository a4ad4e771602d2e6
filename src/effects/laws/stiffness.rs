//! Spring: `F = stiffness d`. It stores energy and takes out none. Negative: the model is too stiff there.

use crate::effects::law::Point;
use crate::effects::{Memoryless, Parameter};
use faer::c64;

/// Linear spring, missing or too much.
#[derive(Debug)]
pub struct Stiffness;

const PARAMETERS: [Parameter; 1] = [Parameter::coefficient("stiffness", "N/m", "k").of_any_sign()];

impl Memoryless for Stiffness {
    fn list(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn at(&self, p: &[f64], _width: f64, d: f64, _v: f64) -> Point {
        Point { force: p[0] * d, by_displacement: p[0], by_velocity: 0.0 }
    }

    fn by_parameter(&self, _p: &[f64], _k: usize, _width: f64, d: f64, _v: f64) -> f64 {
        d
    }

    fn cycle_energy(&self, _p: &[f64], _amplitude: f64, _omega: f64) -> Option<f64> {
        Some(0.0)
    }

    fn stiffness_at(&self, p: &[f64], _omega: f64) -> Option<c64> {
        Some(c64::new(p[0], 0.0))
    }

    fn takes_energy(&self) -> bool {
        false
    }
}
