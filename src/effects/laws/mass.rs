//! Mass: `F = mass d''`. It stores energy and takes out none. Negative: the model is too heavy there.

use crate::effects::description::{Constant, Description, Exponents};
use crate::effects::linear::LinearLaw;
use crate::effects::parameter::Parameter;
use crate::effects::symbol::{Mark, Tone};
use faer::c64;

/// Lumped mass, missing or too much.
#[derive(Debug)]
pub(crate) struct Mass;

const DESCRIPTION: Description = Description {
    dissipates: false,
    constant: Some(Constant::Mass),
    exponents: |_| Exponents::stiffness(0.0, 2.0),
    symbol: &[
        Mark::Area(&[(-0.36, -9.0), (0.36, -9.0), (0.36, 9.0), (-0.36, 9.0)], Tone::Faint),
        Mark::Line(&[(-0.5, 0.0), (-0.36, 0.0)]),
        Mark::Line(&[(0.36, 0.0), (0.5, 0.0)]),
    ],
    example: &[0.5],
    ..Description::new(
        "mass",
        "m d''",
        "A mass that the model lacks, or has too much of if negative.",
        &[Parameter::coefficient("mass", "kg", "m").of_any_sign()],
    )
};

impl LinearLaw for Mass {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn stiffness(&self, p: &[f64], omega: f64) -> c64 {
        c64::new(-omega * omega * p[0], 0.0)
    }

    fn stiffness_by(&self, _p: &[f64], _k: usize, omega: f64) -> c64 {
        c64::new(-omega * omega, 0.0)
    }
}
