//! Non-negative least squares: `min |A x - b|` subject to `x >= 0`.
//!
//! Lawson and Hanson, *Solving Least Squares Problems* (1974), chapter 23. Columns are scaled to unit norm inside, so
//! that columns that differ by orders of magnitude (viscous beside Coulomb) are treated alike. A column that depends on
//! those already in use is never admitted, and a step that does not lower the residual is undone and its column barred
//! until another step succeeds: every set of columns in use has a smaller residual than the one before, so no set comes
//! back and the iteration ends.

use dashpot_numerics::dot;
use faer::MatRef;

/// Part of a unit column that must be independent of the columns in use; below it the column is taken as dependent.
const INDEPENDENCE: f64 = 1e-10;

/// The solution of a non-negative least squares problem.
#[derive(Debug, Clone, PartialEq)]
pub struct NonNegative {
    /// `x >= 0`, one value a column of `A`.
    pub solution: Vec<f64>,
    /// `|A x - b|`, in the unit of `b`.
    pub residual_norm: f64,
    /// `A^T (b - A x)`: zero where `x > 0`, at most rounding above zero elsewhere (the Karush-Kuhn-Tucker conditions).
    pub dual: Vec<f64>,
    /// Number of times a column was tried.
    pub iterations: usize,
}

/// Why a least squares problem has no answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum NnlsError {
    #[error("the right-hand side has {values} values but the matrix has {rows} rows: give one value a row")]
    Sizes { rows: usize, values: usize },
    #[error("row {row} of column {column} of the matrix is {value}: every entry must be a finite number")]
    Matrix { row: usize, column: usize, value: f64 },
    #[error("value {row} of the right-hand side is {value}: every value must be a finite number")]
    RightHandSide { row: usize, value: f64 },
    #[error("no non-negative solution within {iterations} steps: the columns are too nearly alike")]
    NoConvergence { iterations: usize },
}

/// Solves `min |A x - b|`, `x >= 0`. `A` is m x n (any m and n), `b` has m values.
///
/// Zero columns get a zero coefficient; of collinear columns at most one gets a positive coefficient.
///
/// # Errors
/// [`NnlsError`] when sizes disagree, an entry is not finite, or (never seen) rounding prevents convergence.
///
/// ```
/// let a = faer::mat![[1.0, 1.0], [0.0, 1.0], [0.0, 0.0]];
/// let fit = dashpot::math::nnls::nnls(a.as_ref(), &[2.0, -1.0, 3.0]).unwrap();
/// assert!((fit.solution[0] - 2.0).abs() < 1e-12 && fit.solution[1] == 0.0);
/// assert!((fit.residual_norm - 10f64.sqrt()).abs() < 1e-12);
/// ```
pub fn nnls(a: MatRef<'_, f64>, b: &[f64]) -> Result<NonNegative, NnlsError> {
    let mut problem = Problem::new(a, b)?;
    let iterations = problem.solve()?;
    Ok(problem.finish(iterations))
}

/// Checks sizes and finiteness of `A` and `b`.
pub(crate) fn check(a: MatRef<'_, f64>, b: &[f64]) -> Result<(), NnlsError> {
    if a.nrows() != b.len() {
        return Err(NnlsError::Sizes { rows: a.nrows(), values: b.len() });
    }
    for column in 0..a.ncols() {
        for row in 0..a.nrows() {
            if !a[(row, column)].is_finite() {
                return Err(NnlsError::Matrix { row, column, value: a[(row, column)] });
            }
        }
    }
    match b.iter().position(|v| !v.is_finite()) {
        Some(row) => Err(NnlsError::RightHandSide { row, value: b[row] }),
        None => Ok(()),
    }
}

/// Euclidean norm that neither overflows nor underflows.
pub fn norm(x: &[f64]) -> f64 {
    let largest = x.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    if largest == 0.0 || !largest.is_finite() {
        return largest;
    }
    largest * x.iter().map(|v| (v / largest).powi(2)).sum::<f64>().sqrt()
}

/// The scaled problem and the state of the active-set iteration.
struct Problem {
    /// Unit columns (or zero).
    columns: Vec<Vec<f64>>,
    scale: Vec<f64>,
    /// Right-hand side of unit norm (or zero).
    b: Vec<f64>,
    b_norm: f64,
    x: Vec<f64>,
    /// Columns in use, in the order of admission.
    passive: Vec<usize>,
    residual: Vec<f64>,
    basis: Basis,
}

/// Orthonormal columns of those in use, `A_P = Q R`. Kept from one step to the next as far as the columns are the same: a column
/// that is tried costs one orthogonalisation, not that of all.
#[derive(Default)]
struct Basis {
    order: Vec<usize>,
    q: Vec<Vec<f64>>,
    /// Column k holds the k + 1 entries above and on the diagonal.
    r: Vec<Vec<f64>>,
    /// `Q^T b`.
    image: Vec<f64>,
}

