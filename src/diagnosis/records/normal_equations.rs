//! The normal equations of a fit of records at a point: products of the derivatives of every record, with the priors of the
//! corrections, and the step of Levenberg and Marquardt that follows from them.

use super::coarse_steps::Defect;
use super::data::{RecordData, RecordDiagnosisError};
use super::fitted::FittedRecords;
use super::problem::FitProblem;
use super::steps::Steps;
use crate::response::transient::{TransientError, TransientParameter};
use dashpot_numerics::{EquilibratedCholesky, dot};
use faer::Mat;

/// Normal equations at a point.
pub(super) struct Normal {
    pub matrix: Mat<f64>,
    pub gradient: Vec<f64>,
    pub left: Left,
}

/// How the equations at a point, and what is left there, are found.
pub(super) struct Equations<'a> {
    pub normal: &'a dyn Fn(&FittedRecords) -> Result<Normal, RecordDiagnosisError>,
    pub left: &'a dyn Fn(&FittedRecords) -> Result<Left, RecordDiagnosisError>,
}

/// What is left at a point.
#[derive(Default)]
pub(super) struct Left {
    pub chi_square: f64,
    pub prior: f64,
    pub count: usize,
    pub residual: Vec<Vec<Vec<f64>>>,
}

impl Left {
    pub(super) fn total(&self, unit: f64) -> f64 {
        self.chi_square + unit * self.prior
    }
}

