//! Power that sources take out of a record's motion at every sample: `d' F(d, d', states)` at their values.
//!
//! Laws without memory are evaluated sample by sample; linear laws with memory and whole-structure laws on the lines of the
//! record, `F(f) = Z(i omega) d(f)`; hysteresis is marched from the start of the part that is used, from its virgin state.

use super::band::line_omega;
use super::motion::Motion;
use crate::effects::{Effect, Leg, Source, effect::Kind};
use crate::response::linear_matrices::unit_matrix;
use crate::structure::Structure;
use dashpot_numerics::{product, transposed_product};
use faer::c64;
use std::collections::HashMap;

/// Relative motions that are at hand already.
pub(super) struct Works<'a> {
    structure: &'a Structure,
    motion: &'a Motion,
    relative: HashMap<[usize; 2], [Vec<f64>; 2]>,
}

impl<'a> Works<'a> {
    pub fn new(structure: &'a Structure, motion: &'a Motion) -> Self {
        Self { structure, motion, relative: HashMap::new() }
    }

    /// Power of a source at its own values, W, one value a sample.
    pub fn power(&mut self, source: &Source) -> Vec<f64> {
        let mut power = vec![0.0; self.motion.q[0].len()];
        match source.effect.kind() {
            Kind::Relative(_) => {
                for leg in source.place.legs() {
                    self.add_leg(source, leg, &mut power);
                }
            }
            Kind::Whole(_) => self.add_whole(source, &mut power),
            Kind::Channel(_) => {}
        }
        power
    }

    /// Weight of each mode in a relative motion.
    fn weights(&self, leg: Leg) -> Vec<f64> {
        let shapes = &self.motion.band.shapes;
        (0..self.motion.q.len()).map(|r| leg.relative(|i| shapes[(i, r)])).collect()
    }

    fn add_leg(&mut self, source: &Source, leg: Leg, power: &mut [f64]) {
        let key = [leg.first, leg.second.unwrap_or(usize::MAX)];
        let weights = self.weights(leg);
        let motion = self.motion;
        let [d, v] =
            self.relative.entry(key).or_insert_with(|| [combined(&motion.q, &weights), combined(&motion.v, &weights)]);
        if source.effect == Effect::Viscous {
            let c = source.coefficient();
            power.iter_mut().zip(v.iter()).for_each(|(p, v)| *p += c * v * v);
            return;
        }
        let Some(law) = source.effect.law() else { return };
        let parameters = &source.parameters;
        if law.point(parameters, 0.0, 1.0).is_some() {
            let force = |d: f64, v: f64| law.point(parameters, d, v).unwrap_or_default().force;
            power.iter_mut().zip(d.iter().zip(v.iter())).for_each(|(p, (d, v))| *p += v * force(*d, *v));
        } else if law.dynamic_stiffness(parameters, 1.0).is_some() {
            let resolution = line_omega(motion.padded, motion.step);
            let line = |k: usize| {
                let d: c64 = motion.lines.iter().zip(&weights).map(|(lines, w)| lines[k] * *w).sum();
                let z = if k == 0 { None } else { law.dynamic_stiffness(parameters, k as f64 * resolution) };
                d * z.unwrap_or(c64::new(0.0, 0.0))
            };
            let force = motion.signal((0..=motion.padded / 2).map(line).collect());
            power.iter_mut().zip(v.iter().zip(&force)).for_each(|(p, (v, f))| *p += v * f);
        } else if let Some(mut memory) = law.memory(parameters) {
            for (p, (d, v)) in power.iter_mut().zip(d.iter().zip(v.iter())) {
                *p += v * memory.advance(*d, motion.step);
            }
        }
    }

    /// `sum_rs v_r (Phi^T B Phi)_rs factor q_s`.
    fn add_whole(&self, source: &Source, power: &mut [f64]) {
        let (Kind::Whole(law), Ok(basis)) = (source.effect.kind(), unit_matrix(self.structure, source)) else { return };
        let motion = self.motion;
        let shapes = motion.band.shapes.as_ref();
        let modal = transposed_product(shapes, product(basis.as_ref(), shapes).as_ref());
        let resolution = line_omega(motion.padded, motion.step);
        for r in 0..motion.q.len() {
            let line = |k: usize| {
                let q: c64 = motion.lines.iter().enumerate().map(|(s, lines)| lines[k] * modal[(r, s)]).sum();
                if k == 0 { c64::new(0.0, 0.0) } else { q * law.factor(source.coefficient(), k as f64 * resolution) }
            };
            let force = motion.signal((0..=motion.padded / 2).map(line).collect());
            power.iter_mut().zip(motion.v[r].iter().zip(&force)).for_each(|(p, (v, f))| *p += v * f);
        }
    }
}

fn combined(modal: &[Vec<f64>], weights: &[f64]) -> Vec<f64> {
    let mut sum = vec![0.0; modal[0].len()];
    for (values, w) in modal.iter().zip(weights) {
        sum.iter_mut().zip(values).for_each(|(s, x)| *s += w * x);
    }
    sum
}
