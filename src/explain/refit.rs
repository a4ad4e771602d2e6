//! The short list is judged on the response itself: the parameters of all added effects, and the corrections of the
//! model where they are free, are fitted by Levenberg and Marquardt's method to the whitened amplitudes of all channels,
//! runs and harmonics. Corrections carry their prior as one more datum each.

use super::data::{Data, ExplainError, RunData, size};
use super::descent::{Descent, Residual, Variables, descend};
use super::noise::Whitening;
use super::predict::{FINAL, Predictor, RunPrediction, SEARCH, transfer};
use super::tuning::Tuning;
use crate::control::Control;
use crate::effects::{Source, effect::Kind};
use crate::math::statistics::root_mean_square;
use crate::response::harmonic_balance::{Response, ResponseError, Settings};
use crate::response::sensitivity::{Unknown, sensitivities};
use faer::{Mat, c64};

/// Step of a variable for derivatives by differences.
const STEP: f64 = 1e-4;
/// Groups of runs that are left out in turn.
const FOLDS: usize = 4;

/// A response of each run to start from.
pub(crate) type Starts = Vec<Option<Response>>;

/// A model to be fitted: the predictor with its data and noise.
#[derive(Clone, Copy)]
pub(crate) struct Bench<'a> {
    pub predictor: &'a Predictor,
    pub data: &'a Data,
    pub noise: &'a [Whitening],
    pub control: &'a Control,
}

/// A set of effects fitted on the response.
#[derive(Debug, Clone)]
pub struct Refit {
    /// Effects with their parameters.
    pub effects: Vec<Source>,
    /// Corrections of the model that were free.
    pub tuning: Tuning,
    /// Standard deviation of every parameter, of every effect.
    pub deviations: Vec<Vec<f64>>,
    /// Standard deviation of every correction.
    pub tuning_deviations: Vec<f64>,
    /// Squared whitened residual.
    pub chi_square: f64,
    /// What the corrections cost: their squared prior residual and Occam's factor of their freedom.
    pub tuning_cost: f64,
    /// Number of fitted parameters of effects.
    pub parameters: usize,
    /// Relative root mean square error, as in `compare`.
    pub error: f64,
    pub(crate) starts: Starts,
    pub(crate) descent: Descent,
}

