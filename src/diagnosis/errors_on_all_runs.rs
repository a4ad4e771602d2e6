//! Errors on all runs of what was found on the most informative ones.

use super::channels::mended;
use crate::control::Control;
use crate::diagnosis::residual::data::{Data, DiagnosisError, Problem};
use crate::diagnosis::residual::prediction::Predictor;
use crate::diagnosis::result::{Added, Diagnosis};
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::diagnosis::updating::correction::{Correction, with_corrections};
use crate::diagnosis::updating::noise_model::Linearisation;
use crate::diagnosis::updating::parameters::Updating;
use crate::effects::Source;
use std::sync::Arc;

/// A diagnosis with the errors of its steps, and of the effects that are added, on `all` runs.
pub(super) fn with_errors(
    problem: &Problem,
    all: &Data,
    mut diagnosis: Diagnosis,
    control: &Control,
) -> Result<Diagnosis, DiagnosisError> {
    let predictor = Arc::new(Predictor::new(problem.structure, problem.known(), all)?);
    let raw = ReferenceModel::new(predictor.clone(), all, control, &|_| {})?;
    diagnosis.error_before = raw.agreement().error;
    let whole = mended(all, &diagnosis.channel_faults);
    let stated = ReferenceModel::new(predictor, &whole, control, &|_| {})?;
    let corrected = corrected(problem, &whole, &stated, &diagnosis.corrections);
    let (count, corrections) = (diagnosis.steps.len(), !diagnosis.corrections.is_empty());
    for (k, step) in diagnosis.steps.iter_mut().enumerate() {
        let effects: Vec<Source> = step.added.iter().map(|added| added.source.clone()).collect();
        let as_it_is = effects.is_empty() && !(corrections && k + 1 == count);
        step.error = match (k, as_it_is) {
            (0, _) => diagnosis.error_before,
            (_, true) => stated.agreement().error,
            (_, false) => corrected.error_of_structure(&effects, &Vec::new())?,
        };
    }
    let errors: Vec<Option<f64>> =
        diagnosis.suggestions.iter().map(|s| error_with(&diagnosis, &s.added.source)).collect();
    for (suggestion, error) in diagnosis.suggestions.iter_mut().zip(errors) {
        suggestion.error_after = error.unwrap_or(suggestion.error_after);
    }
    Ok(diagnosis)
}

/// Error of the step with what is added with `source`; none where no step has that alone.
fn error_with(diagnosis: &Diagnosis, source: &Source) -> Option<f64> {
    let set = diagnosis.added_with(source);
    let same = |added: &[Added]| {
        added.len() == set.len() && added.iter().all(|a| set.iter().any(|other| other.is_same(&a.source)))
    };
    diagnosis.steps.iter().find(|step| same(&step.added)).map(|step| step.error)
}

/// The model of `stated` with `corrections`.
fn corrected<'a>(
    problem: &Problem,
    data: &Data,
    stated: &ReferenceModel<'a>,
    corrections: &[Correction],
) -> ReferenceModel<'a> {
    let updating = with_corrections(Updating::all(problem.structure, &problem.known(), data), corrections);
    ReferenceModel {
        linearisation: Arc::new(Linearisation { updating, ..Linearisation::default() }),
        ..stated.shallow()
    }
}
