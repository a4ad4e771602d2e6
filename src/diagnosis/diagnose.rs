//! Which effect is missing: ranked suggestions, the steps to a model that agrees with the data, a verdict.

use crate::control::Control;
use crate::diagnosis::channels::{self, ChannelFault};
use crate::diagnosis::on_all_runs;
use crate::diagnosis::residual::data::{Data, DiagnosisError, Problem};
use crate::diagnosis::residual::levels::sessions;
use crate::diagnosis::residual::prediction::{Predictor, RunPrediction};
use crate::diagnosis::residual::telling_runs::telling;
use crate::diagnosis::selection::search::ReferenceModel;
use crate::diagnosis::selection::{found, stepwise};
use crate::diagnosis::updating::correction::Correction;
use crate::effects::Source;
use crate::math::statistics::root_mean_square;
use std::sync::Arc;

/// What the comparison of model and data says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// The model agrees with the data to the noise.
    Adequate,
    /// An effect is missing, and it is named.
    Missing,
    /// The model disagrees, and the data cannot tell the suggestions apart.
    Undecided,
    /// What the model states is off, and nothing is missing.
    Detuned,
    /// Something is missing that no law known here, at any place, gives.
    Unexplained,
}

impl Verdict {
    /// Word in files.
    pub fn word(self) -> &'static str {
        match self {
            Self::Adequate => "adequate",
            Self::Missing => "missing",
            Self::Undecided => "undecided",
            Self::Detuned => "detuned",
            Self::Unexplained => "unexplained",
        }
    }
}

/// An effect with the standard deviations of its parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Added {
    /// Effect, place and parameters.
    pub source: Source,
    /// Standard deviation of every parameter.
    pub deviations: Vec<f64>,
}

/// One suggested effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Suggestion {
    /// The effect.
    pub added: Added,
    /// Error of the model with this effect alone added.
    pub error_after: f64,
    /// The same on runs that were left out of the fit.
    pub held_out_error_after: f64,
    /// Probability among all that was looked at, 0 to 1.
    pub probability: f64,
    /// Why, in sentences with numbers.
    pub evidence: Vec<String>,
    /// Other effects or places that fit as well within the noise.
    pub indistinguishable_from: Vec<Source>,
}

/// The model on the way: effects added so far and the error with them.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// Effects.
    pub added: Vec<Added>,
    /// Error, as in `compare`.
    pub error: f64,
    /// Squared residual per datum in units of the noise: 1 for a model that agrees.
    pub misfit: f64,
}

/// Kind of a test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TestKind {
    /// Steady state under a sine.
    Steady,
    /// A decay after a DOF is let go from this displacement, m.
    Release {
        /// Displacement of the DOF, m.
        displacement_m: f64,
    },
    /// The same blow, sweep or noise as was recorded, so many times as large.
    Alike {
        /// Force over that of the record.
        times: f64,
    },
}

impl TestKind {
    /// Word in files.
    pub fn word(self) -> &'static str {
        match self {
            Self::Steady => "steady",
            Self::Release { .. } => "decay",
            Self::Alike { .. } => "transient",
        }
    }
}

/// A run that would tell suggestions apart or pin a parameter down.
#[derive(Debug, Clone, PartialEq)]
pub struct NextTest {
    /// What kind of test.
    pub kind: TestKind,
    /// Frequency of a sine, Hz; of other tests that of the motion that stands out.
    pub frequency_hz: f64,
    /// Row of the DOF to be driven, or to be let go.
    pub force_dof: usize,
    /// Amplitude of the force, N; of a release the one that holds the DOF there.
    pub force: f64,
    /// What it would show.
    pub why: String,
}

/// The whole answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnosis {
    /// Error of the model as it is.
    pub error_before: f64,
    /// What it would be were the model exact.
    pub noise_floor: f64,
    /// Verdict.
    pub verdict: Verdict,
    /// Suggestions, best first; none if adequate.
    pub suggestions: Vec<Suggestion>,
    /// From the model as it is to the best one.
    pub steps: Vec<Step>,
    /// Tests worth doing next.
    pub next_test: Vec<NextTest>,
    /// What the model states wrongly, where the data demand it: corrections that were fitted beside the effects.
    pub corrections: Vec<Correction>,
    /// Reversed, exchanged and misread channels; all the rest is of the data with these mended.
    pub channel_faults: Vec<ChannelFault>,
    /// Whether the search came to its end before its time was up ([`Control::hurry`]).
    pub complete: bool,
    /// Numbers of the runs of the project that were searched where there are more than a search needs: those that tell most
    /// (its errors are of all runs); none where all were.
    pub runs: Vec<usize>,
}

impl Diagnosis {
    /// What is added with `source`: beside corrections the whole set that these were fitted with; else it alone.
    pub fn added_with(&self, source: &Source) -> Vec<Source> {
        match self.steps.last().filter(|_| self.is_corrected_beside(source)) {
            Some(step) => step.added.iter().map(|added| added.source.clone()).collect(),
            None => vec![source.clone()],
        }
    }

    /// Whether `source` is of the set that the corrections were fitted with.
    pub fn is_corrected_beside(&self, source: &Source) -> bool {
        let set = self.steps.last().map_or(&[][..], |step| &step.added);
        !self.corrections.is_empty() && set.iter().any(|added| added.source.is_same(source))
    }
}

/// Is told of suggestions as soon as there are any, before they are fitted to the end: their errors and probabilities are
/// provisional. It may be told several times; what it was told last replaces what it was told before.
pub type Early<'a> = dyn Fn(&[Suggestion]) + Sync + 'a;

