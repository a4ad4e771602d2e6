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
//! error is `1 - 1/t` of a force and of the fundamental of a response, `t - 1` of its multiples.

use crate::diagnosis::candidates::eliminator::Eliminator;
use crate::diagnosis::candidates::friction::{friction, sizes};
use crate::diagnosis::candidates::start::{Fields, relative};
use crate::diagnosis::localisation::cell::{FreeForce, shrunk};
use crate::diagnosis::localisation::free_force::ForceFreedom;
use crate::diagnosis::localisation::location::Spot;
use crate::diagnosis::residual::data::{Data, RunData};
use crate::diagnosis::selection::levenberg_marquardt::variables::Variables;
use crate::diagnosis::selection::levenberg_marquardt::{Descent, Residual, descend};
use crate::effects::{ByParameter, Effect, Kind, Law, Motion, Range, Sampling, SetValued, Source, State};
use dashpot_numerics::dot;
use faer::{Mat, c64};
use std::convert::Infallible;

/// Samples a period.
const SAMPLES: usize = 128;
/// Deviations of the squared misfit within which a law explains a free force.
const ENOUGH: f64 = 3.0;
/// Multiple of what the best law of two parameters leaves up to which the best shape of a law of more may still become the
/// best once its parameters are fitted.
const PRESELECTED: f64 = 10.0;
/// Gain of the misfit, in units of what is left per datum, below which a regression has arrived: it orders candidates that are
/// refined if within dozens of such units, and is where their fit on the response starts.
const ENOUGH_FOR_A_START: f64 = 1.0;
/// How many times what the best shape of a law leaves another may leave that a fit starts from too.
const NEAR_BEST: f64 = 1.3;
/// Step of a variable for difference quotients: friction has kinks, and the step is to see past those of single samples.
const STEP: f64 = 1e-3;

/// The free forces of one place and the motions they imply.
#[derive(Clone)]
pub(crate) struct PlaceData {
    pub(super) spot: Spot,
    /// `[run][harmonic]`.
    pub(super) forces: Vec<Vec<FreeForce>>,
    /// One a run; at rest for channels.
    pub(super) motions: Vec<Motion>,
    /// Samples of the free force, one list a run.
    pub(super) histories: Vec<Vec<f64>>,
    /// Impedance of the structure between the DOFs of a leg, N s/m, one a run.
    pub(super) impedances: Vec<f64>,
    /// Its static compliance there, m/N; 0 where it is free to move.
    pub(super) static_compliance: f64,
    pub(super) sampling: Sampling,
    /// How the force changes with parameters that were free beside it, and these eliminated.
    pub(super) freedom: Option<(ForceFreedom, Eliminator)>,
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
pub(crate) struct LawFit {
    /// Effect with its parameters.
    pub source: Source,
    /// Weighted squared difference `J` of free force and law.
    pub misfit: f64,
}

impl PlaceData {
    /// The free `forces` of a spot with the motion `fields` that they imply; `impedances` (N s/m, one a run) and static
    /// compliance (m/N) are those of the structure there.
    pub(crate) fn new(
        data: &Data,
        spot: &Spot,
        forces: &[Vec<FreeForce>],
        fields: &Fields,
        impedances: Vec<f64>,
        static_compliance: f64,
        freedom: Option<ForceFreedom>,
    ) -> Self {
        let harmonics = data.runs.iter().map(|run| run.harmonics).max().unwrap_or(0);
        let sampling = Sampling::with_harmonics(SAMPLES, harmonics);
        let motion = |(run, field): (&RunData, &Mat<c64>)| {
            let harmonics = match spot {
                Spot::Leg(leg) => relative(field, *leg),
                Spot::Response(_) | Spot::Force(_) => vec![c64::new(0.0, 0.0); run.harmonics],
            };
            sampling.motion(run.omega, 0.0, &harmonics)
        };
        let motions: Vec<Motion> = data.runs.iter().zip(fields).map(motion).collect();
        let range = Range::of(&motions);
        let histories = forces.iter().map(|list| history(&sampling, list)).collect();
        let freedom = freedom.map(|freedom| {
            let eliminator = Eliminator::new(forces, &freedom);
            (freedom, eliminator)
        });
        let (spot, forces) = (spot.clone(), forces.to_vec());
        Self { spot, forces, motions, histories, impedances, static_compliance, sampling, freedom, range }
    }