impl Basis {
    /// Makes it the basis of `columns[order]` by modified Gram-Schmidt with reorthogonalisation; false if these are dependent.
    fn follow(&mut self, order: &[usize], columns: &[Vec<f64>], b: &[f64]) -> bool {
        let same = self.order.iter().zip(order).take_while(|(a, b)| a == b).count();
        self.order.truncate(same);
        self.q.truncate(same);
        self.r.truncate(same);
        self.image.truncate(same);
        order[same..].iter().all(|&j| self.append(j, &columns[j], b))
    }

    fn append(&mut self, j: usize, column: &[f64], b: &[f64]) -> bool {
        let mut v = column.to_vec();
        let mut r = vec![0.0; self.q.len()];
        for _ in 0..2 {
            for (entry, unit) in r.iter_mut().zip(&self.q) {
                let projection = dot(unit, &v);
                *entry += projection;
                subtract(&mut v, projection, unit);
            }
        }
        let rest = norm(&v);
        if rest < INDEPENDENCE {
            return false;
        }
        v.iter_mut().for_each(|value| *value /= rest);
        r.push(rest);
        self.image.push(dot(&v, b));
        self.q.push(v);
        self.r.push(r);
        self.order.push(j);
        true
    }

    /// `R^-1 Q^T b`.
    fn solution(&self) -> Vec<f64> {
        let p = self.order.len();
        let mut x = self.image.clone();
        for k in (0..p).rev() {
            x[k] /= self.r[k][k];
            let value = x[k];
            for (entry, above) in x[..k].iter_mut().zip(&self.r[k]) {
                *entry -= value * above;
            }
        }
        x
    }
}

impl Problem {
    fn new(a: MatRef<'_, f64>, b: &[f64]) -> Result<Self, NnlsError> {
        check(a, b)?;
        let mut columns: Vec<Vec<f64>> = (0..a.ncols()).map(|j| (0..a.nrows()).map(|i| a[(i, j)]).collect()).collect();
        let scale: Vec<f64> = columns.iter_mut().map(|c| normalise(c)).collect();
        let mut b = b.to_vec();
        let b_norm = normalise(&mut b);
        let (x, residual) = (vec![0.0; columns.len()], b.clone());
        Ok(Self { x, residual, columns, scale, b, b_norm, passive: Vec::new(), basis: Basis::default() })
    }

    fn solve(&mut self) -> Result<usize, NnlsError> {
        let n = self.columns.len();
        let tolerance = 8.0 * f64::EPSILON * (self.b.len().max(n).max(1)) as f64;
        let limit = 100 + 30 * n;
        let mut barred = vec![false; n];
        for iteration in 0..limit {
            let Some(entering) = self.steepest(&barred, tolerance) else {
                return Ok(iteration);
            };
            if self.admit(entering) {
                barred.fill(false);
            } else {
                barred[entering] = true;
            }
        }
        Err(NnlsError::NoConvergence { iterations: limit })
    }

