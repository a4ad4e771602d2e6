//! The model of a project against its measurements: steady runs, records that are not steady, components in a testing machine.

use crate::balance::loops::ComponentError;
use crate::control::Control;
use crate::diagnosis::candidates::restoring_force::{self, RestoringForce};
use crate::diagnosis::channels::mending::{mended_in_time, mended_run};
use crate::diagnosis::channels::{ChannelFault, find_in_time};
use crate::diagnosis::combined::combined;
use crate::diagnosis::component::{Loops, compare_component, diagnose_component};
use crate::diagnosis::diagnose::{diagnose_without, faults_of_channels};
use crate::diagnosis::records::compare::OneRecord;
use crate::diagnosis::records::{
    self, RecordComparison, RecordDiagnosisError, Records, agreement_with_records, compare_records, diagnose_records,
};
use crate::diagnosis::residual::comparison::{ChannelComparison, RunComparison};
use crate::diagnosis::result::{Early, RecordErrors, Step};
use crate::diagnosis::{Comparison, Diagnosis, DiagnosisError, Problem};
use crate::effects::Source;
use crate::exchange::Project;
use crate::measurement::TransientRun;
use crate::structure::StructureKind;

/// Why a model cannot be compared with records.
#[derive(Debug, thiserror::Error)]
pub enum ValidationError {
    /// Records of a structure.
    #[error(transparent)]
    Records(#[from] RecordDiagnosisError),
    /// Loops of one component.
    #[error(transparent)]
    Component(#[from] ComponentError),
    /// Steady runs.
    #[error(transparent)]
    Steady(#[from] DiagnosisError),
}

/// The model and the steady runs of a project.
pub fn problem(project: &Project) -> Problem<'_> {
    Problem { structure: &project.structure, sources: &project.sources, runs: &project.runs }
}

/// Whether a project uses records that are not steady.
pub fn has_records(project: &Project) -> bool {
    project.transient_runs.iter().any(|run| run.enabled)
}

/// Whether a project uses nothing but records that are not steady.
pub fn only_records(project: &Project) -> bool {
    !project.runs.iter().any(|run| run.enabled) && has_records(project)
}

/// Whether it is one component in a testing machine.
pub fn is_component(project: &Project) -> bool {
    project.structure.kind() == StructureKind::Component
}

fn loops(project: &Project) -> Result<Loops, ComponentError> {
    Loops::new(&project.structure, &project.sources, &project.transient_runs)
}

fn records(project: &Project) -> Result<Records<'_>, RecordDiagnosisError> {
    Records::new(&project.structure, &project.sources, &project.transient_runs)
}

/// The model against the records; `None` where there are none, or no model that predicts them.
///
/// # Errors
/// [`ValidationError`]: records or a model that cannot be compared.
pub fn compared_with_records(
    project: &Project,
    control: &Control,
) -> Result<Option<RecordComparison>, ValidationError> {
    compared_with_effects(project, &[], control)
}

/// The same with `effects` added to the model.
///
/// # Errors
/// As [`compared_with_records`].
pub fn compared_with_effects(
    project: &Project,
    effects: &[Source],
    control: &Control,
) -> Result<Option<RecordComparison>, ValidationError> {
    if !has_records(project) {
        return Ok(None);
    }
    if is_component(project) {
        return Ok(Some(compare_component(&loops(project)?, effects)?));
    }
    if project.structure.matrices().is_none() {
        return Ok(None);
    }
    Ok(Some(compare_records(&records(project)?, effects, control)?))
}

/// What the model lacks in all measurements that are used: steady runs, records that are not steady, or what both say together.
///
/// # Errors
/// [`ValidationError`]: runs, records or a model that cannot be compared.
pub fn diagnosed(project: &Project, control: &Control, early: &Early<'_>) -> Result<Diagnosis, ValidationError> {
    let faults = channel_faults(project, control)?;
    if faults.is_empty() {
        return diagnosed_as_read(project, control, early);
    }
    let mut diagnosis = diagnosed_as_read(&without(project, &faults), control, early)?;
    diagnosis.follows(agreement(project, control)?, faults);
    Ok(diagnosis)
}

/// Reversed, exchanged and misread channels where records that are not steady are used: in the steady runs beside them, and in the
/// records with these mended. Without such records the search in steady runs looks for them itself.
///
/// # Errors
/// [`ValidationError`]: runs or a model that cannot be compared.
pub(crate) fn channel_faults(project: &Project, control: &Control) -> Result<Vec<ChannelFault>, ValidationError> {
    if !has_records(project) || is_component(project) || project.structure.matrices().is_none() {
        return Ok(Vec::new());
    }
    let mut faults = Vec::new();
    if !only_records(project) {
        faults = faults_of_channels(&problem(project), control)?.0;
    }
    let runs: Vec<TransientRun> =
        project.transient_runs.iter().map(|run| mended_in_time(run, &faults, &project.structure)).collect();
    faults.extend(find_in_time(&project.structure, &runs));
    Ok(faults)
}

/// The project with the faults of its channels mended.
fn without(project: &Project, faults: &[ChannelFault]) -> Project {
    let on = &project.structure;
    Project {
        runs: project.runs.iter().map(|run| mended_run(run, faults, on)).collect(),
        transient_runs: project.transient_runs.iter().map(|run| mended_in_time(run, faults, on)).collect(),
        ..project.clone()
    }
}

/// How the model as it is agrees with what the channels read: with the steady runs, where there are some.
///
/// # Errors
/// [`ValidationError`]: runs, records or a model that cannot be compared.
pub(crate) fn agreement(project: &Project, control: &Control) -> Result<Step, ValidationError> {
    if only_records(project) {
        return Ok(agreement_with_records(&records(project)?, control)?);
    }
    Ok(faults_of_channels(&problem(project), control)?.1)
}

/// The same of channels that read rightly, or are not to be doubted.
fn diagnosed_as_read(project: &Project, control: &Control, early: &Early<'_>) -> Result<Diagnosis, ValidationError> {
    if only_records(project) {
        return diagnosed_from_records(project, control, early);
    }
    let steady = |control: &Control| diagnose_without(&problem(project), &project.ruled_out, control, early);
    if !has_records(project) || is_component(project) || project.structure.matrices().is_none() {
        return Ok(steady(control)?);
    }
    let by_runs = steady(&control.piece(0, 2))?;
    let by_records = diagnosed_from_records(project, &control.piece(1, 2), &|_| {})?;
    let told = by_records.clone();
    let joint = combined(by_runs, by_records);
    let records = Some(errors_of_records(project, &joint, &told, control)?);
    Ok(Diagnosis { records, ..joint })
}

/// Errors of the records before and after what runs and records say together: as their own search promises it, corrections included,
/// where it is its answer; else of the model with the effects added.
fn errors_of_records(
    project: &Project,
    joint: &Diagnosis,
    told: &Diagnosis,
    control: &Control,
) -> Result<RecordErrors, ValidationError> {
    let first = joint.suggestions.first().map(|s| &s.added.source);
    let effects = first.map_or_else(Vec::new, |source| joint.added_with(source));
    let own = first.and_then(|source| told.suggestions.iter().find(|s| s.added.source == *source));
    let error_after = match own {
        Some(own) if joint.corrections == told.corrections => own.error_after,
        _ => compared_with_effects(project, &effects, &control.unhurried())?.map_or(told.error_before, |c| c.error),
    };
    Ok(RecordErrors { error_before: told.error_before, error_after, noise_floor: told.noise_floor })
}

/// The comparison with records that are not steady in the form of that with runs: an entry a record.
pub fn as_runs(p: &Project, found: &RecordComparison) -> Comparison {
    Comparison {
        error: found.error,
        noise_floor: found.noise_floor,
        energy_error: f64::NAN,
        runs: found.records.iter().map(|r| of_record(&p.transient_runs[r.index], r)).collect(),
        unpredicted: Vec::new(),
        levels: Vec::new(),
        channels: Vec::new(),
        harmonics: Vec::new(),
        whiteness: Vec::new(),
    }
}

fn of_record(run: &TransientRun, found: &OneRecord) -> RunComparison {
    let dof = |name: &str| run.channels().iter().find(|c| c.to_string() == name).map_or(0, |c| c.dof);
    let channel = |(name, [error, noise_floor]): &(String, [f64; 2])| {
        let (channel, dof, harmonics) = (name.clone(), dof(name), Vec::new());
        ChannelComparison { channel, dof, error: *error, noise_floor: *noise_floor, scale: 1.0, harmonics }
    };
    RunComparison {
        index: found.index,
        used: run.enabled,
        error: found.error,
        noise_floor: found.noise_floor,
        branch: None,
        energy_error: f64::NAN,
        channels: found.channels.iter().map(channel).collect(),
    }
}

/// What the model of the records lacks.
///
/// # Errors
/// [`ValidationError`]: records or a model that cannot be compared.
pub fn diagnosed_from_records(
    project: &Project,
    control: &Control,
    early: &Early<'_>,
) -> Result<Diagnosis, ValidationError> {
    if is_component(project) {
        return Ok(diagnose_component(&loops(project)?, &project.ruled_out, control, early)?);
    }
    Ok(diagnose_records(&records(project)?, &project.ruled_out, control, early)?)
}

/// The missing force at the place of a suggestion of a diagnosis, or at the place that explains most, in steady runs or, where
/// there are no others, in records; `None` where none can be drawn.
///
/// # Errors
/// [`ValidationError`]: a model that cannot be compared.
pub fn missing_force(
    project: &Project,
    diagnosis: &Diagnosis,
    source: Option<&Source>,
    control: &Control,
) -> Result<Option<RestoringForce>, ValidationError> {
    if !only_records(project) {
        return Ok(restoring_force::of_diagnosis(&problem(project), diagnosis, source, control)?);
    }
    if is_component(project) || project.structure.matrices().is_none() {
        return Ok(None);
    }
    Ok(records::missing_force(&records(project)?, diagnosis, source, control)?)
}
