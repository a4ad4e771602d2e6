//! The residual on the response as a function of everything that is fitted, with its derivatives.

use crate::control::Cancelled;
use crate::diagnosis::residual::data::{ChannelData, DiagnosisError, RunData};
use crate::diagnosis::residual::prediction::{Predictor, RunPrediction, transfer};
use crate::diagnosis::selection::estimator::{Estimator, Starts};
use crate::diagnosis::selection::levenberg_marquardt::Residual;
use crate::diagnosis::selection::levenberg_marquardt::variables::Variables;
use crate::effects::{Kind, Source};
use crate::response::harmonic_balance::Settings;
use crate::response::sensitivity::{Unknown, sensitivities};
use faer::{Mat, c64};

/// Step of a variable for derivatives by differences.
const STEP: f64 = 1e-4;

/// The model at one point of a descent.
pub(crate) struct Trial {
    pub theta: Vec<f64>,
    pub predictions: Vec<RunPrediction>,
}

/// The residual on the response as a function of the variables of the effects.
pub(crate) struct OnResponse<'a> {
    pub estimator: Estimator<'a>,
    pub variables: &'a Variables,
    pub settings: Settings,
    /// Responses at the last point that was accepted, from which trials start.
    pub starts: Starts,
    pub last: Option<Trial>,
}

/// Derivatives of the recorded amplitudes of a run, `[unknown][channel][harmonic - 1]`.
pub(crate) type RunSlopes = Vec<Vec<Vec<c64>>>;

/// Derivatives of the recorded amplitudes of run `r` by sums of unknowns with factors, one list of `[channel][harmonic]`
/// a sum; `None` where the response has no derivatives. Zero where the prediction was not found.
pub(crate) fn run_slopes(
    predictor: &Predictor,
    r: usize,
    run: &RunData,
    effects: &[Source],
    prediction: &RunPrediction,
    sums: &[Vec<(Unknown, f64)>],
) -> Option<RunSlopes> {
    if !prediction.found {
        return Some(vec![vec![vec![ZERO; run.harmonics]; run.responses.len()]; sums.len()]);
    }
    let sources = predictor.sources(effects);
    let unknowns: Vec<Unknown> = sums.iter().flatten().map(|(unknown, _)| *unknown).collect();
    let excitation = predictor.excitation(run, effects);
    let dofs: Vec<usize> = run.responses.iter().map(|channel| channel.dof).collect();
    let all = sensitivities(predictor.run(r), &sources, &excitation, &prediction.response, &dofs, &unknowns).ok()?;
    let mut rest = &all[..];
    let mut slopes = Vec::with_capacity(sums.len());
    for sum in sums {
        let (own, others) = rest.split_at(sum.len());
        rest = others;
        let channel = |(c, channel): (usize, &ChannelData)| -> Vec<c64> {
            let slope_at_harmonic = |h: usize| {
                let w = h as f64 * run.omega;
                let entry = |m: &Mat<c64>| if h <= m.ncols() { m[(c, h - 1)] } else { ZERO };
                let change = own.iter().zip(sum).fold(ZERO, |s, (m, (_, factor))| s + entry(m) * *factor);
                transfer(effects, &channel.name, w) * channel.from_displacement(w) * change
            };
            (1..=run.harmonics).map(slope_at_harmonic).collect()
        };
        slopes.push(run.responses.iter().enumerate().map(channel).collect());
    }
    Some(slopes)
}

/// What the response is differentiated by for each parameter of `effects`, which come after `known` sources; nothing for errors
/// of channels.
pub(super) fn unknowns_of(effects: &[Source], known: usize) -> Vec<Vec<(Unknown, f64)>> {
    let mut source = known;
    let mut sums = Vec::new();
    for effect in effects {
        let channel = matches!(effect.effect.kind(), Kind::Channel(_));
        for parameter in 0..effect.parameters.len() {
            sums.push(if channel { Vec::new() } else { vec![(Unknown::Source { source, parameter }, 1.0)] });
        }
        source += usize::from(!channel);
    }
    sums
}

