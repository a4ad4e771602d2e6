//! Sets of columns among very many, by exchange: each place of a set in turn takes the column that is best beside the others.
//!
//! With unit columns `a_j` and the residual `r` of the others `R` of a set, whose Gram matrix is `G`, column `j` lowers the
//! sum of squares by
//!
//! ```text
//! (a_j^T r)^2 / (1 - c_j^T G^-1 c_j),   c_j = A_R^T a_j,   a_j^T r = a_j^T b - c_j^T G^-1 A_R^T b  > 0
//! ```
//!
//! (orthogonal least squares: S. Chen, S. A. Billings and W. Luo, Int. J. Control 50 (1989) 1873; sequential replacement:
//! A. J. Miller, Subset Selection in Regression, 2nd ed. (2002) ch. 3). The products of a column with all others are kept, so
//! that one product with `A` is needed for each column that ever was in a set.

use super::system::System;
use dashpot_numerics::{Cholesky, with_columns};
use faer::Mat;
use std::collections::BTreeMap;

/// Part of a unit column outside of the others below which it is one of them.
const PARALLEL: f64 = 1e-9;
/// Part of `|b|^2` that a further column must explain.
const LEAST: f64 = 1e-14;
/// Gain by which a column must be better than the one in its place.
const BETTER: f64 = 1.0 + 1e-9;
/// Most rounds through the places of a set.
const ROUNDS: usize = 20;

/// The columns of a system, of unit length.
pub(super) struct Exchange<'a> {
    a: &'a Mat<f64>,
    norms: Vec<f64>,
    /// `a_j^T b`.
    with_b: Vec<f64>,
    square: f64,
    /// `A^T a_j` of the columns that were asked for.
    products: BTreeMap<usize, Vec<f64>>,
}

impl<'a> Exchange<'a> {
    pub(super) fn new(system: &'a System) -> Self {
        let (a, b) = (&system.a, &system.b);
        let norms: Vec<f64> = (0..a.ncols()).map(|j| a.col(j).norm_l2()).collect();
        let with_b = products(a, &norms, b);
        Self { a, norms, with_b, square: b.iter().map(|x| x * x).sum(), products: BTreeMap::new() }
    }

    /// Good sets of each size up to `most` sources beside the forced ones, the smallest first.
    pub(super) fn sets(&mut self, forced: &[usize], most: usize) -> Vec<Vec<usize>> {
        let mut set = forced.to_vec();
        let mut sets = Vec::new();
        while set.len() < forced.len() + most {
            let Some((gain, best)) = best(&self.gains(&set)) else { break };
            if gain < LEAST * self.square {
                break;
            }
            set.push(best);
            self.exchange(&mut set, forced.len());
            sets.push(set.clone());
        }
        sets
    }

    /// Exchanges columns as long as that helps; the first `fixed` stay.
    fn exchange(&mut self, set: &mut [usize], fixed: usize) {
        for _ in 0..ROUNDS {
            let before = set.to_vec();
            for place in fixed..set.len() {
                let others: Vec<usize> = (0..set.len()).filter(|&k| k != place).map(|k| set[k]).collect();
                let gains = self.gains(&others);
                if let Some((gain, best)) = best(&gains).filter(|(gain, _)| *gain > BETTER * gains[set[place]]) {
                    debug_assert!(gain.is_finite());
                    set[place] = best;
                }
            }
            if set == &before[..] {
                return;
            }
        }
    }

    /// By how much each column lowers the sum of squares beside those of a set; 0 where it does not.
    fn gains(&mut self, set: &[usize]) -> Vec<f64> {
        set.iter().for_each(|&j| self.ask(j));
        let columns: Vec<&Vec<f64>> = set.iter().filter_map(|j| self.products.get(j)).collect();
        let k = columns.len();
        // A trace of the diagonal keeps parallel columns from making the matrix singular.
        let gram = Mat::from_fn(k, k, |p, q| columns[p][set[q]] + if p == q { PARALLEL } else { 0.0 });
        let Some(inverse) = Cholesky::new(gram.as_ref()).map(|factor| factor.solve(Mat::identity(k, k).as_ref()))
        else {
            return vec![0.0; self.norms.len()];
        };
        let x: Vec<f64> = (0..k).map(|p| (0..k).map(|q| inverse[(p, q)] * self.with_b[set[q]]).sum()).collect();
        let gain = |j: usize| {
            let own = |p: usize| columns[p][j];
            let product = self.with_b[j] - (0..k).map(|p| x[p] * own(p)).sum::<f64>();
            let inside: f64 = (0..k).map(|p| own(p) * (0..k).map(|q| inverse[(p, q)] * own(q)).sum::<f64>()).sum();
            let outside = 1.0 - inside;
            if product > 0.0 && outside > 2.0 * PARALLEL && !set.contains(&j) {
                product * product / outside
            } else {
                0.0
            }
        };
        (0..self.norms.len()).map(gain).collect()
    }

    /// The columns that are most like a column, it itself first.
    pub(super) fn alike(&mut self, column: usize, count: usize) -> Vec<usize> {
        self.ask(column);
        let products = &self.products[&column];
        let mut order: Vec<usize> = (0..products.len()).filter(|&j| self.norms[j] > 0.0).collect();
        order.sort_by(|&i, &j| products[j].total_cmp(&products[i]));
        order.truncate(count);
        order
    }

    fn ask(&mut self, column: usize) {
        if self.products.contains_key(&column) {
            return;
        }
        let norm = if self.norms[column] > 0.0 { self.norms[column] } else { 1.0 };
        let unit: Vec<f64> = self.a.col(column).iter().map(|x| x / norm).collect();
        self.products.insert(column, products(self.a, &self.norms, &unit));
    }
}

/// Products of every unit column with a vector.
fn products(a: &Mat<f64>, norms: &[f64], vector: &[f64]) -> Vec<f64> {
    let all = with_columns(a, vector);
    norms.iter().zip(&all).map(|(norm, product)| if *norm > 0.0 { product / norm } else { 0.0 }).collect()
}

fn best(gains: &[f64]) -> Option<(f64, usize)> {
    let best = (0..gains.len()).max_by(|&i, &j| gains[i].total_cmp(&gains[j]))?;
    (gains[best] > 0.0).then_some((gains[best], best))
}
