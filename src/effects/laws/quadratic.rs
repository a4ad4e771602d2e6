//! Quadratic (fluid) damping: `F = c d' |d'|`, `c` in N s^2/m^2. Energy per cycle of `d = X cos(omega t)`:
//! `(8/3) c omega^2 X^3`.

use crate::effects::description::{Description, Exponents};
use crate::effects::law::{Point, Variable};
use crate::effects::memoryless::MemorylessLaw;
use crate::effects::parameter::Parameter;
use crate::effects::symbol::{HALF_WIDTH, Mark, Tone};

/// Quadratic damping.
#[derive(Debug)]
pub(crate) struct Quadratic;

const FLUID: &[(f32, f32)] = &[(-0.2, -HALF_WIDTH), (0.5, -HALF_WIDTH), (0.5, HALF_WIDTH), (-0.2, HALF_WIDTH)];

const DESCRIPTION: Description = Description {
    exponents: |_| Exponents::damping(1.0, 1.0),
    symbol: &[Mark::Area(FLUID, Tone::Faint), Mark::Dashpot(-0.5, 0.5)],
    example: &[20.0],
    ..Description::new(
        "quadratic damping",
        "c_2 d' |d'|",
        "A force that grows with velocity squared: turbulent flow, air or water drag.",
        &[Parameter::coefficient("c", "N s^2/m^2", "c_2")],
    )
};

impl MemorylessLaw for Quadratic {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn variable(&self) -> Variable {
        Variable::Velocity
    }

    fn at(&self, p: &[f64], _d: f64, v: f64) -> Point {
        Point { force: p[0] * v * v.abs(), by_displacement: 0.0, by_velocity: 2.0 * p[0] * v.abs() }
    }

    fn by_parameter(&self, _p: &[f64], _k: usize, _d: f64, v: f64) -> f64 {
        v * v.abs()
    }

    fn cycle_energy(&self, p: &[f64], amplitude: f64, omega: f64) -> Option<f64> {
        Some(8.0 / 3.0 * p[0] * omega * omega * amplitude.powi(3))
    }
}
