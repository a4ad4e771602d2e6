//! Bouc-Wen hysteresis (Bouc 1967; Wen 1976) that turns smoothly from stiffness to sliding, its two shape factors equal so
//! that it unloads elastically:
//!
//! ```text
//! dF/dd = stiffness (1 - |F / force|^exponent)    while |F| grows,    dF/dd = stiffness    while it falls
//! ```
//!
//! Large exponents give the elastic slider. With `z = F / force` and `xi = stiffness d / force`, the way from 0 to `z` is
//! `Psi(z) = integral_0^z du / (1 - u^exponent)`; the steady loop of `d = X cos(omega t)` turns at `z_m` with
//! `z_m + Psi(z_m) = 2 stiffness X / force` and takes out `2 force^2 / stiffness (integral_0^z_m u dPsi - z_m^2 / 2)`.

use crate::effects::description::Description;
use crate::effects::effect::Effect;
use crate::effects::internal::{InternalLaw, Way};
use crate::effects::limits::{CLOSE, Limit};
use crate::effects::loading_curve::{LoadingCurve, Reached};
use crate::effects::parameter::{Ends, Parameter};
use crate::effects::symbol::{Mark, Tone};
use std::f64::consts::LN_2;

/// Smooth hysteresis.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BoucWen;

const DESCRIPTION: Description = Description {
    scaled: &[0, 1],
    shapes: |range| {
        let shape = |extension: f64| [1.3, 3.0].map(|exponent| vec![1.0, extension, exponent]);
        range.yields().into_iter().step_by(2).flat_map(shape).collect()
    },
    limits: &[
        Limit {
            law: Effect::Stiffness,
            holds: |p, at| relative(p, at.displacement).powf(p[2]) < CLOSE,
            parameters: |p| vec![p[0]],
        },
        Limit { law: Effect::Coulomb, holds: |p, at| relative(p, at.least) * CLOSE > 1.0, parameters: |p| vec![p[1]] },
        // For large exponents the loading curve lies ln 2 / exponent of the force beside the corner of the slider at the most.
        Limit { law: Effect::ElasticSlider, holds: |p, _| LN_2 < CLOSE * p[2], parameters: |p| vec![p[0], p[1]] },
    ],
    symbol: &[
        Mark::spring(-0.5, -0.02, 3),
        Mark::Pads(0.0, 0.5, Tone::Faint),
        Mark::Line(&[(-0.45, 9.0), (-0.3, 2.0), (-0.15, -6.0), (0.0, -9.0), (0.2, -10.0)]),
    ],
    example: &[400.0, 0.5, 2.0],
    ..Description::new(
        "Bouc-Wen hysteresis",
        "k (1 - |F/F_y|^n) d'",
        "A loop that bends over smoothly from stiffness to sliding: wire ropes, elastomers, riveted and bolted joints.",
        &[
            Parameter::shape("stiffness", "N/m", "k", 1e4).above(0.0),
            Parameter::shape("force", "N", "F_y", 1.0).above(0.0),
            Parameter::shape("exponent", "", "n", 2.0).within(1.0, 50.0, Ends::Closed),
        ],
    )
};

/// Displacement over that at which the initial stiffness gives the sliding force.
fn relative(p: &[f64], d: f64) -> f64 {
    p[0] * d / p[1]
}

/// From `z` over the signed way `xi`, on the first loading curve.
fn reached(curve: &LoadingCurve, z: f64, xi: f64) -> Reached {
    let sign = if xi < 0.0 { -1.0 } else { 1.0 };
    let (z, way) = (sign * z, xi.abs());
    if z + way <= 0.0 {
        return Reached { z: sign * (z + way), by_start: 1.0, by_way: 1.0, by_exponent: 0.0 };
    }
    let up = if z < 0.0 {
        let up = curve.risen(0.0, z + way);
        Reached { by_start: up.by_way, ..up }
    } else {
        curve.risen(z, way)
    };
    Reached { z: sign * up.z, by_exponent: sign * up.by_exponent, ..up }
}

impl InternalLaw for BoucWen {
    type Shape = LoadingCurve;

    fn shape(&self, p: &[f64]) -> LoadingCurve {
        LoadingCurve::new(p[2])
    }

    fn stiffness(&self, p: &[f64]) -> f64 {
        p[0]
    }

    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn step(&self, curve: &LoadingCurve, p: &[f64], start: f64, way: f64) -> Way {
        let to = reached(curve, start / p[1], relative(p, way));
        Way { force: p[1] * to.z, by_start: to.by_start, by_way: p[0] * to.by_way }
    }

    fn step_by(&self, curve: &LoadingCurve, p: &[f64], k: usize, start: f64, way: f64) -> f64 {
        let (z, xi) = (start / p[1], relative(p, way));
        let to = reached(curve, z, xi);
        match k {
            0 => way * to.by_way,
            1 => to.z - z * to.by_start - xi * to.by_way,
            _ => p[1] * to.by_exponent,
        }
    }

    fn bound(&self, p: &[f64], _range: f64) -> f64 {
        p[1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where it is told as an elastic slider, its loading curve lies no further from that of the slider than laws that are all but alike.
    #[test]
    fn a_large_exponent_makes_it_an_elastic_slider() {
        let farthest = |exponent: f64| {
            let curve = LoadingCurve::new(exponent);
            let gap = |k: i32| {
                let extension = 0.01 * f64::from(k);
                (extension.min(1.0) - reached(&curve, 0.0, extension).z).abs()
            };
            (0..300).map(gap).fold(0.0, f64::max)
        };
        let least = LN_2 / CLOSE;
        assert!(farthest(1.01 * least) < CLOSE && farthest(0.9 * least) > CLOSE, "{}", farthest(least));
    }
}