/// Finds what the model of `problem` lacks.
///
/// ```
/// use dashpot::{control::Control, diagnosis::{Problem, diagnose}, effects::Effect, exchange::project::load};
///
/// let control = Control::unattended();
/// let project = load("sample-data/five-masses-cubic/project.toml".as_ref(), &control)?;
/// let problem = Problem { structure: &project.structure, sources: &project.sources, runs: &project.runs };
/// let diagnosis = diagnose(&problem, &control)?;
/// for suggestion in &diagnosis.suggestions {
///     println!("{}: {:.0} %", suggestion.added.source.effect, 100.0 * suggestion.probability);
/// }
/// assert_eq!(diagnosis.suggestions[0].added.source.effect, Effect::CubicStiffness);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn diagnose(problem: &Problem, control: &Control) -> Result<Diagnosis, DiagnosisError> {
    diagnose_telling(problem, control, &|_| {})
}

/// [`diagnose`], with the first suggestions told to `early` while the search goes on.
pub fn diagnose_telling(problem: &Problem, control: &Control, early: &Early) -> Result<Diagnosis, DiagnosisError> {
    diagnose_without(problem, &[], control, early)
}

/// [`diagnose_telling`] where the effects `excluded`, each at its place, are known not to be what is missing: it finds what
/// else it could be. Their parameters do not matter.
pub fn diagnose_without(
    problem: &Problem,
    excluded: &[Source],
    control: &Control,
    early: &Early,
) -> Result<Diagnosis, DiagnosisError> {
    let diagnosis = searched(problem, excluded, control, early)?;
    control.report(1.0);
    Ok(Diagnosis { complete: control.is_complete(), ..diagnosis })
}

fn searched(
    problem: &Problem,
    excluded: &[Source],
    control: &Control,
    early: &Early,
) -> Result<Diagnosis, DiagnosisError> {
    if problem.structure.matrices().is_none() {
        return crate::diagnosis::points::search::diagnose(problem, excluded, control);
    }
    let data = Data::new(problem)?;
    let all = Data { excluded: excluded.to_vec(), sessions: sessions(problem, &data), ..data };
    let Some(data) = telling(&all) else { return on_runs(problem, &all, control, early) };
    let diagnosis = on_runs(problem, &data, control, early)?;
    let runs = data.runs.iter().map(|run| run.index).collect();
    Ok(Diagnosis { runs, ..on_all_runs::told(problem, &all, diagnosis, control)? })
}

/// What is found on the runs of `data`.
fn on_runs(problem: &Problem, data: &Data, control: &Control, early: &Early) -> Result<Diagnosis, DiagnosisError> {
    let predictor = Arc::new(Predictor::new(problem.structure, problem.known(), data)?);
    let reference = ReferenceModel::new(predictor.clone(), data, control, early)?;
    let mut faults = channels::find(&predictor, data, &reference.predictions);
    let asis = agreement(&reference);
    drop(reference);
    let mendable = faults.len();
    let mut diagnosis = loop {
        let mended = channels::mended(data, &faults);
        let reference = ReferenceModel::new(predictor.clone(), &mended, control, early)?;
        match explained(reference)? {
            Ok(diagnosis) => break diagnosis,
            Err(fault) => faults.push(fault),
        }
    };
    if faults.is_empty() {
        return Ok(diagnosis);
    }
    diagnosis.error_before = asis.error;
    if mendable > 0 {
        diagnosis.steps.insert(0, asis);
        if diagnosis.verdict == Verdict::Adequate {
            diagnosis.verdict = Verdict::Missing;
        }
    }
    diagnosis.channel_faults = faults;
    Ok(diagnosis)
}

/// The model as it is, as a first step.
pub(super) fn agreement(reference: &ReferenceModel) -> Step {
    let estimator = reference.estimator();
    let before = square(&estimator.residual(&reference.predictions));
    Step {
        added: Vec::new(),
        error: estimator.error(&reference.predictions),
        misfit: before / reference.count().max(1) as f64,
    }
}

/// Explains what the reference model leaves; or a channel that is not to be relied on.
fn explained(reference: ReferenceModel) -> Result<Result<Diagnosis, ChannelFault>, DiagnosisError> {
    let estimator = reference.estimator();
    let before = square(&estimator.residual(&reference.predictions));
    let diagnosis = Diagnosis {
        error_before: estimator.error(&reference.predictions),
        noise_floor: noise_floor(&reference, &[], &reference.predictions),
        verdict: Verdict::Adequate,
        suggestions: Vec::new(),
        steps: vec![agreement(&reference)],
        next_test: Vec::new(),
        corrections: Vec::new(),
        channel_faults: Vec::new(),
        complete: true,
        runs: Vec::new(),
    };
    if found::agrees(&reference, before, 0) {
        return Ok(Ok(diagnosis));
    }
    match stepwise::explain(reference, before)? {
        Ok(outcome) => Ok(Ok(outcome.conclude(diagnosis)?)),
        Err(fault) => Ok(Err(fault)),
    }
}

/// Error that noise and truncation alone would leave.
pub(crate) fn noise_floor(reference: &ReferenceModel, effects: &[Source], predictions: &[RunPrediction]) -> f64 {
    let Ok(noise) = reference.noise_of(effects, predictions) else { return f64::NAN };
    let mut floors = Vec::new();
    for ((run, noise), prediction) in reference.data.runs.iter().zip(&noise.runs).zip(predictions) {
        let residual = |k: usize, h: usize| run.responses[k].measured[h - 1] - prediction.channels[k][h - 1];
        for c in 0..run.responses.len() {
            let scale = run.scale(c);
            floors.push(if scale > 0.0 { noise.expected_given(c, residual).sqrt() / scale } else { 0.0 });
        }
    }
    root_mean_square(&floors)
}

fn square(residual: &[f64]) -> f64 {
    residual.iter().map(|r| r * r).sum()
}
