//! One harmonic of one run seen from every place: whitened residual, columns of the places and of the parameters that are
//! free, and what is left once free forces and the run's own parameters are eliminated.

use dashpot_numerics::{self as numerics, Cholesky, transposed_product};
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
        if self.is_held() {
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

    /// Whether no parameter is free here.
    pub(super) fn is_held(&self) -> bool {
        self.slopes.is_empty() && self.own.is_empty()
    }

    /// `Re [B V]^H [B V]`.
    pub(super) fn gram(&self) -> &Mat<f64> {
        self.gram.get_or_init(|| {
            let all: Vec<&Vec<c64>> = self.slopes.iter().chain(&self.own).collect();
            let channels = self.residual.len();
            let part = |i: usize, k: usize| if i < channels { all[k][i].re } else { all[k][i - channels].im };
            let stacked = Mat::from_fn(2 * channels, all.len(), part);
            transposed_product(stacked.as_ref(), stacked.as_ref())
        })
    }

    /// What free forces at `spots` and the run's own parameters, with the prior weight `misfit`, take off the normal equations of the
    /// common ones.
    pub(super) fn eliminate(&self, spots: &[usize], misfit: f64) -> Eliminated {
        let basis = self.basis(spots);
        let (q, p, forces) = (self.slopes.len(), self.own.len(), 2 * basis.len());
        let mut columns = vec![0.0; q * (forces + p)];
        let mut loads = vec![0.0; forces + p];
        let mut shares = vec![vec![0.0; forces]; p];
        for (i, v) in basis.iter().enumerate() {
            let (re, im) = (2 * i, 2 * i + 1);
            for (j, b) in self.slopes.iter().enumerate() {
                let share = dot(v, b);
                (columns[re * q + j], columns[im * q + j]) = (share.re, share.im);
            }
            for (own, b) in shares.iter_mut().zip(&self.own) {
                let share = dot(v, b);
                (own[re], own[im]) = (share.re, share.im);
            }
            let seen = dot(v, &self.residual);
            (loads[re], loads[im]) = (seen.re, seen.im);
        }
        let gram = self.gram();
        let inner = Mat::from_fn(p, p, |i, j| {
            gram[(q + i, q + j)] - numerics::dot(&shares[i], &shares[j]) + if i == j { misfit } else { 0.0 }
        });
        let factor = Cholesky::new(inner.as_ref());
        let lower = factor.map_or_else(|| Mat::zeros(p, p), |factor| factor.factor().to_owned());
        for k in (0..p).filter(|&k| lower[(k, k)] > 0.0) {
            let (before, own) = columns.split_at_mut((forces + k) * q);
            let mut load = dot(&self.own[k], &self.residual).re - numerics::dot(&shares[k], &loads[..forces]);
            own[..q].iter_mut().enumerate().for_each(|(j, x)| *x = gram[(q + k, j)]);
            for (d, column) in before.chunks_exact(q.max(1)).enumerate() {
                let factor = if d < forces { shares[k][d] } else { lower[(k, d - forces)] };
                own[..q].iter_mut().zip(column).for_each(|(x, c)| *x -= factor * c);
            }
            (0..k).for_each(|l| load -= lower[(k, l)] * loads[forces + l]);
            own[..q].iter_mut().for_each(|x| *x /= lower[(k, k)]);
            loads[forces + k] = load / lower[(k, k)];
        }
        Eliminated { columns, loads, lower }
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

/// What is taken off the normal equations of the common parameters: their matrix becomes `G - X X^T`, their right side `b - X y`.
#[derive(Debug, Clone)]
pub(super) struct Eliminated {
    /// `X`, column by column, two of every free force, then one of every own parameter.
    pub(super) columns: Vec<f64>,
    /// `y`.
    pub(super) loads: Vec<f64>,
    /// Lower Cholesky factor `L` of the matrix of the own parameters, free forces eliminated; zero where there is none.
    lower: Mat<f64>,
}

impl Eliminated {
    /// By how much the own parameters lower the squared residual: `|y|^2` of theirs.
    pub(super) fn gain(&self) -> f64 {
        self.own_loads().iter().map(|y| y * y).sum()
    }

    fn own_loads(&self) -> &[f64] {
        &self.loads[self.loads.len() - self.lower.nrows()..]
    }

    /// Columns of `X` of the own parameters.
    fn own_columns(&self) -> impl Iterator<Item = &[f64]> {
        let q = self.columns.len() / self.loads.len().max(1);
        let first = self.loads.len() - self.lower.nrows();
        (first..self.loads.len()).map(move |d| &self.columns[d * q..(d + 1) * q])
    }

    /// `L^-T z`.
    fn back(&self, mut z: Vec<f64>) -> Vec<f64> {
        for k in (0..z.len()).rev() {
            let known: f64 = (k + 1..z.len()).map(|l| self.lower[(l, k)] * z[l]).sum();
            z[k] = if self.lower[(k, k)] > 0.0 { (z[k] - known) / self.lower[(k, k)] } else { 0.0 };
        }
        z
    }

    /// Own parameters after a `change` of the common ones: `L^-T (y - X^T du)`.
    pub(super) fn own(&self, change: &[f64]) -> Vec<f64> {
        let left = self.own_columns().zip(self.own_loads()).map(|(x, y)| y - numerics::dot(x, &change[..x.len()]));
        self.back(left.collect())
    }

    /// Change of the own parameters, sign reversed, with each common one, one list a common one: columns of `L^-T X^T`.
    pub(super) fn own_by_common(&self) -> Vec<Vec<f64>> {
        let columns: Vec<&[f64]> = self.own_columns().collect();
        let count = columns.first().map_or(0, |x| x.len());
        (0..count).map(|j| self.back(columns.iter().map(|x| x[j]).collect())).collect()
    }

    /// Covariance of the own parameters, free forces eliminated: `(L L^T)^-1`, column by column.
    pub(super) fn covariance(&self) -> Vec<Vec<f64>> {
        let p = self.lower.nrows();
        let unit = |k: usize| {
            let mut z = vec![0.0; p];
            for i in (k..p).filter(|&i| self.lower[(i, i)] > 0.0) {
                let known: f64 = (k..i).map(|l| self.lower[(i, l)] * z[l]).sum();
                z[i] = (f64::from(u8::from(i == k)) - known) / self.lower[(i, i)];
            }
            self.back(z)
        };
        (0..p).map(unit).collect()
    }
}

/// `a^H b`.
pub(super) fn dot(a: &[c64], b: &[c64]) -> c64 {
    a.iter().zip(b).map(|(x, y)| x.conj() * y).sum()
}
