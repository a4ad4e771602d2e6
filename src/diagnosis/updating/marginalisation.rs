//! Updating parameters eliminated from fits: their effect on the whitened residual is linear near a reference,
//!
//! ```text
//! r(theta, u) = r(theta, u_0) - B (u - u_0),      u ~ N(0, 1)
//! chi^2(theta) = min_u |r(theta, u)|^2 + |u|^2 = | (1 - Q Q^T) [r + B u_0; 0] |^2,      [B; 1] = Q R
//! ```
//!
//! so that a fit has the parameters of its effects alone, and their deviations contain what is not known of the model
//! (variable projection, Golub and Pereyra 1973; restricted maximum likelihood, Harville 1977).

use super::parameters::Updating;
use super::scales::Scales;
use dashpot_numerics::{Cholesky, dot, thin_qr};
use faer::Mat;
use std::sync::OnceLock;

/// Updating parameters at a reference with what they do to the residual there.
#[derive(Debug, Clone, Default)]
pub(crate) struct Marginalisation {
    /// Parameters, values of the reference and scales.
    pub updating: Updating,
    /// `B`, one column a parameter: derivative of the whitened prediction, one row a datum.
    slopes: Vec<Vec<f64>>,
    /// `Q`, one column a parameter, data rows first; computed when a residual asks for it.
    basis: OnceLock<Vec<Vec<f64>>>,
    /// `B u_0`.
    offset: Vec<f64>,
    /// `1 + B^T B`.
    normal: Option<Mat<f64>>,
    /// Its factor.
    factor: Option<Cholesky>,
    /// `ln det (1 + B^T B)`.
    pub log_determinant: f64,
}

impl Marginalisation {
    /// Of `updating` at its values, whose standardised parameters have the whitened `slopes`.
    pub(crate) fn new(updating: Updating, slopes: Vec<Vec<f64>>) -> Self {
        let q = slopes.len();
        if q == 0 {
            return Self { updating, ..Self::default() };
        }
        let n = slopes[0].len();
        let mut normal = Mat::identity(q, q);
        for i in 0..q {
            for j in 0..=i {
                let product = dot(&slopes[i], &slopes[j]);
                normal[(i, j)] += product;
                if i != j {
                    normal[(j, i)] += product;
                }
            }
        }
        let Some(factor) = Cholesky::new(normal.as_ref()) else { return Self { updating, ..Self::default() } };
        let log_determinant = (0..q).map(|k| 2.0 * factor.factor()[(k, k)].ln()).sum();
        let u = updating.standardised();
        let mut offset = vec![0.0; n];
        for (slope, u) in slopes.iter().zip(&u) {
            offset.iter_mut().zip(slope).for_each(|(o, s)| *o += u * s);
        }
        let (normal, factor) = (Some(normal), Some(factor));
        Self { updating, slopes, basis: OnceLock::new(), offset, normal, factor, log_determinant }
    }

    /// `Q`, none where slopes are beyond all numbers.
    fn basis(&self) -> &[Vec<f64>] {
        self.basis.get_or_init(|| {
            let (q, n) = (self.slopes.len(), self.slopes.first().map_or(0, Vec::len));
            if q == 0 {
                return Vec::new();
            }
            let stacked = Mat::from_fn(n + q, q, |i, k| match i.checked_sub(n) {
                Some(row) => f64::from(u8::from(row == k)),
                None => self.slopes[k][i],
            });
            let orthonormal = thin_qr(stacked.as_ref()).0;
            (0..q).map(|k| orthonormal.col_as_slice(k).to_vec()).collect()
        })
    }

    /// Whether no parameter is eliminated.
    pub(crate) fn is_empty(&self) -> bool {
        self.slopes.is_empty()
    }

    /// `B`, one column a parameter.
    pub(crate) fn slopes(&self) -> &[Vec<f64>] {
        &self.slopes
    }

    /// Turns a whitened residual into the marginal one, a datum longer for every parameter.
    pub(crate) fn residual(&self, rows: Vec<f64>) -> Vec<f64> {
        self.column(self.without_reference(rows))
    }

