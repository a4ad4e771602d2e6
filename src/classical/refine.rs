//! Maximum likelihood refinement of poles within a band, noise as it was measured, else in proportion to the response:
//!
//! ```text
//! H_o(w) = sum_k R_ok / (i w - lambda_k) + P_o + Q_o (w - w0)        rows weighted by 1 / deviation
//! ```
//!
//! `P` and `Q` stand for all modes outside. The residues are linear and eliminated (variable projection in Kaufman's form); the
//! model is analytic in the poles, so Gauss-Newton runs on complex unknowns.

use super::error::ClassicalError;
use super::extracted_mode::ExtractedMode;
use super::responses::FrequencyResponses;
use crate::math::fill::{filled, filled_complex};
use faer::{Mat, c64};

/// Most steps.
const STEPS: usize = 40;
/// Part of a decay rate below which a step has settled.
const SETTLED: f64 = 1e-9;
/// Least magnitude in the weights, as a part of the largest in the band: noise does not vanish with the signal.
const FLOOR: f64 = 0.02;
/// Part of a value up to which resonances are those of constant poles: no test piece is more linear, and weights by the noise
/// alone would leave the flanks of a quiet measurement out.
const TRUE: f64 = 0.01;

/// A stretch of lines.
pub(super) struct Band {
    /// Circular frequencies, rad/s.
    pub omega: Vec<f64>,
    /// As measured: they rule the weights.
    measured: Vec<Mat<c64>>,
    /// What is fitted: the measured, other modes taken off where they are known.
    values: Vec<Mat<c64>>,
    /// Deviation that a value is weighted by, sensors x drives.
    scales: Vec<Mat<f64>>,
}

impl Band {
    pub(super) fn new(responses: &FrequencyResponses, first: usize, last: usize) -> Self {
        let values: Vec<Mat<c64>> = responses.values[first..=last].to_vec();
        let mut scales = in_proportion(&values);
        for (scale, deviation) in scales.iter_mut().zip(responses.deviations.iter().skip(first)) {
            *scale = of_noise(scale, deviation);
        }
        Self { omega: responses.omega[first..=last].to_vec(), scales, measured: values.clone(), values }
    }

    /// Takes off what is known already: the modes of `others` with their conjugates, and the conjugates of the band's `own`.
    pub(super) fn take_off(&mut self, others: &[&ExtractedMode], own: &[ExtractedMode]) {
        for (k, &w) in self.omega.iter().enumerate() {
            let s = c64::new(0.0, w);
            let known = |i: usize, j: usize| -> c64 {
                let conjugate = |m: &ExtractedMode| m.residues[(i, j)].conj() / (s - m.pole.conj());
                let direct = |m: &ExtractedMode| m.residues[(i, j)] / (s - m.pole);
                others.iter().map(|m| direct(m) + conjugate(m)).sum::<c64>() + own.iter().map(conjugate).sum::<c64>()
            };
            let measured = &self.measured[k];
            self.values[k] = filled_complex(measured.nrows(), measured.ncols(), |i, j| measured[(i, j)] - known(i, j));
        }
    }

    pub(super) fn sensors(&self) -> usize {
        self.values[0].nrows()
    }

    pub(super) fn drives(&self) -> usize {
        self.values[0].ncols()
    }

    pub(super) fn outputs(&self) -> usize {
        self.sensors() * self.drives()
    }

    pub(super) fn value(&self, line: usize, sensor: usize, drive: usize) -> c64 {
        self.values[line][(sensor, drive)]
    }

    /// Squared weight of a sensor's row at a line, all drives together.
    pub(super) fn weight(&self, line: usize, sensor: usize) -> f64 {
        let sum: f64 = (0..self.drives()).map(|j| self.scale(line, sensor, j).powi(2)).sum();
        1.0 / sum
    }

    fn scale(&self, line: usize, sensor: usize, drive: usize) -> f64 {
        self.scales[line][(sensor, drive)]
    }
}

/// Measured deviations, but none better than modes are linear; `values` are those in proportion to the response.
fn of_noise(values: &Mat<f64>, deviations: &Mat<f64>) -> Mat<f64> {
    filled(values.nrows(), values.ncols(), |i, j| deviations[(i, j)].hypot(TRUE * values[(i, j)]))
}