impl OnResponse<'_> {
    fn compute(&self, theta: &[f64]) -> Result<Trial, DiagnosisError> {
        let effects = self.variables.effects(theta);
        let predictions = self.estimator.predict(&effects, &self.settings, &self.starts)?;
        Ok(Trial { theta: theta.to_vec(), predictions })
    }

    /// The model at `theta`, the last one if it was there.
    pub(crate) fn trial(&mut self, theta: &[f64]) -> Result<Trial, DiagnosisError> {
        match self.last.take().filter(|t| t.theta == theta) {
            Some(trial) => Ok(trial),
            None => self.compute(theta),
        }
    }

    /// A column by differences of the residual that `rows` gives of predictions.
    fn difference(
        &self,
        theta: &[f64],
        k: usize,
        rows: impl Fn(&[RunPrediction]) -> Vec<f64>,
        at: &[f64],
    ) -> Result<Vec<f64>, DiagnosisError> {
        let mut moved = theta.to_vec();
        moved[k] += STEP;
        let after = rows(&self.compute(&moved)?.predictions);
        Ok(after.iter().zip(at).map(|(a, b)| (a - b) / STEP).collect())
    }

    /// Whitened derivatives of the residual by the variables at a trial, what is each run's own eliminated and the updating
    /// parameters at their reference; `None` where a response has no derivatives. Empty for parameters of channels.
    fn analytic_columns(&self, trial: &Trial) -> Result<Option<Vec<Vec<f64>>>, DiagnosisError> {
        let effects = self.variables.effects(&trial.theta);
        let known = self.estimator.predictor.known().len();
        let (sums, factors) = (unknowns_of(&effects, known), self.variables.slopes(&trial.theta));
        let mut columns: Vec<Vec<f64>> = vec![Vec::with_capacity(self.estimator.count()); trial.theta.len()];
        let data = self.estimator.data;
        let of_run = |r: usize| {
            self.estimator.control.check()?;
            Ok(run_slopes(self.estimator.predictor, r, &data.runs[r], &effects, &trial.predictions[r], &sums))
        };
        for (r, slopes) in self.estimator.control.map(data.runs.len(), of_run).into_iter().enumerate() {
            let Some(slopes) = slopes.map_err(|cancelled: Cancelled| DiagnosisError::from(cancelled))? else {
                return Ok(None);
            };
            for ((column, slope), factor) in columns.iter_mut().zip(&slopes).zip(&factors) {
                self.estimator.whitened(r, column, |c, h| -slope[c][h - 1] * *factor);
            }
        }
        Ok(Some(columns))
    }

    /// [`Self::analytic_columns`] at `theta`, by differences where there are none, and the residual there.
    pub(crate) fn at_reference(&mut self, theta: &[f64]) -> Result<(Vec<f64>, Vec<Vec<f64>>), DiagnosisError> {
        let trial = self.trial(theta)?;
        self.starts = trial.predictions.iter().map(|p| p.found.then(|| p.response.clone())).collect();
        let rows = |predictions: &[RunPrediction]| self.estimator.at_reference(predictions);
        let residual = rows(&trial.predictions);
        let analytic = self.analytic_columns(&trial)?;
        let channels = self.of_channels();
        let column = |k: usize| match &analytic {
            Some(columns) if !channels[k] => Ok(columns[k].clone()),
            _ => self.difference(theta, k, rows, &residual),
        };
        let columns = (0..theta.len()).map(column).collect::<Result<_, _>>()?;
        Ok((residual, columns))
    }

    /// Which variables are parameters of channels: their columns are differences.
    fn of_channels(&self) -> Vec<bool> {
        let effects = self.variables.effects(&vec![0.0; self.variables.len()]);
        let channel_flags = |e: &Source| vec![matches!(e.effect.kind(), Kind::Channel(_)); e.parameters.len()];
        effects.iter().flat_map(channel_flags).collect()
    }
}

pub(crate) const ZERO: c64 = c64::new(0.0, 0.0);

impl Residual for OnResponse<'_> {
    type Error = DiagnosisError;

    fn is_late(&self) -> bool {
        self.estimator.control.is_late()
    }

    fn bounds(&self) -> Vec<[f64; 2]> {
        self.variables.bounds()
    }

    fn residual(&mut self, theta: &[f64]) -> Result<Vec<f64>, DiagnosisError> {
        let trial = self.compute(theta)?;
        let residual = self.estimator.residual(&trial.predictions);
        self.last = Some(trial);
        Ok(residual)
    }

    fn jacobian(&mut self, theta: &[f64], at: &[f64]) -> Result<Mat<f64>, DiagnosisError> {
        let trial = self.trial(theta)?;
        self.starts = trial.predictions.iter().map(|p| p.found.then(|| p.response.clone())).collect();
        let mut analytic = self.analytic_columns(&trial)?;
        let channels = self.of_channels();
        let rows = |predictions: &[RunPrediction]| self.estimator.residual(predictions);
        let mut columns = Vec::with_capacity(theta.len());
        for (k, of_channel) in channels.into_iter().enumerate() {
            columns.push(match &mut analytic {
                Some(analytic) if !of_channel => self.estimator.noise.updating.column(std::mem::take(&mut analytic[k])),
                _ => self.difference(theta, k, rows, at)?,
            });
        }
        self.last = Some(trial);
        Ok(Mat::from_fn(at.len(), columns.len(), |i, k| columns[k][i]))
    }
}

#[cfg(test)]
mod tests;
