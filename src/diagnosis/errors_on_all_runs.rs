//! Errors on all runs of what was found on the most informative ones.

use super::channels::mended;
use super::unreliable_runs::{corrected, run_faults};
use crate::control::Control;
use crate::diagnosis::residual::data::{Data, DiagnosisError, Problem};
use crate::diagnosis::residual::prediction::Predictor;
use crate::diagnosis::result::{Added, Diagnosis};
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::effects::Source;
use std::sync::Arc;

/// A diagnosis with the errors of its steps, and of the effects that are added, on `all` runs.
pub(super) fn with_errors(
    problem: &Problem,
    all: &Data,
    mut diagnosis: Diagnosis,
    control: &Control,
) -> Result<Diagnosis, DiagnosisError> {
    let predictor = |data: &Data| Predictor::new(problem.structure, problem.known(), data).map(Arc::new);
    let raw = ReferenceModel::new(predictor(all)?, all, control, &|_| {})?;
    diagnosis.error_before = raw.agreement().error;
    let left_out: Vec<usize> = diagnosis.run_faults.iter().map(|fault| fault.run).collect();
    let whole = mended(all, &diagnosis.channel_faults).without_runs(&left_out);
    let stated = ReferenceModel::new(predictor(&whole)?, &whole, control, &|_| {})?;
    let corrected = corrected(problem, &whole, &stated, &diagnosis.corrections);
    let (count, corrections) = (diagnosis.steps.len(), !diagnosis.corrections.is_empty());
    for (k, step) in diagnosis.steps.iter_mut().enumerate() {
        let effects: Vec<Source> = step.added.iter().map(|added| added.source.clone()).collect();
        let as_it_is = effects.is_empty() && !(corrections && k + 1 == count);
        step.error = match (k, as_it_is) {
            (0, _) if left_out.is_empty() => diagnosis.error_before,
            (0, _) | (_, true) => stated.agreement().error,
            (_, false) => corrected.error_of_structure(&effects, &Vec::new())?,
        };
    }
    let errors: Vec<Option<f64>> =
        diagnosis.suggestions.iter().map(|s| error_with(&diagnosis, &s.added.source)).collect();
    for (suggestion, error) in diagnosis.suggestions.iter_mut().zip(errors) {
        suggestion.error_after = error.unwrap_or(suggestion.error_after);
    }
    diagnosis.run_faults =
        run_faults(problem, &mended(all, &diagnosis.channel_faults), &diagnosis, &left_out, control)?;
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
