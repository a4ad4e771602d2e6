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

use crate::control::Control;
use crate::diagnosis::localisation::location::{Receptances, Spot};
use crate::diagnosis::residual::data::{Data, DiagnosisError};
use crate::diagnosis::residual::prediction::{Predictor, RunPrediction};
use crate::diagnosis::updating::noise_model::NoiseModel;
use crate::effects::Leg;
use crate::math::least_squares::solve_symmetric;
use faer::{Mat, c64};
use std::borrow::Cow;

/// Part of a second column that must be independent of the first.
const INDEPENDENCE: f64 = 1e-6;

/// Whitened residual and columns of one harmonic of one run.
#[derive(Debug, Clone)]
struct Cell {
    /// `e`.
    residual: Vec<c64>,
    /// `|e|^2`.
    total: f64,
    /// `a_s^H e` by spot.
    products: Vec<c64>,
    /// `a_s` by spot.
    columns: Vec<Vec<c64>>,
    /// `|a_s|^2` by spot.
    squares: Vec<f64>,
    /// `B`, one column an updating parameter; none where they do nothing.
    slopes: Vec<Vec<c64>>,
    /// `V`, one column a parameter that is the run's own.
    own: Vec<Vec<c64>>,
}

/// The residual of a model seen from every place.
#[derive(Debug, Clone)]
pub struct Screen {
    /// Places.
    pub spots: Vec<Spot>,
    /// `[run][harmonic]`.
    cells: Vec<Vec<Cell>>,
    /// Present values of the updating parameters in units of their prior deviations.
    reference: Vec<f64>,
}

/// Parameters that are free while places are looked at, by what they do to the fundamentals.
#[derive(Debug, Clone, Default)]
pub(crate) struct Freedom {
    /// Values of the updating parameters in units of their prior deviations.
    pub values: Vec<f64>,
    /// Derivatives of the fundamentals by updating parameters, `[run][parameter][channel]`.
    pub slopes: Vec<Vec<Vec<c64>>>,
    /// The same by what differs from run to run.
    pub own: Vec<Vec<Vec<c64>>>,
}

/// A free complex force with its variance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeForce {
    /// Force of the effect, N (relative error for channels).
    pub value: c64,
    /// Its weight: one over the variance of a real part.
    pub weight: f64,
}

/// What one place, or two, leave unexplained.
#[derive(Debug, Clone, PartialEq)]
pub struct Placing {
    /// Indices into the spots.
    pub spots: Vec<usize>,
    /// Squared whitened residual that is left.
    pub chi_square: f64,
}

impl Screen {
    /// Screens the residuals of `predictions` (of the model whose linear part `receptances` holds).
    pub(crate) fn new(
        predictor: &Predictor,
        data: &Data,
        predictions: &[RunPrediction],
        noise: &NoiseModel,
        receptances: &mut Receptances,
        freedom: &Freedom,
        control: &Control,
    ) -> Result<Self, DiagnosisError> {
        let spots = Spot::all(predictor.structure(), data);
        for run in &data.runs {
            for channel in run.responses.iter().chain(&run.forces) {
                receptances.need(channel.dof, control)?;
            }
        }
        let mut cells = Vec::with_capacity(data.runs.len());
        for (r, run) in data.runs.iter().enumerate() {
            let at = |h: usize| {
                let prediction = &predictions[r].channels;
                let e = noise.runs[r].apply(h, |c| run.responses[c].measured[h - 1] - prediction[c][h - 1]);
                let columns: Vec<Vec<c64>> = spots
                    .iter()
                    .map(|spot| noise.runs[r].apply(h, |c| unit(receptances, r, data, h, c, spot, prediction)))
                    .collect();
                let products = columns.iter().map(|a| dot(a, &e)).collect();
                let squares = columns.iter().map(|a| dot(a, a).re).collect();
                let whitened = |all: &[Vec<Vec<c64>>]| -> Vec<Vec<c64>> {
                    let own = all.get(r).filter(|_| h == 1);
                    own.map_or_else(Vec::new, |list| list.iter().map(|s| noise.runs[r].apply(1, |c| s[c])).collect())
                };
                let (slopes, own) = (whitened(&freedom.slopes), whitened(&freedom.own));
                Cell { total: dot(&e, &e).re, residual: e, products, columns, squares, slopes, own }
            };
            cells.push((1..=run.harmonics).map(at).collect());
        }
        Ok(Self { spots, cells, reference: freedom.values.clone() })
    }

    /// Squared whitened residual of the model as it is.
    pub fn total(&self) -> f64 {
        self.cells.iter().flatten().map(|cell| cell.total).sum()
    }

    /// Every single place, best first.
    pub fn singles(&self) -> Vec<Placing> {
        let of = |s: usize| Placing { spots: vec![s], chi_square: self.left(&[s], |cell| cell.left_by(s)) };
        sorted((0..self.spots.len()).map(of).collect())
    }

