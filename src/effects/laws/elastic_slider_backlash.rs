//! Elastic slider with backlash: a play of `backlash` in series with a spring `stiffness` and a slider that yields at `force`.
//!
//! The displacement `z` of the spring's end follows `d` until the slider yields; the force is that of the spring beyond the play:
//!
//! ```text
//! |z| <= w = force / stiffness + backlash / 2,    F = stiffness sgn(z) max(|z| - backlash / 2, 0)
//! ```
//!
//! After a reversal it unloads, travels the backlash without force and loads again until it slides. Energy per cycle of
//! `d = X cos(omega t)`: `4 force (X - w)` where it slides, else 0; of any motion the sum over its closed loops, since `z` is that
//! of an elastic slider and work is lost only while `|F| = force`.

use crate::effects::description::Description;
use crate::effects::effect::Effect;
use crate::effects::internal::{InternalLaw, Way};
use crate::effects::limits::{CLOSE, Limit};
use crate::effects::motion::Motion;
use crate::effects::parameter::Parameter;
use crate::effects::symbol::{HALF_WIDTH, Mark, Tone};
use crate::effects::turning::loop_ranges;

/// Spring in series with a slider and a play.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ElasticSliderBacklash;

const DESCRIPTION: Description = Description {
    scaled: &[0, 1],
    shapes: |range| {
        let shape = |extension: f64| [0.5, 2.0].map(|share| vec![1.0, extension, share * extension]);
        range.yields().into_iter().step_by(2).flat_map(shape).collect()
    },
    limits: &[
        Limit {
            law: Effect::ElasticSlider,
            holds: |p, at| 0.5 * p[2] < CLOSE * at.least,
            parameters: |p| vec![p[0], p[1]],
        },
        // It never slips.
        Limit {
            law: Effect::Gap,
            holds: |p, at| bound(p) >= p[0] * at.displacement,
            parameters: |p| vec![p[0], 0.5 * p[2]],
        },
    ],
    symbol: &[
        Mark::spring(-0.5, -0.16, 3),
        Mark::Line(&[(-0.14, -HALF_WIDTH), (-0.14, HALF_WIDTH)]),
        Mark::Line(&[(0.0, -HALF_WIDTH), (0.0, HALF_WIDTH)]),
        Mark::Pads(0.0, 0.5, Tone::Full),
    ],
    example: &[400.0, 0.5, 1e-3],
    ..Description::new(
        "elastic slider with backlash",
        "k + slider F_y + play b",
        "A slider with play: after each reversal it moves through the backlash without force before it grips again.",
        &[
            Parameter::shape("stiffness", "N/m", "k", 1e4).above(0.0),
            Parameter::shape("force", "N", "F_y", 1.0).above(0.0),
            Parameter::shape("backlash", "m", "b", 1e-4),
        ],
    )
};

/// Force of the spring alone, as if there were no play, at which the slider yields, N.
fn bound(p: &[f64]) -> f64 {
    p[1] + 0.5 * p[0] * p[2]
}

/// The internal force is `stiffness z`.
impl InternalLaw for ElasticSliderBacklash {
    type Shape = ();

    fn shape(&self, _p: &[f64]) {}

    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn stiffness(&self, p: &[f64]) -> f64 {
        p[0]
    }

    fn step(&self, _shape: &(), p: &[f64], start: f64, way: f64) -> Way {
        let (end, bound) = (start + p[0] * way, bound(p));
        if end.abs() < bound {
            return Way { force: end, by_start: 1.0, by_way: p[0] };
        }
        Way { force: bound.copysign(end), by_start: 0.0, by_way: 0.0 }
    }

    fn step_by(&self, _shape: &(), p: &[f64], k: usize, start: f64, way: f64) -> f64 {
        let end = start + p[0] * way;
        match (k, end.abs() < bound(p)) {
            (0, true) => way,
            (_, true) => 0.0,
            (0, false) => (0.5 * p[2]).copysign(end),
            (1, false) => end.signum(),
            (_, false) => (0.5 * p[0]).copysign(end),
        }
    }

    fn bound(&self, p: &[f64], _range: f64) -> f64 {
        bound(p)
    }

    fn output(&self, p: &[f64], internal: f64) -> [f64; 2] {
        let beyond = internal.abs() - 0.5 * p[0] * p[2];
        if beyond > 0.0 { [beyond.copysign(internal), 1.0] } else { [0.0; 2] }
    }

    fn output_by(&self, p: &[f64], k: usize, internal: f64) -> f64 {
        match k {
            _ if internal.abs() <= 0.5 * p[0] * p[2] => 0.0,
            0 => -(0.5 * p[2]).copysign(internal),
            1 => 0.0,
            _ => -(0.5 * p[0]).copysign(internal),
        }
    }

    fn loop_energy(&self, p: &[f64], amplitude: f64) -> Option<f64> {
        Some(4.0 * p[1] * (amplitude - bound(p) / p[0]).max(0.0))
    }

    fn exact_energy(&self, p: &[f64], motion: &Motion) -> Option<f64> {
        loop_ranges(motion).into_iter().map(|range| self.loop_energy(p, 0.5 * range)).sum()
    }
}
