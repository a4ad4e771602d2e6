//! Then the law: the free force of a place is regressed on the motion there.
//!
//! With the free forces `g_r,h` of weights `w_r,h` and the motion `D_r,h = D_lin - C g` that they imply, the parameters
//! `p` of a law minimise
//!
//! ```text
//! J(p) = sum_r,h w_r,h | g_r,h - F_h(D_r; p) |^2
//! ```
//!
//! from the best of a grid of shapes, whose scale is linear. Errors of a channel are regressed alike: the free relative
//! error is `t - 1` of a response, `1 - 1/t` of a force.

use crate::diagnosis::candidates::eliminator::Eliminator;
use crate::diagnosis::candidates::friction::{held, sizes, slides};
use crate::diagnosis::candidates::start::{Fields, relative};
use crate::diagnosis::candidates::start_grids::{Range, scaled, shapes};
use crate::diagnosis::localisation::free_force::{ForceFreedom, FreeForce};
use crate::diagnosis::localisation::location::Spot;
use crate::diagnosis::residual::data::{Data, RunData};
use crate::diagnosis::selection::levenberg_marquardt::{Descent, Residual, Variables, descend};
use crate::effects::{ChannelLaw, Effect, Law, Motion, Sampling, Source, State, effect::Kind};
use dashpot_numerics::dot;
use faer::{Mat, c64};
use std::convert::Infallible;

/// Samples a period.
const SAMPLES: usize = 128;
/// Deviations of the squared misfit within which a law explains a free force.
const ENOUGH: f64 = 3.0;
/// Step of a variable for difference quotients: friction has kinks, and the step is to see past those of single samples.
const STEP: f64 = 1e-3;

/// The free forces of one place and the motions they imply.
pub(crate) struct PlaceData {
    spot: Spot,
    /// `[run][harmonic]`.
    pub(crate) forces: Vec<Vec<FreeForce>>,
    /// One a run; at rest for channels.
    pub(crate) motions: Vec<Motion>,
    /// Samples of the free force, one list a run.
    pub(crate) histories: Vec<Vec<f64>>,
    /// Impedance of the structure between the DOFs of a leg, N s/m, one a run.
    impedances: Vec<f64>,
    pub(crate) sampling: Sampling,
    /// Parameters that were free beside the force.
    freedom: Option<Eliminator>,
    /// Range of the motion.
    pub range: Range,
}

/// Ratio of the fundamental of a free force to that of its motion in one run.
#[derive(Debug, Clone, Copy)]
#[expect(clippy::struct_field_names, reason = "the ratio is what the struct is about")]
pub(crate) struct Ratio {
    /// `g / D`, N/m.
    pub ratio: c64,
    /// Standard deviation of a real part, N/m.
    pub deviation: f64,
    /// One over its square.
    pub weight: f64,
    /// `|D|`, m.
    pub amplitude: f64,
    /// Circular frequency, rad/s.
    pub omega: f64,
}

/// A law fitted to the free forces of a place.
#[derive(Debug, Clone, PartialEq)]
pub struct LawFit {
    /// Effect with its parameters.
    pub source: Source,
    /// Weighted squared difference `J` of free force and law.
    pub misfit: f64,
}

impl PlaceData {
    /// The free `forces` of a spot with the motion `fields` that they imply; `impedances` (N s/m, one a run) are those of
    /// the structure there.
    pub fn new(
        data: &Data,
        spot: &Spot,
        forces: &[Vec<FreeForce>],
        fields: &Fields,
        impedances: Vec<f64>,
        freedom: Option<ForceFreedom>,
    ) -> Self {
        let sampling = Sampling::new(SAMPLES);
        let motion = |(run, field): (&RunData, &Mat<c64>)| {
            let harmonics = match spot {
                Spot::Leg(leg) => relative(field, *leg),
                Spot::Response(_) | Spot::Force(_) => vec![c64::new(0.0, 0.0); run.harmonics],
            };
            sampling.motion(run.omega, 0.0, &harmonics)
        };
        let motions: Vec<Motion> = data.runs.iter().zip(fields).map(motion).collect();
        let range = range(&motions);
        let history = |list: &Vec<FreeForce>| {
            let harmonics: Vec<c64> = (1..=list.len()).map(|h| shrunk(list, h)).collect();
            sampling.motion(1.0, 0.0, &harmonics).displacement
        };
        let histories = forces.iter().map(history).collect();
        let freedom = freedom.map(|freedom| Eliminator::new(forces, &freedom));
        Self { spot: spot.clone(), forces: forces.to_vec(), motions, histories, impedances, sampling, freedom, range }
    }

