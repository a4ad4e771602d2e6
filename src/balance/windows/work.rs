//! Power that sources take out of a record's motion at every sample: `d' F(d, d', states)` at their values.
//!
//! Laws without memory are evaluated sample by sample; linear laws with memory and whole-structure laws on the lines of the
//! record, `F(f) = Z(i omega) d(f)`; hysteresis is marched from the start of the part that is used, from its virgin state.

use super::band::line_omega;
use super::motion::Motion;
use crate::effects::{Constant, Kind, Law, Leg, Source};
use crate::response::linear_matrices::unit_matrix;
use crate::structure::Structure;
use dashpot_numerics::{product, transposed_product};
use faer::c64;
use std::collections::HashMap;

/// Relative motions that are at hand already.
pub(crate) struct Works<'a> {
    structure: &'a Structure,
    motion: &'a Motion,
    relative: HashMap<[usize; 2], [Vec<f64>; 2]>,
}

impl<'a> Works<'a> {
    pub(crate) fn new(structure: &'a Structure, motion: &'a Motion) -> Self {
        Self { structure, motion, relative: HashMap::new() }
    }

    /// Power of a source at its own values, W, one value a sample.
    pub(crate) fn power(&mut self, source: &Source) -> Vec<f64> {
        let mut power = vec![0.0; self.motion.q[0].len()];
        let motion = self.motion;
        match source.effect.kind() {
            Kind::Relative(_) => {
                for leg in source.place.legs() {
                    let Some(force) = self.leg_force(source, leg) else { continue };
                    let [_, v] = self.relative(leg);
                    power.iter_mut().zip(v.iter().zip(&force)).for_each(|(p, (v, f))| *p += v * f);
                }
            }
            Kind::Whole(_) => {
                for (r, force) in self.whole_force(source).iter().enumerate() {
                    power.iter_mut().zip(motion.v[r].iter().zip(force)).for_each(|(p, (v, f))| *p += v * f);
                }
            }
            Kind::Channel(_) => {}
        }
        power
    }

    /// Modal forces of a source at its own values against the motion, N/sqrt(kg): one list a mode.
    pub(crate) fn modal_force(&mut self, source: &Source) -> Vec<Vec<f64>> {
        if let Kind::Whole(_) = source.effect.kind() {
            return self.whole_force(source);
        }
        let mut sum = vec![vec![0.0; self.motion.q[0].len()]; self.motion.q.len()];
        for leg in source.place.legs() {
            let (weights, Some(force)) = (self.weights(leg), self.leg_force(source, leg)) else { continue };
            for (list, w) in sum.iter_mut().zip(weights) {
                list.iter_mut().zip(&force).for_each(|(s, f)| *s += w * f);
            }
        }
        sum
    }

    /// Weight of each mode in a relative motion.
    pub(crate) fn weights(&self, leg: Leg) -> Vec<f64> {
        let shapes = &self.motion.band.shapes;
        (0..self.motion.q.len()).map(|r| leg.relative(|i| shapes[(i, r)])).collect()
    }

    /// Relative displacement (m) and velocity (m/s) of a leg.
    pub(crate) fn relative(&mut self, leg: Leg) -> &[Vec<f64>; 2] {
        let key = [leg.first, leg.second.unwrap_or(usize::MAX)];
        let weights = self.weights(leg);
        let motion = self.motion;
        self.relative.entry(key).or_insert_with(|| [combined(&motion.q, &weights), combined(&motion.v, &weights)])
    }

    /// Force of a source in one of its legs, N, one value a sample; none where its law has none in time.
    pub(crate) fn leg_force(&mut self, source: &Source, leg: Leg) -> Option<Vec<f64>> {
        let (weights, motion) = (self.weights(leg), self.motion);
        let [d, v] = self.relative(leg);
        if source.effect.adds_to(Constant::Viscous) {
            let c = source.coefficient();
            return Some(v.iter().map(|v| c * v).collect());
        }
        let law = source.effect.law()?;
        let parameters = &source.parameters;
        if law.point(parameters, 0.0, 1.0).is_some() {
            let force = |(d, v): (&f64, &f64)| law.point(parameters, *d, *v).unwrap_or_default().force;
            return Some(d.iter().zip(v.iter()).map(force).collect());
        }
        if law.dynamic_stiffness(parameters, 1.0).is_some() {
            return Some(linear_force(law, parameters, motion, &weights));
        }
        let mut memory = law.memory(parameters)?;
        Some(d.iter().map(|d| memory.advance(*d, motion.step)).collect())
    }

    /// `sum_s (Phi^T B Phi)_rs factor q_s`, one list a mode.
    fn whole_force(&self, source: &Source) -> Vec<Vec<f64>> {
        let motion = self.motion;
        let (Kind::Whole(law), Ok(basis)) = (source.effect.kind(), unit_matrix(self.structure, source)) else {
            return vec![vec![0.0; motion.q[0].len()]; motion.q.len()];
        };
        let shapes = motion.band.shapes.as_ref();
        let modal = transposed_product(shapes, product(basis.as_ref(), shapes).as_ref());
        let resolution = line_omega(motion.padded, motion.step);
        let force_on_mode = |r: usize| {
            let line = |k: usize| {
                let q: c64 = motion.lines.iter().enumerate().map(|(s, lines)| lines[k] * modal[(r, s)]).sum();
                if k == 0 { c64::new(0.0, 0.0) } else { q * law.factor(source.coefficient(), k as f64 * resolution) }
            };
            motion.signal((0..=motion.padded / 2).map(line).collect())
        };
        (0..motion.q.len()).map(force_on_mode).collect()
    }
}

/// Force of a law that is linear, from its dynamic stiffness on the lines of the record.
fn linear_force(law: &dyn Law, parameters: &[f64], motion: &Motion, weights: &[f64]) -> Vec<f64> {
    let resolution = line_omega(motion.padded, motion.step);
    let line = |k: usize| {
        let d: c64 = motion.lines.iter().zip(weights).map(|(lines, w)| lines[k] * *w).sum();
        let z = if k == 0 { None } else { law.dynamic_stiffness(parameters, k as f64 * resolution) };
        d * z.unwrap_or(c64::new(0.0, 0.0))
    };
    motion.signal((0..=motion.padded / 2).map(line).collect())
}

fn combined(modal: &[Vec<f64>], weights: &[f64]) -> Vec<f64> {
    let mut sum = vec![0.0; modal[0].len()];
    for (values, w) in modal.iter().zip(weights) {
        sum.iter_mut().zip(values).for_each(|(s, x)| *s += w * x);
    }
    sum
}
