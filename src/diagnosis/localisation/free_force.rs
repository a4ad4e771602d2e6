//! Place before law: at every place, run by run and harmonic by harmonic, one free complex force.
//!
//! With the whitened residual `e` of the model and the whitened response `a` of the channels to a unit at the place,
//!
//! ```text
//! chi^2 = sum_r,h ( |e|^2 - |a^H e|^2 / |a|^2 )
//! ```
//!
//! is what no law at that place could explain: at the true place it falls to the noise whatever the law. Two places take
//! a pair of forces. An error of a channel is a place like any other: its column is that channel alone.

mod without_run;

use super::cell::{Cell, Eliminated, dot};
use crate::control::Control;
use crate::diagnosis::localisation::cell::FreeForce;
use crate::diagnosis::localisation::location::{Receptances, Spot};
use crate::diagnosis::residual::data::{Data, DiagnosisError};
use crate::diagnosis::residual::prediction::{Predictor, RunPrediction};
use crate::diagnosis::residual::whitening::Whitening;
use crate::diagnosis::updating::noise_model::Linearisation;
use crate::effects::Leg;
use crate::math::least_squares::solve_symmetric;
use dashpot_numerics::product_transposed;
use faer::{Mat, MatRef, c64};
use std::sync::OnceLock;

/// Squared change of a harmonic, in units of its noise, that all free parameters together make of one deviation each, below which they
/// count as held: chance would bring ten times as much.
const FELT: f64 = 0.1;

/// The residual of a model seen from every place.
#[derive(Debug, Clone)]
pub(crate) struct Screen {
    /// Places.
    pub spots: Vec<Spot>,
    /// `[run][harmonic]`.
    cells: Vec<Vec<Cell>>,
    /// Present values of the parameters that are common to all runs: of updating parameters in units of their prior deviations.
    reference: Vec<f64>,
    /// Normal equations of these, nothing eliminated, once they are needed.
    common: OnceLock<(Mat<f64>, Vec<f64>)>,
    /// How many of the last of them have no prior: those of laws of the whole structure.
    without_prior: usize,
    /// Squared residual per datum that even the best place leaves, at least 1: the parameters are not to explain what is
    /// no noise.
    misfit: f64,
}

/// A law of the whole structure fitted beside the updating parameters.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct BesideWhole {
    /// Its parameter.
    pub value: f64,
    /// Squared whitened residual that is left.
    pub chi_square: f64,
    /// Standardised updating parameters.
    pub updated: Vec<f64>,
}

/// What one place, or two, leave unexplained.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Placing {
    /// Indices into the spots.
    pub spots: Vec<usize>,
    /// Squared whitened residual that is left.
    pub chi_square: f64,
}

impl Screen {
    /// Screens the residuals of `predictions` (of the model whose linear part `receptances` holds), the parameters of `linearisation`
    /// free beside the forces: what differs from run to run for each harmonic on its own.
    pub(crate) fn new(
        predictor: &Predictor,
        data: &Data,
        predictions: &[RunPrediction],
        noise: &[Whitening],
        receptances: &mut Receptances,
        linearisation: &Linearisation,
        control: &Control,
    ) -> Result<Self, DiagnosisError> {
        // Of the model as it is stated: which DOFs of matrices without lines are neighbours may change with it.
        let spots = Spot::all(predictor.stated().0, data);
        for run in &data.runs {
            for channel in run.responses.iter().chain(&run.forces) {
                receptances.need(channel.dof, control)?;
            }
        }
        let mut cells = Vec::with_capacity(data.runs.len());
        for (r, run) in data.runs.iter().enumerate() {
            let cell_of_harmonic = |h: usize| {
                let prediction = &predictions[r].channels;
                let [common, own] = linearisation.of_harmonic(r, h);
                let reference = linearisation.own_reference(r);
                let in_model = |c: usize| -> c64 {
                    own.iter().zip(&reference).fold(c64::new(0.0, 0.0), |sum, (slope, u)| sum + slope[c] * *u)
                };
                let e = noise[r].apply(h, |c| run.responses[c].measured[h - 1] - prediction[c][h - 1] + in_model(c));
                let columns: Vec<Vec<c64>> = spots
                    .iter()
                    .map(|spot| noise[r].apply(h, |c| unit(receptances, r, data, h, c, spot, prediction)))
                    .collect();
                let products = columns.iter().map(|a| dot(a, &e)).collect();
                let squares = columns.iter().map(|a| dot(a, a).re).collect();
                let whitened =
                    |list: &[Vec<c64>]| -> Vec<Vec<c64>> { list.iter().map(|s| noise[r].apply(h, |c| s[c])).collect() };
                let (mut slopes, mut own) = (whitened(&common), whitened(&own));
                if h > 1 && slopes.iter().chain(&own).map(|b| dot(b, b).re).sum::<f64>() < FELT {
                    (slopes, own) = (Vec::new(), Vec::new());
                }
                Cell {
                    total: dot(&e, &e).re,
                    residual: e,
                    products,
                    columns,
                    squares,
                    slopes,
                    own,
                    gram: OnceLock::new(),
                }
            };
            cells.push((1..=run.harmonics).map(cell_of_harmonic).collect());
        }
        let reference = linearisation.updating.standardised();
        let mut screen = Self { spots, cells, reference, common: OnceLock::new(), without_prior: 0, misfit: 1.0 };
        screen.adjust();
        Ok(screen)
    }