    /// Force over motion at the fundamental of every run in which both can be seen.
    pub fn ratios(&self) -> Vec<Ratio> {
        self.ratios_by_run().into_iter().map(|(_, ratio)| ratio).collect()
    }

    /// The same with the number of the run in the data.
    pub fn ratios_by_run(&self) -> Vec<(usize, Ratio)> {
        let of = |(r, (motion, forces)): (usize, (&Motion, &Vec<FreeForce>))| {
            let (d, free) = (*motion.harmonics.first()?, *forces.first()?);
            let amplitude = d.norm();
            let weight = free.weight * amplitude * amplitude;
            let ratio = || Ratio {
                ratio: free.value / d,
                deviation: weight.sqrt().recip(),
                weight,
                amplitude,
                omega: motion.omega,
            };
            (amplitude > 0.0 && free.weight > 0.0).then(|| (r, ratio()))
        };
        self.motions.iter().zip(&self.forces).enumerate().filter_map(of).collect()
    }

    /// Number of real data.
    pub fn count(&self) -> usize {
        2 * self.forces.iter().flatten().filter(|f| f.weight > 0.0).count()
    }

    /// Fits every effect that can act here; those of many parameters only where simpler ones leave more than noise.
    pub fn fits(&self) -> Vec<LawFit> {
        let simple = |effect: &Effect| effect.parameters().len() <= 2;
        let (few, many): (Vec<Effect>, Vec<Effect>) = Effect::ALL.into_iter().partition(simple);
        let mut fits: Vec<LawFit> = few.into_iter().filter_map(|effect| self.fit(effect)).collect();
        let count = self.count() as f64;
        let noise = count + ENOUGH * (2.0 * count).sqrt();
        if !fits.iter().any(|fit| fit.misfit < noise) {
            fits.extend(many.into_iter().filter_map(|effect| self.fit(effect)));
        }
        fits
    }

    /// Fits `effect`; `None` if it cannot act here or its best scale has an unphysical sign.
    pub fn fit(&self, effect: Effect) -> Option<LawFit> {
        match (effect.kind(), &self.spot) {
            (Kind::Relative(law), Spot::Leg(_)) => self.fit_law(effect, law),
            (Kind::Channel(law), Spot::Response(_) | Spot::Force(_)) => self.fit_channel(effect, law),
            _ => None,
        }
    }

    /// Shapes of `effect` with their best scale, best first, each with what it leaves of the free force.
    fn grid(&self, effect: Effect, law: &dyn Law) -> Vec<(f64, Vec<f64>)> {
        let mut grid: Vec<(f64, Vec<f64>)> = Vec::new();
        if slides(effect) {
            grid.extend(self.sizes(effect).into_iter().map(|p| (self.left_by_friction(effect, &p), p)));
            grid.sort_by(|a, b| a.0.total_cmp(&b.0));
            return grid;
        }
        for mut p in shapes(effect, &self.range) {
            let (scale, misfit) = self.scale(law, &p);
            let signed = effect.parameters()[0].least < 0.0;
            if !scale.is_finite() || scale == 0.0 || (scale < 0.0 && !signed) {
                continue;
            }
            scaled(effect).iter().for_each(|&k| p[k] *= scale);
            grid.push((misfit, p));
        }
        grid.sort_by(|a, b| a.0.total_cmp(&b.0));
        grid
    }

    /// Best shapes of `effect` as they are, for fits that start from somewhere sensible.
    pub fn starts(&self, effect: Effect, most: usize) -> Vec<LawFit> {
        let (Kind::Relative(law), Spot::Leg(_)) = (effect.kind(), &self.spot) else { return Vec::new() };
        let fit = |(misfit, parameters)| LawFit {
            source: Source { effect, place: self.spot.place(), state: State::Known, parameters },
            misfit,
        };
        self.grid(effect, law).into_iter().take(most).map(fit).collect()
    }

