//! The residual on the response as a function of everything that is fitted, with its derivatives.

use crate::diagnosis::residual::data::DiagnosisError;
use crate::diagnosis::residual::prediction::{Predictor, RunPrediction, transfer};
use crate::diagnosis::selection::fitted_model::{Bench, Starts};
use crate::diagnosis::selection::levenberg_marquardt::{Residual, Variables};
use crate::diagnosis::updating::parameters::Tuning;
use crate::effects::{Source, effect::Kind};
use crate::response::harmonic_balance::Settings;
use crate::response::sensitivity::{Unknown, sensitivities};
use faer::{Mat, c64};

/// Step of a variable for derivatives by differences.
const STEP: f64 = 1e-4;

/// The model at one point of a descent.
pub(crate) struct Trial {
    pub theta: Vec<f64>,
    pub predictor: Option<Predictor>,
    pub predictions: Vec<RunPrediction>,
}

/// The residual on the response as a function of the variables of the effects and of the corrections.
pub(crate) struct OnResponse<'a> {
    pub bench: Bench<'a>,
    pub variables: &'a Variables,
    pub tuning: &'a Tuning,
    pub priors: &'a [f64],
    pub settings: Settings,
    /// Responses at the last point that was accepted, from which trials start.
    pub starts: Starts,
    pub last: Option<Trial>,
}

impl OnResponse<'_> {
    /// Effects, and logarithms of the corrections.
    pub fn split(&self, theta: &[f64]) -> (Vec<Source>, Vec<f64>) {
        let (effects, knobs) = theta.split_at(self.variables.len());
        (self.variables.effects(effects), knobs.iter().zip(self.priors).map(|(u, s)| u * s).collect())
    }

    fn compute(&self, theta: &[f64]) -> Result<Trial, DiagnosisError> {
        let (effects, values) = self.split(theta);
        let predictor =
            if self.tuning.is_empty() { None } else { Some(self.bench.predictor.tuned(&self.tuning.with(&values))?) };
        let bench = Bench { predictor: predictor.as_ref().unwrap_or(self.bench.predictor), ..self.bench };
        let predictions = bench.predict(&effects, &self.settings, &self.starts)?;
        Ok(Trial { theta: theta.to_vec(), predictor, predictions })
    }

    /// The model at `theta`, the last one if it was there.
    pub fn trial(&mut self, theta: &[f64]) -> Result<Trial, DiagnosisError> {
        match self.last.take().filter(|t| t.theta == theta) {
            Some(trial) => Ok(trial),
            None => self.compute(theta),
        }
    }

    /// Derivatives of the recorded amplitudes of run `r`, one list of `[channel][harmonic]` a variable; none where the
    /// response has no derivatives.
    pub fn slopes(&self, trial: &Trial, r: usize) -> Option<Vec<Vec<Vec<c64>>>> {
        let predictor = trial.predictor.as_ref().unwrap_or(self.bench.predictor);
        let (effects, values) = self.split(&trial.theta);
        let (run, response) = (&self.bench.data.runs[r], &trial.predictions[r].response);
        if !trial.predictions[r].found {
            return Some(vec![vec![vec![ZERO; run.harmonics]; run.responses.len()]; trial.theta.len()]);
        }
        let sources = predictor.sources(&effects);
        let (unknowns, parts) = self.unknowns(&effects, &values, predictor.known());
        let excitation = run.excitation(|channel, w| transfer(&effects, &channel.name, w));
        let all = sensitivities(predictor.run(r), &sources, &excitation, response, &unknowns).ok()?;
        let shown = |of: &[(usize, f64)]| -> Vec<Vec<c64>> {
            let channel = |channel: &crate::diagnosis::residual::data::ChannelData| -> Vec<c64> {
                let at = |h: usize| {
                    let w = h as f64 * run.omega;
                    let entry = |m: &Mat<c64>| if h <= m.ncols() { m[(channel.dof, h - 1)] } else { ZERO };
                    let sum = of.iter().fold(ZERO, |s, (k, factor)| s + entry(&all[*k]) * *factor);
                    transfer(&effects, &channel.name, w) * channel.from_displacement(w) * sum
                };
                (1..=run.harmonics).map(at).collect()
            };
            run.responses.iter().map(channel).collect()
        };
        Some(parts.iter().map(|of| shown(of)).collect())
    }

    /// What the response is differentiated by, and how each variable is made up of it.
    fn unknowns(&self, effects: &[Source], values: &[f64], known: &[Source]) -> (Vec<Unknown>, Vec<Vec<(usize, f64)>>) {
        let (mut unknowns, mut parts) = (Vec::new(), Vec::new());
        let mut push = |list: Vec<(Unknown, f64)>| {
            let at = unknowns.len();
            parts.push(list.iter().enumerate().map(|(i, (_, factor))| (at + i, *factor)).collect());
            unknowns.extend(list.iter().map(|(unknown, _)| *unknown));
        };
        let mut source = known.len();
        for effect in effects {
            let channel = matches!(effect.effect.kind(), Kind::Channel(_));
            for parameter in 0..effect.parameters.len() {
                push(if channel { Vec::new() } else { vec![(Unknown::Source { source, parameter }, 1.0)] });
            }
            source += usize::from(!channel);
        }
        let tuning = self.tuning.with(values);
        (0..values.len()).for_each(|k| push(tuning.unknowns(k, known)));
        (unknowns, parts)
    }

    /// A column by differences.
    fn difference(&self, theta: &[f64], k: usize, at: &[f64]) -> Result<Vec<f64>, DiagnosisError> {
        let mut moved = theta.to_vec();
        moved[k] += STEP;
        let trial = self.compute(&moved)?;
        let after = self.bench.residual(&trial.predictions);
        Ok(after.iter().zip(at).map(|(a, b)| (a - b) / STEP).collect())
    }

    /// Which variables are parameters of channels: their columns are differences.
    fn of_channels(&self) -> Vec<bool> {
        let effects = self.variables.effects(&vec![0.0; self.variables.len()]);
        let of = |e: &Source| vec![matches!(e.effect.kind(), Kind::Channel(_)); e.parameters.len()];
        effects.iter().flat_map(of).collect()
    }
}

