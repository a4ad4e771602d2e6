//! Hysteretic (structural) damping: `F_h = i loss_stiffness D_h` at each harmonic, in quadrature with the displacement.
//! Energy per cycle of `d = X cos(omega t)`: `pi loss_stiffness X^2`, whatever the frequency.

use crate::effects::description::{Constant, Description, Exponents};
use crate::effects::linear::LinearLaw;
use crate::effects::parameter::Parameter;
use crate::effects::symbol::Mark;
use faer::c64;

/// Hysteretic damper.
#[derive(Debug)]
pub(crate) struct Hysteretic;

const DESCRIPTION: Description = Description {
    constant: Some(Constant::Hysteretic),
    exponents: |_| Exponents::damping(0.0, -1.0),
    symbol: &[Mark::spring(-0.5, 0.5, 4), Mark::Ring(0.42, 10.0)],
    example: &[50.0],
    usual: true,
    ..Description::new(
        "hysteretic damping",
        "i h d",
        "A loss per cycle that does not depend on frequency: damping inside a material.",
        &[Parameter::coefficient("loss_stiffness", "N/m", "h")],
    )
};

impl LinearLaw for Hysteretic {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    /// None at rest.
    fn stiffness(&self, p: &[f64], omega: f64) -> c64 {
        c64::new(0.0, if omega > 0.0 { p[0] } else { 0.0 })
    }

    fn stiffness_by(&self, _p: &[f64], _k: usize, omega: f64) -> c64 {
        self.stiffness(&[1.0], omega)
    }
}
