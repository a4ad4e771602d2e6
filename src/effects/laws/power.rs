//! Power-law damping: `F = c |d'|^exponent sgn(d')`; exponent 0 is Coulomb friction, 1 viscous, 2 quadratic.
//!
//! Energy per cycle of `d = X cos(omega t)`: `c omega^e X^(e+1) * 2 sqrt(pi) Gamma((e+2)/2) / Gamma((e+3)/2)`.
//!
//! Below exponent 1 the slope at rest is infinite; there solvers ask for the speed at which `F(v) + r v = s`, and the
//! slope of the law itself is given as 0 at rest.

use crate::effects::description::{Description, Exponents};
use crate::effects::effect::Effect;
use crate::effects::law::{Point, Variable};
use crate::effects::limits::{CLOSE, Limit, near};
use crate::effects::memoryless::MemorylessLaw;
use crate::effects::parameter::{Ends, Parameter};
use crate::effects::set_valued::Steep;
use crate::effects::symbol::Mark;
use statrs::function::gamma::gamma;
use std::f64::consts::PI;

/// Power-law damping.
#[derive(Debug)]
pub(crate) struct Power;

const DESCRIPTION: Description = Description {
    shapes: |_| [0.25, 0.5, 0.75, 1.3, 1.6, 2.5, 3.0].map(|e| vec![1.0, e]).to_vec(),
    exponents: |p| Exponents::damping(p[1] - 1.0, p[1] - 1.0),
    limits: &[
        Limit { law: Effect::Coulomb, holds: |p, _| near(p[1], 0.0), parameters: |p| vec![p[0]] },
        Limit { law: Effect::Viscous, holds: |p, _| near(p[1], 1.0), parameters: |p| vec![p[0]] },
        Limit { law: Effect::Quadratic, holds: |p, _| near(p[1], 2.0), parameters: |p| vec![p[0]] },
    ],
    disguised: |p| p[1] < CLOSE,
    symbol: &[Mark::Dashpot(-0.5, 0.5), Mark::Arrow],
    example: &[2.0, 0.5],
    ..Description::new(
        "power-law damping",
        "c_e |d'|^e sgn(d')",
        "A force that grows with a power of velocity: orifices, seals, between friction and drag.",
        &[
            Parameter::coefficient("c", "N (s/m)^e", "c_e"),
            Parameter::shape("exponent", "", "e", 1.5).within(0.0, 5.0, Ends::Closed),
        ],
    )
};

impl MemorylessLaw for Power {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn variable(&self) -> Variable {
        Variable::Velocity
    }

    fn at(&self, p: &[f64], _d: f64, v: f64) -> Point {
        let [c, exponent] = [p[0], p[1]];
        if v == 0.0 {
            let by_velocity = if exponent == 1.0 { c } else { 0.0 };
            return Point { force: 0.0, by_displacement: 0.0, by_velocity };
        }
        let secant = c * v.abs().powf(exponent - 1.0);
        Point { force: secant * v, by_displacement: 0.0, by_velocity: secant * exponent }
    }

    fn by_parameter(&self, p: &[f64], k: usize, _d: f64, v: f64) -> f64 {
        self.by(p, k, v.abs()) * v.signum()
    }

    fn cycle_energy(&self, p: &[f64], amplitude: f64, omega: f64) -> Option<f64> {
        let [c, e] = [p[0], p[1]];
        let shape = 2.0 * PI.sqrt() * gamma(0.5 * e + 1.0) / gamma(0.5 * e + 1.5);
        Some(c * omega.powf(e) * amplitude.powf(e + 1.0) * shape)
    }

    fn is_steep(&self, p: &[f64]) -> bool {
        p[1] < 1.0
    }

    fn steep(&self) -> Option<&dyn Steep> {
        Some(self)
    }
}

impl Steep for Power {
    /// By Newton's method in `y = v^e` where that is well scaled.
    fn speed(&self, p: &[f64], r: f64, s: f64) -> f64 {
        let [c, e] = [p[0].max(0.0), p[1]];
        if c == 0.0 || s == 0.0 {
            return s / r;
        }
        if e < 1e-3 {
            return (s - c).max(0.0) / r;
        }
        // In y the left side is convex and rising, so Newton from above falls monotonically to the root.
        let mut y = (s / c).min((s / r).powf(e));
        for _ in 0..60 {
            let v = y.powf(1.0 / e);
            let slope = c + r * v / (e * y.max(f64::MIN_POSITIVE));
            let step = (c * y + r * v - s) / slope;
            y = (y - step).max(0.0);
            if step.abs() <= 1e-15 * y {
                break;
            }
        }
        y.powf(1.0 / e)
    }

    fn slope(&self, p: &[f64], speed: f64) -> f64 {
        match p[0] {
            c if c <= 0.0 => 0.0,
            c if speed > 0.0 => c * p[1] * speed.powf(p[1] - 1.0),
            _ => f64::INFINITY,
        }
    }

    fn by(&self, p: &[f64], k: usize, speed: f64) -> f64 {
        if speed == 0.0 {
            return 0.0;
        }
        let raised = speed.powf(p[1]);
        if k == 0 { raised } else { p[0] * raised * speed.ln() }
    }
}
