//! One-sided stop: `F = stiffness (d - gap)` where `d` is beyond `gap` on the side of its sign, else 0. It takes out no energy.
//!
//! `gap = 0` is a contact that closes for `d > 0`, as a crack that breathes. Under `d = X cos(omega t)` with `X > |gap|` and
//! `cos a = |gap| / X` the mean force is `stiffness X (sin a - a cos a) / pi`, towards the stop.

use crate::effects::description::Description;
use crate::effects::law::{Point, Variable};
use crate::effects::memoryless::MemorylessLaw;
use crate::effects::parameter::Parameter;
use crate::effects::range::geometric;
use crate::effects::symbol::{HALF_WIDTH, Mark, Tone};

/// Contact on one side only.
#[derive(Debug)]
pub(crate) struct Stop;

const DESCRIPTION: Description = Description {
    odd: false,
    folds: true,
    dissipates: false,
    shapes: |range| {
        let gaps = geometric(0.05 * range.displacement, 0.95 * range.displacement, 8);
        gaps.into_iter().flat_map(|gap| [gap, -gap]).map(|gap| vec![1.0, gap]).collect()
    },
    symbol: &[
        Mark::spring(-0.5, 0.1, 3),
        Mark::Line(&[(0.12, -HALF_WIDTH), (0.12, HALF_WIDTH)]),
        Mark::Area(&[(0.36, -HALF_WIDTH), (0.5, -HALF_WIDTH), (0.5, HALF_WIDTH), (0.36, HALF_WIDTH)], Tone::Full),
    ],
    example: &[1000.0, 0.003],
    ..Description::new(
        "one-sided stop",
        "k_s (d - g) beyond g",
        "A contact on one side only: a bumper, a pipe on its support, a crack that opens and closes.",
        &[Parameter::coefficient("stiffness", "N/m", "k_s"), Parameter::shape("gap", "m", "g", 1e-4).of_any_sign()],
    )
};

/// How far `d` is beyond the gap, with the sign of the gap; 0 on this side of it.
fn beyond(gap: f64, d: f64) -> f64 {
    let side = 1.0_f64.copysign(gap);
    side * (side * (d - gap)).max(0.0)
}

impl MemorylessLaw for Stop {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn variable(&self) -> Variable {
        Variable::Displacement
    }

    fn at(&self, p: &[f64], d: f64, _v: f64) -> Point {
        let beyond = beyond(p[1], d);
        if beyond == 0.0 {
            return Point::default();
        }
        Point { force: p[0] * beyond, by_displacement: p[0], by_velocity: 0.0 }
    }

    fn by_parameter(&self, p: &[f64], k: usize, d: f64, _v: f64) -> f64 {
        match (k, beyond(p[1], d)) {
            (_, 0.0) => 0.0,
            (0, beyond) => beyond,
            _ => -p[0],
        }
    }
}
