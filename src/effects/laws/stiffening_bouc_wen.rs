//! Bouc-Wen hysteresis (Bouc 1967; Wen 1976) of exponent 1 with two different shape factors, so that it may grow stiffer the
//! further it is loaded:
//!
//! ```text
//! dF/dd = stiffness (1 + loading |F| / force)    while |F| grows,    dF/dd = stiffness (1 + |F| / force)    while it falls
//! ```
//!
//! In the words of Wen, `dF = A dd - beta |dd| F - gamma dd |F|` with `A = stiffness`, `beta = stiffness (1 - loading) / (2 force)` and
//! `gamma = -stiffness (1 + loading) / (2 force)`. It takes out energy as long as `loading < 1`; where `loading` is negative it is
//! bounded by `-force / loading`. With `z = F / force` and `xi = stiffness d / force` each part of a way is an exponential.

use crate::effects::description::Description;
use crate::effects::effect::Effect;
use crate::effects::internal::{InternalLaw, Way};
use crate::effects::limits::{CLOSE, Limit};
use crate::effects::parameter::{Ends, Parameter};
use crate::effects::symbol::{Mark, Tone};

/// Hysteresis that stiffens.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StiffeningBoucWen;

/// Largest exponent of growth over one way: `e^100` forces are no forces, and the next of an iteration is nearer.
const LARGEST: f64 = 100.0;
/// Exponent below which series stand in for differences of almost equal numbers.
const SMALL: f64 = 0.01;

/// Ratio of the growth while it is loaded to that while it falls above which little is taken out.
const ELASTIC: f64 = 0.75;

const DESCRIPTION: Description = Description {
    scaled: &[0, 1],
    shapes: |range| {
        let shape = |extension: f64| [-0.5, 0.3].map(|loading| vec![1.0, extension, loading]);
        range.yields().into_iter().step_by(2).flat_map(shape).collect()
    },
    limits: &[Limit {
        law: Effect::Stiffness,
        holds: |p, at| p[0] * at.displacement < CLOSE * p[1],
        parameters: |p| vec![p[0]],
    }],
    // It gives back nearly all that it takes up, and stands for a spring that stiffens.
    disguised: |p| p[2] > ELASTIC,
    symbol: &[
        Mark::spring(-0.5, -0.02, 3),
        Mark::Pads(0.0, 0.5, Tone::Faint),
        Mark::Line(&[(-0.45, 9.0), (-0.2, 6.0), (0.0, 0.0), (0.12, -5.0), (0.2, -10.0)]),
    ],
    example: &[400.0, 2.0, 0.3],
    ..Description::new(
        "stiffening Bouc-Wen hysteresis",
        "k (1 + r |F|/F_s) d'",
        "A loop that grows stiffer as it is loaded and unloads more steeply still: wire-rope isolators, stranded cables, felt.",
        &[
            Parameter::shape("stiffness", "N/m", "k", 1e4).above(0.0),
            Parameter::shape("force", "N", "F_s", 1.0).above(0.0),
            Parameter::shape("loading", "", "r", 0.0).within(-1.0, 0.9, Ends::Closed),
        ],
    )
};

/// Where a way leads `z`, with its derivatives by the start, the way and `loading`.
struct Reached {
    z: f64,
    by_start: f64,
    by_way: f64,
    by_loading: f64,
}

/// From `z >= 0` over a way `w >= 0` that loads.
fn loaded(r: f64, z: f64, w: f64) -> Reached {
    let x = (r * w).min(LARGEST);
    let (growth, grown) = (x.exp(), if x == 0.0 { w } else { w * x.exp_m1() / x });
    let by_loading = if x.abs() < SMALL {
        w * w * (0.5 + x * (1.0 / 3.0 + x * (0.125 + x * (1.0 / 30.0 + x / 144.0))))
    } else {
        w * w * (x * growth - x.exp_m1()) / (x * x)
    };
    let end = z * growth + grown;
    Reached { z: end, by_start: growth, by_way: growth * (1.0 + r * z), by_loading: z * w * growth + by_loading }
}

/// From `z` over the signed way `xi`.
fn reached(r: f64, z: f64, xi: f64) -> Reached {
    let sign = if xi < 0.0 { -1.0 } else { 1.0 };
    let (z, way) = (sign * z, xi.abs());
    if z >= 0.0 {
        let to = loaded(r, z, way);
        return Reached { z: sign * to.z, by_loading: sign * to.by_loading, ..to };
    }
    let to_zero = (-z).ln_1p();
    if way <= to_zero {
        let fading = (-way).exp();
        return Reached {
            z: sign * ((z - 1.0) * fading + 1.0),
            by_start: fading,
            by_way: (1.0 - z) * fading,
            by_loading: 0.0,
        };
    }
    let to = loaded(r, 0.0, way - to_zero);
    Reached { z: sign * to.z, by_start: to.by_way / (1.0 - z), by_way: to.by_way, by_loading: sign * to.by_loading }
}

impl InternalLaw for StiffeningBoucWen {
    type Shape = ();

    fn shape(&self, _p: &[f64]) {}

    fn stiffness(&self, p: &[f64]) -> f64 {
        p[0]
    }

    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn step(&self, _shape: &(), p: &[f64], start: f64, way: f64) -> Way {
        let to = reached(p[2], start / p[1], p[0] * way / p[1]);
        Way { force: p[1] * to.z, by_start: to.by_start, by_way: p[0] * to.by_way }
    }

    fn step_by(&self, _shape: &(), p: &[f64], k: usize, start: f64, way: f64) -> f64 {
        let (z, xi) = (start / p[1], p[0] * way / p[1]);
        let to = reached(p[2], z, xi);
        match k {
            0 => way * to.by_way,
            1 => to.z - z * to.by_start - xi * to.by_way,
            _ => p[1] * to.by_loading,
        }
    }

    /// What loading from rest over the whole range gives.
    fn bound(&self, p: &[f64], range: f64) -> f64 {
        p[1] * loaded(p[2], 0.0, p[0] * range / p[1]).z
    }
}
