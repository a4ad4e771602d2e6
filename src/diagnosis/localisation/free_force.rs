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
use crate::diagnosis::residual::whitening::Whitening;
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
    /// `B`, one column a correction of the model; none where corrections do nothing.
    slopes: Vec<Vec<c64>>,
}

/// The residual of a model seen from every place.
#[derive(Debug, Clone)]
pub struct Screen {
    /// Places.
    pub spots: Vec<Spot>,
    /// `[run][harmonic]`.
    cells: Vec<Vec<Cell>>,
    /// Present corrections of the model in units of their prior deviations.
    corrections: Vec<f64>,
}

/// Corrections of the model that are free while places are looked at.
#[derive(Debug, Clone, Default)]
pub(crate) struct Freedom {
    /// Their values in units of their prior deviations.
    pub values: Vec<f64>,
    /// Derivatives of the fundamentals, `[run][correction][channel]`.
    pub slopes: Vec<Vec<Vec<c64>>>,
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
        noise: &[Whitening],
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
                let e = noise[r].apply(h, |c| run.responses[c].measured[h - 1] - prediction[c][h - 1]);
                let columns: Vec<Vec<c64>> = spots
                    .iter()
                    .map(|spot| noise[r].apply(h, |c| unit(receptances, r, data, h, c, spot, prediction)))
                    .collect();
                let products = columns.iter().map(|a| dot(a, &e)).collect();
                let squares = columns.iter().map(|a| dot(a, a).re).collect();
                let free = freedom.slopes.get(r).filter(|_| h == 1);
                let slopes =
                    free.map_or_else(Vec::new, |all| all.iter().map(|slope| noise[r].apply(1, |c| slope[c])).collect());
                Cell { total: dot(&e, &e).re, residual: e, products, columns, squares, slopes }
            };
            cells.push((1..=run.harmonics).map(at).collect());
        }
        Ok(Self { spots, cells, corrections: freedom.values.clone() })
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

    /// What free forces at `spots` and the corrections leave; `of` is what the forces alone leave of a cell.
    fn left(&self, spots: &[usize], of: impl Fn(&Cell) -> f64) -> f64 {
        let alone = self.sum(of);
        let Some((change, gain)) = self.corrected(spots) else { return alone };
        let prior: f64 = self.corrections.iter().map(|u| u * u).sum();
        if change.is_empty() { alone } else { alone + prior - gain }
    }

    /// Change of the corrections that fits best together with free forces at `spots`, and by how much it lowers the
    /// squared residual with its prior: `(1 + sum B^H P B) du = sum B^H P e - u`.
    fn corrected(&self, spots: &[usize]) -> Option<(Vec<f64>, f64)> {
        let q = self.corrections.len();
        if q == 0 {
            return None;
        }
        let mut normal = Mat::from_fn(q, q, |i, j| if i == j { 1.0 } else { 0.0 });
        let mut right = Mat::from_fn(q, 1, |k, _| -self.corrections[k]);
        for cell in self.cells.iter().flatten().filter(|cell| !cell.slopes.is_empty()) {
            let basis = cell.basis(spots);
            let shares: Vec<Vec<c64>> = cell.slopes.iter().map(|b| basis.iter().map(|v| dot(v, b)).collect()).collect();
            let seen: Vec<c64> = basis.iter().map(|v| dot(v, &cell.residual)).collect();
            for i in 0..q {
                right[(i, 0)] += (dot(&cell.slopes[i], &cell.residual) - dot(&shares[i], &seen)).re;
                for j in 0..=i {
                    normal[(i, j)] += (dot(&cell.slopes[i], &cell.slopes[j]) - dot(&shares[i], &shares[j])).re;
                }
            }
        }
        let full = Mat::from_fn(q, q, |i, j| if i >= j { normal[(i, j)] } else { normal[(j, i)] });
        let change = solve_symmetric(full.as_ref(), right.as_ref()).ok()?;
        let change: Vec<f64> = (0..q).map(|k| change[(k, 0)]).collect();
        let gain = change.iter().enumerate().map(|(k, x)| x * right[(k, 0)]).sum();
        Some((change, gain))
    }

    /// The free force of each spot of a placing, `[spot][run][harmonic]`, the others there too.
    pub fn forces(&self, spots: &[usize]) -> Vec<Vec<Vec<FreeForce>>> {
        let change = self.corrected(spots).map_or_else(Vec::new, |(change, _)| change);
        let mut forces = vec![Vec::with_capacity(self.cells.len()); spots.len()];
        for run in &self.cells {
            let solved: Vec<Vec<FreeForce>> = run.iter().map(|cell| cell.corrected(&change).solve(spots)).collect();
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

    /// The cell after a change of the corrections.
    fn corrected(&self, change: &[f64]) -> Cow<'_, Self> {
        if self.slopes.is_empty() || change.is_empty() {
            return Cow::Borrowed(self);
        }
        let mut cell = self.clone();
        for (b, x) in self.slopes.iter().zip(change) {
            cell.residual.iter_mut().zip(b).for_each(|(e, b)| *e -= *b * *x);
        }
        cell.total = dot(&cell.residual, &cell.residual).re;
        cell.products = cell.columns.iter().map(|a| dot(a, &cell.residual)).collect();
        Cow::Owned(cell)
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

/// `a^H b`.
fn dot(a: &[c64], b: &[c64]) -> c64 {
    a.iter().zip(b).map(|(x, y)| x.conj() * y).sum()
}

fn sorted(mut placings: Vec<Placing>) -> Vec<Placing> {
    placings.sort_by(|a, b| a.chi_square.total_cmp(&b.chi_square));
    placings
}
