//! The equations of motion of the modes of one record along its measured motion, on the lines of its tapered spectrum, weighted by
//! the covariance that the noise of the channels leaves there and by a share of the elastic force by which any model is wrong.

use crate::balance::windows::motion::Motion;
use dashpot_numerics::{EquilibratedCholesky, RealTransform, dot};
use faer::{Mat, c64};
use std::f64::consts::{PI, TAU};

/// Share of the elastic force by which a model is taken to be wrong on a line.
const MODEL_SHARE: f64 = 3e-3;
/// Share of the diagonal that is added to the covariance of the modes on a line: few sensors make it singular.
const RIDGE: f64 = 1e-9;
/// Lines of a taper's flank, and of the width within which a resonance is not told from its neighbours.
const FLANK: f64 = 2.0;
/// Most lines of a record, those of greatest motion.
const MOST_LINES: usize = 600;

/// One record.
pub(super) struct ModalEquations {
    pub motion: Motion,
    pub first: usize,
    pub taper: Vec<f64>,
    transform: RealTransform,
    lines: Vec<usize>,
    /// Rows that whiten the modes on each line, lower triangle.
    whitening: Vec<Mat<f64>>,
}

/// The equation of motion of every mode along the measured motion.
#[derive(Default)]
pub(super) struct Equation {
    /// Elastic force `omega^2 q`.
    pub elastic: Vec<Vec<f64>>,
    /// Measured force `phi^T B u`.
    pub pushed: Vec<Vec<f64>>,
    /// What is left: `phi^T B u - q'' - omega^2 q`.
    pub balance: Vec<Vec<f64>>,
}

impl ModalEquations {
    /// Of a measured motion; none where the record is too short for the taper.
    pub(super) fn new(motion: Motion) -> Option<Self> {
        let length = smooth(motion.usable.len());
        let first = motion.usable.start;
        let flank = (FLANK * TAU / motion.band.omega[0] / motion.step) as usize;
        if length < 4 * flank.max(8) {
            return None;
        }
        let edge = |n: usize| n.min(length - 1 - n) as f64 / flank as f64;
        let taper: Vec<f64> = (0..length).map(|n| 0.5 - 0.5 * (PI * edge(n).min(1.0)).cos()).collect();
        let transform = RealTransform::new(length);
        let mut part = Self { motion, first, taper, transform, lines: Vec::new(), whitening: Vec::new() };
        let resolution = 1.0 / (length as f64 * part.motion.step);
        let band = &part.motion.band;
        let inside = |k: &usize| *k as f64 * resolution >= band.low[1] && *k as f64 * resolution <= band.high[0];
        let all: Vec<usize> = (1..length / 2).filter(inside).collect();
        part.lines.clone_from(&all);
        let elastic = part.equation(1.0).elastic;
        let spectra: Vec<Vec<c64>> = elastic.iter().map(|x| part.spectrum(x)).collect();
        let height = |i: usize| spectra.iter().map(|s| s[i].norm_sqr()).sum::<f64>();
        let mut order: Vec<usize> = (0..all.len()).collect();
        order.sort_by(|&a, &b| height(b).total_cmp(&height(a)));
        order.truncate(MOST_LINES);
        part.lines = order.iter().map(|&i| all[i]).collect();
        let whitening = order.iter().map(|&i| {
            let sizes: Vec<f64> = spectra.iter().map(|s| s[i].norm()).collect();
            part.whitening(all[i], &sizes)
        });
        part.whitening = whitening.collect::<Option<Vec<_>>>()?;
        (!part.lines.is_empty()).then_some(part)
    }

