//! What each command does to a project file. The caller checks the whole file afterwards and keeps the old one if it fails.

use super::command::{Command, Setting, SourceAt, SourceSpec};
use super::document::Document;
use super::mending::mend;
use super::refusal::Refusal;
use super::sensors::set_sensor;
use super::{sources, structure};
use crate::effects::{Effect, Family, State};
use crate::exchange::project::MeasurementTables;
use crate::exchange::project::correction::CorrectionTable;
use crate::exchange::project::file::{CandidatesTable, ProjectFile, RunTable, Shape, SourceTable};
use crate::exchange::project::ruled_out::RuledOutTable;
use crate::structure::beam::Supports;
use crate::structure::{LumpedMass, Structure};
use std::collections::BTreeMap;
use std::path::Path;

type Done = Result<(), Refusal>;

impl Document {
    /// The document after `command`.
    ///
    /// # Errors
    /// [`Refusal`] with the reason; the document itself is never changed.
    pub fn after(&self, command: &Command) -> Result<Self, Refusal> {
        let mut file = ProjectFile::clone(self.file());
        change(&mut file, command, self.structure(), self.folder())?;
        self.with(file)
    }
}

fn change(file: &mut ProjectFile, command: &Command, on: &Structure, folder: &Path) -> Done {
    match command {
        Command::SetTitle(title) => set(&mut file.project.title, title.clone()),
        Command::SetNotes(notes) => set(&mut file.project.notes, notes.clone()),
        Command::SetReport(table) => set(&mut file.report, table.clone()),
        Command::AddSource(spec) => add_source(file, spec),
        Command::RemoveSource(at) => remove_source(file, at, on),
        Command::SetSourceState { source, state } => set_state(file, source, *state, on),
        Command::SetSourceParameters { source, parameters } => set_parameters(file, source, parameters, on),
        Command::AddCandidates { law, family, parameters } => add_family(file, *law, *family, parameters),
        Command::RemoveCandidates { law, family } => remove_family(file, *law, *family),
        Command::SetStructureParameter { name, value } => {
            structure::set_number(&mut file.structure.shape, name, *value)
        }
        Command::SetStructureParameters(values) => set_numbers(file, values),
        Command::SetSupports(supports) => set_supports(file, *supports),
        Command::SetLumpedMass { dof, mass } => set_lumped(file, dof, *mass, on),
        Command::CorrectStructure(tables) => correct_structure(file, tables),
        Command::ImportRuns(files) => import_runs(file, files, folder),
        Command::ImportTables(tables) => import_tables(file, tables),
        Command::RemoveRun(run) => remove_run(file, run),
        Command::SetRunUse { file: run, enabled } => set(&mut run_of(file, run)?.enabled, Some(*enabled)),
        Command::SetRunFrequency { file: run, frequency } => set_frequency(file, run, *frequency),
        Command::SetRunLevel { file: run, level } => set(&mut run_of(file, run)?.level, *level),
        Command::SetSensor { channel, delay, gain } => set_sensor(file, channel, [*delay, *gain], on),
        Command::MendChannels(mending) => mend(file, mending, on),
        Command::RuleOut(at) => rule_out(file, at, on),
        Command::Allow(at) => allow(file, at, on),
        Command::SetSetting(setting) => set_setting(file, *setting),
    }
}

#[expect(clippy::unnecessary_wraps, reason = "an arm of `change` ends with the outcome of its change")]
fn set<T>(place: &mut T, value: T) -> Done {
    *place = value;
    Ok(())
}

#[expect(clippy::unnecessary_wraps, reason = "an arm of `change` ends with the outcome of its change")]
fn add_source(file: &mut ProjectFile, spec: &SourceSpec) -> Done {
    let SourceSpec { law, dofs, elements, state, parameters } = spec.clone();
    file.source.push(SourceTable { law, dofs: sources::labels(&dofs), elements, state, parameters });
    Ok(())
}