pub(crate) const ZERO: c64 = c64::new(0.0, 0.0);

impl Residual for OnResponse<'_> {
    type Error = DiagnosisError;

    fn residual(&mut self, theta: &[f64]) -> Result<Vec<f64>, DiagnosisError> {
        let trial = self.compute(theta)?;
        let mut residual = self.bench.residual(&trial.predictions);
        residual.extend(&theta[self.variables.len()..]);
        self.last = Some(trial);
        Ok(residual)
    }

    fn jacobian(&mut self, theta: &[f64], at: &[f64]) -> Result<Mat<f64>, DiagnosisError> {
        let trial = self.trial(theta)?;
        self.starts = trial.predictions.iter().map(|p| p.found.then(|| p.response.clone())).collect();
        let (effects, count) = (self.variables.len(), theta.len());
        let mut columns: Vec<Vec<f64>> = vec![Vec::with_capacity(at.len()); count];
        let factors: Vec<f64> =
            self.variables.slopes(&theta[..effects]).into_iter().chain(self.priors.iter().copied()).collect();
        let mut exact = true;
        for r in 0..self.bench.data.runs.len() {
            self.bench.control.check()?;
            let Some(slopes) = self.slopes(&trial, r) else {
                exact = false;
                break;
            };
            for ((column, slope), factor) in columns.iter_mut().zip(&slopes).zip(&factors) {
                self.bench.whitened(r, column, |c, h| -slope[c][h - 1] * *factor);
            }
        }
        let channels = self.of_channels();
        for k in 0..count {
            if !exact || channels.get(k).copied().unwrap_or(false) {
                columns[k] = self.difference(theta, k, at)?;
            }
            columns[k].resize(at.len(), 0.0);
            if k >= effects {
                let row = at.len() - (count - k);
                columns[k][row] = 1.0;
            }
        }
        self.last = Some(trial);
        Ok(Mat::from_fn(at.len(), count, |i, k| columns[k][i]))
    }
}
