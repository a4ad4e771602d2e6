//! What the model with some effects added predicts for every channel of every run.
//!
//! Recorded amplitude of a response channel: `Y_c,h = t_c(h w) (i h w)^q X_c,h`, with `t_c` the transfer of an error of
//! that channel (1 without). An error of a force channel divides the recorded force: the structure felt `F / t_f`.

use crate::control::Control;
use crate::diagnosis::residual::data::{Data, DiagnosisError, RunData};
use crate::diagnosis::updating::base_load;
use crate::diagnosis::updating::parameters::Updating;
use crate::effects::{Kind, Place, Source};
use crate::response::harmonic_balance::{
    Excitation, ForwardModel, Response, ResponseError, RunModel, Settings, is_stable,
};
use crate::structure::Structure;
use faer::c64;
use std::sync::Arc;

/// How exactly responses are computed in the search. What is not answered soon is far from what was measured.
pub(crate) const SEARCH: Settings = Settings {
    harmonics: 7,
    most_harmonics: 15,
    watched: 7,
    truncation: 1e-4,
    tolerance: 1e-8,
    estimate: false,
    patience: 80,
};
/// How exactly they are computed for results.
pub(crate) const FINAL: Settings = Settings {
    harmonics: 15,
    most_harmonics: 31,
    watched: 7,
    truncation: 1e-5,
    tolerance: 1e-9,
    estimate: true,
    patience: 250,
};

/// The same for friction that is still far from what was measured.
pub(crate) const RUBBING: Settings = Settings { truncation: 1e-4, tolerance: 1e-8, ..FINAL };

/// The same where truncation would still show above the noise: nearly sticking friction.
const FINEST: Settings = Settings { most_harmonics: 63, ..FINAL };

/// Share of the noise that truncation of the series may add.
const OF_THE_NOISE: f64 = 0.01;
/// Relative truncation beyond which no noise lets it go.
const COARSEST: f64 = 1e-3;

/// `settings` for a response that is compared with a run: harmonics that were not measured need not rest, and those that were no
/// better than the noise lets see.
fn as_exact_as(data: &RunData, settings: &Settings) -> Settings {
    let relative = |&c: &usize| {
        let channel = &data.responses[c];
        let (y, s) = (channel.measured.first()?.norm(), channel.deviation.first()?);
        (y > 0.0).then_some(s / y)
    };
    let noise = data.alive.iter().filter_map(relative).fold(f64::INFINITY, f64::min);
    let allowed = if noise.is_finite() { (OF_THE_NOISE * noise).min(COARSEST) } else { 0.0 };
    Settings {
        watched: settings.watched.min(data.harmonics.max(1)),
        truncation: settings.truncation.max(allowed),
        ..*settings
    }
}

/// Predicted response of one run.
#[derive(Debug, Clone)]
pub struct RunPrediction {
    /// Predicted recorded amplitudes, one list of harmonics 1..=H a response channel.
    pub channels: Vec<Vec<c64>>,
    /// Error of those by the truncated series, the same unit.
    pub truncation: Vec<Vec<f64>>,
    /// The response behind it.
    pub response: Response,
    /// Whether it is an answer to the forces; if none was found, the prediction is to rest.
    pub found: bool,
}

/// The model over the runs, ready for any effects added to what is known.
#[derive(Debug, Clone)]
pub struct Predictor {
    model: ForwardModel,
    runs: Vec<RunModel>,
    known: Vec<Source>,
    /// Structure and known sources as the project states them.
    stated: Arc<(Structure, Vec<Source>)>,
    omegas: Vec<f64>,
    /// Errors of the force channels that go with the updating parameters.
    force_gains: Vec<Source>,
    /// Loads of a moving base over those of the stated masses, one a degree of freedom; none: as stated.
    load_ratios: Vec<f64>,
    /// Whether a base moves in some run.
    on_moving_base: bool,
}