    /// Force over motion at the fundamental of every run in which both can be seen.
    pub(crate) fn ratios(&self) -> Vec<Ratio> {
        self.ratios_by_run().into_iter().map(|(_, ratio)| ratio).collect()
    }

    /// The same with the number of the run in the data.
    pub(crate) fn ratios_by_run(&self) -> Vec<(usize, Ratio)> {
        let ratio_of_run = |(r, (motion, forces)): (usize, (&Motion, &Vec<FreeForce>))| {
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
        self.motions.iter().zip(&self.forces).enumerate().filter_map(ratio_of_run).collect()
    }

    /// Number of real data.
    pub(crate) fn count(&self) -> usize {
        2 * self.forces.iter().flatten().filter(|f| f.weight > 0.0).count()
    }

    /// Fits every effect that can act here, given those of [`Self::simple_fits`]: those of many parameters only where simpler
    /// ones leave more than noise and one that they contain is among the best of those.
    pub(crate) fn all_fits(&self, simple: Vec<LawFit>) -> Vec<LawFit> {
        let mut fits = simple;
        let count = self.count() as f64;
        let noise = count + ENOUGH * (2.0 * count).sqrt();
        let least = fits.iter().map(|fit| fit.misfit).fold(f64::INFINITY, f64::min);
        let bound = PRESELECTED * least;
        let contained = |effect: Effect| fits.iter().any(|f| effect.contains(f.source.effect) && f.misfit < bound);
        let many = Effect::ALL.into_iter().filter(|effect| !is_simple(*effect));
        let preselected: Vec<Effect> = many.filter(|&effect| least >= noise && contained(effect)).collect();
        if preselected.is_empty() {
            return fits;
        }
        let subsample = self.subsample();
        let on = subsample.as_ref().unwrap_or(self);
        let bound = bound * on.count() as f64 / self.count().max(1) as f64;
        let fit = |effect| on.fit_within(effect, bound, on).map(|fit| self.on_all_runs(fit));
        fits.extend(preselected.into_iter().filter_map(fit));
        fits
    }

    /// Fits every effect of no more than two parameters that can act here.
    pub(crate) fn simple_fits(&self) -> Vec<LawFit> {
        let subsample = self.subsample();
        let grid = subsample.as_ref().unwrap_or(self);
        let simple = Effect::ALL.into_iter().filter(|effect| is_simple(*effect));
        simple.filter_map(|effect| self.fit_within(effect, f64::INFINITY, grid)).collect()
    }

    /// Fits `effect` from the best shape of a grid on the runs of `grid`, the same place; `None` if it cannot act here, if its best scale
    /// has an unphysical sign, or if the best shape leaves more than `bound` there.
    pub(super) fn fit_within(&self, effect: Effect, bound: f64, grid: &Self) -> Option<LawFit> {
        match (effect.kind(), &self.spot) {
            (Kind::Relative(law), Spot::Leg(_)) if is_scale(effect, law) => self.starts_of(effect, law).next(),
            (Kind::Relative(law), Spot::Leg(_)) => self.fit_law(effect, law, grid.grid(effect, law), bound),
            (Kind::Channel(law), Spot::Response(_) | Spot::Force(_)) => self.fit_channel(effect, law),
            _ => None,
        }
    }

    /// Shapes of `effect` with their best scale, best first, each with what it leaves of the free force.
    fn grid(&self, effect: Effect, law: &dyn Law) -> Vec<(f64, Vec<f64>)> {
        let mut grid: Vec<(f64, Vec<f64>)> = Vec::new();
        if let Some(law) = friction(effect) {
            grid.extend(self.sizes(effect, law).into_iter().map(|p| (self.left_by_friction(law, &p), p)));
            grid.sort_by(|a, b| a.0.total_cmp(&b.0));
            return grid;
        }
        for mut p in effect.shapes(&self.range) {
            let (scale, misfit) = self.scale(law, &p);
            let signed = effect.parameters()[0].least < 0.0;
            if !scale.is_finite() || scale == 0.0 || (scale < 0.0 && !signed) {
                continue;
            }
            effect.scaled().iter().for_each(|&k| p[k] *= scale);
            grid.push((misfit, p));
        }
        grid.sort_by(|a, b| a.0.total_cmp(&b.0));
        grid
    }

    /// Best shapes of `effect` as they are, for fits that start from somewhere sensible.
    pub(crate) fn starts(&self, effect: Effect, most: usize) -> Vec<LawFit> {
        let (Kind::Relative(law), Spot::Leg(_)) = (effect.kind(), &self.spot) else { return Vec::new() };
        self.starts_of(effect, law).take(most).collect()
    }

    fn starts_of(&self, effect: Effect, law: &dyn Law) -> impl Iterator<Item = LawFit> {
        let fit = move |(misfit, parameters)| LawFit {
            source: Source { effect, place: self.spot.place(), state: State::Known, parameters },
            misfit,
        };
        self.grid(effect, law).into_iter().map(fit)
    }

    /// A law from the best shapes of a `grid` that leave less than `bound`.
    fn fit_law(
        &self,
        effect: Effect,
        law: &'static dyn Law,
        mut grid: Vec<(f64, Vec<f64>)>,
        bound: f64,
    ) -> Option<LawFit> {
        grid.retain(|(left, _)| *left < bound);
        let source =
            |p: &[f64]| Source { effect, place: self.spot.place(), state: State::Known, parameters: p.to_vec() };
        let (misfit, _) = grid.first()?;
        // Laws of many parameters have many local minima.
        let starts = if effect.parameters().len() > 2 { 3 } else { 1 };
        let close = |(left, _): &&(f64, Vec<f64>)| *left < NEAR_BEST * misfit;
        let descent = |(_, p): &(f64, Vec<f64>)| {
            let (variables, start) = Variables::new(&[source(p)]);
            let Ok(Descent { theta, chi_square, .. }) = descend(
                &mut Equation { data: self, friction: friction(effect), law, variables: &variables },
                &start,
                15,
            );
            LawFit { source: variables.effects(&theta).remove(0), misfit: chi_square }
        };
        let fits = grid.iter().take(starts).take_while(close).map(descent);
        fits.filter(|f| f.misfit.is_finite()).min_by(|a, b| a.misfit.total_cmp(&b.misfit))
    }

    /// Best scale of the force at `p`, and the misfit with it: about no mean, which laws that are not odd have.
    fn scale(&self, law: &dyn Law, p: &[f64]) -> (f64, f64) {
        let none = |_: usize, order: usize| vec![c64::new(0.0, 0.0); order];
        let measured = self.rows(1.0, none);
        let force = self.rows(0.0, |r, order| self.at_motion(law, p, &self.motions[r], order));
        let (product, square, total) = (-dot(&measured, &force), dot(&force, &force), dot(&measured, &measured));
        if square > 0.0 { (product / square, total - product * product / square) } else { (0.0, total) }
    }

    /// Shapes of friction in sizes that the free forces suggest.
    pub(super) fn sizes(&self, effect: Effect, law: &dyn SetValued) -> Vec<Vec<f64>> {
        let amplitudes = self.forces.iter().filter(|f| !f.is_empty()).map(|f| f[0].value.norm()).collect();
        let sizes = sizes(amplitudes);
        let shapes = effect.shapes(&self.range);
        let scaled_shape = |shape: &Vec<f64>, size: f64| {
            let mut p = shape.clone();
            effect.scaled().iter().for_each(|&k| p[k] *= size / law.bounds(shape)[1]);
            p
        };
        shapes.iter().flat_map(|shape| sizes.iter().map(move |&size| scaled_shape(shape, size))).collect()
    }

    /// What friction of the parameters `p` leaves of the free force.
    fn left_by_friction(&self, law: &dyn SetValued, p: &[f64]) -> f64 {
        self.rows(1.0, |r, order| self.held(law, p, r, order)).iter().map(|d| d * d).sum()
    }

    /// Harmonics of the force that friction of the parameters `p` would hold in run `r`.
    pub(super) fn held(&self, law: &dyn SetValued, p: &[f64], r: usize, order: usize) -> Vec<c64> {
        let pairs = self.histories[r].iter().zip(&self.motions[r].velocity);
        let samples: Vec<f64> = pairs.map(|(f, v)| law.held(p, *f, *v, self.impedances[r])).collect();
        let mut harmonics = vec![c64::new(0.0, 0.0); order];
        self.sampling.analyse(&samples, &mut harmonics);
        harmonics
    }

    /// Weighted differences between the free forces, times `measured`, and those of a law, which is given the run and the
    /// number of harmonics.
    pub(super) fn rows(&self, measured: f64, law: impl Fn(usize, usize) -> Vec<c64>) -> Vec<f64> {
        let mut rows = Vec::with_capacity(self.count());
        for (r, forces) in self.forces.iter().enumerate().filter(|(_, forces)| !forces.is_empty()) {
            for (free, f) in forces.iter().zip(law(r, forces.len())) {
                let difference = (free.value * measured - f) * free.weight.sqrt();
                rows.extend([difference.re, difference.im]);
            }
        }
        match &self.freedom {
            Some((_, eliminator)) => eliminator.eliminated(rows),
            None => rows,
        }
    }

    /// What forces of a law, `[run][harmonic]`, leave of the free forces: `J`.
    pub(super) fn left_by(&self, of_law: &[Vec<c64>]) -> f64 {
        let rows = self.rows(1.0, |r, _| of_law[r].clone());
        dot(&rows, &rows)
    }
}

/// Samples of a force with these harmonics.
pub(super) fn history(sampling: &Sampling, list: &[FreeForce]) -> Vec<f64> {
    let harmonics: Vec<c64> = (1..=list.len()).map(|h| shrunk(list, h)).collect();
    sampling.motion(1.0, 0.0, &harmonics).displacement
}

/// Whether the force of a law is its only parameter times that of the motion, which takes no mean by it.
fn is_scale(effect: Effect, law: &dyn Law) -> bool {
    effect.parameters().len() == 1 && friction(effect).is_none() && law.description().odd
}

/// Whether a law has so few parameters that it is regressed at every place.
fn is_simple(effect: Effect) -> bool {
    effect.parameters().len() <= 2
}

/// The regression of one law with parameters that shape it.
struct Equation<'a> {
    data: &'a PlaceData,
    friction: Option<&'static dyn SetValued>,
    law: &'static dyn Law,
    variables: &'a Variables,
}

impl Equation<'_> {
    fn parameters(&self, theta: &[f64]) -> Vec<f64> {
        self.variables.effects(theta).remove(0).parameters
    }

