//! Symmetric sparse matrices: products with blocks of vectors, and Cholesky factors with a fill-reducing order.

use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Mat, MatRef, Side};

/// A symmetric n x n matrix; the lower triangle is kept, column by column, rows ascending.
#[derive(Debug, Clone, PartialEq)]
pub struct SparseSymmetric {
    size: usize,
    /// Where each column begins, n + 1 values.
    starts: Vec<usize>,
    rows: Vec<usize>,
    values: Vec<f64>,
}

impl SparseSymmetric {
    /// From entries `(row, column, value)`, each of the lower or the upper triangle; those of one place are added. Give
    /// each pair of mirrored entries once. `None` if an index is not below `size`.
    pub fn from_entries(size: usize, entries: &[(usize, usize, f64)]) -> Option<Self> {
        if entries.iter().any(|&(i, j, _)| i.max(j) >= size) {
            return None;
        }
        let mut starts = vec![0; size + 1];
        entries.iter().for_each(|&(i, j, _)| starts[i.min(j) + 1] += 1);
        (0..size).for_each(|j| starts[j + 1] += starts[j]);
        let mut next = starts.clone();
        let mut sorted = vec![(0, 0.0); entries.len()];
        for &(i, j, value) in entries {
            let at = &mut next[i.min(j)];
            sorted[*at] = (i.max(j), value);
            *at += 1;
        }
        let mut matrix = Self { size, starts: Vec::with_capacity(size + 1), rows: Vec::new(), values: Vec::new() };
        matrix.starts.push(0);
        for j in 0..size {
            let column = &mut sorted[starts[j]..starts[j + 1]];
            column.sort_by_key(|&(row, _)| row);
            matrix.append(column);
        }
        Some(matrix)
    }

    /// Appends a column of sorted entries, those of one row added.
    fn append(&mut self, column: &[(usize, f64)]) {
        let begin = self.rows.len();
        for &(row, value) in column {
            if self.rows.len() > begin && self.rows.last() == Some(&row) {
                if let Some(last) = self.values.last_mut() {
                    *last += value;
                }
            } else {
                self.rows.push(row);
                self.values.push(value);
            }
        }
        self.starts.push(self.rows.len());
    }

    /// Number of rows, n.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Entries of the lower triangle `(row, column, value)`.
    pub fn entries(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        (0..self.size).flat_map(move |j| {
            let range = self.starts[j]..self.starts[j + 1];
            range.map(move |k| (self.rows[k], j, self.values[k]))
        })
    }

    /// The diagonal.
    pub fn diagonal(&self) -> Vec<f64> {
        let mut diagonal = vec![0.0; self.size];
        self.entries().filter(|&(i, j, _)| i == j).for_each(|(i, _, value)| diagonal[i] = value);
        diagonal
    }

    /// `A X`, n x k.
    pub fn times(&self, x: MatRef<'_, f64>) -> Mat<f64> {
        let mut product = Mat::zeros(self.size, x.ncols());
        for c in 0..x.ncols() {
            let from: Vec<f64> = x.col(c).iter().copied().collect();
            let mut to = vec![0.0; self.size];
            for j in 0..self.size {
                let mut sum = 0.0;
                for k in self.starts[j]..self.starts[j + 1] {
                    let (i, value) = (self.rows[k], self.values[k]);
                    to[i] += value * from[j];
                    if i != j {
                        sum += value * from[i];
                    }
                }
                to[j] += sum;
            }
            product.col_mut(c).iter_mut().zip(&to).for_each(|(p, t)| *p = *t);
        }
        product
    }

    /// `A + factor B`, of one size.
    #[must_use]
    pub fn plus(&self, factor: f64, other: &Self) -> Self {
        let scaled = other.entries().map(|(i, j, value)| (i, j, factor * value));
        let all: Vec<_> = self.entries().chain(scaled).collect();
        Self::from_entries(self.size, &all).unwrap_or_else(|| self.clone())
    }

