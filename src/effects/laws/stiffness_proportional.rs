//! Stiffness-proportional viscous damping: `F = beta K x'`.

use crate::effects::basis::Basis;
use crate::effects::description::{Constant, Description};
use crate::effects::law::WholeLaw;
use crate::effects::parameter::Parameter;
use crate::effects::symbol::Mark;
use faer::c64;

/// Viscous damping in proportion to the stiffness matrix.
#[derive(Debug)]
pub(crate) struct StiffnessProportional;

const DESCRIPTION: Description = Description {
    constant: Some(Constant::Viscous),
    symbol: &[Mark::Dashpot(-0.5, 0.5), Mark::Letter("K")],
    ..Description::new(
        "stiffness-proportional damping",
        "beta K x'",
        "Viscous damping in proportion to the stiffness matrix, greater in high modes.",
        &[Parameter::coefficient("beta", "s", "beta")],
    )
};

impl WholeLaw for StiffnessProportional {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn basis(&self) -> Basis {
        Basis::Stiffness
    }

    fn factor(&self, value: f64, omega: f64) -> c64 {
        c64::new(0.0, omega * value)
    }
}
