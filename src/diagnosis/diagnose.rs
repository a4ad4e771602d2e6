//! Which effect is missing: ranked suggestions, the steps to a model that agrees with the data, a verdict.

use crate::control::Control;
use crate::diagnosis::channels::{self, ChannelFault};
use crate::diagnosis::errors_on_all_runs;
use crate::diagnosis::residual::data::{Data, DiagnosisError, Problem, RunData};
use crate::diagnosis::residual::energy_balance::scaled_factors;
use crate::diagnosis::residual::levels::sessions;
use crate::diagnosis::residual::prediction::{Predictor, RunPrediction};
use crate::diagnosis::residual::run_selection::informative_runs;
use crate::diagnosis::result::{Diagnosis, Early, Step, Verdict};
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::diagnosis::selection::search_result::agrees;
use crate::diagnosis::selection::unreliable::Unreliable;
use crate::diagnosis::selection::{one_level, stepwise};
use crate::diagnosis::unreliable_runs::run_faults;
use crate::effects::Source;
use crate::math::statistics::sum_of_squares;
use std::sync::Arc;

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
    diagnose_without(problem, &[], control, &|_| {})
}

/// [`diagnose`] where the effects `excluded`, each at its place, are known not to be what is missing: it finds what else it
/// could be. Their parameters do not matter. The first suggestions are told to `early` while the search goes on.
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
    let Some(data) = informative_runs(&all) else { return on_runs(problem, &all, control, early) };
    let diagnosis = on_runs(problem, &data, control, early)?;
    let runs = data.runs.iter().map(|run| run.index).collect();
    Ok(Diagnosis { runs, ..errors_on_all_runs::with_errors(problem, &all, diagnosis, control)? })
}

/// Reversed, exchanged and misread channels alone, by the steady runs of `problem`, and how the model agrees with what they read.
///
/// # Errors
/// [`DiagnosisError`]: runs or a model that cannot be compared.
pub(crate) fn faults_of_channels(
    problem: &Problem,
    control: &Control,
) -> Result<(Vec<ChannelFault>, Step), DiagnosisError> {
    let all = Data::new(problem)?;
    let data = informative_runs(&all).unwrap_or(all);
    let predictor = Arc::new(Predictor::new(problem.structure, problem.known(), &data)?);
    let reference = ReferenceModel::new(predictor.clone(), &data, control, &|_| {})?;
    Ok((channels::find(&predictor, &data, &reference.predictions), reference.agreement()))
}

/// The row at which the only force of the steady runs of `problem` fits the motion of the model, where it fits one well.
///
/// # Errors
/// As [`faults_of_channels`].
pub(crate) fn place_of_force(problem: &Problem, control: &Control) -> Result<Option<usize>, DiagnosisError> {
    let data = Data::new(problem)?;
    let predictor = Arc::new(Predictor::new(problem.structure, problem.known(), &data)?);
    let reference = ReferenceModel::new(predictor.clone(), &data, control, &|_| {})?;
    Ok(channels::place_of_force(&predictor, &data, &reference.predictions))
}

/// Measured over predicted motion below which a model without damping is at its resonance there.
const AT_RESONANCE: f64 = 0.1;

/// Whether a steady run of `problem` is within the width of a resonance that its model lacks: the motion is nearer to a quarter of a
/// period off the predicted one than to it or its opposite, or next to nothing beside it. Between the half-power points of a mode the response lags so far behind
/// that of the model without its damping (Ewins, *Modal Testing*, 2.3).
///
/// # Errors
/// As [`faults_of_channels`].
pub(crate) fn lacks_width(problem: &Problem, control: &Control) -> Result<bool, DiagnosisError> {
    let data = Data::new(problem)?;
    let predictor = Arc::new(Predictor::new(problem.structure, problem.known(), &data)?);
    let predictions = match ReferenceModel::new(predictor, &data, control, &|_| {}) {
        Ok(reference) => reference.predictions,
        // At its natural frequencies a model without damping has no response at all.
        Err(DiagnosisError::Response { .. }) => return Ok(true),
        Err(error) => return Err(error),
    };
    let within = |(run, prediction): (&RunData, &RunPrediction)| {
        let factor = scaled_factors(run, prediction).first().copied();
        !prediction.found || factor.is_some_and(|z| z.im.abs() > z.re.abs() || z.norm() < AT_RESONANCE)
    };
    Ok(data.runs.iter().zip(&predictions).any(within))
}

/// Share of the error of what is told below which what was found another way leaves less, where it is no better known.
const LESS: f64 = 0.8;