    /// Turns a whitened residual at the reference into one of the model with no parameter corrected, `r + B u_0`.
    pub(crate) fn without_reference(&self, mut rows: Vec<f64>) -> Vec<f64> {
        rows.iter_mut().zip(&self.offset).for_each(|(r, o)| *r += o);
        rows
    }

    /// Turns a column of a Jacobian into the marginal one.
    pub(crate) fn column(&self, rows: Vec<f64>) -> Vec<f64> {
        marginal(self.basis(), rows)
    }

    /// The parameters (standardised) that fit the whitened residual `rows`, which was taken at the reference; those of the reference
    /// where slopes are beyond all numbers.
    pub(crate) fn solve(&self, rows: &[f64]) -> Vec<f64> {
        let Some(factor) = &self.factor else { return self.updating.standardised() };
        let full: Vec<f64> = rows.iter().zip(&self.offset).map(|(r, o)| r + o).collect();
        let right = Mat::from_fn(self.slopes.len(), 1, |k, _| dot(&self.slopes[k], &full));
        let solved = factor.solve(right.as_ref());
        (0..self.slopes.len()).map(|k| solved[(k, 0)]).collect()
    }

    /// The parameters (standardised) that fit the whitened residual `rows` where its variance is `misfit` rather than 1.
    pub(crate) fn solve_with_misfit(&self, rows: &[f64], misfit: f64) -> Vec<f64> {
        let Some(mut normal) = self.normal.clone() else { return self.updating.standardised() };
        let q = self.slopes.len();
        let full: Vec<f64> = rows.iter().zip(&self.offset).map(|(r, o)| r + o).collect();
        (0..q).for_each(|k| normal[(k, k)] += misfit - 1.0);
        let right = Mat::from_fn(q, 1, |k, _| dot(&self.slopes[k], &full));
        match Cholesky::new(normal.as_ref()) {
            Some(factor) => factor.solve(right.as_ref()).col_as_slice(0).to_vec(),
            None => self.updating.standardised(),
        }
    }

    /// Variances of the standardised parameters, the effects being known; none where slopes are beyond all numbers.
    pub(crate) fn variances(&self) -> Vec<f64> {
        let Some(factor) = &self.factor else { return Vec::new() };
        let q = self.slopes.len();
        let inverse = factor.solve(Mat::<f64>::identity(q, q).as_ref());
        (0..q).map(|k| inverse[(k, k)]).collect()
    }

    /// Least square that is left of the whitened residual `rows`, taken at the reference, with the parameters of the model
    /// there and only those of channels free; priors included.
    pub(crate) fn left_by_channels(&self, rows: &[f64]) -> f64 {
        let of_model = |k: &usize| self.updating.parameters[*k].is_of_model();
        let (fixed, free): (Vec<usize>, Vec<usize>) = (0..self.slopes.len()).partition(of_model);
        let u = self.updating.standardised();
        let square = dot(rows, rows) + fixed.iter().map(|&k| u[k] * u[k]).sum::<f64>();
        let q = free.len();
        let normal =
            Mat::from_fn(q, q, |i, j| dot(&self.slopes[free[i]], &self.slopes[free[j]]) + f64::from(u8::from(i == j)));
        let right = Mat::from_fn(q, 1, |i, _| dot(&self.slopes[free[i]], rows));
        match Cholesky::new(normal.as_ref()).filter(|_| q > 0) {
            Some(factor) => {
                let solved = factor.solve(right.as_ref());
                square - (0..q).map(|i| solved[(i, 0)] * right[(i, 0)]).sum::<f64>()
            }
            None => square,
        }
    }

    /// What is left of a whitened residual taken at the reference once the parameters are at `u`: `r - B (u - u_0)`.
    pub(crate) fn left(&self, mut rows: Vec<f64>, u: &[f64]) -> Vec<f64> {
        let reference = self.updating.standardised();
        for ((slope, u), u0) in self.slopes.iter().zip(u).zip(&reference) {
            rows.iter_mut().zip(slope).for_each(|(r, s)| *r -= (u - u0) * s);
        }
        rows
    }

