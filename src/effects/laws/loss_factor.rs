//! Loss factor of the material: `F_h = i loss_factor K X_h` at each harmonic; no force at rest.

use crate::effects::basis::Basis;
use crate::effects::description::{Constant, Description};
use crate::effects::law::WholeLaw;
use crate::effects::parameter::Parameter;
use crate::effects::symbol::Mark;
use faer::c64;

/// Complex stiffness of the whole structure.
#[derive(Debug)]
pub(crate) struct LossFactor;

const DESCRIPTION: Description = Description {
    constant: Some(Constant::Hysteretic),
    symbol: &[Mark::spring(-0.5, 0.5, 4), Mark::Letter("ηK")],
    ..Description::new(
        "loss factor",
        "i eta K x",
        "A loss in proportion to the strain energy of the whole structure.",
        &[Parameter::coefficient("loss_factor", "", "eta")],
    )
};

impl WholeLaw for LossFactor {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn basis(&self) -> Basis {
        Basis::Stiffness
    }

    fn factor(&self, value: f64, omega: f64) -> c64 {
        c64::new(0.0, if omega > 0.0 { value } else { 0.0 })
    }
}
