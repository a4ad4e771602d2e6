//! Spring: `F = stiffness d`. It stores energy and takes out none. Negative: the model is too stiff there.

use crate::effects::description::{Constant, Description, Exponents};
use crate::effects::linear::LinearLaw;
use crate::effects::parameter::Parameter;
use crate::effects::symbol;
use faer::c64;

/// Linear spring, missing or too much.
#[derive(Debug)]
pub(crate) struct Stiffness;

const DESCRIPTION: Description = Description {
    dissipates: false,
    constant: Some(Constant::Stiffness),
    exponents: |_| Exponents::stiffness(0.0, 0.0),
    symbol: symbol::SPRING,
    example: &[200.0],
    usual: true,
    ..Description::new(
        "spring",
        "k d",
        "A spring that the model lacks, or has too much of if negative.",
        &[Parameter::coefficient("stiffness", "N/m", "k").of_any_sign()],
    )
};

impl LinearLaw for Stiffness {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn stiffness(&self, p: &[f64], _omega: f64) -> c64 {
        c64::new(p[0], 0.0)
    }

    fn stiffness_by(&self, _p: &[f64], _k: usize, _omega: f64) -> c64 {
        c64::new(1.0, 0.0)
    }
}