    fn fit_law(&self, effect: Effect, law: &'static dyn Law) -> Option<LawFit> {
        let grid = self.grid(effect, law);
        let source =
            |p: &[f64]| Source { effect, place: self.spot.place(), state: State::Known, parameters: p.to_vec() };
        let (misfit, parameters) = grid.first()?;
        if effect.parameters().len() == 1 && !slides(effect) {
            return Some(LawFit { source: source(parameters), misfit: *misfit });
        }
        // Laws of many parameters have many valleys.
        let starts = if effect.parameters().len() > 2 { 4 } else { 1 };
        let descent = |(_, p): &(f64, Vec<f64>)| {
            let (variables, start) = Variables::new(&[source(p)]);
            let Ok(Descent { theta, chi_square, .. }) =
                descend(&mut Equation { data: self, effect, law, variables: &variables }, &start, 15);
            LawFit { source: variables.effects(&theta).remove(0), misfit: chi_square }
        };
        let fits = grid.iter().take(starts).map(descent);
        fits.filter(|f| f.misfit.is_finite()).min_by(|a, b| a.misfit.total_cmp(&b.misfit))
    }

    /// Best scale of the force at `p`, and the misfit with it.
    fn scale(&self, law: &dyn Law, p: &[f64]) -> (f64, f64) {
        let none = |_: usize, order: usize| vec![c64::new(0.0, 0.0); order];
        let measured = self.rows(1.0, none);
        let force = self.rows(0.0, |r, order| self.law_force(law, p, &self.motions[r], order));
        let (product, square, total) = (-dot(&measured, &force), dot(&force, &force), dot(&measured, &measured));
        if square > 0.0 { (product / square, total - product * product / square) } else { (0.0, total) }
    }

    /// Shapes of friction in sizes that the free forces suggest.
    fn sizes(&self, effect: Effect) -> Vec<Vec<f64>> {
        let amplitudes = self.forces.iter().filter(|f| !f.is_empty()).map(|f| f[0].value.norm()).collect();
        let sizes = sizes(amplitudes);
        let largest = |p: &[f64]| p[usize::from(effect == Effect::Stribeck)];
        let shapes = shapes(effect, &self.range);
        let of = |shape: &Vec<f64>, size: f64| {
            let mut p = shape.clone();
            scaled(effect).iter().for_each(|&k| p[k] *= size / largest(shape));
            p
        };
        shapes.iter().flat_map(|shape| sizes.iter().map(move |&size| of(shape, size))).collect()
    }

    /// What friction of the parameters `p` leaves of the free force.
    fn left_by_friction(&self, effect: Effect, p: &[f64]) -> f64 {
        self.rows(1.0, |r, order| self.friction(effect, p, r, order)).iter().map(|d| d * d).sum()
    }

    /// Harmonics of the force that friction of the parameters `p` would hold in run `r`.
    pub(crate) fn friction(&self, effect: Effect, p: &[f64], r: usize, order: usize) -> Vec<c64> {
        let samples = held(effect, p, &self.histories[r], &self.motions[r], self.impedances[r]);
        let mut harmonics = vec![c64::new(0.0, 0.0); order];
        self.sampling.analyse(&samples, &mut harmonics);
        harmonics
    }

    /// Weighted differences between the free forces, times `measured`, and those of a law, which is given the run and the
    /// number of harmonics.
    fn rows(&self, measured: f64, law: impl Fn(usize, usize) -> Vec<c64>) -> Vec<f64> {
        let mut rows = Vec::with_capacity(self.count());
        for (r, forces) in self.forces.iter().enumerate() {
            for (free, f) in forces.iter().zip(law(r, forces.len())) {
                let difference = (free.value * measured - f) * free.weight.sqrt();
                rows.extend([difference.re, difference.im]);
            }
        }
        match &self.freedom {
            Some(freedom) => freedom.eliminated(rows),
            None => rows,
        }
    }

    pub(crate) fn law_force(&self, law: &dyn Law, p: &[f64], motion: &Motion, order: usize) -> Vec<c64> {
        if law.dynamic_stiffness(p, motion.omega).is_some() {
            let at = |(i, d): (usize, &c64)| {
                law.dynamic_stiffness(p, (i + 1) as f64 * motion.omega).unwrap_or(c64::new(0.0, 0.0)) * d
            };
            return motion.harmonics.iter().enumerate().map(at).collect();
        }
        let mut samples = vec![0.0; motion.len()];
        law.force(p, motion, &mut samples);
        let mut harmonics = vec![c64::new(0.0, 0.0); order];
        self.sampling.analyse(&samples, &mut harmonics);
        harmonics
    }

