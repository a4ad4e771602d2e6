//! Where a force is missing, whatever its law: one free complex force a line of the spectrum at each place in turn.
//!
//! ```text
//! D(w_k) X_k = B U_k - M (i w_k [x] + [x']) - C [x] - b_p G_k,    Y_k = (i w_k)^o S X_k + end terms
//! R_k = a_k G_k + E_k s + noise,    a = -(i w)^o S D^-1 b_p
//! ```
//!
//! `[x]`, `[x']` are differences between the ends of the record, `2 m` unknowns `s` that all lines share; `G_k` is projected
//! out line by line (bordered least squares). What is left, over the noise, ranks the places.

use super::data::{RecordData, Records};
use super::spectrum::fourier_integral;
use crate::effects::{Constant, Kind, Leg, Place, Source};
use crate::response::linear_matrices::unit_matrix;
use dashpot_numerics::{ComplexLu, EquilibratedCholesky, dot, product, transposed_product};
use faer::{Mat, c64};
use std::f64::consts::TAU;

/// Most modes that the spectrum is expanded in.
const MOST_MODES: usize = 30;
/// Most lines of a record, those of greatest response.
const MOST_LINES: usize = 250;
/// Highest line, as a share of the sampling rate.
const HIGHEST: f64 = 0.15;
/// Share of a response by which the model may be wrong beside the noise.
const MODEL_SHARE: f64 = 2e-3;
/// Share of the diagonal that is added to the normal equations of the differences between the ends, of which a record need not tell all.
pub(super) const RIDGE: f64 = 1e-10;

/// A place with what is left when a free force acts there.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LocatedForce {
    /// Where.
    pub place: Place,
    /// Squared residual a degree of freedom, over the noise.
    pub misfit: f64,
}

/// Places from best to worst; empty where fewer than two channels see the motion, or known laws are nonlinear: then the
/// spectrum cannot tell places apart. `stiffness` is the logarithm of the factor on all stiffness.
pub(crate) fn locate(records: &Records, places: &[Place], stiffness: f64) -> Vec<LocatedForce> {
    if records.list.iter().any(|r| r.channels.len() < 2) || !records.known.iter().all(|s| s.effect.is_linear()) {
        return Vec::new();
    }
    let expansion = Expansion::new(records, stiffness);
    let lines: Vec<Vec<Line>> = records.list.iter().map(|r| expansion.lines(records, r)).collect();
    let mut found: Vec<LocatedForce> = Vec::new();
    for place in places {
        let Some(leg) = place.legs().first().copied() else { continue };
        let pattern = expansion.pattern(leg);
        let (mut square, mut freedom) = (0.0, 0.0);
        for list in &lines {
            let [left, free] = misfit(list, &pattern, 2 * records.kept);
            square += left;
            freedom += free;
        }
        found.push(LocatedForce { place: place.clone(), misfit: square / freedom.max(1.0) });
    }
    found.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
    found
}

/// The structure in its lowest modes.
pub(super) struct Expansion {
    shapes: Mat<f64>,
    squares: Vec<f64>,
    /// Known linear sources: their modal matrices and their dynamic stiffness at unit matrix.
    known: Vec<(Mat<f64>, Source)>,
    /// Known masses.
    mass: Mat<f64>,
}

/// One line of one record, whitened.
pub(super) struct Line {
    pub measured: Vec<c64>,
    /// Columns of the end differences.
    pub ends: Vec<Vec<c64>>,
    /// `(i w)^o S D^-1`, a row a channel.
    pub responses: Mat<c64>,
}

impl Line {
    /// What a unit of force along `pattern` does to the channels.
    pub(super) fn under(&self, pattern: &[f64]) -> Vec<c64> {
        let channel_response = |c: usize| pattern.iter().enumerate().map(|(r, b)| self.responses[(c, r)] * *b).sum();
        (0..self.measured.len()).map(channel_response).collect()
    }
}

impl Expansion {
    pub(super) fn new(records: &Records, stiffness: f64) -> Self {
        let size = records.modes.len().min(MOST_MODES);
        let shapes = records.modes.shapes.subcols(0, size).to_owned();
        let squares = (0..size).map(|r| stiffness.exp() * records.modes.omega[r].powi(2)).collect();
        let modal = |source: &Source| {
            let unit = unit_matrix(records.structure, source).ok()?;
            Some((
                transposed_product(shapes.as_ref(), product(unit.as_ref(), shapes.as_ref()).as_ref()),
                source.clone(),
            ))
        };
        let known: Vec<(Mat<f64>, Source)> = records.known.iter().filter_map(modal).collect();
        let masses = known.iter().filter(|(_, s)| s.effect.constant() == Some(Constant::Mass));
        let mass = masses.fold(Mat::zeros(size, size), |sum, (m, s)| sum + m * faer::Scale(s.coefficient()));
        Self { shapes, squares, known, mass }
    }