/// What is found on the runs of `data`.
fn on_runs(problem: &Problem, data: &Data, control: &Control, early: &Early) -> Result<Diagnosis, DiagnosisError> {
    let predictor = Arc::new(Predictor::new(problem.structure, problem.known(), data)?);
    let reference = ReferenceModel::new(predictor.clone(), data, control, early)?;
    let mut faults = channels::find(&predictor, data, &reference.predictions);
    let as_stated = reference.agreement();
    drop(reference);
    let (mendable, mut left_out, mut kept) = (faults.len(), Vec::new(), Vec::new());
    let mut diagnosis = loop {
        let mended = channels::mended(data, &faults);
        let relied_on = Data { kept: kept.clone(), ..mended.without_runs(&left_out) };
        let predictor = Arc::new(Predictor::new(problem.structure, problem.known(), &relied_on)?);
        let reference = ReferenceModel::new(predictor, &relied_on, control, early)?;
        match explained(problem, reference)? {
            Ok(diagnosis) => {
                let run_faults = run_faults(problem, &mended, &diagnosis, &left_out, control)?;
                let fitting: Vec<usize> = run_faults.iter().filter(|f| f.fits()).map(|f| f.run).collect();
                if fitting.is_empty() || control.is_late() {
                    break Diagnosis { run_faults, ..diagnosis };
                }
                left_out.retain(|run| !fitting.contains(run));
                kept.extend(fitting);
            }
            Err(Unreliable::Channel(fault)) => faults.push(fault),
            Err(Unreliable::Run(number)) => left_out.push(number),
        }
    };
    if mendable > 0 {
        diagnosis.follows(as_stated, faults);
    } else {
        diagnosis.error_before = as_stated.error;
        diagnosis.channel_faults = faults;
    }
    Ok(diagnosis)
}

/// Explains what the reference model leaves; or a run or channel that is not to be relied on.
fn explained(problem: &Problem, reference: ReferenceModel) -> Result<Result<Diagnosis, Unreliable>, DiagnosisError> {
    let before = sum_of_squares(&reference.estimator().residual(&reference.predictions));
    let noise_floor = reference.noise_floor(&[], &reference.predictions);
    let diagnosis = Diagnosis::adequate(reference.agreement(), noise_floor);
    if agrees(&reference, before, 0) {
        return Ok(Ok(diagnosis));
    }
    let (control, stated) = (reference.control, reference.clone());
    let from_one_level = || -> Result<Result<Option<Diagnosis>, Unreliable>, DiagnosisError> {
        match one_level::explain(problem, &stated, before)? {
            Ok(outcome) => outcome.map(|outcome| outcome.conclude(diagnosis.clone())).transpose().map(Ok),
            Err(fault) => Ok(Err(fault)),
        }
    };
    let far = one_level::is_far_at_one_level(problem, &stated);
    let of_level = if far { from_one_level()? } else { Ok(None) };
    let of_level = match of_level {
        Ok(Some(told)) if told.verdict == Verdict::Missing => return Ok(Ok(told)),
        Ok(of_level) => of_level,
        Err(fault) => return Ok(Err(fault)),
    };
    let mut told = match stepwise::explain(reference, before)? {
        Ok(outcome) => {
            if let Some(run) = outcome.unreliable_run()? {
                return Ok(Err(Unreliable::Run(run)));
            }
            outcome.conclude(diagnosis.clone())?
        }
        Err(fault) => return Ok(Err(fault)),
    };
    // Harmonics that excite modes above the band, which the model misses by more than their width, point anywhere.
    if told.verdict == Verdict::Unexplained && !control.is_late() {
        let second = match stepwise::explain(stated.doubting_harmonics(), before)? {
            Ok(outcome) => outcome.conclude(diagnosis.clone())?,
            Err(fault) => return Ok(Err(fault)),
        };
        let better = second.verdict != Verdict::Unexplained || left(&second) < LESS * left(&told);
        told = if better { second } else { told };
    }
    let open = matches!(told.verdict, Verdict::Unexplained | Verdict::Undecided);
    let of_level = if open && !far && !control.is_late() { from_one_level()? } else { Ok(of_level) };
    Ok(of_level.map(|of_level| of_level.filter(|other| open && is_better(other, &told)).unwrap_or(told)))
}

/// Error that what is told leaves.
fn left(diagnosis: &Diagnosis) -> f64 {
    diagnosis.steps.last().map_or(f64::INFINITY, |step| step.error)
}

/// Whether `other` says more than `told` does and leaves less, or leaves much less.
fn is_better(other: &Diagnosis, told: &Diagnosis) -> bool {
    let most = if other.verdict == Verdict::Missing { 1.0 } else { LESS };
    other.verdict != Verdict::Unexplained && left(other) < most * left(told)
}
