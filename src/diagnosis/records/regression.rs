//! Laws regressed on what is left of the equation of motion along the measured motion, before any is fitted to the response
//! (restoring force, Masri and Caughey 1979; force-state mapping, Crawley and Aubert 1986).
//!
//! ```text
//! g_r = phi_r^T B u - q_r'' - omega_r^2 q_r - phi_r^T f_known  =  sum_j c_j phi_r^T f_j(d, d')  + noise
//! ```
//!
//! for every mode `r` that the sensors tell apart (`crate::balance::windows`), on the lines of the tapered record inside the
//! band of its filter. A line is weighted by the covariance that the noise of the channels leaves there, and by a share of the
//! elastic force by which any model is wrong. Stiffness of every mode and sizes of known sources are eliminated beside the law,
//! with priors, so that a frequency that is off is not taken for a law. So are the gain of the measured force, and what wrong
//! shapes bring of one mode into the equation of another. The motion that the laws act on is the measured one: no phase is lost,
//! however long the record, and every law costs one transform.

use super::data::{RecordData, Records};
use super::fitted::FittedRecords;
use super::modal_equations::{Equation, ModalEquations};
use crate::balance::windows::motion::Motion;
use crate::balance::windows::work::Works;
use crate::control::Control;
use crate::effects::{Effect, Place, Range, Source, State};
use dashpot_numerics::{Cholesky, dot};
use faer::Mat;
use std::f64::consts::TAU;

/// Prior deviations of the stiffness of a mode, of the size of a known source and of the shapes of modes, as shares.
const PRIORS: [f64; 3] = [0.03, 0.2, 0.02];
/// Most pairs of modes whose shapes are taken to be mixed by the errors of the model: those of nearest numbers.
const MOST_PAIRS: usize = 12;
/// Places at which laws of several shapes are weighed.
const PLACES: usize = 9;
/// Share of a column beside the nuisances below which they are taken out one by one: differences of squares round there.
const ALMOST_ALL: f64 = 1e-6;
/// Largest relative change of a nuisance; of the damping of a mode that which leaves least of it, for a law in proportion to stiffness states
/// that of high modes many times too large, and a fit that begins there sees nothing of a mode that rings.
const MOST_CHANGE: f64 = 0.15;
const LEAST_DAMPING: f64 = -0.97;

/// A law at a place with the coefficient that fits best.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Regressed {
    /// Effect, place and parameters.
    pub source: Source,
    /// Weighted squared residual with it.
    pub misfit: f64,
}

/// What is left of the equations of motion of all records, weighted, with nuisances eliminated.
pub(crate) struct Regression<'a> {
    records: &'a Records<'a>,
    parts: Vec<ModalEquations>,
    /// Orthonormal columns of the nuisances, prior rows behind.
    nuisances: Vec<Vec<f64>>,
    /// The columns themselves, with the nuisance that one of each stands for.
    columns: Vec<(Vec<f64>, f64)>,
    /// What was measured, beside which nothing is taken out.
    measured: Vec<f64>,
    /// What is left of the measured rows beside them.
    left: Vec<f64>,
}