    /// Sets the misfit by what the best place leaves, with the parameters first held, then free.
    fn adjust(&mut self) {
        let count: usize = self.cells.iter().flatten().map(|cell| 2 * cell.residual.len()).sum();
        let forces: usize = self.cells.iter().map(|run| 2 * run.len()).sum();
        let freedom = count.saturating_sub(forces).max(count / 8).max(1) as f64;
        let spots = 0..self.spots.len();
        let held = spots.clone().map(|s| self.sum(|cell| cell.left_by(s))).fold(f64::INFINITY, f64::min);
        self.misfit = (held / freedom).max(1.0);
        for _ in 0..2 {
            let free = spots.clone().map(|s| self.left(&[s], |cell| cell.left_by(s))).fold(f64::INFINITY, f64::min);
            self.misfit = (free / freedom).clamp(1.0, self.misfit);
        }
    }

    /// Standardised updating parameters that fit best together with free forces at `spots`.
    pub(crate) fn updated(&self, spots: &[usize]) -> Vec<f64> {
        match self.freed(spots) {
            Some(freed) => self.reference.iter().zip(&freed.change).map(|(u, change)| u + change).collect(),
            None => self.reference.clone(),
        }
    }

    /// Standardised updating parameters that fit best beside the known `forces` at `spot`, `[run][harmonic]`.
    pub(crate) fn updated_beside(&self, spot: usize, forces: &[Vec<c64>]) -> Vec<f64> {
        let known = |(run, forces): (&Vec<Cell>, &Vec<c64>)| {
            run.iter().zip(forces).map(|(cell, f)| cell.with_force(spot, *f)).collect()
        };
        let cells = self.cells.iter().zip(forces).map(known).collect();
        Self { cells, spots: Vec::new(), reference: self.reference.clone(), common: OnceLock::new(), ..*self }
            .updated(&[])
    }

    /// What the law of the whole structure leaves whose unit parameter changes the whitened fundamentals by `columns`, one list
    /// of channels a run, with the parameter and the updating parameters that fit best; `None` where nothing depends on it.
    pub(crate) fn beside_whole(&self, columns: &[Vec<c64>]) -> Option<BesideWhole> {
        let size: f64 = columns.iter().map(|column| dot(column, column).re).sum();
        let scale = (size > 0.0).then(|| size.sqrt().recip())?;
        let with_law = |(run, column): (&Vec<Cell>, &Vec<c64>)| {
            let with_column = |cell: &Cell| {
                let mut cell = cell.clone();
                cell.slopes.resize(self.reference.len(), vec![c64::new(0.0, 0.0); column.len()]);
                cell.slopes.push(column.iter().map(|z| *z * scale).collect());
                cell.gram = OnceLock::new();
                cell
            };
            run.iter().take(1).map(with_column).chain(run.iter().skip(1).cloned()).collect()
        };
        let cells = self.cells.iter().zip(columns).map(with_law).collect();
        let reference: Vec<f64> = self.reference.iter().copied().chain([0.0]).collect();
        let beside = Self { cells, spots: Vec::new(), reference, common: OnceLock::new(), without_prior: 1, ..*self };
        let freed = beside.freed(&[])?;
        let mut updated: Vec<f64> = beside.reference.iter().zip(&freed.change).map(|(u, change)| u + change).collect();
        let value = updated.pop()? * scale;
        Some(BesideWhole { value, chi_square: beside.left(&[], |cell| cell.total), updated })
    }

