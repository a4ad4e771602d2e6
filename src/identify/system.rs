//! Weighted linear equations `A c = b` for the coefficients of all columns, in either form.

use crate::math::fill::filled;
use faer::Mat;

/// Rows of unit variance where the noise is known.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct System {
    /// Rows x columns.
    pub a: Mat<f64>,
    pub b: Vec<f64>,
    /// Run (among those in use) of each row.
    pub run: Vec<usize>,
    /// Standard deviation of each row: 1 where weighted by it, unknown (`None`) where noise is not known.
    pub deviation: Option<Vec<f64>>,
}

impl System {
    /// Number of rows.
    pub(super) fn rows(&self) -> usize {
        self.b.len()
    }

    /// Some of the columns, of all rows but those of one run.
    pub(super) fn part(&self, columns: &[usize], without: Option<usize>) -> (Mat<f64>, Vec<f64>) {
        let rows: Vec<usize> = (0..self.rows()).filter(|&i| Some(self.run[i]) != without).collect();
        let a = Mat::from_fn(rows.len(), columns.len(), |i, j| self.a[(rows[i], columns[j])]);
        (a, rows.iter().map(|&i| self.b[i]).collect())
    }

    /// `|A_S c - b|^2`, each row over its deviation where that is known.
    pub(super) fn chi_square(&self, columns: &[usize], coefficients: &[f64]) -> f64 {
        (0..self.rows())
            .map(|i| {
                let model: f64 = columns.iter().zip(coefficients).map(|(&j, c)| self.a[(i, j)] * c).sum();
                let deviation = self.deviation.as_ref().map_or(1.0, |d| d[i]);
                ((model - self.b[i]) / deviation).powi(2)
            })
            .sum()
    }

    /// The least squares problem of some columns in no more rows than they are, plus one, by QR.
    pub(super) fn compressed(&self, columns: &[usize]) -> (Mat<f64>, Vec<f64>) {
        let n = columns.len();
        if self.rows() <= n + 1 {
            return self.part(columns, None);
        }
        let entry = |i: usize, j: usize| columns.get(j).map_or(self.b[i], |&column| self.a[(i, column)]);
        let r = dashpot_numerics::triangle(filled(self.rows(), n + 1, entry).as_ref());
        (filled(n + 1, n, |i, j| r[(i, j)]), (0..=n).map(|i| r[(i, n)]).collect())
    }
}
