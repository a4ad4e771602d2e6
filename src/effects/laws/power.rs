//! Power-law damping: `F = c |d'|^exponent sgn(d')`; exponent 0 is Coulomb friction, 1 viscous, 2 quadratic.
//!
//! Energy per cycle of `d = X cos(omega t)`: `c omega^e X^(e+1) * 2 sqrt(pi) Gamma((e+2)/2) / Gamma((e+3)/2)`.
//!
//! Below exponent 1 the slope at rest is infinite; there the smoothed law `c v (v^2 + width^2)^((e-1)/2)` is for solvers,
//! and the tangent of the law itself is given as 0 at rest.

use crate::effects::law::{Ends, Point};
use crate::effects::{Memoryless, Parameter};
use statrs::function::gamma::gamma;
use std::f64::consts::PI;

/// Power-law damping.
#[derive(Debug)]
pub struct Power;

const PARAMETERS: [Parameter; 2] = [
    Parameter::coefficient("c", "N (s/m)^e", "c_e"),
    Parameter::shape("exponent", "", "e", 1.5).within(0.0, 5.0, Ends::Closed),
];

impl Memoryless for Power {
    fn list(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn at(&self, p: &[f64], width: f64, _d: f64, v: f64) -> Point {
        let [c, exponent] = [p[0], p[1]];
        let speed = v.hypot(width);
        if speed == 0.0 {
            let by_velocity = if exponent == 1.0 { c } else { 0.0 };
            return Point { force: 0.0, by_displacement: 0.0, by_velocity };
        }
        let secant = c * speed.powf(exponent - 1.0);
        let slope = secant * (1.0 + (exponent - 1.0) * (v / speed).powi(2));
        Point { force: secant * v, by_displacement: 0.0, by_velocity: slope }
    }

    fn by_parameter(&self, p: &[f64], k: usize, width: f64, _d: f64, v: f64) -> f64 {
        let speed = v.hypot(width);
        if speed == 0.0 {
            return 0.0;
        }
        let unit = v * speed.powf(p[1] - 1.0);
        if k == 0 { unit } else { p[0] * unit * speed.ln() }
    }

    fn cycle_energy(&self, p: &[f64], amplitude: f64, omega: f64) -> Option<f64> {
        let [c, e] = [p[0], p[1]];
        let shape = 2.0 * PI.sqrt() * gamma(0.5 * e + 1.0) / gamma(0.5 * e + 1.5);
        Some(c * omega.powf(e) * amplitude.powf(e + 1.0) * shape)
    }

    fn is_discontinuous(&self) -> bool {
        true
    }
}
