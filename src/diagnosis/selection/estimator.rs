//! Predictions of all runs and their whitened residuals: what fits on the response are made with.

use crate::control::Control;
use crate::diagnosis::residual::data::{ChannelData, Data, DiagnosisError, RunData, size};
use crate::diagnosis::residual::prediction::{FINAL, Predictor, RunPrediction, SEARCH};
use crate::diagnosis::updating::noise_model::NoiseModel;
use crate::effects::{Kind, Place, Source};
use crate::math::statistics::root_mean_square;
use crate::response::harmonic_balance::{Response, ResponseError, Settings};
use faer::c64;

/// Share of what remains of a search that one predicted run is taken for: a search asks for thousands of them.
const PACE: f64 = 2e-4;

/// A response of each run to start from.
pub(crate) type Starts = Vec<Option<Response>>;

/// A model to be fitted: the predictor with its data and noise.
#[derive(Clone, Copy)]
pub(crate) struct Estimator<'a> {
    pub predictor: &'a Predictor,
    pub data: &'a Data,
    pub noise: &'a NoiseModel,
    pub control: &'a Control,
}

impl Estimator<'_> {
    /// Number of real data.
    pub(crate) fn count(&self) -> usize {
        self.noise.count()
    }

    /// Predicts every run; a run without a periodic answer is predicted to rest, and so fits nothing.
    pub(crate) fn predict(
        &self,
        effects: &[Source],
        settings: &Settings,
        starts: &[Option<Response>],
    ) -> Result<Vec<RunPrediction>, DiagnosisError> {
        let run = |r: usize| {
            let run = &self.data.runs[r];
            self.control.check()?;
            self.control.advance(PACE);
            let start = starts.get(r).and_then(Option::as_ref);
            let predicted = if *settings == FINAL {
                self.predictor.predict_well(r, run, effects, start, self.control)
            } else {
                self.predictor.predict(r, run, effects, settings, start, self.control)
            };
            match predicted {
                Ok(prediction) => Ok(prediction),
                Err(ResponseError::Cancelled(cancelled)) => Err(cancelled.into()),
                Err(_) => self.at_rest(r),
            }
        };
        self.control.map(self.data.runs.len(), run).into_iter().collect()
    }

    pub(super) fn at_rest(&self, r: usize) -> Result<RunPrediction, DiagnosisError> {
        let run = &self.data.runs[r];
        let mut silent = run.clone();
        silent.forces.iter_mut().for_each(|f| f.measured.fill(c64::new(0.0, 0.0)));
        let file = format!("number {}", run.index + 1);
        let failed = |reason| DiagnosisError::of_response(file, reason);
        let resting = self.predictor.predict(r, &silent, &[], &SEARCH, None, self.control).map_err(failed)?;
        Ok(RunPrediction { found: false, ..resting })
    }

    /// Whitened residual of all runs, real and imaginary parts, updating parameters eliminated.
    pub(crate) fn residual(&self, predictions: &[RunPrediction]) -> Vec<f64> {
        self.noise.updating.residual(self.at_reference(predictions))
    }

    /// Whitened residual of all runs with the updating parameters at their reference; what differs from run to run is
    /// eliminated.
    pub(crate) fn at_reference(&self, predictions: &[RunPrediction]) -> Vec<f64> {
        let mut rows = Vec::with_capacity(self.count());
        for (r, (run, prediction)) in self.data.runs.iter().zip(predictions).enumerate() {
            let noise = &self.noise.runs[r];
            let mut own = noise.rows(|c, h| run.responses[c].measured[h - 1] - prediction.channels[c][h - 1]);
            noise.nuisance().without_reference(&mut own);
            noise.nuisance().project(&mut own);
            rows.extend(own);
        }
        rows
    }

    pub(crate) fn whitened(&self, r: usize, rows: &mut Vec<f64>, value: impl Fn(usize, usize) -> c64) {
        let mut own = self.noise.runs[r].rows(value);
        self.noise.runs[r].nuisance().project(&mut own);
        rows.extend(own);
    }

    /// Relative root mean square error of predictions with `effects` over runs and channels, those among them that read wrongly being
    /// mended.
    pub(crate) fn error(&self, predictions: &[RunPrediction], effects: &[Source]) -> f64 {
        root_mean_square(&self.errors(predictions, effects).concat())
    }

    /// The same of every run and channel.
    pub(crate) fn errors(&self, predictions: &[RunPrediction], effects: &[Source]) -> Vec<Vec<f64>> {
        let errors_of_run = |(run, prediction): (&RunData, &RunPrediction)| {
            let gain = |channel: &ChannelData| gain_of(effects, &channel.name, run.omega);
            let error_of_channel = |(c, channel): (usize, &ChannelData)| {
                let pairs = channel.measured.iter().zip(&prediction.channels[c]);
                let difference: Vec<c64> = pairs.map(|(y, m)| y - m).collect();
                let scale = run.scale_beside(c, gain);
                if scale > 0.0 { size(&difference) / scale } else { 0.0 }
            };
            run.responses.iter().enumerate().map(error_of_channel).collect()
        };
        self.data.runs.iter().zip(predictions).map(errors_of_run).collect()
    }
}

/// How many times too large a channel reads by the errors of channels among `effects` at `omega`, rad/s.
fn gain_of(effects: &[Source], channel: &str, omega: f64) -> f64 {
    let gain = |source: &Source| match (source.effect.kind(), &source.place) {
        (Kind::Channel(law), Place::Channel(name)) if name == channel => {
            Some(law.transfer(source.parameters[0], omega).norm())
        }
        _ => None,
    };
    effects.iter().filter_map(gain).filter(|gain| *gain > 0.0).product()
}

/// The responses of predictions, for others to start from.
pub(crate) fn starts_of(predictions: Vec<RunPrediction>) -> Starts {
    predictions.into_iter().map(|p| p.found.then_some(p.response)).collect()
}