impl Bench<'_> {
    /// Number of real data.
    pub fn count(&self) -> usize {
        self.noise.iter().map(Whitening::len).sum()
    }

    /// Predicts every run; a run without a periodic answer is predicted to rest, and so fits nothing.
    pub fn predict(
        &self,
        effects: &[Source],
        settings: &Settings,
        starts: &[Option<Response>],
    ) -> Result<Vec<RunPrediction>, ExplainError> {
        let run = |(r, run): (usize, &RunData)| {
            self.control.check()?;
            let start = starts.get(r).and_then(Option::as_ref);
            match self.predictor.predict(r, run, effects, settings, start, self.control) {
                Ok(prediction) => Ok(prediction),
                Err(ResponseError::Cancelled(cancelled)) => Err(cancelled.into()),
                Err(_) => self.at_rest(r),
            }
        };
        self.data.runs.iter().enumerate().map(run).collect()
    }

    fn at_rest(&self, r: usize) -> Result<RunPrediction, ExplainError> {
        let run = &self.data.runs[r];
        let mut silent = run.clone();
        silent.forces.iter_mut().for_each(|f| f.measured.fill(c64::new(0.0, 0.0)));
        let file = format!("number {}", run.index + 1);
        let failed = |reason| ExplainError::Response { file, reason };
        let resting = self.predictor.predict(r, &silent, &[], &SEARCH, None, self.control).map_err(failed)?;
        Ok(RunPrediction { found: false, ..resting })
    }

    /// Whitened residual of all runs, real and imaginary parts.
    pub fn residual(&self, predictions: &[RunPrediction]) -> Vec<f64> {
        let mut rows = Vec::with_capacity(self.count());
        for (r, (run, prediction)) in self.data.runs.iter().zip(predictions).enumerate() {
            self.whitened(r, &mut rows, |c, h| run.responses[c].measured[h - 1] - prediction.channels[c][h - 1]);
        }
        rows
    }

    fn whitened(&self, r: usize, rows: &mut Vec<f64>, value: impl Fn(usize, usize) -> c64) {
        for h in 1..=self.data.runs[r].harmonics {
            let e = self.noise[r].apply(h, |c| value(c, h));
            rows.extend(e.iter().flat_map(|e| [e.re, e.im]));
        }
    }

    /// Relative root mean square error of predictions over runs and channels.
    pub fn error(&self, predictions: &[RunPrediction]) -> f64 {
        let mut errors = Vec::new();
        for (run, prediction) in self.data.runs.iter().zip(predictions) {
            for (c, channel) in run.responses.iter().enumerate() {
                let pairs = channel.measured.iter().zip(&prediction.channels[c]);
                let difference: Vec<c64> = pairs.map(|(y, m)| y - m).collect();
                let scale = run.scale(c);
                errors.push(if scale > 0.0 { size(&difference) / scale } else { 0.0 });
            }
        }
        root_mean_square(&errors)
    }

    /// Fits all parameters of `effects`, and the corrections `tuning`, from where they are.
    pub fn refit(
        &self,
        effects: &[Source],
        tuning: &Tuning,
        steps: usize,
        settings: &Settings,
        starts: &[Option<Response>],
    ) -> Result<Refit, ExplainError> {
        let (variables, mut start) = Variables::new(effects);
        let priors: Vec<f64> = tuning.knobs.iter().map(super::tuning::Knob::deviation).collect();
        start.extend(tuning.values.iter().zip(&priors).map(|(v, s)| v / s));
        let starts = starts.to_vec();
        let (bench, settings) = (*self, *settings);
        let mut response =
            OnResponse { bench, variables: &variables, tuning, priors: &priors, settings, starts, last: None };
        let descent = descend(&mut response, &start, steps)?;
        let (fitted, values) = response.split(&descent.theta);
        let trial = response.trial(&descent.theta)?;
        Ok(finished(self, &variables, descent, fitted, tuning.with(&values), &priors, trial))
    }

    /// Derivatives of the recorded fundamentals by the corrections of the model in units of their prior deviation,
    /// `[run][correction][channel]`; the predictor is the corrected one.
    pub fn tuning_slopes(
        &self,
        effects: &[Source],
        tuning: &Tuning,
        predictions: &[RunPrediction],
    ) -> Vec<Vec<Vec<c64>>> {
        let (variables, mut theta) = Variables::new(effects);
        let priors: Vec<f64> = tuning.knobs.iter().map(super::tuning::Knob::deviation).collect();
        theta.extend(tuning.values.iter().zip(&priors).map(|(v, s)| v / s));
        let (bench, variables) = (*self, &variables);
        let response =
            OnResponse { bench, variables, tuning, priors: &priors, settings: FINAL, starts: Vec::new(), last: None };
        let trial = Trial { theta, predictor: None, predictions: predictions.to_vec() };
        let of_run = |r: usize| -> Vec<Vec<c64>> {
            let Some(slopes) = response.slopes(&trial, r) else {
                return vec![vec![ZERO; self.data.runs[r].responses.len()]; priors.len()];
            };
            let scaled = |(slope, s): (&Vec<Vec<c64>>, &f64)| slope.iter().map(|c| c[0] * *s).collect();
            slopes[variables.len()..].iter().zip(&priors).map(scaled).collect()
        };
        (0..self.data.runs.len()).map(of_run).collect()
    }

    /// Error on runs that were left out: groups of runs in turn, the parameters refitted without them (linearised).
    pub fn held_out_error(&self, refit: &Refit) -> Result<f64, ExplainError> {
        let (variables, _) = Variables::new(&refit.effects);
        let folds = FOLDS.min(self.data.runs.len());
        if folds < 2 {
            return Ok(refit.error);
        }
        let mut rows = 0;
        let mut fold_of_row = Vec::with_capacity(refit.descent.residual.len());
        for (r, noise) in self.noise.iter().enumerate() {
            rows += noise.len();
            fold_of_row.resize(rows, r % folds);
        }
        // The priors of corrections are never left out.
        fold_of_row.resize(refit.descent.residual.len(), usize::MAX);
        let tuned = self.predictor.tuned(&refit.tuning)?;
        let mut predictions: Vec<Option<RunPrediction>> = vec![None; self.data.runs.len()];
        for fold in 0..folds {
            let theta = without(&refit.descent, &fold_of_row, fold);
            let effects = variables.effects(&theta[..variables.len()]);
            for (r, run) in self.data.runs.iter().enumerate().filter(|(r, _)| r % folds == fold) {
                let start = refit.starts.get(r).and_then(Option::as_ref);
                let predicted = tuned.predict(r, run, &effects, &FINAL, start, self.control);
                predictions[r] = Some(predicted.or_else(|_| self.at_rest(r))?);
            }
        }
        Ok(self.error(&predictions.into_iter().flatten().collect::<Vec<_>>()))
    }
}

