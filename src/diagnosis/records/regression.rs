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
//! with priors, so that a frequency that is off is not taken for a law. The motion that the laws act on is the measured one:
//! no phase is lost, however long the record, and every law costs one transform.

use super::data::Records;
use super::fitted::FittedRecords;
use crate::balance::windows::motion::Motion;
use crate::balance::windows::work::Works;
use crate::control::Control;
use crate::effects::{Effect, Place, Range, Source, State};
use dashpot_numerics::{Cholesky, RealTransform, dot};
use faer::{Mat, c64};
use std::f64::consts::{PI, TAU};

/// Prior deviations of the stiffness of a mode and of the size of a known source, as shares.
const PRIORS: [f64; 2] = [0.03, 0.2];
/// Share of the elastic force by which a model is taken to be wrong on a line.
const MODEL_SHARE: f64 = 3e-3;
/// Largest relative change of a nuisance.
const MOST_CHANGE: f64 = 0.15;
/// Lines of a taper's flank, and of the width within which a resonance is not told from its neighbours.
const FLANK: f64 = 2.0;
/// Most lines of a record, those of greatest motion.
const MOST_LINES: usize = 600;

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
    parts: Vec<Part>,
    /// Orthonormal columns of the nuisances, prior rows behind.
    nuisances: Vec<Vec<f64>>,
    /// The columns themselves, with the nuisance that one of each stands for.
    columns: Vec<(Vec<f64>, f64)>,
    /// What was measured, beside which nothing is taken out.
    measured: Vec<f64>,
    /// What is left of the measured rows beside them.
    left: Vec<f64>,
}

/// One record.
struct Part {
    motion: Motion,
    first: usize,
    taper: Vec<f64>,
    transform: RealTransform,
    lines: Vec<usize>,
    /// Rows that whiten the modes on each line, lower triangle.
    whitening: Vec<Mat<f64>>,
}

impl<'a> Regression<'a> {
    /// Of the records beside what `fit` holds; `None` where no record's sensors tell a mode apart.
    pub fn new(records: &'a Records<'a>, fit: &FittedRecords, control: &Control) -> Option<Self> {
        let made: Vec<Part> =
            records.list.iter().filter_map(|r| Part::new(Motion::new(&records.modes, &r.run, control).ok()?)).collect();
        if made.is_empty() {
            return None;
        }
        let sources = fit.sources(records);
        let (mut measured, mut known) = (Vec::new(), vec![Vec::new(); sources.len()]);
        let modes = made.iter().map(|p| p.motion.q.len()).max().unwrap_or(0);
        let mut stiffness = vec![Vec::new(); modes];
        let factor = fit.stiffness.exp();
        for part in &made {
            let mut works = Works::new(records.structure, &part.motion);
            let forces: Vec<Vec<Vec<f64>>> = sources.iter().map(|s| works.modal_force(s)).collect();
            let list = forces.iter().map(|f| part.rows(f));
            list.zip(&mut known).for_each(|(rows, all)| all.extend(rows));
            let (elastic, balance) = part.equation(factor);
            let total: Vec<f64> = part.rows(&balance);
            measured.extend(total);
            for (r, all) in stiffness.iter_mut().enumerate() {
                let only = |s: usize| if s == r { elastic[s].clone() } else { vec![0.0; elastic[s].len()] };
                all.extend(part.rows(&(0..elastic.len()).map(only).collect::<Vec<_>>()));
            }
        }
        let rows = measured.len();
        for list in &known {
            measured.iter_mut().zip(list).for_each(|(m, f)| *m -= f);
        }
        let count = modes + records.known.len();
        measured.resize(rows + count, 0.0);
        let base = Self {
            records,
            parts: made,
            nuisances: Vec::new(),
            columns: Vec::new(),
            measured: Vec::new(),
            left: measured,
        };
        let with = |mut regression: Self, unit: f64| {
            let measured = std::mem::take(&mut regression.left);
            for k in 0..count {
                let (list, prior) = if k < modes { (&stiffness[k], PRIORS[0]) } else { (&known[k - modes], PRIORS[1]) };
                let mut column: Vec<f64> = list.iter().map(|x| prior / unit * x).collect();
                column.extend((0..count).map(|j| f64::from(u8::from(j == k))));
                regression.columns.push((column.clone(), prior / unit));
                let mut own = regression.beside(column);
                let size = dot(&own, &own).sqrt();
                own.iter_mut().for_each(|x| *x /= size);
                regression.nuisances.push(own);
            }
            regression.left = regression.beside(measured.clone());
            regression.measured.clone_from(&measured);
            (regression, measured)
        };
        // Where the nuisances leave much, rows are alike: a prior weighs as much as what is left.
        let (first, measured) = with(base, 1.0);
        let unit = (first.misfit() / rows.max(1) as f64).sqrt().max(1.0);
        Some(with(Self { nuisances: Vec::new(), columns: Vec::new(), left: measured, ..first }, unit).0)
    }