    /// Weighted differences between the free forces and those of the law with the parameters `p`.
    fn left(&self, p: &[f64]) -> Vec<f64> {
        let data = self.data;
        data.rows(1.0, |r, order| match self.friction {
            Some(friction) => data.held(friction, p, r, order),
            None => data.law_force(self.law, p, r, order),
        })
    }

    /// Derivative of the residual by variable `k`, whose parameter has the derivative `slope`; `tangents` are those of the
    /// runs.
    fn column(&self, tangents: &[Option<ByParameter>], k: usize, slope: f64) -> Vec<f64> {
        let change = |r: usize, order: usize| -> Vec<c64> {
            let mut samples = vec![0.0; self.data.motions[r].len()];
            if let Some(tangent) = &tangents[r] {
                tangent(k, &mut samples);
            }
            let mut harmonics = vec![c64::new(0.0, 0.0); order];
            self.data.sampling.analyse(&samples, &mut harmonics);
            harmonics.iter().map(|f| *f * slope).collect()
        };
        self.data.rows(0.0, change)
    }

    /// The same of friction and of laws that take a mean, by a difference.
    fn difference(&self, theta: &[f64], at: &[f64], k: usize) -> Vec<f64> {
        let mut moved = theta.to_vec();
        moved[k] += STEP;
        let there = self.left(&self.parameters(&moved));
        there.iter().zip(at).map(|(b, a)| (b - a) / STEP).collect()
    }
}

impl Residual for Equation<'_> {
    type Error = Infallible;

    fn enough(&self) -> f64 {
        ENOUGH_FOR_A_START
    }

    fn residual(&mut self, theta: &[f64]) -> Result<Vec<f64>, Infallible> {
        Ok(self.left(&self.parameters(theta)))
    }

    fn jacobian(&mut self, theta: &[f64], at: &[f64]) -> Result<Mat<f64>, Infallible> {
        let slopes = self.variables.slopes(theta).into_iter().enumerate();
        let columns: Vec<Vec<f64>> = if self.friction.is_some() || !self.law.description().odd {
            slopes.map(|(k, _)| self.difference(theta, at, k)).collect()
        } else {
            let p = self.parameters(theta);
            let runs = self.data.motions.iter().zip(&self.data.forces);
            let tangents: Vec<Option<ByParameter>> =
                runs.map(|(motion, forces)| (!forces.is_empty()).then(|| self.law.by_parameters(&p, motion))).collect();
            slopes.map(|(k, slope)| self.column(&tangents, k, slope)).collect()
        };
        Ok(Mat::from_fn(at.len(), columns.len(), |i, k| columns[k][i]))
    }
}

#[cfg(test)]
mod tests;