/// Deviations in proportion to the values, as they are where nothing is known of them.
fn in_proportion(values: &[Mat<c64>]) -> Vec<Mat<f64>> {
    let (rows, columns) = values[0].shape();
    let top = |i: usize, j: usize| values.iter().map(|h| h[(i, j)].norm()).fold(f64::MIN_POSITIVE, f64::max);
    let largest = filled(rows, columns, top);
    let scale = |h: &Mat<c64>| filled(rows, columns, |i, j| h[(i, j)].norm().max(FLOOR * largest[(i, j)]));
    values.iter().map(scale).collect()
}

/// One output's weighted fit at given poles.
struct Fit {
    /// Residues of the poles, then P and Q.
    x: Vec<c64>,
    residual: Vec<c64>,
    /// Derivative of the model by each pole, what the linear part can follow taken out.
    by_pole: Vec<Vec<c64>>,
}

/// Modes from start poles.
pub(super) fn refine(band: &Band, start: &[c64]) -> Result<Vec<ExtractedMode>, ClassicalError> {
    let mut poles = start.to_vec();
    let mut best: Option<(f64, Vec<c64>, Vec<Fit>)> = None;
    let mut damping = 0.0;
    for _ in 0..STEPS {
        let fits = fits(band, &poles)?;
        let error: f64 = fits.iter().flat_map(|f| &f.residual).map(c64::norm_sqr).sum();
        let worse = best.as_ref().is_some_and(|(least, _, _)| error > *least * (1.0 + 1e-12)) || !error.is_finite();
        if worse {
            damping = if damping == 0.0 { 1e-3 } else { 10.0 * damping };
        } else {
            damping *= 0.1;
            best = Some((error, poles.clone(), fits));
        }
        let Some((_, base, fits)) = &best else { break };
        let step = gauss_newton(fits, damping)?;
        let settled = step.iter().zip(base).all(|(d, p)| d.norm() <= SETTLED * p.re.abs());
        poles = base.iter().zip(&step).map(|(p, d)| p + d).collect();
        if settled || damping > 1e6 {
            break;
        }
    }
    let Some((error, poles, fits)) = best else { return Ok(Vec::new()) };
    let rows = band.outputs() * band.omega.len();
    let unknowns = band.outputs() * (poles.len() + 2) + poles.len();
    let variance = error / rows.saturating_sub(unknowns).max(1) as f64;
    let inverse = inverse(&normal(&fits, 0.0))?;
    let mode = |k: usize| ExtractedMode {
        pole: poles[k],
        deviation: (0.5 * variance * inverse[k][k].re).max(0.0).sqrt(),
        residues: filled_complex(band.sensors(), band.drives(), |i, j| fits[i * band.drives() + j].x[k]),
    };
    Ok((0..poles.len()).map(mode).collect())
}

/// The fit of every sensor and drive, drives fastest.
fn fits(band: &Band, poles: &[c64]) -> Result<Vec<Fit>, ClassicalError> {
    let pairs = (0..band.sensors()).flat_map(|i| (0..band.drives()).map(move |j| (i, j)));
    pairs.map(|(i, j)| fit(band, poles, i, j)).collect()
}

fn fit(band: &Band, poles: &[c64], sensor: usize, drive: usize) -> Result<Fit, ClassicalError> {
    let (first, last) = (band.omega[0], band.omega[band.omega.len() - 1]);
    let weights: Vec<f64> = (0..band.omega.len()).map(|k| 1.0 / band.scale(k, sensor, drive)).collect();
    let place = |w: f64| (2.0 * w - first - last) / (last - first);
    let mut columns: Vec<Vec<c64>> = poles
        .iter()
        .map(|pole| {
            let term = |(w, weight): (&f64, &f64)| c64::new(*weight, 0.0) / (c64::new(0.0, *w) - pole);
            band.omega.iter().zip(&weights).map(term).collect()
        })
        .collect();
    columns.push(weights.iter().map(|&w| c64::new(w, 0.0)).collect());
    columns.push(band.omega.iter().zip(&weights).map(|(&w, weight)| c64::new(weight * place(w), 0.0)).collect());
    let projector = Projector::new(columns)?;
    let target: Vec<c64> = weights.iter().enumerate().map(|(k, w)| band.value(k, sensor, drive) * *w).collect();
    let (x, left) = projector.fit(&target);
    let by_pole = poles
        .iter()
        .enumerate()
        .map(|(p, pole)| {
            let slope: Vec<c64> = band
                .omega
                .iter()
                .zip(&projector.columns[p])
                .map(|(&w, column)| x[p] * column / (c64::new(0.0, w) - pole))
                .collect();
            projector.fit(&slope).1
        })
        .collect();
    // `left` is target - model; the residual is its negative.
    Ok(Fit { x, residual: left.iter().map(|v| -v).collect(), by_pole })
}