    /// Weighted squared residual without any law.
    pub fn misfit(&self) -> f64 {
        dot(&self.left, &self.left)
    }

    /// Number of weighted rows.
    pub fn rows(&self) -> usize {
        self.left.len()
    }

    /// Relative changes of the stiffness of the followed modes and of the sizes of the known sources that fit best, beside a law
    /// or without one.
    pub fn corrections(&self, law: Option<&Source>) -> Option<(Vec<f64>, Vec<f64>)> {
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
        let of = |i: usize| &self.columns[i].0;
        let matrix = Mat::from_fn(count, count, |i, j| dot(of(i), of(j)));
        let rhs = Mat::from_fn(count, 1, |i, _| dot(of(i), &left));
        let solved = Cholesky::new(matrix.as_ref())?.solve(rhs.as_ref());
        let value = |i: usize| (solved[(i, 0)] * self.columns[i].1).clamp(-MOST_CHANGE, MOST_CHANGE);
        let mut modes = vec![0.0; self.records.kept];
        for (r, mode) in band.iter().enumerate().filter(|(_, mode)| **mode < self.records.kept) {
            modes[*mode] = value(r);
        }
        Some((modes, (band.len()..count).map(value).collect()))
    }

    /// `fit` with the stiffness of its modes and the sizes of known sources that the equation of motion along the measured motion
    /// demands, beside a law or without one: a motion that is measured loses no phase, however far the model is off.
    pub fn tuned(&self, fit: &FittedRecords, law: Option<&Source>) -> FittedRecords {
        let mut tuned = fit.clone();
        if let Some((modes, known)) = self.corrections(law) {
            tuned.modes = modes.iter().map(|x| x.ln_1p()).collect();
            tuned.known.iter_mut().zip(&known).for_each(|(v, x)| *v += x.ln_1p());
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
        for _ in 0..2 {
            for other in &self.nuisances {
                let share = dot(&column, other);
                column.iter_mut().zip(other).for_each(|(x, o)| *x -= share * o);
            }
        }
        column
    }

    /// The best of every effect at every place, best first.
    pub fn ranked(&self, places: &[Place], effects: &[Effect], control: &Control) -> Vec<Regressed> {
        let of = |k: usize| {
            let mut works: Vec<Works<'_>> =
                self.parts.iter().map(|p| Works::new(self.records.structure, &p.motion)).collect();
            effects.iter().filter_map(|e| self.best(*e, &places[k], &mut works)).collect::<Vec<Regressed>>()
        };
        let mut all: Vec<Regressed> = control.map(places.len(), of).into_iter().flatten().collect();
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
            column.extend(part.rows(&works.modal_force(&source)));
        }
        column.resize(self.left.len(), 0.0);
        let column = self.beside(column);
        let (product, square) = (dot(&column, &self.left), dot(&column, &column));
        let factor = product / square;
        effect.scaled().iter().for_each(|&k| source.parameters[k] *= factor);
        let allowed = source.parameters.iter().zip(effect.parameters()).all(|(v, p)| p.allows(*v));
        (factor.is_finite() && factor != 0.0 && allowed)
            .then(|| Regressed { source, misfit: self.misfit() - product * product / square })
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

impl Part {
    fn new(motion: Motion) -> Option<Self> {
        let length = smooth(motion.usable.len());
        let first = motion.usable.start;
        let flank = (FLANK * TAU / motion.band.omega[0] / motion.step) as usize;
        if length < 4 * flank.max(8) {
            return None;
        }
        let edge = |n: usize| n.min(length - 1 - n) as f64 / flank as f64;
        let taper: Vec<f64> = (0..length).map(|n| 0.5 - 0.5 * (PI * edge(n).min(1.0)).cos()).collect();
        let transform = RealTransform::new(length);
        let mut part = Self { motion, first, taper, transform, lines: Vec::new(), whitening: Vec::new() };
        let resolution = 1.0 / (length as f64 * part.motion.step);
        let band = &part.motion.band;
        let inside = |k: &usize| *k as f64 * resolution >= band.low[1] && *k as f64 * resolution <= band.high[0];
        let all: Vec<usize> = (1..length / 2).filter(inside).collect();
        part.lines.clone_from(&all);
        let elastic = part.equation(1.0).0;
        let spectra: Vec<Vec<c64>> = elastic.iter().map(|x| part.spectrum(x)).collect();
        let height = |i: usize| spectra.iter().map(|s| s[i].norm_sqr()).sum::<f64>();
        let mut order: Vec<usize> = (0..all.len()).collect();
        order.sort_by(|&a, &b| height(b).total_cmp(&height(a)));
        order.truncate(MOST_LINES);
        part.lines = order.iter().map(|&i| all[i]).collect();
        let whitening = order.iter().map(|&i| {
            let sizes: Vec<f64> = spectra.iter().map(|s| s[i].norm()).collect();
            part.whitening(all[i], &sizes)
        });
        part.whitening = whitening.collect::<Option<Vec<_>>>()?;
        (!part.lines.is_empty()).then_some(part)
    }

    /// Elastic force of every mode, and what its equation leaves: `phi^T B u - q'' - omega^2 q`.
    fn equation(&self, factor: f64) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
        let motion = &self.motion;
        let resolution = TAU / (motion.padded as f64 * motion.step);
        let mut elastic = Vec::new();
        let mut balance = Vec::new();
        for (r, omega) in motion.band.omega.iter().enumerate() {
            let square = factor * omega.powi(2);
            let inertia = |(k, z): (usize, &c64)| z * (k as f64 * resolution).powi(2);
            let mut rest = motion.signal(motion.lines[r].iter().enumerate().map(inertia).collect());
            for (dof, u) in &motion.forces {
                let shape = motion.band.shapes[(*dof, r)];
                rest.iter_mut().zip(u).for_each(|(x, u)| *x += shape * u);
            }
            let own: Vec<f64> = motion.q[r].iter().map(|q| square * q).collect();
            rest.iter_mut().zip(&own).for_each(|(x, k)| *x -= k);
            elastic.push(own);
            balance.push(rest);
        }
        (elastic, balance)
    }

    /// Lines of the tapered part of a signal.
    fn spectrum(&self, signal: &[f64]) -> Vec<c64> {
        let mut work: Vec<f64> = signal[self.first..].iter().zip(&self.taper).map(|(y, w)| y * w).collect();
        let lines = self.transform.forward(&mut work);
        self.lines.iter().map(|&k| lines[k]).collect()
    }

    /// Whitened rows of modal signals, real and imaginary parts.
    fn rows(&self, modal: &[Vec<f64>]) -> Vec<f64> {
        let spectra: Vec<Vec<c64>> = modal.iter().map(|x| self.spectrum(x)).collect();
        let mut rows = Vec::with_capacity(2 * modal.len() * self.lines.len());
        for (i, whitening) in self.whitening.iter().enumerate() {
            for r in 0..modal.len() {
                let sum: c64 = (0..=r).map(|s| spectra[s][i] * whitening[(r, s)]).sum();
                rows.extend([sum.re, sum.im]);
            }
        }
        rows
    }

    /// Inverse of the lower factor of the covariance of the modal equations on a line.
    fn whitening(&self, line: usize, elastic: &[f64]) -> Option<Mat<f64>> {
        let (motion, band) = (&self.motion, &self.motion.band);
        let count = band.omega.len();
        let resolution = TAU / (self.taper.len() as f64 * motion.step);
        let omega = line as f64 * resolution;
        let window: f64 = 0.5 * dot(&self.taper, &self.taper);
        let stiff = |r: usize| (band.omega[r].powi(2) - omega * omega).hypot(FLANK * 2.0 * band.omega[r] * resolution);
        let noise = |r: usize, s: usize| -> f64 {
            let of = |(c, (order, variance)): (usize, &(i32, f64))| {
                band.expansion[(r, c)] * band.expansion[(s, c)] * variance * omega.powi(-2 * order)
            };
            motion.sensors.iter().enumerate().map(of).sum::<f64>() * window
        };
        let covariance = Mat::from_fn(count, count, |r, s| {
            let model = if r == s { (MODEL_SHARE * elastic[r]).powi(2) * (1.0 + 1e-9) } else { 0.0 };
            stiff(r) * stiff(s) * noise(r, s) + model
        });
        let scale: Vec<f64> = (0..count).map(|r| covariance[(r, r)].max(f64::MIN_POSITIVE).sqrt()).collect();
        let unit = Mat::from_fn(count, count, |r, s| {
            covariance[(r, s)] / (scale[r] * scale[s]) + if r == s { 1e-9 } else { 0.0 }
        });
        let cholesky = Cholesky::new(unit.as_ref())?;
        let factor = cholesky.factor();
        let mut inverse = Mat::<f64>::zeros(count, count);
        for j in 0..count {
            for i in j..count {
                let rest: f64 = (j..i).map(|k| factor[(i, k)] * inverse[(k, j)]).sum();
                inverse[(i, j)] = (f64::from(u8::from(i == j)) - rest) / factor[(i, i)];
            }
        }
        Some(Mat::from_fn(count, count, |i, j| inverse[(i, j)] / scale[j]))
    }
}

/// The largest number of small factors that is no greater than `n`.
fn smooth(n: usize) -> usize {
    let mut best = 0;
    for odd in [1, 3, 5, 9, 15] {
        let mut length = 2 * odd;
        while 2 * length <= n {
            length *= 2;
        }
        if length <= n {
            best = best.max(length);
        }
    }
    best
}
