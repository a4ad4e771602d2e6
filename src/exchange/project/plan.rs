//! A project before its records are read: what `simulate` needs, and the first half of loading.

use super::error::{ProjectError, TableProblem};
use super::excitation::ExcitationTable;
use super::file::{BaseResponse, Lines, ProjectFile, RunTable, SimulateTable};
use super::kept;
use super::label::Label;
use super::lines::At;
use super::reference_shapes::reference_shapes;
use super::ruled_out_sources::ruled_out;
use super::sources::{sensors, sources};
use super::structure::structure;
use crate::classical::reference_shapes::ReferenceShape;
use crate::control::Control;
use crate::effects::Source;
use crate::exchange::mapping::{ChannelTable, Template, read_mapped, reads_as_own};
use crate::exchange::records::{RecordFileError, RecordProblem, read_record_with};
use crate::identify::Settings;
use crate::measurement::base::AXES;
use crate::measurement::{ChannelCorrection, ChannelName, HarmonicFit, Kind, Quantity, Record, Run, TimeSpan};
use crate::response::recording::Loading;
use crate::structure::Structure;
use std::borrow::Cow;
use std::path::{Component, Path, PathBuf};

/// Name of the tables of runs.
const RUN: &str = "[[run]]";

/// A project whose structure and sources are built and whose records are not read yet.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The project's file.
    pub path: PathBuf,
    /// The file as it is written.
    pub file: ProjectFile,
    /// Structure with its lumped masses.
    pub structure: Structure,
    /// Sources with the families of candidates expanded.
    pub sources: Vec<Source>,
    /// Known errors of the measuring chain: `delay` and `gain` at channels.
    pub sensors: Vec<Source>,
    /// Effects at places that are known not to be what the model lacks.
    pub ruled_out: Vec<Source>,
    /// Modes and operating shapes of other programs.
    pub reference_shapes: Vec<ReferenceShape>,
    /// Runs in the order of the file.
    pub runs: Vec<PlannedRun>,
    pub(super) lines: Lines,
}

/// A run of the project's file.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedRun {
    /// Record as it is named in the project.
    pub file: String,
    /// Path of the record.
    pub path: PathBuf,
    /// Frequency, Hz, where it is given.
    pub frequency_hz: Option<f64>,
    /// Kind of the run.
    pub kind: Kind,
    /// Part of the record that is used.
    pub part: TimeSpan,
    /// Time constant of an exponential window over the motion, s.
    pub exponential_window_s: Option<f64>,
    /// Label of the force level.
    pub level: Option<i64>,
    /// Name of the session it was measured in.
    pub session: Option<String>,
    /// Whether the user wants it used.
    pub enabled: bool,
    /// Whether the user says so by `use = true`.
    pub insisted: bool,
    /// Set of a laboratory file.
    pub set: Option<String>,
    /// Sets of a laboratory file, one a channel of the mapping; none: those that the mapping says.
    pub sets: Vec<String>,
    /// Sampling rate of a laboratory file without time, Hz.
    pub sampling_hz: Option<f64>,
    /// Force of the recipe, `amplitude_n cos(omega t)`, where it is given.
    pub force: Option<PlannedForce>,
    /// Share by which all natural frequencies are higher in this run of the recipe.
    pub frequency_shift: Option<f64>,
    /// Test of a recipe that is not steady, where it is given.
    pub test: Option<PlannedTest>,
    /// Motion of the base in the recipe, where it is given.
    pub base: Option<PlannedBase>,
    /// Whether the motions of the record are absolute or relative to the base.
    pub response: BaseResponse,
}

impl PlannedRun {
    /// What messages and results call the run.
    pub fn name(&self) -> String {
        super::runs::name(&self.file, self.set.as_ref().or(self.sets.first()))
    }
}

/// A test of a recipe that is not steady.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlannedTest {
    /// Row of the DOF; 0 of a moving base, which has none.
    pub dof: usize,
    /// Length of the record, s.
    pub duration_s: f64,
    /// What is done.
    pub loading: Loading,
}

/// A run that came as fitted harmonics, with what its table or its file says of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Fitted {
    /// Name in the file.
    pub name: String,
    /// Harmonics as measured, known errors of the channels not corrected.
    pub fit: HarmonicFit,
    /// Label of the force level.
    pub level: Option<i64>,
    /// Name of the session.
    pub session: Option<String>,
    /// Key `use`.
    pub enabled: Option<bool>,
}

impl Fitted {
    /// The run with its channels corrected.
    pub fn run(self, corrections: &[ChannelCorrection]) -> Run {
        let Self { name, fit, level, session, enabled } = self;
        let run = Run::from_harmonics(name, level, enabled != Some(false), fit, corrections);
        Run { session, insisted: enabled == Some(true), ..run }
    }
}

/// A harmonic motion of the base of a recipe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlannedBase {
    /// 0, 1, 2: along x, y, z.
    pub axis: usize,
    /// Amplitude of the acceleration, m/s^2.
    pub acceleration: f64,
}

