//! Elastic slider (Jenkins element): spring `stiffness` in series with a slider that yields at `force`.
//!
//! `F' = stiffness d'` while it sticks, `|F| = force` while it slips. Energy per cycle of `d = X cos(omega t)`:
//! `4 force (X - force / stiffness)` where it slips, else 0; of any motion: the sum over its closed loops.

use crate::effects::masing::march;
use crate::effects::memory::MasingMemory;
use crate::effects::turning::loop_ranges;
use crate::effects::{Law, Memory, Motion, Parameter};

/// Spring in series with a slider.
#[derive(Debug)]
pub struct ElasticSlider;

const PARAMETERS: [Parameter; 2] =
    [Parameter::shape("stiffness", "N/m", "k", 1e4), Parameter::shape("force", "N", "F_y", 1.0)];

fn slips(p: &[f64], d: f64) -> bool {
    (p[0] * d).abs() >= p[1]
}

fn backbone(p: &[f64], d: f64) -> f64 {
    if slips(p, d) { p[1] * d.signum() } else { p[0] * d }
}

fn slope(p: &[f64], d: f64) -> f64 {
    if slips(p, d) { 0.0 } else { p[0] }
}

fn by_parameter(p: &[f64], k: usize, d: f64) -> f64 {
    match (k, slips(p, d)) {
        (0, false) => d,
        (1, true) => d.signum(),
        _ => 0.0,
    }
}

impl Law for ElasticSlider {
    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn force(&self, p: &[f64], motion: &Motion, force: &mut [f64]) {
        let d = &motion.displacement;
        march(d, force, |n| backbone(p, d[n]), |r, n| 2.0 * backbone(p, 0.5 * (d[n] - d[r])));
    }

    fn tangent(&self, p: &[f64], motion: &Motion, direction: &Motion, tangent: &mut [f64]) {
        let (d, e) = (&motion.displacement, &direction.displacement);
        march(d, tangent, |n| slope(p, d[n]) * e[n], |r, n| slope(p, 0.5 * (d[n] - d[r])) * (e[n] - e[r]));
    }

    fn parameter_tangent(&self, p: &[f64], k: usize, motion: &Motion, tangent: &mut [f64]) {
        let d = &motion.displacement;
        march(d, tangent, |n| by_parameter(p, k, d[n]), |r, n| 2.0 * by_parameter(p, k, 0.5 * (d[n] - d[r])));
    }

    fn memory(&self, p: &[f64]) -> Option<Box<dyn Memory>> {
        let p = [p[0], p[1]];
        Some(Box::new(MasingMemory::new(move |d| [backbone(&p, d), slope(&p, d)])))
    }

    fn energy_per_cycle(&self, p: &[f64], amplitude: f64, _omega: f64) -> Option<f64> {
        Some(if slips(p, amplitude) && p[0] > 0.0 { 4.0 * p[1] * (amplitude - p[1] / p[0]) } else { 0.0 })
    }

    fn energy(&self, p: &[f64], motion: &Motion) -> f64 {
        loop_ranges(motion).into_iter().filter_map(|range| self.energy_per_cycle(p, 0.5 * range, motion.omega)).sum()
    }
}
