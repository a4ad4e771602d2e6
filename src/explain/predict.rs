//! What the model with some effects added predicts for every channel of every run.
//!
//! Recorded amplitude of a response channel: `Y_c,h = t_c(h w) (i h w)^q X_c,h`, with `t_c` the transfer of an error of
//! that channel (1 without). An error of a force channel divides the recorded force: the structure felt `F / t_f`.

use super::data::{Data, ExplainError, RunData};
use crate::control::Control;
use crate::effects::{Place, Source, effect::Kind};
use crate::response::harmonic_balance::{ForwardModel, Response, ResponseError, RunModel, Settings};
use crate::structure::Structure;
use faer::c64;

/// How exactly responses are computed in the search.
pub(crate) const SEARCH: Settings =
    Settings { harmonics: 7, most_harmonics: 15, watched: 7, truncation: 1e-4, tolerance: 1e-8, estimate: false };
/// How exactly they are computed for results.
pub(crate) const FINAL: Settings =
    Settings { harmonics: 15, most_harmonics: 31, watched: 7, truncation: 1e-5, tolerance: 1e-9, estimate: true };

/// Predicted response of one run.
#[derive(Debug, Clone)]
pub struct RunPrediction {
    /// Predicted recorded amplitudes, one list of harmonics 1..=H a response channel.
    pub channels: Vec<Vec<c64>>,
    /// Error of those by the truncated series, the same unit.
    pub truncation: Vec<Vec<f64>>,
    /// The response behind it.
    pub response: Response,
}

/// The model over the runs, ready for any effects added to what is known.
#[derive(Debug, Clone)]
pub struct Predictor {
    model: ForwardModel,
    runs: Vec<RunModel>,
    known: Vec<Source>,
}

/// Transfer of the errors among `effects` of the channel of that name at circular frequency `w`.
pub(crate) fn transfer(effects: &[Source], name: &str, w: f64) -> c64 {
    let mut product = c64::new(1.0, 0.0);
    for effect in effects {
        if let (Kind::Channel(law), Place::Channel(channel)) = (effect.effect.kind(), &effect.place)
            && channel == name
        {
            product *= law.transfer(effect.parameters[0], w);
        }
    }
    product
}

impl Predictor {
    /// Prepares the structure with its known sources for the runs of `data`.
    pub fn new(structure: &Structure, known: Vec<Source>, data: &Data) -> Result<Self, ExplainError> {
        let model = ForwardModel::new(structure, &known)?;
        let runs = data.runs.iter().map(|run| model.at(run.omega)).collect();
        Ok(Self { model, runs, known })
    }

    /// Known sources.
    pub fn known(&self) -> &[Source] {
        &self.known
    }

    /// The structure.
    pub fn structure(&self) -> &Structure {
        self.model.structure()
    }

    /// The model of one run.
    pub(crate) fn run(&self, r: usize) -> &RunModel {
        &self.runs[r]
    }

    /// Known sources and the effects on the structure among `effects`.
    pub fn sources(&self, effects: &[Source]) -> Vec<Source> {
        let on_structure = effects.iter().filter(|e| !matches!(e.effect.kind(), Kind::Channel(_)));
        self.known.iter().chain(on_structure).cloned().collect()
    }

    /// Predicts run number `r` of the data with `effects` added; `start` is a response nearby.
    pub fn predict(
        &self,
        r: usize,
        data: &RunData,
        effects: &[Source],
        settings: &Settings,
        start: Option<&Response>,
        control: &Control,
    ) -> Result<RunPrediction, ResponseError> {
        let excitation = data.excitation(|channel, w| transfer(effects, &channel.name, w));
        let response = self.runs[r].respond(&self.sources(effects), &excitation, settings, start, control)?;
        let order = data.harmonics;
        let mut channels = Vec::with_capacity(data.responses.len());
        let mut truncation = Vec::with_capacity(data.responses.len());
        for channel in &data.responses {
            let factor = |h: usize| {
                let w = h as f64 * data.omega;
                transfer(effects, &channel.name, w) * channel.from_displacement(w)
            };
            channels.push((1..=order).map(|h| factor(h) * response.amplitude(channel.dof, h)).collect());
            let error = |h: usize| response.truncation.get(h - 1).copied().unwrap_or(0.0);
            truncation.push((1..=order).map(|h| factor(h).norm() * error(h)).collect());
        }
        Ok(RunPrediction { channels, truncation, response })
    }
}