    /// Dynamic stiffness of the known sources at a circular frequency.
    pub(super) fn sources(&self, w: f64) -> Mat<c64> {
        let size = self.squares.len();
        let mut sum = Mat::<c64>::zeros(size, size);
        for (matrix, source) in &self.known {
            let z = match source.effect.kind() {
                Kind::Whole(law) => law.factor(source.coefficient(), w),
                Kind::Relative(law) => law.dynamic_stiffness(&source.parameters, w).unwrap_or(c64::new(0.0, 0.0)),
                Kind::Channel(_) => continue,
            };
            sum += Mat::from_fn(size, size, |i, j| z * matrix[(i, j)]);
        }
        sum
    }

    /// The modes along a leg.
    pub(super) fn pattern(&self, leg: Leg) -> Vec<f64> {
        (0..self.squares.len()).map(|r| leg.relative(|i| self.shapes[(i, r)])).collect()
    }

    /// Lines of a record, those of greatest response over the noise.
    fn lines(&self, records: &Records, record: &RecordData) -> Vec<Line> {
        let spectra = Spectra::new(record);
        let responses = &spectra.responses;
        let height = |k: usize| {
            (0..responses.len()).map(|c| (responses[c][k].norm() / line_noise(record, c)).powi(2)).sum::<f64>()
        };
        let highest = (HIGHEST * (record.len() - 1) as f64) as usize;
        let mut numbers: Vec<usize> = (1..highest.min(responses[0].len())).collect();
        numbers.sort_by(|&a, &b| height(b).total_cmp(&height(a)));
        numbers.truncate(MOST_LINES);
        self.lines_of(records, record, &spectra, &numbers)
    }

    /// Lines of these numbers of a record with its spectra.
    pub(super) fn lines_of(
        &self,
        records: &Records,
        record: &RecordData,
        Spectra { responses, forces }: &Spectra,
        numbers: &[usize],
    ) -> Vec<Line> {
        let length = record.step * (record.len() - 1) as f64;
        let largest = |c: usize| responses[c].iter().skip(1).map(|y| y.norm()).fold(0.0, f64::max);
        let peaks: Vec<f64> = (0..responses.len()).map(largest).collect();
        let line = |&k: &usize| {
            let y: Vec<c64> = responses.iter().map(|list| list[k]).collect();
            let u: Vec<c64> = forces.iter().map(|list| list[k]).collect();
            let floor = |c: usize| line_noise(record, c);
            let weight = |c: usize| 1.0 / floor(c).hypot(MODEL_SHARE * y[c].norm()).hypot(1e-5 * peaks[c]);
            let weights: Vec<f64> = (0..y.len()).map(weight).collect();
            self.line(records.kept, record, TAU * k as f64 / length, &y, &u, &weights)
        };
        numbers.iter().map(line).collect()
    }

    /// `D^-1` times columns, at a circular frequency with the dynamic stiffness `known` of the known sources there.
    pub(super) fn receptance(&self, w: f64, known: &Mat<c64>, columns: &Mat<c64>) -> Mat<c64> {
        let size = self.squares.len();
        let dynamic =
            Mat::from_fn(size, size, |i, j| known[(i, j)] + if i == j { self.squares[i] - w * w } else { 0.0 });
        ComplexLu::new(dynamic.as_ref()).solve(columns.as_ref())
    }

    /// Modal force that a unit difference of mode `r` between the ends of a record stands for, of its velocity or displacement.
    pub(super) fn end_push(&self, w: f64, known: &Mat<c64>, r: usize, velocity: bool) -> Vec<c64> {
        let inertia = |i: usize| f64::from(u8::from(i == r)) + self.mass[(i, r)];
        let push = |i: usize| {
            if velocity { c64::new(inertia(i), 0.0) } else { c64::new(0.0, w) * inertia(i) + known[(i, r)].im / w }
        };
        (0..self.squares.len()).map(push).collect()
    }