impl FitProblem<'_> {
    pub(super) fn normal(
        &self,
        at: &FittedRecords,
        scales: &[Vec<f64>],
        unit: f64,
    ) -> Result<Normal, RecordDiagnosisError> {
        let parts = self.control.map(self.records.list.len(), |r| {
            self.derivatives(at, scales, r, Steps::Fine).map(|derivatives| derivatives.products(1.0))
        });
        Ok(self.assembled(at, unit, parts.into_iter().collect::<Result<_, _>>()?))
    }

    /// The equations of the products of all records, with the priors.
    pub(super) fn assembled(&self, at: &FittedRecords, unit: f64, parts: Vec<RecordPart>) -> Normal {
        let size = self.shared(at) + self.records.list.len() * self.local();
        let mut normal = Normal { matrix: Mat::zeros(size, size), gradient: vec![0.0; size], left: Left::default() };
        for part in parts {
            normal.add(&part);
            normal.left.chi_square += part.square;
            normal.left.count += part.left.iter().map(Vec::len).sum::<usize>();
            normal.left.residual.push(part.left);
        }
        let priors = self.priors(at);
        normal.left.prior = self.prior_cost(at, &priors);
        for (k, value, deviation) in priors {
            let weight = unit * deviation.powi(-2);
            normal.matrix[(k, k)] += weight;
            normal.gradient[k] -= weight * value;
        }
        // What is held moves nowhere.
        let laws = self.first_correction(at);
        for k in 0..if self.free.effects { 0 } else { laws } {
            normal.matrix[(k, k)] = 1.0;
        }
        for k in self.unused_shifts(at) {
            normal.matrix[(k, k)] = 1.0;
        }
        for (j, _) in self.free.corrections.iter().enumerate().filter(|(_, free)| !**free) {
            normal.matrix[(laws + j, laws + j)] = 1.0;
        }
        normal
    }

    /// What a model leaves, without derivatives.
    pub(super) fn left(&self, at: &FittedRecords) -> Result<Left, RecordDiagnosisError> {
        self.left_by(at, &|r| self.left_of(at, r, Steps::Fine))
    }

    /// The same in long steps, put right by their defect.
    pub(super) fn left_beside(&self, at: &FittedRecords, defect: &Defect) -> Result<Left, RecordDiagnosisError> {
        self.left_by(at, &|r| {
            let mut left = self.left_of(at, r, Steps::Coarse)?;
            defect.take_from(r, &mut left);
            Ok(left)
        })
    }

    fn left_by(
        &self,
        at: &FittedRecords,
        left_of_record: &(dyn Fn(usize) -> Result<Vec<Vec<f64>>, RecordDiagnosisError> + Sync),
    ) -> Result<Left, RecordDiagnosisError> {
        let mut left = Left::default();
        for list in self.control.map(self.records.list.len(), left_of_record) {
            let list = list?;
            left.chi_square += list.iter().flatten().map(|e| e * e).sum::<f64>();
            left.count += list.iter().map(Vec::len).sum::<usize>();
            left.residual.push(list);
        }
        left.prior = self.prior_cost(at, &self.priors(at));
        Ok(left)
    }

    /// What it leaves of record `r`, over the noise.
    pub(super) fn left_of(
        &self,
        at: &FittedRecords,
        r: usize,
        steps: Steps,
    ) -> Result<Vec<Vec<f64>>, RecordDiagnosisError> {
        let response = at.predict_in(steps, self.records, r, self.samples(r), &[])?;
        self.over_noise(r, &response.channels)
    }

    /// Samples of a record that are used.
    fn samples(&self, r: usize) -> usize {
        let length = self.records.list[r].len();
        ((self.share * length as f64) as usize).clamp(16.min(length), length)
    }

    /// What a prediction of a record leaves, over the noise.
    fn over_noise(&self, r: usize, predicted: &[Vec<f64>]) -> Result<Vec<Vec<f64>>, RecordDiagnosisError> {
        let record = &self.records.list[r];
        let channel_residual = |(c, model): (usize, &Vec<f64>)| {
            let measured = record.samples[c].iter().zip(&record.sigma[c]);
            model.iter().zip(measured).map(|(m, (y, s))| (y - m) / s).collect::<Vec<f64>>()
        };
        let left: Vec<Vec<f64>> = predicted.iter().enumerate().map(channel_residual).collect();
        if left.iter().flatten().any(|e| !e.is_finite()) {
            let (file, reason) = (record.file.clone(), TransientError::StepFailed);
            return Err(RecordDiagnosisError::Model { file, reason });
        }
        Ok(left)
    }

    /// Derivatives of what record `r` leaves, over the noise.
    pub(super) fn derivatives(
        &self,
        at: &FittedRecords,
        scales: &[Vec<f64>],
        r: usize,
        steps: Steps,
    ) -> Result<RecordDerivatives, RecordDiagnosisError> {
        let unknowns = self.unknowns(at, scales, r);
        let mut parameters: Vec<TransientParameter> = Vec::new();
        for (p, ..) in &unknowns {
            if !parameters.contains(p) {
                parameters.push(*p);
            }
        }
        let mut response = at.predict_in(steps, self.records, r, self.samples(r), &parameters)?;
        let left = self.over_noise(r, &response.channels)?;
        let mut derivatives = std::mem::take(&mut response.derivatives);
        self.whiten(r, &mut derivatives);
        let count = parameters.len();
        let record = &self.records.list[r];
        let mut channels = Vec::with_capacity(left.len());
        for (c, e) in left.iter().enumerate() {
            let mut columns: Vec<(usize, Vec<f64>)> =
                derivatives.iter_mut().map(|list| std::mem::take(&mut list[c])).enumerate().collect();
            let shapes = self.shape_columns(record, c, &response.modal);
            let first = count + self.records.sensor(record, c) * self.records.kept;
            columns.extend(shapes.into_iter().enumerate().map(|(k, list)| (first + k, list)));
            columns.push((count + self.shapes() + c, self.offset_column(r, c, e.len())));
            channels.push(columns);
        }
        let number_of = |p: &TransientParameter| parameters.iter().position(|q| q == p).unwrap_or(0);
        let mut unknowns: Vec<(usize, usize, f64)> = unknowns.iter().map(|(p, k, s)| (number_of(p), *k, *s)).collect();
        let first = self.shared(at) - self.shapes();
        unknowns.extend((0..self.shapes()).map(|k| (count + k, first + k, 1.0)));
        let (own, first) = (count + self.shapes(), self.offset_variable(at, r));
        unknowns.extend((0..self.offsets()).map(|c| (own + c, first + c, 1.0)));
        Ok(RecordDerivatives { unknowns, count: count + self.shapes() + self.offsets(), channels, left })
    }

    /// What record `r` leaves over the noise, and its derivatives by some parameters, `[parameter][channel][sample]`.
    pub(super) fn responses(
        &self,
        at: &FittedRecords,
        r: usize,
        parameters: &[TransientParameter],
        steps: Steps,
    ) -> Result<(Vec<Vec<f64>>, Vec<Vec<Vec<f64>>>), RecordDiagnosisError> {
        let mut response = at.predict_in(steps, self.records, r, self.samples(r), parameters)?;
        let left = self.over_noise(r, &response.channels)?;
        self.whiten(r, &mut response.derivatives);
        Ok((left, response.derivatives))
    }

    /// Divides derivatives of record `r` by the noise.
    fn whiten(&self, r: usize, derivatives: &mut [Vec<Vec<f64>>]) {
        let record = &self.records.list[r];
        for list in derivatives {
            for (channel, sigma) in list.iter_mut().zip(&record.sigma) {
                channel.iter_mut().zip(sigma).for_each(|(d, s)| *d /= s);
            }
        }
    }

    /// Derivative of a channel of record `r` by its offset, over the noise.
    fn offset_column(&self, r: usize, c: usize, samples: usize) -> Vec<f64> {
        let record = &self.records.list[r];
        record.sigma[c][..samples].iter().map(|s| record.largest[c] / s).collect()
    }

    /// Derivatives of a channel by the errors of its shapes, over the noise, one list a kept mode; none where they are held.
    fn shape_columns(&self, record: &RecordData, c: usize, modal: &[Vec<Vec<f64>>; 3]) -> Vec<Vec<f64>> {
        let order = record.channels[c].quantity.derivatives().and_then(|order| usize::try_from(order).ok());
        let (Some(modes), true) = (order.and_then(|order| modal.get(order)), self.free.shapes) else {
            return Vec::new();
        };
        let column = |(r, list): (usize, &Vec<f64>)| {
            let size = self.records.shape_size(r);
            list.iter().zip(&record.sigma[c]).map(|(q, s)| size * q / s).collect()
        };
        modes.iter().enumerate().map(column).collect()
    }
}