fn remove_source(file: &mut ProjectFile, at: &SourceAt, on: &Structure) -> Done {
    let index = sources::find(file, at, on)?;
    file.source.remove(index);
    Ok(())
}

/// What becomes known without a value starts from the typical one of its law, for the user to correct.
fn set_state(file: &mut ProjectFile, at: &SourceAt, state: State, on: &Structure) -> Done {
    let index = sources::find(file, at, on)?;
    let table = &mut file.source[index];
    table.state = state;
    if matches!(state, State::Known | State::Reference) {
        for parameter in table.law.parameters() {
            table.parameters.entry(parameter.name.into()).or_insert(parameter.typical);
        }
    }
    Ok(())
}

fn set_parameters(file: &mut ProjectFile, at: &SourceAt, values: &BTreeMap<String, f64>, on: &Structure) -> Done {
    let index = sources::find(file, at, on)?;
    file.source[index].parameters.extend(values.iter().map(|(name, &value)| (name.clone(), value)));
    Ok(())
}

/// A part that is corrected already is corrected further by the product of the factors.
#[expect(clippy::unnecessary_wraps, reason = "an arm of `change` ends with the outcome of its change")]
fn correct_structure(file: &mut ProjectFile, tables: &[CorrectionTable]) -> Done {
    for table in tables {
        let same =
            |other: &&mut CorrectionTable| CorrectionTable { factor: table.factor, ..(**other).clone() } == *table;
        match file.structure.correction.iter_mut().find(same) {
            Some(earlier) => earlier.factor *= table.factor,
            None => file.structure.correction.push(table.clone()),
        }
    }
    Ok(())
}

fn family_at(file: &ProjectFile, law: Effect, family: Family) -> Option<usize> {
    file.candidates.iter().position(|table| table.law == law && table.family == family)
}

fn add_family(file: &mut ProjectFile, law: Effect, family: Family, parameters: &BTreeMap<String, f64>) -> Done {
    if family_at(file, law, family).is_some() {
        return Err(Refusal::FamilyTwice { law, family: family.name() });
    }
    file.candidates.push(CandidatesTable { law, family, parameters: parameters.clone() });
    Ok(())
}

fn remove_family(file: &mut ProjectFile, law: Effect, family: Family) -> Done {
    let index = family_at(file, law, family).ok_or(Refusal::NoSuchFamily { law, family: family.name() })?;
    file.candidates.remove(index);
    Ok(())
}

fn set_numbers(file: &mut ProjectFile, values: &BTreeMap<String, f64>) -> Done {
    values.iter().try_for_each(|(name, &value)| structure::set_number(&mut file.structure.shape, name, value))
}

fn set_supports(file: &mut ProjectFile, supports: Supports) -> Done {
    match &mut file.structure.shape {
        Shape::Beam(beam) => set(&mut beam.supports, supports),
        other => Err(Refusal::NoSupports { kind: structure::kind(other) }),
    }
}

fn set_lumped(file: &mut ProjectFile, dof: &str, mass: Option<f64>, on: &Structure) -> Done {
    on.require_dof(dof)?;
    let masses = &mut file.structure.lumped_mass;
    let Some(mass) = mass else {
        let before = masses.len();
        masses.retain(|lumped| lumped.dof != dof);
        let removed = masses.len() < before;
        return if removed { Ok(()) } else { Err(Refusal::NoLumpedMass { dof: dof.into() }) };
    };
    match masses.iter_mut().find(|lumped| lumped.dof == dof) {
        Some(lumped) => lumped.mass = mass,
        None => masses.push(LumpedMass { dof: dof.into(), mass }),
    }
    Ok(())
}

fn import_tables(file: &mut ProjectFile, tables: &str) -> Done {
    let tables = MeasurementTables::parse(tables, "import")?;
    file.add_measurements(tables).map_err(|file| Refusal::RunTwice { file })
}

fn import_runs(file: &mut ProjectFile, files: &[String], folder: &Path) -> Done {
    if files.is_empty() {
        return Err(Refusal::NoFile);
    }
    files.iter().try_for_each(|name| import_run(file, relative(name, folder)))
}