    /// How the free force at one spot would change with the parameters that are free; `None` where none is.
    pub(crate) fn freedom(&self, spot: usize) -> Option<ForceFreedom> {
        let freed = self.freed(&[spot])?;
        let freedom_of_cell = |cell: &Cell| {
            let square = cell.squares[spot];
            if square <= 0.0 || cell.is_held() {
                return None;
            }
            let by = |b: &Vec<c64>| -dot(&cell.columns[spot], b) / square;
            let own: Vec<c64> = cell.own.iter().map(by).collect();
            let local = cell.eliminate(&[spot], self.misfit);
            let q = cell.slopes.len();
            let solved = local.own_by_common();
            let covariance = local.covariance();
            let follow = |j: usize| -> c64 { own.iter().enumerate().map(|(k, o)| *o * solved[j][k]).sum() };
            let common =
                (0..q).map(|j| by(&cell.slopes[j]) - if own.is_empty() { 0.0.into() } else { follow(j) }).collect();
            let part = |z: c64, i: usize| if i == 0 { z.re } else { z.im };
            let spread = |i: usize, j: usize| {
                let sum = |k: usize| (0..own.len()).map(|l| covariance[l][k] * part(own[l], j)).sum::<f64>();
                (0..own.len()).map(|k| part(own[k], i) * sum(k)).sum::<f64>()
            };
            Some(HarmonicForceFreedom { common, own: [spread(0, 0), spread(0, 1), spread(1, 1)] })
        };
        let runs = self.cells.iter().map(|run| run.iter().map(freedom_of_cell).collect()).collect();
        Some(ForceFreedom { runs, information: freed.normal })
    }

    /// What the parameters leave without any force.
    pub(crate) fn nothing(&self) -> f64 {
        self.left(&[], |cell| cell.total)
    }

    /// What free forces at one place and the parameters leave.
    pub(crate) fn left_by(&self, spot: usize) -> f64 {
        self.left(&[spot], |cell| cell.left_by(spot))
    }

    /// Every single place, best first.
    pub(crate) fn singles(&self) -> Vec<Placing> {
        let single_place = |s: usize| Placing { spots: vec![s], chi_square: self.left_by(s) };
        sorted((0..self.spots.len()).map(single_place).collect())
    }

    /// Every pair of places, best first.
    pub(crate) fn pairs(&self, most: usize) -> Vec<Placing> {
        let count = self.spots.len();
        let mut best: Vec<Placing> = Vec::new();
        for i in 0..count {
            for j in i + 1..count {
                let chi_square = self.left(&[i, j], |cell| cell.left_by_pair(i, j));
                if best.len() < 4 * most || chi_square < best[best.len() - 1].chi_square {
                    best.push(Placing { spots: vec![i, j], chi_square });
                }
            }
            best = sorted(best);
            best.truncate(4 * most);
        }
        best.truncate(most);
        best
    }

    fn sum(&self, value: impl Fn(&Cell) -> f64) -> f64 {
        self.cells.iter().flatten().map(value).sum()
    }

    /// What free forces at `spots` and the parameters leave; `left_of_cell` is what the forces alone leave of a cell.
    fn left(&self, spots: &[usize], left_of_cell: impl Fn(&Cell) -> f64) -> f64 {
        let alone = self.sum(left_of_cell);
        let Some(freed) = self.freed(spots) else { return alone };
        let prior: f64 = self.reference.iter().map(|u| u * u).sum();
        alone + self.misfit * prior - freed.gain
    }

    /// Weight of the prior of common parameter `k`.
    fn prior_weight(&self, k: usize) -> f64 {
        if k + self.without_prior < self.reference.len() { self.misfit } else { 0.0 }
    }

    /// Changes of the parameters that fit best together with free forces at `spots`; those of a run are eliminated first:
    /// `(1 + sum B^H P B) du = sum B^H P e - u`.
    fn freed(&self, spots: &[usize]) -> Option<Freed> {
        let q = self.reference.len();
        if self.cells.iter().flatten().all(Cell::is_held) {
            return None;
        }
        let (gram, loads) = self.common.get_or_init(|| self.common_normal());
        let mut right: Vec<f64> = self.reference.iter().zip(loads).map(|(u, b)| b - self.misfit * u).collect();
        let (mut gain, mut stacked, mut locals) = (0.0, Vec::new(), Vec::with_capacity(self.cells.len()));
        for run in &self.cells {
            let eliminate = |cell: &Cell| (!cell.is_held()).then(|| cell.eliminate(spots, self.misfit));
            let of_run: Vec<Option<Eliminated>> = run.iter().map(eliminate).collect();
            for local in of_run.iter().flatten() {
                let own = local.columns.len() / local.loads.len().max(1);
                for (column, y) in local.columns.chunks_exact(own.max(1)).zip(&local.loads) {
                    stacked.extend_from_slice(column);
                    stacked.resize(stacked.len() + q - column.len(), 0.0);
                    right.iter_mut().zip(column).for_each(|(b, x)| *b -= x * y);
                }
                gain += local.gain();
            }
            locals.push(of_run);
        }
        let taken = MatRef::from_column_major_slice(&stacked, q, stacked.len() / q.max(1));
        let taken = product_transposed(taken, taken);
        let normal =
            Mat::from_fn(q, q, |i, j| gram[(i, j)] - taken[(i, j)] + if i == j { self.prior_weight(i) } else { 0.0 });
        let column = Mat::from_fn(q, 1, |k, _| right[k]);
        let change = if q > 0 { solve_symmetric(normal.as_ref(), column.as_ref()).ok()? } else { Mat::zeros(0, 1) };
        let change: Vec<f64> = (0..q).map(|k| change[(k, 0)]).collect();
        gain += change.iter().zip(&right).map(|(x, b)| x * b).sum::<f64>();
        Some(Freed { change, locals, gain, normal })
    }

