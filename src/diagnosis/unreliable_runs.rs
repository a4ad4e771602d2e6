//! What is wrong with the runs that a search left out because they do not fit the others: told from what the model with all that was found
//! predicts of them.

use super::run_fault::{RunFault, misreading};
use crate::control::Control;
use crate::diagnosis::residual::data::{Data, DiagnosisError, Problem, RunData};
use crate::diagnosis::residual::prediction::{FINAL, Predictor, RunPrediction};
use crate::diagnosis::result::Diagnosis;
use crate::diagnosis::selection::estimator::Estimator;
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::diagnosis::updating::correction::{Correction, with_corrections};
use crate::diagnosis::updating::noise_model::Linearisation;
use crate::diagnosis::updating::parameters::Updating;
use crate::effects::Source;
use crate::math::statistics::root_mean_square;
use std::sync::Arc;

/// What is wrong with the runs of `data`, whose channels are mended, of the numbers `left_out`, by what `diagnosis` found without them.
pub(super) fn run_faults(
    problem: &Problem,
    data: &Data,
    diagnosis: &Diagnosis,
    left_out: &[usize],
    control: &Control,
) -> Result<Vec<RunFault>, DiagnosisError> {
    if left_out.is_empty() {
        return Ok(Vec::new());
    }
    let predictor = Arc::new(Predictor::new(problem.structure, problem.known(), data)?);
    let stated = ReferenceModel::new(predictor, data, control, &|_| {})?;
    let model = corrected(problem, data, &stated, &diagnosis.corrections);
    let last = diagnosis.steps.last();
    let effects: Vec<Source> = last.map_or_else(Vec::new, |s| s.added.iter().map(|a| a.source.clone()).collect());
    let structure = model.of_structure()?;
    let estimator = Estimator { predictor: &structure, ..model.estimator() };
    let predictions = estimator.predict(&effects, &FINAL, &[])?;
    let error_before = estimator.error(&predictions, &effects);
    let error_after = last.map_or(error_before, |step| step.error);
    let errors = estimator.errors(&predictions, &effects);
    let runs = data.runs.iter().zip(&predictions).zip(&errors).filter(|((run, _), _)| left_out.contains(&run.index));
    let fault = |((run, prediction), errors): ((&RunData, &RunPrediction), &Vec<f64>)| RunFault {
        run: run.index,
        misreading: misreading(run, &prediction.channels),
        own_error: root_mean_square(errors),
        error_before,
        error_after,
    };
    Ok(runs.map(fault).collect())
}

/// The model of `stated` with `corrections`.
pub(super) fn corrected<'a>(
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
