//! Fractional derivative (viscoelastic) damping: `F_h = c (i w)^order D_h` at `w = h omega`, 0 < order < 1.
//! Energy per cycle of `d = X cos(omega t)`: `pi c omega^order X^2 sin(order pi / 2)`.

use crate::effects::description::{Description, Exponents};
use crate::effects::effect::Effect;
use crate::effects::limits::{Limit, near};
use crate::effects::linear::LinearLaw;
use crate::effects::parameter::{Ends, Parameter};
use crate::effects::symbol::{Mark, Tone};
use faer::c64;
use std::f64::consts::FRAC_PI_2;

/// Element between a spring (order 0) and a dashpot (order 1).
#[derive(Debug)]
pub(crate) struct Fractional;

const DESCRIPTION: Description = Description {
    shapes: |_| [0.15, 0.3, 0.45, 0.6, 0.75, 0.9].map(|order| vec![1.0, order]).to_vec(),
    exponents: |p| Exponents::damping(0.0, p[1] - 1.0),
    limits: &[
        Limit { law: Effect::Viscous, holds: |p, _| near(p[1], 1.0), parameters: |p| vec![p[0]] },
        Limit { law: Effect::Stiffness, holds: |p, _| near(p[1], 0.0), parameters: |p| vec![p[0]] },
        // The imaginary part of a small order hardly knows the frequency, but the spring beside it is never gone.
        Limit { law: Effect::Hysteretic, holds: |_, _| false, parameters: |p| vec![p[0]] },
    ],
    symbol: &[Mark::Area(&[(-0.5, 0.0), (0.0, -8.0), (0.5, 0.0), (0.0, 8.0)], Tone::Faint)],
    example: &[15.0, 0.5],
    ..Description::new(
        "fractional damping",
        "c_a D^a d",
        "A force between elastic and viscous over a wide band of frequency: polymers.",
        &[
            Parameter::coefficient("c", "N s^a/m", "c_a"),
            Parameter::shape("order", "", "a", 0.5).within(0.0, 1.0, Ends::Open),
        ],
    )
};

impl LinearLaw for Fractional {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    /// None at rest.
    fn stiffness(&self, p: &[f64], omega: f64) -> c64 {
        if omega <= 0.0 {
            return c64::new(0.0, 0.0);
        }
        let (sin, cos) = (p[1] * FRAC_PI_2).sin_cos();
        let magnitude = p[0] * omega.powf(p[1]);
        c64::new(magnitude * cos, magnitude * sin)
    }

    /// By the order, the stiffness times `ln(i w)`.
    fn stiffness_by(&self, p: &[f64], k: usize, omega: f64) -> c64 {
        if k == 0 {
            self.stiffness(&[1.0, p[1]], omega)
        } else if omega > 0.0 {
            self.stiffness(p, omega) * c64::new(omega.ln(), FRAC_PI_2)
        } else {
            c64::new(0.0, 0.0)
        }
    }
}