    /// The unused column with the largest positive gradient.
    fn steepest(&self, barred: &[bool], tolerance: f64) -> Option<usize> {
        (0..self.columns.len())
            .filter(|&j| !barred[j] && self.scale[j] > 0.0 && !self.passive.contains(&j))
            .map(|j| (j, dot(&self.columns[j], &self.residual)))
            .filter(|&(_, gradient)| gradient > tolerance)
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(j, _)| j)
    }

    /// Takes column `entering` into use; undoes everything and returns false if that does not lower the residual.
    fn admit(&mut self, entering: usize) -> bool {
        let before = (self.x.clone(), self.passive.clone(), self.residual.clone());
        self.passive.push(entering);
        let improved = self.restore_feasibility(entering) && {
            self.update_residual();
            norm(&self.residual) < norm(&before.2)
        };
        if !improved {
            (self.x, self.passive, self.residual) = before;
        }
        improved
    }

    /// The inner loop: solve without bounds, and give up columns whose coefficient would turn negative.
    fn restore_feasibility(&mut self, entering: usize) -> bool {
        let mut first = true;
        while let Some(target) = self.unbounded_solution() {
            let last = self.passive.len().checked_sub(1);
            if first && last.is_some_and(|last| target[last] <= 0.0) {
                return false;
            }
            first = false;
            if target.iter().all(|&t| t > 0.0) {
                for (&j, &t) in self.passive.iter().zip(&target) {
                    self.x[j] = t;
                }
                return true;
            }
            self.step_towards(&target);
            if !self.passive.contains(&entering) {
                return false;
            }
        }
        false
    }

    /// Moves to the first bound on the way to `target` and drops the columns that reach it.
    fn step_towards(&mut self, target: &[f64]) {
        let blocking = self.passive.iter().zip(target).enumerate().filter(|(_, (_, t))| **t <= 0.0);
        let (first, alpha) = blocking
            .map(|(k, (&j, &t))| (k, self.x[j] / (self.x[j] - t)))
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap_or((0, 0.0));
        let alpha = if alpha.is_finite() { alpha } else { 0.0 };
        for (&j, &t) in self.passive.iter().zip(target) {
            self.x[j] += alpha * (t - self.x[j]);
        }
        self.x[self.passive[first]] = 0.0;
        let x = &mut self.x;
        self.passive.retain(|&j| {
            if x[j] <= 0.0 {
                x[j] = 0.0;
            }
            x[j] > 0.0
        });
    }

    /// Least squares on the columns in use; `None` if they are dependent.
    fn unbounded_solution(&mut self) -> Option<Vec<f64>> {
        self.basis.follow(&self.passive, &self.columns, &self.b).then(|| self.basis.solution())
    }

    fn update_residual(&mut self) {
        self.residual.clone_from(&self.b);
        for &j in &self.passive {
            subtract(&mut self.residual, self.x[j], &self.columns[j]);
        }
    }

    /// Back to the units of the question.
    fn finish(self, iterations: usize) -> NonNegative {
        let solution =
            self.x.iter().zip(&self.scale).map(|(x, s)| if *s > 0.0 { x * self.b_norm / s } else { 0.0 }).collect();
        let dual =
            self.columns.iter().zip(&self.scale).map(|(c, s)| dot(c, &self.residual) * s * self.b_norm).collect();
        NonNegative { solution, residual_norm: norm(&self.residual) * self.b_norm, dual, iterations }
    }
}

fn subtract(from: &mut [f64], factor: f64, what: &[f64]) {
    for (f, w) in from.iter_mut().zip(what) {
        *f -= factor * w;
    }
}

/// Divides by the norm and returns it; leaves a zero vector alone.
pub(super) fn normalise(x: &mut [f64]) -> f64 {
    let length = norm(x);
    if length > 0.0 {
        for v in x.iter_mut() {
            *v /= length;
        }
    }
    length
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use faer::{Mat, mat};

    #[test]
    fn collinear_and_zero_columns_are_harmless() {
        let a = mat![[1.0, 2.0, 0.0, 1.0], [1.0, 2.0, 0.0, -1.0], [1.0, 2.0, 0.0, 0.0]];
        let fit = nnls(a.as_ref(), &[3.0, 1.0, 2.0]).unwrap();
        assert!(fit.residual_norm < 1e-13);
        assert_eq!(fit.solution[2], 0.0);
        assert!((fit.solution[0] + 2.0 * fit.solution[1] - 2.0).abs() < 1e-13);
        assert!((fit.solution[3] - 1.0).abs() < 1e-13);
    }

    #[test]
    fn columns_of_very_different_size() {
        let a = mat![[1e-9, 1e9], [2e-9, -1e9], [0.0, 1e9]];
        let fit = nnls(a.as_ref(), &[2e-9 + 3e9, 4e-9 - 3e9, 3e9]).unwrap();
        assert!((fit.solution[1] - 3.0).abs() < 1e-12);
    }

    #[test]
    fn negative_direction_gives_zero() {
        let fit = nnls(mat![[1.0], [1.0]].as_ref(), &[-1.0, -2.0]).unwrap();
        assert_eq!(fit.solution, [0.0]);
        assert!((fit.residual_norm - 5f64.sqrt()).abs() < 1e-14);
        assert!((fit.dual[0] + 3.0).abs() < 1e-14);
    }

    #[test]
    fn bad_input_is_an_error() {
        let nan = nnls(mat![[1.0], [f64::NAN]].as_ref(), &[1.0, 2.0]).unwrap_err();
        assert!(matches!(nan, NnlsError::Matrix { row: 1, column: 0, .. }));
        let rhs = nnls(mat![[1.0]].as_ref(), &[f64::INFINITY]).unwrap_err();
        assert_eq!(rhs.to_string(), "value 0 of the right-hand side is inf: every value must be a finite number");
        assert_eq!(nnls(mat![[1.0]].as_ref(), &[1.0, 2.0]), Err(NnlsError::Sizes { rows: 1, values: 2 }));
    }

    #[test]
    fn empty_and_zero_problems() {
        assert!(nnls(Mat::zeros(3, 0).as_ref(), &[1.0, 0.0, 0.0]).unwrap().solution.is_empty());
        assert_eq!(nnls(mat![[1.0, 2.0]].as_ref(), &[0.0]).unwrap().solution, [0.0, 0.0]);
    }
}
