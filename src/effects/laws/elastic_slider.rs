//! Elastic slider (Jenkins element): spring `stiffness` in series with a slider that yields at `force`.
//!
//! `F' = stiffness d'` while it sticks, `|F| = force` while it slips. Energy per cycle of `d = X cos(omega t)`:
//! `4 force (X - force / stiffness)` where it slips, else 0; of any motion: the sum over its closed loops.

use crate::effects::description::Description;
use crate::effects::effect::Effect;
use crate::effects::limits::{CLOSE, Limit};
use crate::effects::masing::MasingLaw;
use crate::effects::parameter::Parameter;
use crate::effects::set_valued::SetValued;
use crate::effects::symbol::{Mark, Tone};

/// Spring in series with a slider.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ElasticSlider;

const DESCRIPTION: Description = Description {
    scaled: &[0, 1],
    shapes: |range| range.yields().into_iter().map(|extension| vec![1.0, extension]).collect(),
    limits: &[
        // It never slips; it slips at once.
        Limit { law: Effect::Stiffness, holds: |p, at| p[1] >= p[0] * at.displacement, parameters: |p| vec![p[0]] },
        Limit { law: Effect::Coulomb, holds: |p, at| p[1] < CLOSE * p[0] * at.least, parameters: |p| vec![p[1]] },
    ],
    symbol: &[Mark::spring(-0.5, -0.02, 3), Mark::Pads(0.0, 0.5, Tone::Full)],
    example: &[400.0, 0.5],
    ..Description::new(
        "elastic slider",
        "k + slider F_y",
        "A contact that first gives elastically, then slips at its yield force.",
        &[Parameter::shape("stiffness", "N/m", "k", 1e4), Parameter::shape("force", "N", "F_y", 1.0)],
    )
};

fn slips(p: &[f64], d: f64) -> bool {
    (p[0] * d).abs() >= p[1]
}

impl MasingLaw for ElasticSlider {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn backbone(&self, p: &[f64], d: f64) -> f64 {
        if slips(p, d) { p[1] * d.signum() } else { p[0] * d }
    }

    fn slope(&self, p: &[f64], d: f64) -> f64 {
        if slips(p, d) { 0.0 } else { p[0] }
    }

    fn by_parameter(&self, p: &[f64], k: usize, d: f64) -> f64 {
        match (k, slips(p, d)) {
            (0, false) => d,
            (1, true) => d.signum(),
            _ => 0.0,
        }
    }

    fn loop_energy(&self, p: &[f64], amplitude: f64) -> f64 {
        if slips(p, amplitude) && p[0] > 0.0 { 4.0 * p[1] * (amplitude - p[1] / p[0]) } else { 0.0 }
    }

    fn set_valued(&self) -> Option<&dyn SetValued> {
        Some(self)
    }

    fn series_stiffness(&self, p: &[f64]) -> Option<f64> {
        Some(p[0])
    }
}

/// The slider alone.
impl SetValued for ElasticSlider {
    fn bounds(&self, p: &[f64]) -> [f64; 2] {
        let bound = p[1].max(0.0);
        [-bound, bound]
    }

    fn bounds_by(&self, _p: &[f64], k: usize) -> [f64; 2] {
        if k == 1 { [-1.0, 1.0] } else { [0.0; 2] }
    }
}