    /// The equation of motion of every mode.
    pub(super) fn equation(&self, factor: f64) -> Equation {
        let motion = &self.motion;
        let resolution = TAU / (motion.padded as f64 * motion.step);
        let mut equation = Equation::default();
        for (r, omega) in motion.band.omega.iter().enumerate() {
            let square = factor * omega.powi(2);
            let inertia = |(k, z): (usize, &c64)| z * (k as f64 * resolution).powi(2);
            let mut rest = motion.signal(motion.lines[r].iter().enumerate().map(inertia).collect());
            let mut pushed = vec![0.0; rest.len()];
            for (dof, u) in &motion.forces {
                let shape = motion.band.shapes[(*dof, r)];
                pushed.iter_mut().zip(u).for_each(|(x, u)| *x += shape * u);
            }
            let own: Vec<f64> = motion.q[r].iter().map(|q| square * q).collect();
            rest.iter_mut().zip(own.iter().zip(&pushed)).for_each(|(x, (k, u))| *x += u - k);
            equation.elastic.push(own);
            equation.pushed.push(pushed);
            equation.balance.push(rest);
        }
        equation
    }

    /// What an error of the shapes as large as they are brings of mode `s` into the equation of mode `r`: it reads its motion from
    /// sensors, and its stiffness couples the two.
    pub(super) fn leak(&self, [r, s]: [usize; 2], elastic: &[Vec<f64>]) -> Option<Vec<f64>> {
        let omega = &self.motion.band.omega;
        let ratio = (omega.get(r)? / omega.get(s)?).powi(2).max(1.0);
        Some(elastic[s].iter().map(|x| ratio * x).collect())
    }

    /// Whitened rows of a signal in the equation of mode `r` of `count`, rows of zeros where there is none.
    pub(super) fn rows_of(&self, r: usize, signal: Option<&Vec<f64>>, count: usize) -> Vec<f64> {
        let Some(signal) = signal else { return vec![0.0; 2 * count * self.lines.len()] };
        let spectrum = self.spectrum(signal);
        let mut rows = Vec::with_capacity(2 * count * spectrum.len());
        for (line, whitening) in spectrum.iter().zip(&self.whitening) {
            rows.extend((0..r).flat_map(|_| [0.0; 2]));
            rows.extend((r..count).flat_map(|k| [line.re, line.im].map(|x| x * whitening[(k, r)])));
        }
        rows
    }

    /// Lines of the tapered part of a signal.
    fn spectrum(&self, signal: &[f64]) -> Vec<c64> {
        let mut work: Vec<f64> = signal[self.first..].iter().zip(&self.taper).map(|(y, w)| y * w).collect();
        let lines = self.transform.forward(&mut work);
        self.lines.iter().map(|&k| lines[k]).collect()
    }

    /// Whitened rows of modal signals, real and imaginary parts.
    pub(super) fn rows(&self, modal: &[Vec<f64>]) -> Vec<f64> {
        let spectra: Vec<Vec<c64>> = modal.iter().map(|x| self.spectrum(x)).collect();
        let mut rows = Vec::with_capacity(2 * modal.len() * self.lines.len());
        for (i, whitening) in self.whitening.iter().enumerate() {
            for r in 0..modal.len() {
                let sum: c64 = (0..=r).map(|s| spectra[s][i] * whitening[(r, s)]).sum();
                rows.extend([sum.re, sum.im]);
            }
        }
        rows
    }

    /// Whitened rows of one force that acts on every mode with the weight of that mode, `g_r = weights_r force`: those of
    /// [`Self::rows`] from one transform.
    pub(super) fn rows_along(&self, weights: &[f64], force: &[f64]) -> Vec<f64> {
        let spectrum = self.spectrum(force);
        let mut rows = Vec::with_capacity(2 * weights.len() * spectrum.len());
        for (line, whitening) in spectrum.iter().zip(&self.whitening) {
            for r in 0..weights.len() {
                let factor: f64 = (0..=r).map(|s| weights[s] * whitening[(r, s)]).sum();
                rows.extend([factor * line.re, factor * line.im]);
            }
        }
        rows
    }

