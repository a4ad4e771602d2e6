//! Dahl friction (Dahl 1976): presliding by a stiffness that fades as the force nears that of sliding,
//! `dF/dd = stiffness (1 - F sgn(d') / force)`.
//!
//! Along a straight way `u`, `F = s force + (F_0 - s force) exp(-stiffness |u| / force)` with `s = sgn u`. In steady state
//! under `d = X cos(omega t)` the force turns at `F_m = force tanh(stiffness X / force)`; energy per cycle:
//! `4 force (X - F_m / stiffness)`.
//!
//! Chosen before LuGre: its two parameters are those that periodic tests determine. LuGre adds a falling force, micro
//! damping and a viscous part, which stand beside it as `stribeck` and `viscous` sources; its six parameters cannot be
//! told apart from steady states.

use crate::effects::description::Description;
use crate::effects::effect::Effect;
use crate::effects::internal::{InternalLaw, Way};
use crate::effects::limits::{CLOSE, Limit};
use crate::effects::parameter::Parameter;
use crate::effects::symbol::{Mark, Tone};

/// Friction with a fading presliding stiffness.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Dahl;

/// Exponent at which what a way began with is less than rounding of the sliding force: `e^-46` is 1e-20.
const FORGOTTEN: f64 = -46.0;

const DESCRIPTION: Description = Description {
    scaled: &[0, 1],
    shapes: |range| range.yields().into_iter().map(|extension| vec![1.0, extension]).collect(),
    limits: &[
        Limit {
            law: Effect::Stiffness,
            holds: |p, at| p[0] * at.displacement < CLOSE * p[1],
            parameters: |p| vec![p[0]],
        },
        Limit { law: Effect::Coulomb, holds: |p, at| p[1] < CLOSE * p[0] * at.least, parameters: |p| vec![p[1]] },
    ],
    symbol: &[Mark::spring(-0.5, -0.02, 3), Mark::Pads(0.0, 0.5, Tone::Faint)],
    example: &[400.0, 0.5],
    ..Description::new(
        "Dahl friction",
        "dF/dd = k (1 -+ F/F_c)",
        "Friction of rolling bearings, guides and screws: it gives elastically, ever more softly, before it slides.",
        &[
            Parameter::shape("stiffness", "N/m", "k", 1e4).above(0.0),
            Parameter::shape("force", "N", "F_c", 1.0).above(0.0),
        ],
    )
};

impl InternalLaw for Dahl {
    type Shape = ();

    fn shape(&self, _p: &[f64]) {}

    fn stiffness(&self, p: &[f64]) -> f64 {
        p[0]
    }

    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn step(&self, _shape: &(), p: &[f64], start: f64, way: f64) -> Way {
        let [stiffness, force] = [p[0], p[1]];
        let sliding = force * if way < 0.0 { -1.0 } else { 1.0 };
        let exponent = -stiffness * way.abs() / force;
        if exponent < FORGOTTEN {
            return Way { force: sliding, by_start: 0.0, by_way: 0.0 };
        }
        let fading = exponent.exp();
        Way {
            // Of ways that are short of sliding, the difference of two large forces would be rounding.
            force: start * fading - sliding * exponent.exp_m1(),
            by_start: fading,
            by_way: stiffness * (1.0 - start / sliding) * fading,
        }
    }

    fn step_by(&self, _shape: &(), p: &[f64], k: usize, start: f64, way: f64) -> f64 {
        let [stiffness, force] = [p[0], p[1]];
        let sign = if way < 0.0 { -1.0 } else { 1.0 };
        let length = way.abs() / force;
        if -stiffness * length < FORGOTTEN {
            return if k == 0 { 0.0 } else { sign };
        }
        let fading = (-stiffness * length).exp();
        let rest = (start - sign * force) * fading;
        if k == 0 { -length * rest } else { sign * (1.0 - fading) + rest * stiffness * length / force }
    }

    fn bound(&self, p: &[f64], _range: f64) -> f64 {
        p[1]
    }

    fn loop_energy(&self, p: &[f64], amplitude: f64) -> Option<f64> {
        let [stiffness, force] = [p[0], p[1]];
        let x = stiffness * amplitude / force;
        // Of small loops the difference below is rounding: 4 force^2 / stiffness (x^3/3 - 2 x^5/15 ...).
        let lost =
            if x < 1e-2 { x.powi(3) * (1.0 / 3.0 - x * x * (2.0 / 15.0 - x * x * 17.0 / 315.0)) } else { x - x.tanh() };
        Some(4.0 * force * force / stiffness * lost)
    }
}