    /// Every pair of places, best first.
    pub fn pairs(&self, most: usize) -> Vec<Placing> {
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

    fn sum(&self, of: impl Fn(&Cell) -> f64) -> f64 {
        self.cells.iter().flatten().map(of).sum()
    }

    /// What free forces at `spots` and the parameters leave; `of` is what the forces alone leave of a cell.
    fn left(&self, spots: &[usize], of: impl Fn(&Cell) -> f64) -> f64 {
        let alone = self.sum(of);
        let Some(freed) = self.freed(spots) else { return alone };
        let prior: f64 = self.reference.iter().map(|u| u * u).sum();
        alone + prior - freed.gain
    }

    /// Changes of the parameters that fit best together with free forces at `spots`; those of a run are eliminated first:
    /// `(1 + sum B^H P B) du = sum B^H P e - u`.
    fn freed(&self, spots: &[usize]) -> Option<Freed> {
        let q = self.reference.len();
        if self.cells.iter().flatten().all(|cell| cell.slopes.is_empty() && cell.own.is_empty()) {
            return None;
        }
        let mut normal = Mat::from_fn(q, q, |i, j| if i == j { 1.0 } else { 0.0 });
        let mut right: Vec<f64> = self.reference.iter().map(|u| -u).collect();
        let (mut gain, mut solved) = (0.0, Vec::with_capacity(self.cells.len()));
        for run in &self.cells {
            let Some(local) = run.first().map(|cell| cell.eliminate(spots)) else { continue };
            for (i, value) in right.iter_mut().enumerate().take(local.right.len()) {
                *value += local.right[i];
                (0..q).for_each(|j| normal[(i, j)] += local.normal[(i, j)]);
            }
            gain += local.gain;
            solved.push(local);
        }
        let column = Mat::from_fn(q, 1, |k, _| right[k]);
        let change = if q > 0 { solve_symmetric(normal.as_ref(), column.as_ref()).ok()? } else { Mat::zeros(0, 1) };
        let change: Vec<f64> = (0..q).map(|k| change[(k, 0)]).collect();
        gain += change.iter().zip(&right).map(|(x, b)| x * b).sum::<f64>();
        let own = solved.iter().map(|local| local.own(&change)).collect();
        Some(Freed { change, own, gain })
    }

    /// The free force of each spot of a placing, `[spot][run][harmonic]`, the others there too.
    pub fn forces(&self, spots: &[usize]) -> Vec<Vec<Vec<FreeForce>>> {
        let freed = self.freed(spots).unwrap_or_default();
        let mut forces = vec![Vec::with_capacity(self.cells.len()); spots.len()];
        for (r, run) in self.cells.iter().enumerate() {
            let own = freed.own.get(r).map_or(&[][..], Vec::as_slice);
            let at = |cell: &Cell| cell.corrected(&freed.change, own).solve(spots);
            let solved: Vec<Vec<FreeForce>> = run.iter().map(at).collect();
            for (k, list) in forces.iter_mut().enumerate() {
                list.push(solved.iter().map(|cell| cell[k]).collect());
            }
        }
        forces
    }
}

/// Column of a spot for response channel `c`: the recorded amplitude for a unit force of the effect, or unit relative
/// error of the channel.
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
        Spot::Response(name) if *name == channel.name => prediction[c][h - 1],
        Spot::Response(_) => c64::new(0.0, 0.0),
        Spot::Force(name) => {
            let at = |f: &crate::diagnosis::residual::data::ChannelData| {
                let leg = Leg { first: f.dof, second: None };
                -receptances.channel(r, run, h, channel, leg) * f.measured[h - 1]
            };
            run.forces.iter().filter(|f| f.name == *name).map(at).sum()
        }
    }
}

impl Cell {
    /// Orthonormal columns that span those of `spots`.
    fn basis(&self, spots: &[usize]) -> Vec<Vec<c64>> {
        let mut basis: Vec<Vec<c64>> = Vec::with_capacity(spots.len());
        for &s in spots {
            let mut v = self.columns[s].clone();
            for b in &basis {
                let share = dot(b, &v);
                v.iter_mut().zip(b).for_each(|(v, b)| *v -= share * b);
            }
            let size = dot(&v, &v).re;
            if size > INDEPENDENCE * self.squares[s] && size > 0.0 {
                let scale = size.sqrt().recip();
                basis.push(v.iter().map(|v| *v * scale).collect());
            }
        }
        basis
    }