/// Derivatives of one record.
pub(super) struct RecordDerivatives {
    /// Number of the derivative, of the variable, and the factor between them.
    pub unknowns: Vec<(usize, usize, f64)>,
    /// Number of derivatives.
    pub count: usize,
    /// Of each channel: numbers of derivatives with their samples, over the noise.
    pub channels: Vec<Vec<(usize, Vec<f64>)>>,
    /// What is left, over the noise, `[channel][sample]`.
    pub left: Vec<Vec<f64>>,
}

impl RecordDerivatives {
    /// Their products, each sample counted `times`.
    pub(super) fn products(&self, times: f64) -> RecordPart {
        let mut products = Products::new(self.count);
        for (columns, e) in self.channels.iter().zip(&self.left) {
            let columns: Vec<(usize, &[f64])> = columns.iter().map(|(k, list)| (*k, &list[..])).collect();
            products.add(&columns, e);
        }
        products.matrix.iter_mut().chain(&mut products.against).for_each(|x| *x *= times);
        let square = times * self.left.iter().flatten().map(|e| e * e).sum::<f64>();
        RecordPart { unknowns: self.unknowns.clone(), products, square, left: self.left.clone() }
    }
}

/// Products of columns with each other and with what is left.
#[derive(Clone)]
pub(super) struct Products {
    count: usize,
    matrix: Vec<f64>,
    against: Vec<f64>,
}

impl Products {
    fn new(count: usize) -> Self {
        Self { count, matrix: vec![0.0; count * count], against: vec![0.0; count] }
    }

    /// Those of the columns behind the first `laws` with each other; nothing stands against what is left.
    pub(super) fn without(&self, laws: usize) -> Self {
        let mut others = Self::new(self.count - laws);
        for (row, all) in others.matrix.chunks_exact_mut((self.count - laws).max(1)).zip(laws..) {
            row.copy_from_slice(&self.matrix[all * self.count + laws..(all + 1) * self.count]);
        }
        others
    }