    /// Rows and columns `chosen` (ascending), and the rectangular block of the other rows by the chosen columns as
    /// `(row among the others, column among the chosen, value)`; then the block of the others.
    pub fn partition(&self, chosen: &[usize]) -> (Self, Vec<(usize, usize, f64)>, Self) {
        let mut place = vec![(false, 0); self.size];
        let mut others = 0;
        let mut next = chosen.iter().copied().peekable();
        let mut kept = 0;
        for (i, entry) in place.iter_mut().enumerate() {
            if next.peek() == Some(&i) {
                next.next();
                *entry = (true, kept);
                kept += 1;
            } else {
                *entry = (false, others);
                others += 1;
            }
        }
        let (mut own, mut between, mut rest) = (Vec::new(), Vec::new(), Vec::new());
        for (i, j, value) in self.entries() {
            match (place[i], place[j]) {
                ((true, a), (true, b)) => own.push((a, b, value)),
                ((false, a), (false, b)) => rest.push((a, b, value)),
                ((false, a), (true, b)) | ((true, b), (false, a)) => between.push((a, b, value)),
            }
        }
        let built = |size, entries: &[_]| {
            let empty = Self { size, starts: vec![0; size + 1], rows: Vec::new(), values: Vec::new() };
            Self::from_entries(size, entries).unwrap_or(empty)
        };
        (built(kept, &own), between, built(others, &rest))
    }
}

/// `P A P^T = L L^T` of a sparse symmetric positive definite matrix.
#[derive(Debug, Clone)]
pub struct SparseCholesky(Llt<usize, f64>);

impl SparseCholesky {
    /// Factors of `a`; `None` if it is not positive definite (or does not fit in memory).
    pub fn new(a: &SparseSymmetric) -> Option<Self> {
        let symbolic = SymbolicSparseColMatRef::new_checked(a.size, a.size, &a.starts, None, &a.rows);
        let order = SymbolicLlt::try_new(symbolic, Side::Lower).ok()?;
        Llt::try_new_with_symbolic(order, SparseColMatRef::new(symbolic, &a.values), Side::Lower).ok().map(Self)
    }

    /// `A^-1 B`.
    pub fn solve(&self, b: MatRef<'_, f64>) -> Mat<f64> {
        self.0.solve(b)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    /// A chain of springs with a coupling across, entries of either triangle and given in parts.
    fn example() -> SparseSymmetric {
        let mut entries: Vec<(usize, usize, f64)> = (0..7).map(|i| (i, i, 3.0 + i as f64)).collect();
        entries.extend((0..6).map(|i| (i, i + 1, -1.0)));
        entries.extend([(6, 0, -0.25), (0, 6, -0.25)]);
        SparseSymmetric::from_entries(7, &entries).unwrap()
    }

    fn dense(a: &SparseSymmetric) -> Mat<f64> {
        let mut full = Mat::zeros(a.size(), a.size());
        a.entries().for_each(|(i, j, value)| {
            full[(i, j)] = value;
            full[(j, i)] = value;
        });
        full
    }

    #[test]
    fn products_and_solutions_are_those_of_the_full_matrix() {
        let a = example();
        let x = Mat::from_fn(7, 3, |i, j| ((i * 3 + j) as f64).sin());
        let full = dense(&a);
        assert_eq!(full[(0, 6)], -0.5);
        let product = a.times(x.as_ref());
        assert!((&product - &full * &x).norm_max() < 1e-14);
        let back = SparseCholesky::new(&a).unwrap().solve(product.as_ref());
        assert!((&back - &x).norm_max() < 1e-13);
        let sum = a.plus(-2.0, &a);
        assert!((dense(&sum) + full).norm_max() < 1e-15);
    }

    #[test]
    fn parts_are_the_blocks() {
        let (full, chosen) = (dense(&example()), [1, 6]);
        let (own, between, rest) = example().partition(&chosen);
        let others = [0, 2, 3, 4, 5];
        assert_eq!(dense(&own), Mat::from_fn(2, 2, |i, j| full[(chosen[i], chosen[j])]));
        assert_eq!(dense(&rest), Mat::from_fn(5, 5, |i, j| full[(others[i], others[j])]));
        let mut block = Mat::<f64>::zeros(5, 2);
        between.iter().for_each(|&(i, j, value)| block[(i, j)] += value);
        assert_eq!(block, Mat::from_fn(5, 2, |i, j| full[(others[i], chosen[j])]));
    }

    #[test]
    fn indefinite_matrices_have_no_factors() {
        let a = SparseSymmetric::from_entries(2, &[(0, 0, 1.0), (1, 0, 2.0), (1, 1, 1.0)]).unwrap();
        assert!(SparseCholesky::new(&a).is_none());
        assert!(SparseSymmetric::from_entries(1, &[(0, 1, 1.0)]).is_none());
    }
}
