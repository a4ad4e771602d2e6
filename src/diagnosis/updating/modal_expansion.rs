//! Motion at every DOF as the sensors show it: that of a model, corrected by its modes so far as the sensors ask for it.
//!
//! ```text
//! X = X_0 + C S^T (S C S^T + R)^-1 (y - S X_0),     C = s^2 sum_n phi_n phi_n^T / [(w_n^2 - w^2)^2 + (eta w_n^2)^2]
//! ```
//!
//! `S` picks the DOFs of the sensors, `R` is the variance of what they read, and a mode may be wrong by as much as a force
//! of its own, the same for all modes, would move it. With the motion known the response is linear in what the model states
//! wrongly, however far off it is: `y - S A F = -S A dZ X - S A L f`.
//!
//! Modal expansion of measured motion: Ewins (2000), chapter 4; Gaussian estimate of the modal amplitudes: Tarantola
//! (2005), chapter 3.

use crate::diagnosis::residual::data::{ChannelData, Data, RunData};
use crate::diagnosis::residual::prediction::{Predictor, RunPrediction};
use dashpot_numerics::Cholesky;
use faer::{Mat, c64};

/// Error of the gain of a sensor that an expansion allows for, relative.
const GAIN: f64 = 0.01;
/// Detuning of a mode, as a share of its squared frequency, within which it counts as resonant: what models are off by.
pub(crate) const DETUNING: f64 = 0.03;

/// Gains of the expansion of one harmonic of one run.
#[derive(Debug, Clone)]
pub(crate) struct ModalExpansion {
    /// `C S^T (S C S^T + R)^-1`, n x sensors.
    gain: Mat<f64>,
}

impl ModalExpansion {
    /// Of every run and harmonic of `data` for the model of `predictor` with its `predictions`, `[run][harmonic - 1]`; none where
    /// the model is singular, nor of harmonics above `highest`.
    pub(crate) fn of_runs(
        predictor: &Predictor,
        data: &Data,
        predictions: &[RunPrediction],
        highest: usize,
    ) -> Vec<Vec<Option<Self>>> {
        let of_run = |(r, (run, prediction)): (usize, (&RunData, &RunPrediction))| {
            (1..=run.harmonics.min(highest)).map(|h| Self::new(predictor, r, h, run, prediction)).collect()
        };
        data.runs.iter().zip(predictions).enumerate().map(of_run).collect()
    }

    /// Of harmonic `h` of run number `r`; none where its model is singular or agrees with the sensors.
    pub(crate) fn new(
        predictor: &Predictor,
        r: usize,
        h: usize,
        run: &RunData,
        prediction: &RunPrediction,
    ) -> Option<Self> {
        let basis = predictor.run(r).linear().basis();
        let dofs: Vec<usize> = run.alive.iter().map(|&c| run.responses[c].dof).collect();
        let n = predictor.structure().len();
        let square = (h as f64 * run.omega).powi(2);
        let mut spread = Mat::<f64>::zeros(n, dofs.len());
        for m in 0..basis.len() {
            let (own, shape) = (basis.square(m), basis.shape(m));
            let compliance = 1.0 / ((own - square).powi(2) + (DETUNING * own.max(square)).powi(2));
            for (k, &dof) in dofs.iter().enumerate() {
                let factor = compliance * shape[dof];
                spread.col_as_slice_mut(k).iter_mut().zip(shape).for_each(|(s, x)| *s += factor * x);
            }
        }
        let own: f64 = dofs.iter().enumerate().map(|(k, &dof)| spread[(dof, k)]).sum();
        let missing: f64 =
            differences(run, h, |dof| prediction.response.amplitude(dof, h)).iter().map(c64::norm_sqr).sum();
        if own <= 0.0 || missing <= 0.0 {
            return None;
        }
        let scale = missing / own;
        let seen = Mat::from_fn(dofs.len(), dofs.len(), |i, k| {
            scale * spread[(dofs[i], k)] + if i == k { variance(run, run.alive[i], h) } else { 0.0 }
        });
        let factor = Cholesky::new(seen.as_ref())?;
        let transposed = Mat::from_fn(dofs.len(), n, |k, i| scale * spread[(i, k)]);
        Some(Self { gain: factor.solve(transposed.as_ref()).transpose().to_owned() })
    }

    /// Corrects the `field` of harmonic `h` of `run`, m by DOF.
    pub(crate) fn correct(&self, run: &RunData, h: usize, field: &mut [c64]) {
        for (k, difference) in differences(run, h, |dof| field[dof]).into_iter().enumerate() {
            field.iter_mut().zip(self.gain.col_as_slice(k)).for_each(|(x, g)| *x += difference * *g);
        }
    }
}

/// What the sensors that are alive show at harmonic `h` beyond the motion `field`, m.
fn differences(run: &RunData, h: usize, field: impl Fn(usize) -> c64) -> Vec<c64> {
    run.alive.iter().map(|&c| displacement(run, &run.responses[c], h) - field(run.responses[c].dof)).collect()
}

/// Measured displacement at harmonic `h`, m.
fn displacement(run: &RunData, channel: &ChannelData, h: usize) -> c64 {
    channel.measured[h - 1] / channel.from_displacement(h as f64 * run.omega)
}

/// Variance of a measured displacement at harmonic `h`, m^2.
fn variance(run: &RunData, c: usize, h: usize) -> f64 {
    let channel = &run.responses[c];
    let noise = channel.deviation[h - 1] / channel.from_displacement(h as f64 * run.omega).norm();
    noise * noise + GAIN * GAIN * displacement(run, channel, h).norm_sqr()
}
