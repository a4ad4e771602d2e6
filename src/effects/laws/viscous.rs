//! Viscous dashpot: `F = c d'`, `c` in N s/m. Energy per cycle of `d = X cos(omega t)`: `pi c omega X^2`.

use crate::effects::description::{Constant, Description, Exponents};
use crate::effects::linear::LinearLaw;
use crate::effects::parameter::Parameter;
use crate::effects::symbol;
use faer::c64;

/// Viscous dashpot.
#[derive(Debug)]
pub(crate) struct Viscous;

const DESCRIPTION: Description = Description {
    constant: Some(Constant::Viscous),
    exponents: |_| Exponents::damping(0.0, 0.0),
    symbol: symbol::DASHPOT,
    example: &[4.5],
    usual: true,
    ..Description::new(
        "viscous dashpot",
        "c d'",
        "A force in proportion to velocity: a damper with laminar flow, eddy currents, some rubbers.",
        &[Parameter::coefficient("c", "N s/m", "c")],
    )
};

impl LinearLaw for Viscous {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn stiffness(&self, p: &[f64], omega: f64) -> c64 {
        c64::new(0.0, omega * p[0])
    }

    fn stiffness_by(&self, _p: &[f64], _k: usize, omega: f64) -> c64 {
        c64::new(0.0, omega)
    }
}