fn finished(
    bench: &Bench,
    variables: &Variables,
    descent: Descent,
    effects: Vec<Source>,
    tuning: Tuning,
    priors: &[f64],
    trial: Trial,
) -> Refit {
    let parameters = variables.len();
    let slopes = variables.slopes(&descent.theta[..parameters]);
    let all = descent.deviations();
    let mut own = all.iter().zip(&slopes).map(|(d, s)| d * s.abs());
    let deviations = effects.iter().map(|e| own.by_ref().take(e.parameters.len()).collect()).collect();
    let knobs = &descent.theta[parameters..];
    let penalty: f64 = knobs.iter().map(|u| u * u).sum();
    // Occam's factor: how far the data narrow each correction down.
    let occam: f64 = all[parameters..].iter().map(|d| -2.0 * d.clamp(1e-12, 1.0).ln()).sum();
    Refit {
        tuning_deviations: all[parameters..].iter().zip(priors).map(|(d, s)| d * s).collect(),
        chi_square: descent.chi_square - penalty,
        tuning_cost: penalty + occam,
        parameters,
        error: bench.error(&trial.predictions),
        starts: starts_of(trial.predictions),
        effects,
        tuning,
        deviations,
        descent,
    }
}

/// The responses of predictions, for others to start from.
pub(crate) fn starts_of(predictions: Vec<RunPrediction>) -> Starts {
    predictions.into_iter().map(|p| p.found.then_some(p.response)).collect()
}

/// Variables of the linearised fit without the rows of one fold.
fn without(descent: &Descent, fold_of_row: &[usize], fold: usize) -> Vec<f64> {
    let n = descent.theta.len();
    let kept = |column: &[f64], other: &[f64]| -> f64 {
        let rows = column.iter().zip(other).zip(fold_of_row);
        rows.filter(|(_, f)| **f != fold).map(|((a, b), _)| a * b).sum()
    };
    let j = |k: usize| descent.jacobian.col_as_slice(k);
    let normal = Mat::from_fn(n, n, |a, b| kept(j(a), j(b)) + if a == b { 1e-12 } else { 0.0 });
    let gradient = Mat::from_fn(n, 1, |k, _| kept(j(k), &descent.residual));
    match crate::math::least_squares::solve_symmetric(normal.as_ref(), gradient.as_ref()) {
        Ok(step) => (0..n).map(|k| descent.theta[k] - step[(k, 0)].clamp(-0.5, 0.5)).collect(),
        Err(_) => descent.theta.clone(),
    }
}

/// The model at one point of a descent.
struct Trial {
    theta: Vec<f64>,
    predictor: Option<Predictor>,
    predictions: Vec<RunPrediction>,
}

/// The residual on the response as a function of the variables of the effects and of the corrections.
struct OnResponse<'a> {
    bench: Bench<'a>,
    variables: &'a Variables,
    tuning: &'a Tuning,
    priors: &'a [f64],
    settings: Settings,
    /// Responses at the last point that was accepted, from which trials start.
    starts: Starts,
    last: Option<Trial>,
}

impl OnResponse<'_> {
    /// Effects, and logarithms of the corrections.
    fn split(&self, theta: &[f64]) -> (Vec<Source>, Vec<f64>) {
        let (effects, knobs) = theta.split_at(self.variables.len());
        (self.variables.effects(effects), knobs.iter().zip(self.priors).map(|(u, s)| u * s).collect())
    }

    fn compute(&self, theta: &[f64]) -> Result<Trial, ExplainError> {
        let (effects, values) = self.split(theta);
        let predictor =
            if self.tuning.is_empty() { None } else { Some(self.bench.predictor.tuned(&self.tuning.with(&values))?) };
        let bench = Bench { predictor: predictor.as_ref().unwrap_or(self.bench.predictor), ..self.bench };
        let predictions = bench.predict(&effects, &self.settings, &self.starts)?;
        Ok(Trial { theta: theta.to_vec(), predictor, predictions })
    }

    /// The model at `theta`, the last one if it was there.
    fn trial(&mut self, theta: &[f64]) -> Result<Trial, ExplainError> {
        match self.last.take().filter(|t| t.theta == theta) {
            Some(trial) => Ok(trial),
            None => self.compute(theta),
        }
    }

    /// Derivatives of the recorded amplitudes of run `r`, one list of `[channel][harmonic]` a variable; none where the
    /// response has no derivatives.
    fn slopes(&self, trial: &Trial, r: usize) -> Option<Vec<Vec<Vec<c64>>>> {
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
            let channel = |channel: &super::data::ChannelData| -> Vec<c64> {
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
    fn difference(&self, theta: &[f64], k: usize, at: &[f64]) -> Result<Vec<f64>, ExplainError> {
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

const ZERO: c64 = c64::new(0.0, 0.0);

impl Residual for OnResponse<'_> {
    type Error = ExplainError;

    fn residual(&mut self, theta: &[f64]) -> Result<Vec<f64>, ExplainError> {
        let trial = self.compute(theta)?;
        let mut residual = self.bench.residual(&trial.predictions);
        residual.extend(&theta[self.variables.len()..]);
        self.last = Some(trial);
        Ok(residual)
    }

    fn jacobian(&mut self, theta: &[f64], at: &[f64]) -> Result<Mat<f64>, ExplainError> {
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