fn import_run(file: &mut ProjectFile, name: String) -> Done {
    if name.trim().is_empty() {
        return Err(Refusal::EmptyName);
    }
    if file.run.iter().any(|run| run.file == name) {
        return Err(Refusal::RunTwice { file: name });
    }
    file.run.push(RunTable::of(name));
    Ok(())
}

/// The path as seen from the project, where it lies below it.
fn relative(name: &str, folder: &Path) -> String {
    let below = Path::new(name).strip_prefix(folder).ok().and_then(Path::to_str);
    below.filter(|_| !folder.as_os_str().is_empty()).unwrap_or(name).to_owned()
}

fn run_of<'a>(file: &'a mut ProjectFile, name: &str) -> Result<&'a mut RunTable, Refusal> {
    let index = file.run.iter().position(|run| run.name() == name);
    let index = index.or_else(|| file.run.iter().position(|run| run.file == name));
    index.and_then(|index| file.run.get_mut(index)).ok_or_else(|| Refusal::NoSuchRun { file: name.into() })
}

fn remove_run(file: &mut ProjectFile, name: &str) -> Done {
    run_of(file, name)?;
    let named = |run: &RunTable| run.name() == name;
    let any = file.run.iter().any(named);
    file.run.retain(|run| if any { !named(run) } else { run.file != name });
    Ok(())
}

fn set_frequency(file: &mut ProjectFile, name: &str, frequency: Option<f64>) -> Done {
    if let Some(value) = frequency {
        within("frequency", value, value > 0.0 && value.is_finite(), "above 0 Hz")?;
    }
    set(&mut run_of(file, name)?.frequency, frequency)
}

fn within(name: &'static str, value: f64, holds: bool, range: &'static str) -> Done {
    if holds { Ok(()) } else { Err(Refusal::OutOfRange { name, range, value }) }
}

/// Where an effect is among those that are ruled out.
fn ruled_out_at(file: &ProjectFile, at: &RuledOutTable, on: &Structure) -> Result<Option<usize>, Refusal> {
    let wanted = sources::ruled_out(at, on)?;
    let same = |table: &RuledOutTable| table.source(on).is_ok_and(|source| source.is_same(&wanted));
    Ok(file.ruled_out.iter().position(same))
}

fn rule_out(file: &mut ProjectFile, at: &RuledOutTable, on: &Structure) -> Done {
    if ruled_out_at(file, at, on)?.is_some() {
        return Err(Refusal::RuledOutTwice { law: at.law });
    }
    file.ruled_out.push(at.clone());
    Ok(())
}

fn allow(file: &mut ProjectFile, at: &RuledOutTable, on: &Structure) -> Done {
    let index = ruled_out_at(file, at, on)?.ok_or(Refusal::NotRuledOut { law: at.law })?;
    file.ruled_out.remove(index);
    Ok(())
}

/// Greatest count that a setting may ask for, as in project files.
const MOST: usize = 1000;

fn set_setting(file: &mut ProjectFile, setting: Setting) -> Done {
    let a = &mut file.analysis;
    let count = |name, n: usize, least| within(name, n as f64, (least..=MOST).contains(&n), "a count of at most 1000");
    match setting {
        Setting::Harmonics(n) => count("harmonics", n, 1).and_then(|()| set(&mut a.harmonics, n)),
        Setting::Expansion(expansion) => set(&mut a.expansion, expansion),
        Setting::Keep(n) => count("keep", n, 0).and_then(|()| set(&mut a.keep, n)),
        Setting::Weights(weights) => set(&mut a.weights, weights),
        Setting::MaxSources(n) => count("max_sources", n, 1).and_then(|()| set(&mut a.max_sources, n)),
        Setting::StopAngleDeg(angle) => {
            within("stop_angle_deg", angle, (0.0..=90.0).contains(&angle), "between 0 and 90 degrees")?;
            set(&mut a.stop_angle_deg, angle)
        }
    }
}
