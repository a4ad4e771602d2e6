//! Quadratic (fluid) damping: `F = c d' |d'|`, `c` in N s^2/m^2. Energy per cycle of `d = X cos(omega t)`:
//! `(8/3) c omega^2 X^3`.

use crate::effects::law::Point;
use crate::effects::{Memoryless, Parameter};

/// Quadratic damping.
#[derive(Debug)]
pub struct Quadratic;

const PARAMETERS: [Parameter; 1] = [Parameter::coefficient("c", "N s^2/m^2", "c_2")];

impl Memoryless for Quadratic {
    fn list(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn at(&self, p: &[f64], _width: f64, _d: f64, v: f64) -> Point {
        Point { force: p[0] * v * v.abs(), by_displacement: 0.0, by_velocity: 2.0 * p[0] * v.abs() }
    }

    fn by_parameter(&self, _p: &[f64], _k: usize, _width: f64, _d: f64, v: f64) -> f64 {
        v * v.abs()
    }

    fn cycle_energy(&self, p: &[f64], amplitude: f64, omega: f64) -> Option<f64> {
        Some(8.0 / 3.0 * p[0] * omega * omega * amplitude.powi(3))
    }
}