    /// The cell after a change of the parameters, common ones and those of its run.
    fn corrected(&self, change: &[f64], own: &[f64]) -> Cow<'_, Self> {
        if self.slopes.is_empty() && self.own.is_empty() {
            return Cow::Borrowed(self);
        }
        let mut cell = self.clone();
        for (b, x) in self.slopes.iter().zip(change).chain(self.own.iter().zip(own)) {
            cell.residual.iter_mut().zip(b).for_each(|(e, b)| *e -= *b * *x);
        }
        cell.total = dot(&cell.residual, &cell.residual).re;
        cell.products = cell.columns.iter().map(|a| dot(a, &cell.residual)).collect();
        Cow::Owned(cell)
    }

    /// Normal equations of the common parameters where free forces at `spots` and the run's own parameters are eliminated.
    fn eliminate(&self, spots: &[usize]) -> Eliminated {
        let basis = self.basis(spots);
        let all: Vec<&Vec<c64>> = self.slopes.iter().chain(&self.own).collect();
        let shares: Vec<Vec<c64>> = all.iter().map(|b| basis.iter().map(|v| dot(v, b)).collect()).collect();
        let seen: Vec<c64> = basis.iter().map(|v| dot(v, &self.residual)).collect();
        let product = |i: usize, j: usize| (dot(all[i], all[j]) - dot(&shares[i], &shares[j])).re;
        let load = |i: usize| (dot(all[i], &self.residual) - dot(&shares[i], &seen)).re;
        let (q, p) = (self.slopes.len(), self.own.len());
        let inner = Mat::from_fn(p, p, |i, j| product(q + i, q + j) + f64::from(u8::from(i == j)));
        let outer = Mat::from_fn(p, q + 1, |i, j| if j < q { product(q + i, j) } else { load(q + i) });
        let solved = solve_symmetric(inner.as_ref(), outer.as_ref()).unwrap_or_else(|_| Mat::zeros(p, q + 1));
        let eliminated = |i: usize, j: usize| (0..p).map(|k| outer[(k, i)] * solved[(k, j)]).sum::<f64>();
        Eliminated {
            normal: Mat::from_fn(q, q, |i, j| product(i, j) - eliminated(i, j)),
            right: (0..q).map(|i| load(i) - eliminated(i, q)).collect(),
            gain: eliminated(q, q),
            solved,
        }
    }

    fn left_by(&self, s: usize) -> f64 {
        if self.squares[s] > 0.0 { self.total - self.products[s].norm_sqr() / self.squares[s] } else { self.total }
    }

    fn left_by_pair(&self, i: usize, j: usize) -> f64 {
        let (first, second) = if self.squares[i] > 0.0 { (i, j) } else { (j, i) };
        let square = self.squares[first];
        if square <= 0.0 {
            return self.total;
        }
        let coupling = dot(&self.columns[first], &self.columns[second]);
        let rest = self.squares[second] - coupling.norm_sqr() / square;
        let left = self.left_by(first);
        if rest <= INDEPENDENCE * self.squares[second] {
            return left;
        }
        left - (self.products[second] - coupling.conj() / square * self.products[first]).norm_sqr() / rest
    }

    /// Forces of one or two spots with their weights.
    fn solve(&self, spots: &[usize]) -> Vec<FreeForce> {
        let none = FreeForce { value: c64::new(0.0, 0.0), weight: 0.0 };
        let alone = |s: usize| {
            if self.squares[s] > 0.0 {
                FreeForce { value: self.products[s] / self.squares[s], weight: self.squares[s] }
            } else {
                none
            }
        };
        let [i, j] = *spots else { return spots.iter().map(|&s| alone(s)).collect() };
        let (gi, gj) = (self.squares[i], self.squares[j]);
        let coupling = dot(&self.columns[i], &self.columns[j]);
        let determinant = gi * gj - coupling.norm_sqr();
        if determinant <= INDEPENDENCE * gi * gj {
            return vec![alone(i), none];
        }
        let (bi, bj) = (self.products[i], self.products[j]);
        vec![
            FreeForce { value: (bi * gj - coupling * bj) / determinant, weight: determinant / gj },
            FreeForce { value: (bj * gi - coupling.conj() * bi) / determinant, weight: determinant / gi },
        ]
    }
}

/// Changes of the parameters that were free beside free forces.
#[derive(Debug, Clone, Default)]
struct Freed {
    /// Of the common ones, in units of their prior deviations.
    change: Vec<f64>,
    /// Of those of each run.
    own: Vec<Vec<f64>>,
    /// By how much they lower the squared residual with its prior.
    gain: f64,
}

/// Normal equations of a run whose own parameters are eliminated.
#[derive(Debug, Clone)]
struct Eliminated {
    normal: Mat<f64>,
    right: Vec<f64>,
    gain: f64,
    /// Own parameters, one column a common one whose change takes its share off, the last as they are without.
    solved: Mat<f64>,
}

impl Eliminated {
    /// Own parameters after a `change` of the common ones.
    fn own(&self, change: &[f64]) -> Vec<f64> {
        let q = self.right.len();
        let of = |k: usize| self.solved[(k, q)] - (0..q).map(|j| self.solved[(k, j)] * change[j]).sum::<f64>();
        (0..self.solved.nrows()).map(of).collect()
    }
}

/// `a^H b`.
fn dot(a: &[c64], b: &[c64]) -> c64 {
    a.iter().zip(b).map(|(x, y)| x.conj() * y).sum()
}

fn sorted(mut placings: Vec<Placing>) -> Vec<Placing> {
    placings.sort_by(|a, b| a.chi_square.total_cmp(&b.chi_square));
    placings
}