/// The model at every frequency; runs of one frequency share what is computed there.
fn run_models(omegas: &[f64], model_at: impl Fn(f64) -> RunModel) -> Vec<RunModel> {
    let mut runs: Vec<RunModel> = Vec::with_capacity(omegas.len());
    for &omega in omegas {
        let same = runs.iter().find(|run| run.omega() == omega).cloned();
        runs.push(same.unwrap_or_else(|| model_at(omega)));
    }
    runs
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
    pub fn new(structure: &Structure, known: Vec<Source>, data: &Data) -> Result<Self, DiagnosisError> {
        let model = ForwardModel::new(structure, &known)?;
        let omegas: Vec<f64> = data.runs.iter().map(|run| run.omega).collect();
        let runs = run_models(&omegas, |omega| model.at(omega));
        let stated = Arc::new((structure.clone(), known.clone()));
        let on_moving_base = data.runs.iter().any(|run| run.on_moving_base);
        let (force_gains, load_ratios) = (Vec::new(), Vec::new());
        Ok(Self { model, runs, known, stated, omegas, force_gains, load_ratios, on_moving_base })
    }

    /// The same with the stated structure and known sources updated.
    pub fn updated(&self, updating: &Updating) -> Result<Self, DiagnosisError> {
        let known = updating.known(&self.stated.1);
        let model = ForwardModel::new(&updating.structure(&self.stated.0), &known)?;
        let mut runs = run_models(&self.omegas, |omega| model.at(omega));
        for (r, run) in runs.iter_mut().enumerate() {
            let shift = updating.shift(r);
            if shift != 0.0 {
                *run = run.stiffened(1.0 + shift);
            }
        }
        let mut load_ratios = Vec::new();
        if self.on_moving_base {
            load_ratios = base_load::load_ratios(&self.stated.0, model.structure());
        }
        let (stated, omegas, on_moving_base) = (self.stated.clone(), self.omegas.clone(), self.on_moving_base);
        let force_gains = updating.force_gains();
        Ok(Self { model, runs, known, stated, omegas, force_gains, load_ratios, on_moving_base })
    }

    /// The forces that the structure felt: as measured, freed of the errors of their channels, those among `effects` and those of
    /// the updating parameters; of a moving base those of the updated masses.
    pub(crate) fn excitation(&self, data: &RunData, effects: &[Source]) -> Excitation {
        let load =
            |dof: usize| if data.on_moving_base { self.load_ratios.get(dof).copied().unwrap_or(1.0) } else { 1.0 };
        data.excitation(|channel, w| {
            transfer(effects, &channel.name, w) * transfer(&self.force_gains, &channel.name, w) / load(channel.dof)
        })
    }

    /// Structure and known sources as the project states them.
    pub fn stated(&self) -> (&Structure, &[Source]) {
        (&self.stated.0, &self.stated.1)
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
        let excitation = self.excitation(data, effects);
        let settings = as_exact_as(data, settings);
        let response = self.runs[r].respond(&self.sources(effects), &excitation, &settings, start, control)?;
        Ok(recorded(data, effects, response))
    }

    /// [`Self::predict`] with as many harmonics as the noise of the run lets see: [`FINAL`], and more where that shows, or
    /// where the response nearby has more.
    pub(crate) fn predict_well(
        &self,
        r: usize,
        data: &RunData,
        effects: &[Source],
        start: Option<&Response>,
        control: &Control,
    ) -> Result<RunPrediction, ResponseError> {
        if let Some(start) = start.filter(|s| s.order() > FINAL.most_harmonics) {
            return self.predict(r, data, effects, &FINEST, Some(start), control);
        }
        let prediction = self.predict(r, data, effects, &FINAL, start, control)?;
        self.refined(r, data, effects, prediction, control)
    }

    /// `prediction`, or one of more harmonics beside it where its truncation shows above the noise.
    pub(crate) fn refined(
        &self,
        r: usize,
        data: &RunData,
        effects: &[Source],
        prediction: RunPrediction,
        control: &Control,
    ) -> Result<RunPrediction, ResponseError> {
        let shows = |c: &usize| {
            let channel = &data.responses[*c];
            let pairs = prediction.truncation[*c].iter().zip(&channel.deviation);
            pairs.clone().any(|(t, d)| *d > 0.0 && t > d)
        };
        if !data.alive.iter().any(shows) || control.is_late() {
            return Ok(prediction);
        }
        self.predict(r, data, effects, &FINEST, Some(&prediction.response), control)
    }

    /// Predictions of run number `r` on every periodic motion of the model, each with whether it is stable; several only
    /// where a stiffness law folds the response.
    pub fn branches(
        &self,
        r: usize,
        data: &RunData,
        effects: &[Source],
        settings: &Settings,
        control: &Control,
    ) -> Result<Vec<(RunPrediction, bool)>, ResponseError> {
        let found =
            self.runs[r].branches(&self.sources(effects), &self.excitation(data, effects), settings, control)?;
        Ok(found.into_iter().map(|(response, stable)| (recorded(data, effects, response), stable)).collect())
    }

    /// The motion that the model settles to from `start`, with whether it is stable.
    pub(crate) fn settled(
        &self,
        r: usize,
        data: &RunData,
        effects: &[Source],
        settings: &Settings,
        start: &Response,
        control: &Control,
    ) -> Result<(RunPrediction, bool), ResponseError> {
        let (sources, excitation) = (self.sources(effects), self.excitation(data, effects));
        let response = self.runs[r].respond(&sources, &excitation, settings, Some(start), control)?;
        let stable = is_stable(&self.runs[r], &sources, &excitation, &response);
        Ok((recorded(data, effects, response), stable))
    }
}

/// What the response channels record of `response`.
fn recorded(data: &RunData, effects: &[Source], response: Response) -> RunPrediction {
    let mut channels = Vec::with_capacity(data.responses.len());
    let mut truncation = Vec::with_capacity(data.responses.len());
    for channel in &data.responses {
        let factor = |h: usize| {
            let w = h as f64 * data.omega;
            transfer(effects, &channel.name, w) * channel.from_displacement(w)
        };
        channels.push((1..=data.harmonics).map(|h| factor(h) * response.amplitude(channel.dof, h)).collect());
        let error = |h: usize| response.truncation_at(channel.dof, h);
        truncation.push((1..=data.harmonics).map(|h| factor(h).norm() * error(h)).collect());
    }
    RunPrediction { channels, truncation, response, found: true }
}
