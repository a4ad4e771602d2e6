//! The bound of branch and bound: non-negative least squares over all columns still allowed, from the normal matrix and
//! from the solution of the node above, so that one node costs microseconds.
//!
//! With unit columns, `N = A^T A`, `h = A^T b` and `|b| = 1`, the residual of columns in use is `1 - x^T h`.

use super::unit_problem::Unit;
use crate::math::nnls::{NnlsError, nnls};
use faer::Mat;

/// Gradients below this are rounding.
const GRADIENT: f64 = 1e-13;
/// Squared sine under which a column counts as dependent in the normal matrix; the slow route takes over.
const PIVOT: f64 = 1e-11;

/// Errors of a solution by the normal matrix, in units of the last digit over the least pivot.
const ROUNDING: f64 = 64.0;

/// Normal matrix and right-hand side of the unit problem.
pub(super) struct Normal {
    pub n: usize,
    pub gram: Vec<f64>,
    pub h: Vec<f64>,
}

impl Normal {
    pub(super) fn new(unit: &Unit) -> Self {
        let n = unit.columns.len();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let mut gram = vec![0.0; n * n];
        for i in 0..n {
            for j in 0..=i {
                let value = dot(&unit.columns[i], &unit.columns[j]);
                gram[i * n + j] = value;
                gram[j * n + i] = value;
            }
        }
        Self { n, gram, h: unit.columns.iter().map(|c| dot(c, &unit.b)).collect() }
    }

    /// Whether least squares without bounds on `set` gives a coefficient that is negative beyond rounding: then the best with
    /// bounds leaves a column out, and the set is none of its size. False where rounding hides it.
    pub(super) fn has_negative(&self, set: &[usize]) -> bool {
        let Some((x, least)) = self.solve(set) else { return false };
        let size = x.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let rounding = ROUNDING * f64::EPSILON / least * size;
        x.iter().any(|v| *v < -rounding)
    }

    /// Solves `N_SS x = h_S`, with the least pivot; `None` when a column depends on those before it. By hand: a general factorisation costs
    /// more to call than these few columns to solve, and a node of the search makes some.
    fn solve(&self, set: &[usize]) -> Option<(Vec<f64>, f64)> {
        let p = set.len();
        let mut l = vec![0.0; p * p];
        let mut x = vec![0.0; p];
        let mut least = 1.0_f64;
        for i in 0..p {
            for j in 0..=i {
                let known: f64 = l[i * p..i * p + j].iter().zip(&l[j * p..j * p + j]).map(|(a, b)| a * b).sum();
                let rest = self.gram[set[i] * self.n + set[j]] - known;
                if i > j {
                    l[i * p + j] = rest / l[j * p + j];
                } else if rest > PIVOT {
                    least = least.min(rest);
                    l[i * p + i] = rest.sqrt();
                } else {
                    return None;
                }
            }
            let known: f64 = l[i * p..i * p + i].iter().zip(&x).map(|(a, b)| a * b).sum();
            x[i] = (self.h[set[i]] - known) / l[i * p + i];
        }
        for i in (0..p).rev() {
            let known: f64 = (i + 1..p).map(|k| l[k * p + i] * x[k]).sum();
            x[i] = (x[i] - known) / l[i * p + i];
        }
        Some((x, least))
    }
}

/// A relaxed solution: the columns in use, their coefficients, and the squared residual.
#[derive(Debug, Clone, Default)]
pub(super) struct Relaxed {
    pub passive: Vec<usize>,
    pub x: Vec<f64>,
    pub squared_residual: f64,
}

impl Relaxed {
    /// Drops a column; [`Relaxed::optimise`] must follow.
    pub(super) fn exclude(&mut self, column: usize) {
        if let Some(k) = self.passive.iter().position(|&j| j == column) {
            self.passive.remove(k);
            self.x.remove(k);
        }
    }

    /// Continues from the present columns to the optimum over `allowed`.
    pub(super) fn optimise(&mut self, normal: &Normal, unit: &Unit, allowed: &[usize]) -> Result<(), NnlsError> {
        if self.descend(normal, allowed).is_none() {
            self.slow(unit, allowed)?;
        }
        Ok(())
    }

    /// Lawson-Hanson on the normal matrix; `None` where rounding makes it untrustworthy.
    fn descend(&mut self, normal: &Normal, allowed: &[usize]) -> Option<()> {
        self.settle(normal)?;
        for _ in 0..3 * allowed.len() + 10 {
            let Some(entering) = self.steepest(normal, allowed) else {
                let fit: f64 = self.passive.iter().zip(&self.x).map(|(&j, x)| normal.h[j] * x).sum();
                self.squared_residual = (1.0 - fit).max(0.0);
                return Some(());
            };
            self.passive.push(entering);
            self.x.push(0.0);
            self.settle(normal)?;
            if self.passive.last() != Some(&entering) {
                return None;
            }
        }
        None
    }

    fn steepest(&self, normal: &Normal, allowed: &[usize]) -> Option<usize> {
        let mut gradient = normal.h.clone();
        for (&p, x) in self.passive.iter().zip(&self.x) {
            for (g, n) in gradient.iter_mut().zip(&normal.gram[p * normal.n..(p + 1) * normal.n]) {
                *g -= x * n;
            }
        }
        let open = allowed.iter().filter(|&&j| gradient[j] > GRADIENT && !self.passive.contains(&j));
        open.copied().max_by(|&a, &b| gradient[a].total_cmp(&gradient[b]))
    }

    /// Least squares on the columns in use, giving up those whose coefficient would turn negative.
    fn settle(&mut self, normal: &Normal) -> Option<()> {
        loop {
            let (target, _) = normal.solve(&self.passive)?;
            if target.iter().all(|&t| t > 0.0) {
                self.x = target;
                return Some(());
            }
            let ratio = |k: usize| self.x[k] / (self.x[k] - target[k]);
            let blocking = (0..target.len()).filter(|&k| target[k] <= 0.0);
            let first = blocking.min_by(|&a, &b| ratio(a).total_cmp(&ratio(b)))?;
            let alpha = ratio(first);
            let alpha = if alpha.is_finite() { alpha } else { 0.0 };
            for (x, t) in self.x.iter_mut().zip(&target) {
                *x += alpha * (t - *x);
            }
            self.passive.remove(first);
            self.x.remove(first);
        }
    }

    /// The same by orthogonal factorisation.
    fn slow(&mut self, unit: &Unit, allowed: &[usize]) -> Result<(), NnlsError> {
        let a = Mat::from_fn(unit.b.len(), allowed.len(), |i, j| unit.columns[allowed[j]][i]);
        let fit = nnls(a.as_ref(), &unit.b)?;
        let used = || allowed.iter().zip(&fit.solution).filter(|(_, x)| **x > 0.0);
        self.passive = used().map(|(&j, _)| j).collect();
        self.x = used().map(|(_, &x)| x).collect();
        self.squared_residual = fit.residual_norm * fit.residual_norm;
        Ok(())
    }
}