impl<'a> Regression<'a> {
    /// Of the records beside what `fit` holds; `None` where no record's sensors tell a mode apart.
    pub(super) fn new(records: &'a Records<'a>, fit: &FittedRecords, control: &Control) -> Option<Self> {
        let record_equations = |r: &RecordData| ModalEquations::new(Motion::new(&records.modes, &r.run, control).ok()?);
        let made: Vec<ModalEquations> = records.list.iter().filter_map(record_equations).collect();
        if made.is_empty() {
            return None;
        }
        let sources = fit.sources(records);
        let (mut measured, mut known) = (Vec::new(), vec![Vec::new(); sources.len()]);
        let modes = made.iter().map(|p| p.motion.q.len()).max().unwrap_or(0);
        let pairs = pairs(modes);
        let mut stiffness = vec![Vec::new(); modes];
        let mut coupled = vec![Vec::new(); pairs.len()];
        let mut driven = vec![Vec::new(); modes];
        let mut damped = vec![Vec::new(); if records.damped() > 0 { modes } else { 0 }];
        let factor = fit.stiffness.exp();
        for part in &made {
            let mut works = Works::new(records.structure, &part.motion);
            let mut forces: Vec<Vec<Vec<f64>>> = sources.iter().map(|s| works.modal_force(s)).collect();
            let whole = damp(&mut forces, &sources, &part.motion.band.modes, &fit.damping);
            for (r, all) in damped.iter_mut().enumerate() {
                all.extend(part.rows_of(r, whole.get(r), whole.len()));
            }
            let list = forces.iter().map(|f| part.rows(f));
            list.zip(&mut known).for_each(|(rows, all)| all.extend(rows));
            let Equation { elastic, pushed, balance } = part.equation(factor);
            measured.extend(part.rows(&balance));
            let count = elastic.len();
            for (r, (all, pushes)) in stiffness.iter_mut().zip(&mut driven).enumerate() {
                all.extend(part.rows_of(r, elastic.get(r), count));
                pushes.extend(part.rows_of(r, pushed.get(r), count));
            }
            for (all, [r, s]) in coupled.iter_mut().zip(&pairs) {
                all.extend(part.rows_of(*r, part.leak([*r, *s], &elastic).as_ref(), count));
            }
        }
        let rows = measured.len();
        for list in &known {
            measured.iter_mut().zip(list).for_each(|(m, f)| *m -= f);
        }
        let stiff = stiffness.into_iter().map(|rows| (rows, PRIORS[0]));
        let sized = known.into_iter().take(records.known.len()).map(|rows| (rows, PRIORS[1]));
        let damped = damped.into_iter().map(|rows| (rows, PRIORS[1]));
        let shaped = coupled.into_iter().chain(driven).map(|rows| (rows, PRIORS[2]));
        let lists: Vec<(Vec<f64>, f64)> = stiff.chain(sized).chain(damped).chain(shaped).collect();
        measured.resize(rows + lists.len(), 0.0);
        let base = Self {
            records,
            parts: made,
            nuisances: Vec::new(),
            columns: Vec::new(),
            measured: Vec::new(),
            left: Vec::new(),
        };
        // Where the nuisances leave much, rows are alike: a prior weighs as much as what is left.
        let first = base.eliminated(&lists, &measured, 1.0);
        let unit = (first.misfit() / rows.max(1) as f64).sqrt().max(1.0);
        Some(first.eliminated(&lists, &measured, unit))
    }

    /// With nuisances of these rows and prior deviations taken out of what was `measured`; a prior weighs `unit` squared.
    fn eliminated(mut self, lists: &[(Vec<f64>, f64)], measured: &[f64], unit: f64) -> Self {
        (self.nuisances, self.columns) = (Vec::new(), Vec::new());
        for (k, (list, prior)) in lists.iter().enumerate() {
            let mut column: Vec<f64> = list.iter().map(|x| prior / unit * x).collect();
            column.extend((0..lists.len()).map(|j| f64::from(u8::from(j == k))));
            self.columns.push((column.clone(), prior / unit));
            let mut own = self.beside(self.beside(column));
            let size = dot(&own, &own).sqrt();
            own.iter_mut().for_each(|x| *x /= size);
            self.nuisances.push(own);
        }
        self.left = self.beside(self.beside(measured.to_vec()));
        self.measured = measured.to_vec();
        self
    }

    /// Weighted squared residual without any law.
    pub(super) fn misfit(&self) -> f64 {
        dot(&self.left, &self.left)
    }

    /// Number of weighted rows.
    pub(super) fn rows(&self) -> usize {
        self.left.len()
    }

    /// Relative changes of the stiffness of the followed modes, of the sizes of the known sources and of the damping of the modes that
    /// fit best, beside a law or without one.
    pub(super) fn corrections(&self, law: Option<&Source>) -> Option<[Vec<f64>; 3]> {
        let band = &self.parts[0].motion.band.modes;
        if self.parts.iter().any(|p| p.motion.band.modes != *band) {
            return None;
        }
        let mut left = self.measured.clone();
        if let Some(law) = law {
            let mut at = 0;
            for part in &self.parts {
                let mut works = Works::new(self.records.structure, &part.motion);
                for row in part.rows(&works.modal_force(law)) {
                    left[at] -= row;
                    at += 1;
                }
            }
        }
        let count = self.columns.len();
        let column = |i: usize| &self.columns[i].0;
        let matrix = Mat::from_fn(count, count, |i, j| dot(column(i), column(j)));
        let rhs = Mat::from_fn(count, 1, |i, _| dot(column(i), &left));
        let solved = Cholesky::new(matrix.as_ref())?.solve(rhs.as_ref());
        let within = |i: usize, least: f64| (solved[(i, 0)] * self.columns[i].1).clamp(least, MOST_CHANGE);
        let value = |i: usize| within(i, -MOST_CHANGE);
        let of_modes = |count: usize, first: usize, least: f64| {
            let mut list = vec![0.0; count];
            for (r, mode) in band.iter().enumerate().filter(|(_, mode)| **mode < count) {
                list[*mode] = within(first + r, least);
            }
            list
        };
        let known = band.len()..band.len() + self.records.known.len();
        let damping = of_modes(self.records.damped(), known.end, LEAST_DAMPING);
        Some([of_modes(self.records.kept, 0, -MOST_CHANGE), known.map(value).collect(), damping])
    }