    /// The same behind `laws` columns of which nothing is known yet.
    pub(super) fn behind(&self, laws: usize) -> Self {
        let mut all = Self::new(laws + self.count);
        for (row, k) in self.matrix.chunks_exact(self.count.max(1)).zip(laws..) {
            all.matrix[k * all.count + laws..(k + 1) * all.count].copy_from_slice(row);
        }
        all
    }

    /// Adds a product of column `a` with what is left.
    pub(super) fn add_against(&mut self, a: usize, product: f64) {
        self.against[a] += product;
    }

    /// Adds a product of columns `a` and `b`.
    pub(super) fn add_product(&mut self, a: usize, b: usize, product: f64) {
        self.matrix[a * self.count + b] += product;
        if a != b {
            self.matrix[b * self.count + a] += product;
        }
    }

    /// Adds those of one channel: its columns with their numbers, and what is left of it.
    fn add(&mut self, columns: &[(usize, &[f64])], left: &[f64]) {
        for (i, (a, own)) in columns.iter().enumerate() {
            self.against[*a] += dot(own, left);
            for (b, other) in &columns[..=i] {
                self.add_product(*a, *b, dot(own, other));
            }
        }
    }
}

/// Products of the derivatives of one record.
#[derive(Clone)]
pub(super) struct RecordPart {
    /// Number of the derivative, of the variable, and the factor between them.
    pub unknowns: Vec<(usize, usize, f64)>,
    pub products: Products,
    /// Squared residual over the noise.
    pub square: f64,
    /// What is left, over the noise, `[channel][sample]`.
    pub left: Vec<Vec<f64>>,
}

impl Normal {
    /// Adds the products of one record.
    pub(super) fn add(&mut self, part: &RecordPart) {
        let Products { count, matrix, against } = &part.products;
        for (p, k, s) in &part.unknowns {
            self.gradient[*k] += s * against[*p];
            for (q, l, t) in &part.unknowns {
                self.matrix[(*k, *l)] += s * t * matrix[p * count + q];
            }
        }
    }
}

/// Share of the greatest entry of the diagonal below which an entry is rounding.
const UNKNOWN: f64 = 1e-20;

/// A step of Levenberg and Marquardt.
pub(super) struct DampedStep {
    /// Change of every variable.
    pub change: Vec<f64>,
    /// What it takes away of the squared residual and the priors to second order.
    pub expected_gain: f64,
}

/// Step of Levenberg and Marquardt, `(H + lambda D) x = g` with `D` the diagonal of `H`; by it `g x + lambda x D x` is taken away to second
/// order.
pub(super) fn solve(normal: &Normal, damping: f64) -> Option<DampedStep> {
    let damped = EquilibratedCholesky::bounded(normal.matrix.as_ref(), damping, UNKNOWN)?;
    let change = damped.solve(&normal.gradient);
    let expected_gain = dot(&change, &normal.gradient) + damping * damped.scaled_square(&change);
    change.iter().all(|x| x.is_finite()).then_some(DampedStep { change, expected_gain })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    /// What a step is expected to gain is what a quadratic function loses by it, with damping and without.
    #[test]
    fn the_expected_gain_is_that_of_a_quadratic_function() {
        let matrix = Mat::from_fn(2, 2, |i, j| [[4.0, 1.0], [1.0, 9.0]][i][j]);
        let normal = Normal { matrix, gradient: vec![2.0, -3.0], left: Left::default() };
        let loss = |x: &[f64]| {
            let square: f64 = (0..2)
                .flat_map(|i| (0..2).map(move |j| (i, j)))
                .map(|(i, j)| x[i] * normal.matrix[(i, j)] * x[j])
                .sum();
            2.0 * (normal.gradient[0] * x[0] + normal.gradient[1] * x[1]) - square
        };
        for damping in [0.0, 0.1, 10.0] {
            let step = solve(&normal, damping).unwrap();
            assert!((step.expected_gain - loss(&step.change)).abs() < 1e-12, "damping {damping}");
        }
    }
}
