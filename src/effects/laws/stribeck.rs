//! Stribeck friction: `F = (force + (static_force - force) exp(-|d'| / velocity)) sgn(d')`, 0 at rest.
//!
//! The energy is `static_force` times the way travelled, exactly, less the smooth rest by the trapezoidal rule. The
//! smoothed law has `sgn v -> v / m` and `|v| -> m` with `m = sqrt(v^2 + width^2)`.

use crate::effects::law::Point;
use crate::effects::memoryless::sign;
use crate::effects::turning::total_variation;
use crate::effects::{Memoryless, Motion, Parameter};

/// Friction that falls from a static to a sliding force with speed.
#[derive(Debug)]
pub struct Stribeck;

const PARAMETERS: [Parameter; 3] = [
    Parameter::shape("force", "N", "F_c", 1.0),
    Parameter::shape("static_force", "N", "F_s", 1.5),
    Parameter::shape("velocity", "m/s", "v_s", 0.01).above(0.0),
];

impl Memoryless for Stribeck {
    fn list(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn at(&self, p: &[f64], width: f64, _d: f64, v: f64) -> Point {
        let [sliding, resting, velocity] = [p[0], p[1], p[2]];
        let (value, slope) = sign(v, width);
        let excess = (resting - sliding) * (-v.hypot(width) / velocity).exp();
        Point {
            force: (sliding + excess) * value,
            by_displacement: 0.0,
            by_velocity: (sliding + excess) * slope - excess * value * value / velocity,
        }
    }

    fn by_parameter(&self, p: &[f64], k: usize, width: f64, _d: f64, v: f64) -> f64 {
        let (value, _) = sign(v, width);
        let speed = v.hypot(width);
        let decay = (-speed / p[2]).exp();
        match k {
            0 => (1.0 - decay) * value,
            1 => decay * value,
            _ => (p[1] - p[0]) * decay * speed / (p[2] * p[2]) * value,
        }
    }

    fn cycle_energy(&self, _p: &[f64], _amplitude: f64, _omega: f64) -> Option<f64> {
        None
    }

    fn exact_energy(&self, p: &[f64], motion: &Motion) -> Option<f64> {
        let fall = |v: &f64| -(-v.abs() / p[2]).exp_m1() * v.abs();
        let lost: f64 = motion.velocity.iter().map(fall).sum::<f64>() * motion.step();
        Some(p[1] * total_variation(motion) - (p[1] - p[0]) * lost)
    }

    fn is_discontinuous(&self) -> bool {
        true
    }
}
