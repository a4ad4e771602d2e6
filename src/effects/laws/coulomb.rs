//! Coulomb friction: `F = force sgn(d')`, 0 at rest. Energy per cycle of `d = X cos(omega t)`: `4 force X`; of any
//! periodic motion: `force` times the way travelled.
//!
//! The force is set-valued at rest, so the tangent of the law itself is zero almost everywhere. Solvers use the smoothed
//! law `force v / sqrt(v^2 + width^2)` and take `width` to its limit.

use crate::effects::law::Point;
use crate::effects::memoryless::sign;
use crate::effects::turning::total_variation;
use crate::effects::{Memoryless, Motion, Parameter};

/// Coulomb friction.
#[derive(Debug)]
pub struct Coulomb;

const PARAMETERS: [Parameter; 1] = [Parameter::coefficient("force", "N", "F_c")];

impl Memoryless for Coulomb {
    fn list(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn at(&self, p: &[f64], width: f64, _d: f64, v: f64) -> Point {
        let (value, slope) = sign(v, width);
        Point { force: p[0] * value, by_displacement: 0.0, by_velocity: p[0] * slope }
    }

    fn by_parameter(&self, _p: &[f64], _k: usize, width: f64, _d: f64, v: f64) -> f64 {
        sign(v, width).0
    }

    fn cycle_energy(&self, p: &[f64], amplitude: f64, _omega: f64) -> Option<f64> {
        Some(4.0 * p[0] * amplitude)
    }

    fn exact_energy(&self, p: &[f64], motion: &Motion) -> Option<f64> {
        Some(p[0] * total_variation(motion))
    }

    fn is_discontinuous(&self) -> bool {
        true
    }
}