    /// Scales of the classes of these parameters re-estimated from their values `u` and the `left` share of their prior
    /// variances (MacKay 1992, Neural Computation 4, 415): `s^2 <- s^2 sum u^2 / sum (1 - var)`; a class of which the
    /// data say nothing keeps its scale.
    pub(crate) fn scales(&self, u: &[f64], least_known: f64) -> Scales {
        let variances = self.variances();
        let mut list = self.updating.scales.list();
        for (class, scale) in list.iter_mut().enumerate().filter(|(class, _)| !matches!(class, 4 | 5)) {
            let own = || (0..u.len()).filter(|&k| self.updating.parameters[k].class() == class);
            let known: f64 = own().filter_map(|k| variances.get(k)).map(|variance| 1.0 - variance).sum();
            let square: f64 = own().map(|k| u[k] * u[k]).sum();
            if known > least_known {
                *scale *= (square / known).sqrt();
            }
        }
        Scales::from_list(list)
    }
}

/// `rows`, with a zero behind for each of the orthonormal columns `basis` of what is eliminated, without their share along these.
pub(crate) fn marginal(basis: &[Vec<f64>], mut rows: Vec<f64>) -> Vec<f64> {
    rows.resize(rows.len() + basis.len(), 0.0);
    for direction in basis {
        let share = dot(direction, &rows);
        rows.iter_mut().zip(direction).for_each(|(r, d)| *r -= share * d);
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::updating::parameters::UpdatingParameter;
    use crate::structure::Part;

    /// Data that say nothing, since slopes are beyond all numbers, leave scales as they are.
    #[test]
    fn scales_stay_where_slopes_are_beyond_all_numbers() {
        let updating = Updating { parameters: vec![UpdatingParameter::Structure(Part::Mass)], ..two().updating };
        let updating = Updating { values: vec![0.01], ..updating };
        let lost = Marginalisation::new(updating.clone(), vec![vec![f64::INFINITY, 1.0]]);
        assert!(lost.variances().is_empty());
        assert_eq!(lost.scales(&lost.solve(&[1.0, 2.0]), 0.5), updating.scales);
    }

    fn two() -> Marginalisation {
        let parameters = vec![UpdatingParameter::Structure(Part::Stiffness), UpdatingParameter::Structure(Part::Mass)];
        let updating = Updating { parameters, values: vec![0.004, -0.01], ..Updating::default() };
        Marginalisation::new(updating, vec![vec![3.0, 1.0, -2.0, 0.5], vec![1.0, 4.0, 0.3, -1.0]])
    }

    #[test]
    fn the_marginal_square_is_the_least_over_the_parameters() {
        let (m, rows) = (two(), vec![1.0, -2.0, 0.7, 0.1]);
        let u = m.solve(&rows);
        let cost = |u: &[f64]| -> f64 {
            let left = m.left(rows.clone(), u);
            left.iter().chain(u).map(|x| x * x).sum()
        };
        let marginal: f64 = m.residual(rows.clone()).iter().map(|x| x * x).sum();
        assert!((marginal - cost(&u)).abs() < 1e-12);
        for moved in [[0.01, 0.0], [-0.01, 0.0], [0.0, 0.01], [0.0, -0.01]] {
            assert!(cost(&[u[0] + moved[0], u[1] + moved[1]]) > cost(&u));
        }
    }

    /// Random events set a source so large that the response to it was beyond all numbers.
    #[test]
    fn slopes_beyond_all_numbers_leave_the_parameters_where_they_are() {
        let updating = two().updating;
        let m = Marginalisation::new(updating.clone(), vec![vec![f64::INFINITY, 1.0], vec![1.0, 2.0]]);
        assert_eq!(m.solve(&[1.0, 2.0]), updating.standardised());
        assert_eq!(m.solve_with_misfit(&[1.0, 2.0], 3.0), updating.standardised());
    }

    #[test]
    fn the_determinant_and_variances_are_those_of_the_normal_matrix() {
        let m = two();
        let [n11, n22, n12] = [
            1.0 + dot(&m.slopes[0], &m.slopes[0]),
            1.0 + dot(&m.slopes[1], &m.slopes[1]),
            dot(&m.slopes[0], &m.slopes[1]),
        ];
        let determinant = n11 * n22 - n12 * n12;
        assert!((m.log_determinant - determinant.ln()).abs() < 1e-12);
        assert!((m.variances()[0] - n22 / determinant).abs() < 1e-12);
    }
}