/// A harmonic force of a recipe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlannedForce {
    /// Row of its DOF.
    pub dof: usize,
    /// Amplitude, N.
    pub amplitude_n: f64,
}

/// Reads the project at `path` and builds its structure and sources; records are left alone.
///
/// # Errors
/// [`ProjectError`] with file and line of the first thing that is wrong.
pub fn open(path: &Path) -> Result<Plan, ProjectError> {
    let name = path.display().to_string();
    let wrong = |problem| ProjectError::new(&name, None, problem);
    let bytes = std::fs::read(path).map_err(|error| wrong(TableProblem::Unreadable { reason: error.to_string() }))?;
    let text = String::from_utf8(bytes)
        .map_err(|error| wrong(TableProblem::NotText { position: error.utf8_error().valid_up_to() + 1 }))?;
    plan(&text, path)
}

/// [`open`] of a text that stands for the file at `path`.
pub fn plan(text: &str, path: &Path) -> Result<Plan, ProjectError> {
    let name = path.display().to_string();
    let (mut file, lines) = ProjectFile::parse(text.strip_prefix('\u{feff}').unwrap_or(text), &name)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let named = kept::labels(&file, folder);
    let structure = structure(&file.structure, folder, &named, At { file: &name, lines: &lines })?;
    kept::write_down(&mut file, &structure);
    Plan::new(file, structure, lines, path)
}

fn runs(file: &ProjectFile, structure: &Structure, folder: &Path, at: At<'_>) -> Result<Vec<PlannedRun>, ProjectError> {
    let mut runs: Vec<PlannedRun> = Vec::new();
    for (i, table) in file.run.iter().enumerate() {
        if let Some(first) = runs.iter().position(|other| is_same(other, table)) {
            let what = format!("the record \"{}\"", table.file);
            let first = at.lines.of(RUN, first, "file");
            return Err(at.error(RUN, i, "file", TableProblem::Twice { what, first }));
        }
        let row = |label: &Label, key: &str| {
            let wrong = |error| at.error(RUN, i, key, TableProblem::Structure(Box::new(error)));
            structure.require_dof(&label.0).map_err(wrong)
        };
        let force = match (&table.force_dof, table.force_n) {
            (Some(label), Some(amplitude_n)) => Some(PlannedForce { dof: row(label, "force_dof")?, amplitude_n }),
            _ => None,
        };
        let planned = |excitation: &ExcitationTable| {
            let dof = excitation.dof.as_ref().map_or(Ok(0), |label| row(label, "excitation"))?;
            Ok::<_, ProjectError>(PlannedTest { dof, duration_s: excitation.duration_s, loading: excitation.loading })
        };
        let test = table.excitation.as_ref().map(planned).transpose()?;
        runs.push(PlannedRun {
            file: table.file.clone(),
            path: folder.join(&table.file),
            frequency_hz: table.frequency,
            kind: table.kind,
            part: TimeSpan { start_s: table.start_s, end_s: table.end_s },
            exponential_window_s: table.exponential_window_s,
            level: table.level,
            session: table.session.clone(),
            enabled: table.enabled != Some(false),
            insisted: table.enabled == Some(true),
            set: table.set.clone(),
            sets: table.sets.clone(),
            sampling_hz: table.sampling_hz,
            force,
            frequency_shift: table.frequency_shift,
            test,
            base: planned_base(table),
            response: table.response.unwrap_or(file.base.response),
        });
    }
    Ok(runs)
}

/// Whether both are the same part of the same file.
fn is_same(run: &PlannedRun, table: &RunTable) -> bool {
    run.file == table.file
        && run.set == table.set
        && run.sets == table.sets
        && run.part == TimeSpan { start_s: table.start_s, end_s: table.end_s }
}

fn planned_base(table: &RunTable) -> Option<PlannedBase> {
    let axis = AXES.iter().position(|axis| table.base.as_deref() == Some(*axis))?;
    Some(PlannedBase { axis, acceleration: table.base_m_s2? })
}

/// Checks the channels that `simulate` is to record.
fn recorded(channels: &[String], structure: &Structure) -> Result<(), TableProblem> {
    for text in channels {
        let name = ChannelName::parse(text).map_err(|error| TableProblem::Channel(Box::new(error)))?;
        if name.quantity == Quantity::Base {
            continue;
        }
        structure.require_dof(&name.label).map_err(|error| TableProblem::Structure(Box::new(error)))?;
    }
    Ok(())
}

/// Refuses a record with a number that no sensor reads.
fn measurable(record: Record, path: &Path) -> Result<Record, RecordFileError> {
    let Some((c, row)) = record.beyond_measure() else { return Ok(record) };
    let problem = RecordProblem::BeyondMeasure { row: row + 1, value: record.samples(c)[row] };
    let column = Some(format!("channel {}", record.channels()[c]));
    Err(RecordFileError { file: path.display().to_string(), line: None, column, problem })
}