    /// `fit` with the stiffness of its modes and the sizes of known sources that the equation of motion along the measured motion
    /// demands, beside a law or without one: a motion that is measured loses no phase, however far the model is off.
    pub(super) fn tuned(&self, fit: &FittedRecords, law: Option<&Source>) -> FittedRecords {
        let mut tuned = fit.clone();
        if let Some([modes, known, damping]) = self.corrections(law) {
            // The equation of motion was asked with all mass as stated and no part corrected.
            tuned.modes = modes.iter().map(|x| x.ln_1p() + fit.mass).collect();
            if let Some((all, parts)) = self.records.parts.explaining(&tuned.modes) {
                let explained = self.records.stiffness_by_parts(&parts);
                tuned.modes.iter_mut().zip(explained).for_each(|(v, by)| *v -= all + by);
                tuned.stiffness += all;
                tuned.parts = parts;
            }
            tuned.known.iter_mut().zip(&known).for_each(|(v, x)| *v += x.ln_1p());
            tuned.damping.iter_mut().zip(&damping).for_each(|(v, x)| *v += x.ln_1p());
            if tuned.modes.len() == 1 {
                tuned.stiffness += tuned.modes[0];
                tuned.modes[0] = 0.0;
            }
        }
        tuned.effects.extend(law.cloned());
        tuned
    }

    /// A column with what the nuisances explain taken out.
    fn beside(&self, mut column: Vec<f64>) -> Vec<f64> {
        for other in &self.nuisances {
            let share = dot(&column, other);
            column.iter_mut().zip(other).for_each(|(x, o)| *x -= share * o);
        }
        column
    }

    /// The best of every effect at every place, best first; effects of several shapes at the places only where one of a single shape
    /// explains most.
    pub(super) fn ranked(&self, places: &[Place], effects: &[Effect], control: &Control) -> Vec<Regressed> {
        let (plain, shaped): (Vec<Effect>, Vec<Effect>) = effects.iter().partition(|e| e.parameters().len() == 1);
        let regressed = |places: &[Place], effects: &[Effect]| -> Vec<Regressed> {
            let best_at_place = |k: usize| {
                let mut works: Vec<Works<'_>> =
                    self.parts.iter().map(|p| Works::new(self.records.structure, &p.motion)).collect();
                effects.iter().filter_map(|e| self.best(*e, &places[k], &mut works)).collect::<Vec<Regressed>>()
            };
            control.map(places.len(), best_at_place).into_iter().flatten().collect()
        };
        let mut all = regressed(places, &plain);
        all.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
        all.extend(regressed(&foremost(all.iter().map(|r| &r.source.place)), &shaped));
        all.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
        all
    }