    /// Matrix and right side of the normal equations of the common parameters, nothing eliminated and without priors.
    fn common_normal(&self) -> (Mat<f64>, Vec<f64>) {
        let q = self.reference.len();
        let (mut normal, mut right) = (Mat::<f64>::zeros(q, q), vec![0.0; q]);
        for cell in self.cells.iter().flatten().filter(|cell| !cell.slopes.is_empty()) {
            let gram = cell.gram();
            for (j, b) in cell.slopes.iter().enumerate() {
                right[j] += dot(b, &cell.residual).re;
                (0..cell.slopes.len()).for_each(|i| normal[(i, j)] += gram[(i, j)]);
            }
        }
        (normal, right)
    }

    /// The free force of each spot of a placing, `[spot][run][harmonic]`, the others there too.
    pub(crate) fn forces(&self, spots: &[usize]) -> Vec<Vec<Vec<FreeForce>>> {
        let freed = self.freed(spots);
        let change = freed.as_ref().map_or(&[][..], |freed| &freed.change);
        let mut forces = vec![Vec::with_capacity(self.cells.len()); spots.len()];
        for (r, run) in self.cells.iter().enumerate() {
            let local = |k: usize| freed.as_ref().and_then(|freed| freed.locals[r][k].as_ref());
            let own = |k: usize| local(k).map_or_else(Vec::new, |local| local.own(change));
            let forces_of_cell = |(k, cell): (usize, &Cell)| cell.corrected(change, &own(k)).solve(spots);
            let solved: Vec<Vec<FreeForce>> = run.iter().enumerate().map(forces_of_cell).collect();
            for (k, list) in forces.iter_mut().enumerate() {
                list.push(solved.iter().map(|cell| cell[k]).collect());
            }
        }
        forces
    }
}

/// Column of a spot for response channel `c`: the recorded amplitude for a unit force of the effect, or unit relative
/// error of the channel (of what is recorded at the fundamental, of what is predicted at its multiples).
fn unit(
    receptances: &Receptances,
    r: usize,
    data: &Data,
    h: usize,
    c: usize,
    spot: &Spot,
    prediction: &[Vec<c64>],
) -> c64 {
    let run = &data.runs[r];
    let channel = &run.responses[c];
    match spot {
        // The structure feels minus the force of the effect.
        Spot::Leg(leg) => -receptances.channel(r, run, h, channel, *leg),
        // The fundamental is read whatever the model predicts: `y - y / t = (1 - 1/t) y`.
        Spot::Response(name) if *name == channel.name && h == 1 => channel.measured[0],
        Spot::Response(name) if *name == channel.name => prediction[c][h - 1],
        Spot::Response(_) => c64::new(0.0, 0.0),
        Spot::Force(name) => {
            let response_to_force = |f: &crate::diagnosis::residual::data::ChannelData| {
                let leg = Leg { first: f.dof, second: None };
                -receptances.channel(r, run, h, channel, leg) * f.measured[h - 1]
            };
            run.forces.iter().filter(|f| f.name == *name).map(response_to_force).sum()
        }
    }
}

/// Changes of the parameters that were free beside free forces.
#[derive(Debug, Clone)]
struct Freed {
    /// Of the common ones, in units of their prior deviations.
    change: Vec<f64>,
    /// What free forces and own parameters take off their normal equations, `[run][harmonic]`.
    locals: Vec<Vec<Option<Eliminated>>>,
    /// By how much they lower the squared residual with its prior.
    gain: f64,
    /// Normal matrix of the common ones, free forces and own ones eliminated.
    normal: Mat<f64>,
}

/// How a free force would change with parameters that are free.
#[derive(Debug, Clone)]
pub(crate) struct ForceFreedom {
    /// `[run][harmonic]`; `None` where the place is not seen or nothing is free.
    pub runs: Vec<Vec<Option<HarmonicForceFreedom>>>,
    /// Information on the common parameters, free forces eliminated, q x q.
    pub information: Mat<f64>,
}

/// The same at one harmonic of one run.
#[derive(Debug, Clone)]
pub(crate) struct HarmonicForceFreedom {
    /// Derivatives by the standardised common parameters, N.
    pub common: Vec<c64>,
    /// Covariance by the run's own parameters: of the real part, of both, of the imaginary part, N^2.
    pub own: [f64; 3],
}

fn sorted(mut placings: Vec<Placing>) -> Vec<Placing> {
    placings.sort_by(|a, b| a.chi_square.total_cmp(&b.chi_square));
    placings
}

#[cfg(test)]
mod tests;