    fn fit_channel(&self, effect: Effect, law: &dyn ChannelLaw) -> Option<LawFit> {
        let force = matches!(self.spot, Spot::Force(_));
        let value = |t: c64| if force { 1.0 - 1.0 / t } else { t - 1.0 };
        let misfit = |p: f64| -> f64 {
            let of = |r: usize, order: usize| {
                (1..=order).map(|h| value(law.transfer(p, h as f64 * self.motions[r].omega))).collect()
            };
            let rows = self.rows(1.0, of);
            dot(&rows, &rows)
        };
        let step = if effect == Effect::Delay { 1e-7 / self.range.omega.max(1e-3) * 100.0 } else { 1e-5 };
        let mut p = law.neutral();
        for _ in 0..12 {
            // Newton's method by differences: the misfit is nearly quadratic in the only parameter.
            let (low, mid, high) = (misfit(p - step), misfit(p), misfit(p + step));
            let curvature = (high - 2.0 * mid + low) / (step * step);
            if curvature <= 0.0 {
                break;
            }
            let change = -(high - low) / (2.0 * step) / curvature;
            p += change;
            if effect == Effect::Gain {
                p = p.clamp(0.05, 20.0);
            }
        }
        if !p.is_finite() || !effect.parameters()[0].allows(p) {
            return None;
        }
        let source = Source { effect, place: self.spot.place(), state: State::Known, parameters: vec![p] };
        Some(LawFit { source, misfit: misfit(p) })
    }
}

/// A free force drawn to zero where the data hardly see it: harmonics are no larger than the fundamental over the order.
pub(crate) fn shrunk(forces: &[FreeForce], h: usize) -> c64 {
    let free = forces[h - 1];
    if h == 1 {
        return free.value;
    }
    let prior = (forces[0].value.norm() / h as f64).powi(2);
    free.value * (prior * free.weight / (1.0 + prior * free.weight))
}

pub(crate) fn range(motions: &[Motion]) -> Range {
    let peak = |x: &[f64]| x.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let sizes: Vec<f64> = motions.iter().map(|m| peak(&m.displacement)).collect();
    let logs: f64 = motions.iter().map(|m| m.omega.ln()).sum();
    Range {
        displacement: sizes.iter().fold(0.0, |m, &s| f64::max(m, s)),
        least: sizes.iter().fold(f64::INFINITY, |m, &s| f64::min(m, s)),
        velocity: motions.iter().map(|m| peak(&m.velocity)).fold(0.0, f64::max),
        omega: (logs / motions.len().max(1) as f64).exp(),
    }
}

/// The regression of one law with parameters that shape it.
struct Equation<'a> {
    data: &'a PlaceData,
    effect: Effect,
    law: &'static dyn Law,
    variables: &'a Variables,
}

impl Equation<'_> {
    fn parameters(&self, theta: &[f64]) -> Vec<f64> {
        self.variables.effects(theta).remove(0).parameters
    }

    /// Derivative of the residual by variable `k`, whose parameter has the derivative `slope`.
    fn column(&self, theta: &[f64], at: &[f64], k: usize, slope: f64) -> Vec<f64> {
        if slides(self.effect) {
            let mut moved = theta.to_vec();
            moved[k] += STEP;
            let p = self.parameters(&moved);
            let there = self.data.rows(1.0, |r, order| self.data.friction(self.effect, &p, r, order));
            return there.iter().zip(at).map(|(b, a)| (b - a) / STEP).collect();
        }
        let p = self.parameters(theta);
        let change = |r: usize, order: usize| -> Vec<c64> {
            let motion = &self.data.motions[r];
            let mut samples = vec![0.0; motion.len()];
            self.law.parameter_tangent(&p, k, motion, &mut samples);
            let mut harmonics = vec![c64::new(0.0, 0.0); order];
            self.data.sampling.analyse(&samples, &mut harmonics);
            harmonics.iter().map(|f| *f * slope).collect()
        };
        self.data.rows(0.0, change)
    }
}

impl Residual for Equation<'_> {
    type Error = Infallible;

    fn residual(&mut self, theta: &[f64]) -> Result<Vec<f64>, Infallible> {
        let p = self.parameters(theta);
        let data = self.data;
        Ok(data.rows(1.0, |r, order| {
            if slides(self.effect) {
                data.friction(self.effect, &p, r, order)
            } else {
                data.law_force(self.law, &p, &data.motions[r], order)
            }
        }))
    }

    fn jacobian(&mut self, theta: &[f64], at: &[f64]) -> Result<Mat<f64>, Infallible> {
        let slopes = self.variables.slopes(theta);
        let columns: Vec<Vec<f64>> =
            slopes.iter().enumerate().map(|(k, slope)| self.column(theta, at, k, *slope)).collect();
        Ok(Mat::from_fn(at.len(), columns.len(), |i, k| columns[k][i]))
    }
}
