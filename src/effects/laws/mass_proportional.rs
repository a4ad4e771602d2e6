//! Mass-proportional viscous damping: `F = alpha M x'`.

use crate::effects::basis::Basis;
use crate::effects::description::{Constant, Description};
use crate::effects::law::WholeLaw;
use crate::effects::parameter::Parameter;
use crate::effects::symbol::Mark;
use faer::c64;

/// Viscous damping in proportion to the mass matrix.
#[derive(Debug)]
pub(crate) struct MassProportional;

const DESCRIPTION: Description = Description {
    constant: Some(Constant::Viscous),
    symbol: &[Mark::Dashpot(-0.5, 0.5), Mark::Letter("M")],
    ..Description::new(
        "mass-proportional damping",
        "alpha M x'",
        "Viscous damping in proportion to the mass matrix, greater in low modes.",
        &[Parameter::coefficient("alpha", "1/s", "alpha")],
    )
};

impl WholeLaw for MassProportional {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn basis(&self) -> Basis {
        Basis::Mass
    }

    fn factor(&self, value: f64, omega: f64) -> c64 {
        c64::new(0.0, omega * value)
    }
}