impl Plan {
    /// The plan of a project whose structure is built; `lines` say where its keys stand in the text of the file at `path`, if
    /// they were read from one.
    ///
    /// # Errors
    /// [`ProjectError`] for the first thing that does not hold on the structure.
    pub fn new(file: ProjectFile, structure: Structure, lines: Lines, path: &Path) -> Result<Self, ProjectError> {
        let name = path.display().to_string();
        let at = At { file: &name, lines: &lines };
        let folder = path.parent().unwrap_or(Path::new(""));
        let sources = sources(&file, &structure, at)?;
        let sensors = sensors(&file.sensor, &structure, at)?;
        let ruled_out = ruled_out(&file.ruled_out, &structure, at)?;
        let runs = runs(&file, &structure, folder, at)?;
        let reference_shapes = reference_shapes(&file, &structure, folder, at)?;
        recorded(&file.simulate.channels, &structure)
            .map_err(|problem| at.error("[simulate]", 0, "channels", problem))?;
        let path = path.to_owned();
        Ok(Self { path, file, structure, sources, sensors, ruled_out, reference_shapes, runs, lines })
    }

    /// Settings of the analysis.
    pub fn settings(&self) -> &Settings {
        &self.file.analysis
    }

    /// What `simulate` records.
    pub fn simulate(&self) -> &SimulateTable {
        &self.file.simulate
    }

    /// File, line and record of run number `run`, as messages begin.
    pub fn place_of_run(&self, run: usize) -> String {
        let line = self.lines.of(RUN, run, "file").map_or_else(String::new, |line| format!(":{line}"));
        format!("{}{line}: run {}", self.path.display(), self.runs[run].file)
    }

    /// The problem at a key of run number `run`.
    pub(super) fn run_error(&self, run: usize, key: &str, problem: TableProblem) -> ProjectError {
        self.error(self.lines.of(RUN, run, key), problem)
    }

    pub(super) fn error(&self, line: Option<usize>, problem: TableProblem) -> ProjectError {
        ProjectError::new(&self.path.display().to_string(), line, problem)
    }

    /// Checks that every record, put into another folder under its name, stays inside that folder.
    ///
    /// # Errors
    /// [`TableProblem::OutsideFolder`] for a name that is absolute or goes up.
    pub fn records_stay_inside(&self) -> Result<(), ProjectError> {
        let inside = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
        match self.runs.iter().position(|run| !Path::new(&run.file).components().all(inside)) {
            Some(run) => {
                let file = self.runs[run].file.clone();
                Err(self.run_error(run, "file", TableProblem::OutsideFolder { file }))
            }
            None => Ok(()),
        }
    }

    /// The channels of the mapping where run number `run` has them.
    fn channels_of(&self, run: usize) -> Result<Cow<'_, [ChannelTable]>, ProjectError> {
        let (all, dofs) = (&self.file.channel, &self.file.run[run].dofs);
        if dofs.is_empty() {
            return Ok(Cow::Borrowed(all));
        }
        let mut own = all.clone();
        for (name, label) in dofs {
            if all.iter().all(|table| table.name != *name) {
                let names: Vec<String> = all.iter().take(12).map(|table| format!("\"{}\"", table.name)).collect();
                let allowed = format!("the name of a [[channel]]: {}", names.join(", "));
                let problem = TableProblem::NotAllowed { key: "dofs".to_owned(), value: name.clone(), allowed };
                return Err(self.run_error(run, "dofs", problem));
            }
            own.iter_mut().filter(|table| table.name == *name).for_each(|table| table.dof.clone_from(&label.0));
        }
        Ok(Cow::Owned(own))
    }

    /// Reads the record of run number `run`, as it was recorded.
    ///
    /// # Errors
    /// [`ProjectError`], also where the record is still to be simulated.
    pub fn record(&self, run: usize, control: &Control) -> Result<Record, ProjectError> {
        let planned = &self.runs[run];
        if !planned.path.is_file() {
            let file = planned.file.clone();
            let simulated = planned.force.is_some() || planned.base.is_some() || planned.test.is_some();
            let problem = if simulated { TableProblem::NotSimulated { file } } else { TableProblem::NoRecord { file } };
            return Err(self.run_error(run, "file", problem));
        }
        let channels = self.channels_of(run)?;
        let template = Template {
            channels: &channels,
            set: planned.set.as_deref(),
            sets: &planned.sets,
            sampling_hz: planned.sampling_hz,
        };
        let read = if reads_as_own(&planned.path, template) {
            read_record_with(&planned.path, &self.structure, control)
        } else {
            read_mapped(&planned.path, template, &self.structure)
        };
        read.and_then(|record| measurable(record, &planned.path))
            .map_err(|error| self.run_error(run, "file", TableProblem::Record(Box::new(error))))
    }
}