    /// Inverse of the lower factor of the covariance of the modal equations on a line.
    fn whitening(&self, line: usize, elastic: &[f64]) -> Option<Mat<f64>> {
        let (motion, band) = (&self.motion, &self.motion.band);
        let count = band.omega.len();
        let resolution = TAU / (self.taper.len() as f64 * motion.step);
        let omega = line as f64 * resolution;
        let window: f64 = 0.5 * dot(&self.taper, &self.taper);
        let stiff = |r: usize| (band.omega[r].powi(2) - omega * omega).hypot(FLANK * 2.0 * band.omega[r] * resolution);
        let noise = |r: usize, s: usize| -> f64 {
            let sensor_noise = |(c, (order, variance)): (usize, &(i32, f64))| {
                band.expansion[(r, c)] * band.expansion[(s, c)] * variance * omega.powi(-2 * order)
            };
            motion.sensors.iter().enumerate().map(sensor_noise).sum::<f64>() * window
        };
        let covariance = Mat::from_fn(count, count, |r, s| {
            let model = if r == s { (MODEL_SHARE * elastic[r]).powi(2) * (1.0 + 1e-9) } else { 0.0 };
            stiff(r) * stiff(s) * noise(r, s) + model
        });
        Some(EquilibratedCholesky::new(covariance.as_ref(), RIDGE)?.whiten(Mat::identity(count, count)))
    }
}

/// The largest number of small factors that is no greater than `n`.
fn smooth(n: usize) -> usize {
    let mut best = 0;
    for odd in [1, 3, 5, 9, 15] {
        let mut length = 2 * odd;
        while 2 * length <= n {
            length *= 2;
        }
        if length <= n {
            best = best.max(length);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::control::Control;
    use crate::measurement::transient_run::TransientLabel;
    use crate::measurement::{Channel, Kind, Quantity, Record, TransientRun};
    use crate::structure::chain::ChainParameters;
    use std::sync::Arc;

    /// One force on all modes has the rows that it has as a force on each.
    #[test]
    fn a_force_at_a_place_has_the_rows_of_its_modal_forces() {
        let chain = ChainParameters {
            masses: vec![2.0, 1.0],
            ground_stiffness: vec![800.0, 0.0],
            coupling_stiffness: vec![1500.0],
        };
        let structure = chain.build(&[]).unwrap();
        let modes = structure.modes().unwrap();
        let wave = |n: usize, dof: usize| -> f64 {
            let t = 5e-3 * n as f64;
            let mode_motion = |r: usize| modes.shapes[(dof, r)] * (-0.4 * t).exp() * (modes.omega[r] * t).cos();
            1e-2 * (0..2).map(mode_motion).sum::<f64>()
        };
        let channel = |dof: usize| Channel { quantity: Quantity::Displacement, dof, label: (dof + 1).to_string() };
        let samples = (0..2).map(|dof| (0..1600).map(|n| wave(n, dof)).collect()).collect();
        let time = (0..1600).map(|n| 5e-3 * f64::from(n)).collect();
        let record = Record::new(time, vec![channel(0), channel(1)], samples).unwrap();
        let label = TransientLabel { file: "decay.csv".into(), kind: Kind::Decay, enabled: true, ..Default::default() };
        let run = TransientRun::new(label, Arc::new(record), &[]).unwrap();
        let motion = Motion::new(&modes, &run, &Control::unattended()).unwrap();
        let part = ModalEquations::new(motion).unwrap();
        let length = part.motion.q[0].len();
        let force: Vec<f64> = (0..length).map(|n| (0.07 * n as f64).sin().powi(3)).collect();
        let weights: Vec<f64> = (0..part.motion.q.len()).map(|r| 0.6 - 1.7 * r as f64).collect();
        let modal: Vec<Vec<f64>> = weights.iter().map(|w| force.iter().map(|f| w * f).collect()).collect();
        let (rows, along) = (part.rows(&modal), part.rows_along(&weights, &force));
        let size = dot(&rows, &rows).sqrt();
        assert!(rows.len() == along.len() && size > 0.0);
        let off = rows.iter().zip(&along).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        assert!(off < 1e-12 * size, "{off:e} of {size:e}");
    }
}
