//! One harmonic of one run seen from every place: whitened residual, columns of the places and of the parameters that are
//! free, and what is left once free forces and the run's own parameters are eliminated.

use crate::math::least_squares::solve_symmetric;
use faer::{Mat, c64};
use std::borrow::Cow;
use std::sync::OnceLock;

/// Part of a second column that must be independent of the first.
const INDEPENDENCE: f64 = 1e-6;

/// A free complex force with its variance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FreeForce {
    /// Force of the effect, N (relative error for channels).
    pub value: c64,
    /// Its weight: one over the variance of a real part.
    pub weight: f64,
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

/// Whitened residual and columns of one harmonic of one run.
#[derive(Debug, Clone)]
pub(super) struct Cell {
    /// `e`.
    pub(super) residual: Vec<c64>,
    /// `|e|^2`.
    pub(super) total: f64,
    /// `a_s^H e` by spot.
    pub(super) products: Vec<c64>,
    /// `a_s` by spot.
    pub(super) columns: Vec<Vec<c64>>,
    /// `|a_s|^2` by spot.
    pub(super) squares: Vec<f64>,
    /// `B`, one column an updating parameter; none where they do nothing.
    pub(super) slopes: Vec<Vec<c64>>,
    /// `V`, one column a parameter that is the run's own.
    pub(super) own: Vec<Vec<c64>>,
    /// Real parts of the products of the columns of `B` and `V` with each other, once they are needed.
    pub(super) gram: OnceLock<Mat<f64>>,
}

impl Cell {
    /// Orthonormal columns that span those of `spots`.
    pub(super) fn basis(&self, spots: &[usize]) -> Vec<Vec<c64>> {
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
    pub(super) fn corrected(&self, change: &[f64], own: &[f64]) -> Cow<'_, Self> {
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

    /// The cell after a known force of `spot`.
    pub(super) fn with_force(&self, spot: usize, force: c64) -> Self {
        let mut cell = self.clone();
        cell.residual.iter_mut().zip(&self.columns[spot]).for_each(|(e, a)| *e -= force * *a);
        cell.total = dot(&cell.residual, &cell.residual).re;
        cell.products = cell.columns.iter().map(|a| dot(a, &cell.residual)).collect();
        cell
    }

    /// `Re [B V]^H [B V]`.
    fn gram(&self) -> &Mat<f64> {
        self.gram.get_or_init(|| {
            let all: Vec<&Vec<c64>> = self.slopes.iter().chain(&self.own).collect();
            let mut gram = Mat::zeros(all.len(), all.len());
            for (i, a) in all.iter().enumerate() {
                for (j, b) in all.iter().enumerate().take(i + 1) {
                    let product = dot(a, b).re;
                    gram[(i, j)] = product;
                    gram[(j, i)] = product;
                }
            }
            gram
        })
    }

    /// Normal equations of the common parameters where free forces at `spots` and the run's own parameters are eliminated.
    pub(super) fn eliminate(&self, spots: &[usize], misfit: f64) -> Eliminated {
        let basis = self.basis(spots);
        let all: Vec<&Vec<c64>> = self.slopes.iter().chain(&self.own).collect();
        let shares: Vec<Vec<c64>> = all.iter().map(|b| basis.iter().map(|v| dot(v, b)).collect()).collect();
        let seen: Vec<c64> = basis.iter().map(|v| dot(v, &self.residual)).collect();
        let gram = self.gram();
        let product = |i: usize, j: usize| gram[(i, j)] - dot(&shares[i], &shares[j]).re;
        let load = |i: usize| (dot(all[i], &self.residual) - dot(&shares[i], &seen)).re;
        let (q, p) = (self.slopes.len(), self.own.len());
        let inner = Mat::from_fn(p, p, |i, j| product(q + i, q + j) + if i == j { misfit } else { 0.0 });
        let outer = Mat::from_fn(p, q + 1, |i, j| if j < q { product(q + i, j) } else { load(q + i) });
        let inverse = solve_symmetric(inner.as_ref(), Mat::<f64>::identity(p, p).as_ref());
        let inverse = inverse.unwrap_or_else(|_| Mat::zeros(p, p));
        let solved = &inverse * &outer;
        let eliminated = |i: usize, j: usize| (0..p).map(|k| outer[(k, i)] * solved[(k, j)]).sum::<f64>();
        Eliminated {
            normal: Mat::from_fn(q, q, |i, j| product(i, j) - eliminated(i, j)),
            right: (0..q).map(|i| load(i) - eliminated(i, q)).collect(),
            gain: eliminated(q, q),
            solved,
            inverse,
        }
    }

    pub(super) fn left_by(&self, s: usize) -> f64 {
        if self.squares[s] > 0.0 { self.total - self.products[s].norm_sqr() / self.squares[s] } else { self.total }
    }

    pub(super) fn left_by_pair(&self, i: usize, j: usize) -> f64 {
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
    pub(super) fn solve(&self, spots: &[usize]) -> Vec<FreeForce> {
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

/// Normal equations of a run whose own parameters are eliminated.
#[derive(Debug, Clone)]
pub(super) struct Eliminated {
    pub(super) normal: Mat<f64>,
    pub(super) right: Vec<f64>,
    pub(super) gain: f64,
    /// Own parameters, one column a common one whose change takes its share off, the last as they are without.
    pub(super) solved: Mat<f64>,
    /// Covariance of the own ones, free forces eliminated.
    pub(super) inverse: Mat<f64>,
}

impl Eliminated {
    /// Own parameters after a `change` of the common ones.
    pub(super) fn own(&self, change: &[f64]) -> Vec<f64> {
        let q = self.right.len();
        let of = |k: usize| self.solved[(k, q)] - (0..q).map(|j| self.solved[(k, j)] * change[j]).sum::<f64>();
        (0..self.solved.nrows()).map(of).collect()
    }
}

/// `a^H b`.
pub(super) fn dot(a: &[c64], b: &[c64]) -> c64 {
    a.iter().zip(b).map(|(x, y)| x.conj() * y).sum()
}
