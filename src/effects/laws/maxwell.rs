//! Maxwell element, a spring in series with a dashpot: `F_h = k i w c / (k + i w c) D_h` at `w = h omega`.
//! Energy per cycle of `d = X cos(omega t)`: `pi X^2 k^2 omega c / (k^2 + (omega c)^2)`.

use crate::effects::description::Description;
use crate::effects::effect::Effect;
use crate::effects::limits::{CLOSE, Limit};
use crate::effects::linear::LinearLaw;
use crate::effects::memory::{MaxwellMemory, Memory};
use crate::effects::parameter::Parameter;
use crate::effects::symbol::Mark;
use faer::c64;

/// Spring in series with a dashpot.
#[derive(Debug)]
pub(crate) struct Maxwell;

const DESCRIPTION: Description = Description {
    scaled: &[0, 1],
    shapes: |range| [0.1, 0.3, 1.0, 3.0, 10.0].map(|x| vec![1.0, x / range.omega]).to_vec(),
    limits: &[
        Limit { law: Effect::Viscous, holds: |p, at| at.omega * p[1] < CLOSE * p[0], parameters: |p| vec![p[1]] },
        Limit { law: Effect::Stiffness, holds: |p, at| p[0] < CLOSE * at.omega * p[1], parameters: |p| vec![p[0]] },
    ],
    symbol: &[Mark::spring(-0.5, -0.05, 3), Mark::Dashpot(-0.05, 0.5)],
    example: &[400.0, 8.0],
    ..Description::new(
        "Maxwell element",
        "k + dashpot c",
        "A spring in series with a dashpot: a damper on a flexible mount.",
        &[Parameter::shape("stiffness", "N/m", "k", 1e4), Parameter::shape("c", "N s/m", "c", 1.0)],
    )
};

impl LinearLaw for Maxwell {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    /// None if either part is missing.
    fn stiffness(&self, p: &[f64], omega: f64) -> c64 {
        let dashpot = c64::new(0.0, omega * p[1]);
        let sum = p[0] + dashpot;
        if sum.norm() == 0.0 { c64::new(0.0, 0.0) } else { p[0] * dashpot / sum }
    }

    /// By `k` `(i w c / (k + i w c))^2`, by `c` `i w (k / (k + i w c))^2`.
    fn stiffness_by(&self, p: &[f64], k: usize, omega: f64) -> c64 {
        let dashpot = c64::new(0.0, omega * p[1]);
        let sum = p[0] + dashpot;
        if sum.norm() == 0.0 {
            return c64::new(0.0, 0.0);
        }
        if k == 0 {
            let share = dashpot / sum;
            share * share
        } else {
            let share = p[0] / sum;
            c64::new(0.0, omega) * share * share
        }
    }

    fn memory(&self, p: &[f64]) -> Option<Box<dyn Memory>> {
        Some(Box::new(MaxwellMemory::new(p[0], p[1])))
    }
}