    fn line(&self, kept: usize, record: &RecordData, w: f64, y: &[c64], u: &[c64], weights: &[f64]) -> Line {
        let size = self.squares.len();
        let iw = c64::new(0.0, w);
        let known = self.sources(w);
        let order = |c: usize| record.channels[c].quantity.derivatives().unwrap_or(0);
        let shape = |c: usize, r: usize| self.shapes[(record.channels[c].dof, r)];
        // The dynamic stiffness is symmetric: rows of S D^-1 are columns of D^-1 S^T.
        let sensed = Mat::from_fn(size, y.len(), |r, c| iw.powi(order(c)) * shape(c, r));
        let solved = self.receptance(w, &known, &sensed);
        let responses = Mat::from_fn(y.len(), size, |c, r| solved[(r, c)] * weights[c]);
        let driven = |c: usize| -> c64 {
            let push = |(dof, u): (&usize, &c64)| -> c64 {
                (0..size).map(|r| responses[(c, r)] * self.shapes[(*dof, r)]).sum::<c64>() * *u
            };
            record.drives.iter().zip(u).map(push).sum()
        };
        let measured = (0..y.len()).map(|c| y[c] * weights[c] - driven(c)).collect();
        let end = |j: usize| -> Vec<c64> {
            let (r, velocity) = (j % kept, j >= kept);
            let push = self.end_push(w, &known, r, velocity);
            let channel_response = |c: usize| {
                let direct = match (order(c), velocity) {
                    (1, false) | (2, true) => c64::new(shape(c, r), 0.0),
                    (2, false) => iw * shape(c, r),
                    _ => c64::new(0.0, 0.0),
                };
                direct * weights[c] - (0..size).map(|i| responses[(c, i)] * push[i]).sum::<c64>()
            };
            (0..y.len()).map(channel_response).collect()
        };
        Line { measured, ends: (0..2 * kept).map(end).collect(), responses }
    }
}

/// Spectra of the responses and of the forces of a record.
pub(super) struct Spectra {
    pub responses: Vec<Vec<c64>>,
    pub forces: Vec<Vec<c64>>,
}

impl Spectra {
    pub(super) fn new(record: &RecordData) -> Self {
        let transform =
            |list: &Vec<Vec<f64>>| -> Vec<Vec<c64>> { list.iter().map(|y| fourier_integral(y, record.step)).collect() };
        Self { responses: transform(&record.samples), forces: transform(&record.forces) }
    }
}

/// Deviation of a real part of a line of the spectrum of channel `c`.
fn line_noise(record: &RecordData, c: usize) -> f64 {
    record.noise[c] * record.step * (0.5 * (record.len() - 1) as f64).sqrt()
}

/// Squared residual of the lines of a record with a free force along `pattern`, and its degrees of freedom.
fn misfit(lines: &[Line], pattern: &[f64], unknowns: usize) -> [f64; 2] {
    let mut matrix = Mat::<f64>::zeros(unknowns, unknowns);
    let mut rhs = vec![0.0; unknowns];
    let (mut square, mut freedom) = (0.0, -(unknowns as f64));
    for line in lines {
        let count = line.measured.len();
        let a = line.under(pattern);
        let size: f64 = a.iter().map(nalgebra::Complex::norm_sqr).sum();
        let projected = |x: &[c64]| -> Vec<c64> {
            let share: c64 = if size > 0.0 {
                a.iter().zip(x).map(|(a, x)| a.conj() * x).sum::<c64>() / size
            } else {
                c64::new(0.0, 0.0)
            };
            x.iter().zip(&a).map(|(x, a)| x - a * share).collect()
        };
        let inner = |a: &[c64], b: &[c64]| a.iter().zip(b).map(|(a, b)| (a.conj() * b).re).sum::<f64>();
        let y = projected(&line.measured);
        let ends: Vec<Vec<c64>> = line.ends.iter().map(|e| projected(e)).collect();
        for i in 0..unknowns {
            rhs[i] += inner(&ends[i], &y);
            for j in 0..unknowns {
                matrix[(i, j)] += inner(&ends[i], &ends[j]);
            }
        }
        square += inner(&y, &y);
        freedom += 2.0 * (count as f64 - 1.0);
    }
    let explained = EquilibratedCholesky::new(matrix.as_ref(), RIDGE).map_or(0.0, |n| dot(&n.solve(&rhs), &rhs));
    [(square - explained).max(0.0), freedom]
}

#[cfg(test)]
mod tests;