/// Least squares on a few complex columns by their normal equations, columns of unit length.
struct Projector {
    columns: Vec<Vec<c64>>,
    lengths: Vec<f64>,
    inverse: Vec<Vec<c64>>,
}

impl Projector {
    fn new(columns: Vec<Vec<c64>>) -> Result<Self, ClassicalError> {
        let lengths: Vec<f64> = columns.iter().map(|c| dot(c, c).re.sqrt().max(f64::MIN_POSITIVE)).collect();
        let gram: Vec<Vec<c64>> = (0..columns.len())
            .map(|i| (0..columns.len()).map(|j| dot(&columns[i], &columns[j]) / (lengths[i] * lengths[j])).collect())
            .collect();
        let inverse = inverse(&gram)?;
        Ok(Self { columns, lengths, inverse })
    }

    /// Coefficients and what is left of the target.
    fn fit(&self, target: &[c64]) -> (Vec<c64>, Vec<c64>) {
        let right: Vec<c64> = self.columns.iter().zip(&self.lengths).map(|(c, l)| dot(c, target) / *l).collect();
        let x: Vec<c64> = (0..right.len())
            .map(|i| right.iter().zip(&self.inverse[i]).map(|(r, g)| r * g).sum::<c64>() / self.lengths[i])
            .collect();
        let left = (0..target.len())
            .map(|k| target[k] - self.columns.iter().zip(&x).map(|(c, v)| c[k] * v).sum::<c64>())
            .collect();
        (x, left)
    }
}

fn dot(a: &[c64], b: &[c64]) -> c64 {
    a.iter().zip(b).map(|(x, y)| x.conj() * y).sum()
}

/// `J^H J`, its diagonal raised by the part `damping`.
fn normal(fits: &[Fit], damping: f64) -> Vec<Vec<c64>> {
    let count = fits[0].by_pole.len();
    let entry = |p: usize, q: usize| -> c64 {
        let sum: c64 = fits.iter().map(|f| dot(&f.by_pole[p], &f.by_pole[q])).sum();
        if p == q { sum * (1.0 + damping) } else { sum }
    };
    (0..count).map(|p| (0..count).map(|q| entry(p, q)).collect()).collect()
}

fn gauss_newton(fits: &[Fit], damping: f64) -> Result<Vec<c64>, ClassicalError> {
    let inverse = inverse(&normal(fits, damping))?;
    let right: Vec<c64> =
        (0..inverse.len()).map(|p| -fits.iter().map(|f| dot(&f.by_pole[p], &f.residual)).sum::<c64>()).collect();
    Ok(inverse.iter().map(|row| row.iter().zip(&right).map(|(a, b)| a * b).sum()).collect())
}

/// Inverse of a small complex matrix by elimination with row pivots.
fn inverse(a: &[Vec<c64>]) -> Result<Vec<Vec<c64>>, ClassicalError> {
    let n = a.len();
    let unit = |i: usize, j: usize| c64::new(f64::from(u8::from(i == j)), 0.0);
    let mut rows: Vec<Vec<c64>> =
        (0..n).map(|i| a[i].iter().copied().chain((0..n).map(|j| unit(i, j))).collect()).collect();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| rows[i][k].norm().total_cmp(&rows[j][k].norm())).unwrap_or(k);
        rows.swap(k, pivot);
        let head = rows[k][k];
        if !(head.norm() > 0.0 && head.norm().is_finite()) {
            return Err(ClassicalError::Missing { what: "lines that tell the modes of a band apart".to_string() });
        }
        rows[k].iter_mut().for_each(|v| *v /= head);
        let top = rows[k].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != k) {
            let factor = row[k];
            row.iter_mut().zip(&top).for_each(|(v, t)| *v -= factor * t);
        }
    }
    Ok(rows.into_iter().map(|row| row[n..].to_vec()).collect())
}