    /// The best shape of an effect at a place.
    fn best(&self, effect: Effect, place: &Place, works: &mut [Works<'_>]) -> Option<Regressed> {
        let range = self.range(place, works)?;
        let fits = effect.shapes(&range).into_iter().filter_map(|shape| self.scaled(effect, place, shape, works));
        fits.min_by(|a, b| a.misfit.total_cmp(&b.misfit))
    }

    /// A shape with the scale that fits best.
    fn scaled(&self, effect: Effect, place: &Place, shape: Vec<f64>, works: &mut [Works<'_>]) -> Option<Regressed> {
        let mut source = Source { effect, place: place.clone(), state: State::Known, parameters: shape };
        let mut column = Vec::with_capacity(self.left.len());
        for (part, works) in self.parts.iter().zip(works) {
            column.extend(rows_of(part, works, &source));
        }
        column.resize(self.left.len(), 0.0);
        let (product, square) = self.against_left(column);
        let factor = product / square;
        effect.scaled().iter().for_each(|&k| source.parameters[k] *= factor);
        let allowed = source.parameters.iter().zip(effect.parameters()).all(|(v, p)| p.allows(*v));
        (factor.is_finite() && factor != 0.0 && allowed)
            .then(|| Regressed { source, misfit: self.misfit() - product * product / square })
    }

    /// Products of a column, with what the nuisances explain of it taken out, with what is left and with itself. What is left is orthogonal
    /// to the nuisances, so that most columns need not be changed for it.
    fn against_left(&self, column: Vec<f64>) -> (f64, f64) {
        let all = dot(&column, &column);
        let explained: f64 = self.nuisances.iter().map(|n| dot(&column, n).powi(2)).sum();
        if all - explained > ALMOST_ALL * all {
            return (dot(&column, &self.left), all - explained);
        }
        let column = self.beside(column);
        (dot(&column, &self.left), dot(&column, &column))
    }

    /// Range of the motion at a place.
    fn range(&self, place: &Place, works: &mut [Works<'_>]) -> Option<Range> {
        let leg = place.legs().first().copied()?;
        let mut range = Range { displacement: 0.0, least: f64::INFINITY, velocity: 0.0, omega: 1.0 };
        for (part, works) in self.parts.iter().zip(works) {
            let used = part.first..part.first + part.taper.len();
            let [d, v] = works.relative(leg);
            let most = |x: &[f64]| x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let (d, v) = (most(&d[used.clone()]), most(&v[used]));
            range.displacement = range.displacement.max(d);
            range.least = range.least.min(d);
            range.velocity = range.velocity.max(v);
        }
        range.omega = TAU * self.records.list[0].dominant_hz;
        // A decay passes through all amplitudes.
        range.least *= 0.3;
        (range.displacement > 0.0 && range.velocity > 0.0).then_some(range)
    }
}

/// Whitened rows of a law at its own values.
fn rows_of(part: &ModalEquations, works: &mut Works<'_>, source: &Source) -> Vec<f64> {
    if let [leg] = source.place.legs()[..]
        && let Some(force) = works.leg_force(source, leg)
    {
        return part.rows_along(&works.weights(leg), &force);
    }
    part.rows(&works.modal_force(source))
}

/// The first [`PLACES`] different ones of some places.
pub(super) fn foremost<'p>(places: impl Iterator<Item = &'p Place>) -> Vec<Place> {
    let mut first: Vec<Place> = Vec::new();
    for place in places {
        if first.len() < PLACES && !first.iter().any(|p| p.is_same(place)) {
            first.push(place.clone());
        }
    }
    first
}

/// Pairs of different modes, those of nearest numbers first, at most [`MOST_PAIRS`].
fn pairs(modes: usize) -> Vec<[usize; 2]> {
    let mut all: Vec<[usize; 2]> =
        (0..modes).flat_map(|r| (0..modes).map(move |s| [r, s])).filter(|[r, s]| r != s).collect();
    all.sort_by_key(|[r, s]| r.abs_diff(*s));
    all.truncate(MOST_PAIRS);
    all
}

/// Takes the factors on the damping of modes into the modal forces of laws of the whole structure; their sums over these laws. `forces`
/// are `[source][mode][sample]`, `modes` their numbers, `logarithms` those of the factors.
fn damp(forces: &mut [Vec<Vec<f64>>], sources: &[Source], modes: &[usize], logarithms: &[f64]) -> Vec<Vec<f64>> {
    let mut sums = vec![Vec::new(); modes.len()];
    for (force, _) in forces.iter_mut().zip(sources).filter(|(_, source)| source.place == Place::Whole(None)) {
        for ((signal, mode), sum) in force.iter_mut().zip(modes).zip(&mut sums) {
            let factor = logarithms.get(*mode).map_or(1.0, |v| v.exp());
            signal.iter_mut().for_each(|f| *f *= factor);
            sum.resize(signal.len(), 0.0);
            sum.iter_mut().zip(signal.iter()).for_each(|(s, f): (&mut f64, &f64)| *s += f);
        }
    }
    sums
}

#[cfg(test)]
mod tests;
