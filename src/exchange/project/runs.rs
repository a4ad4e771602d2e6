//! Tables `[[run]]` and `[[harmonics]]` of a project.

use super::error::{ProjectError, TableProblem};
use super::file::{HarmonicsTable, Lines, RunTable};
use super::frf::dofs;
use super::keys::above_zero;
use super::label::Label;
use super::reader::Table;
use super::{base, excitation};
use crate::measurement::base::AXES;
use crate::measurement::{Quantity, TimeSpan};
use std::collections::BTreeMap;

type Read<T> = Result<T, ProjectError>;

impl RunTable {
    /// A steady run of a record of which nothing else is said.
    pub fn of(file: String) -> Self {
        Self { file, ..Self::default() }
    }

    /// What messages and results call the run.
    pub fn name(&self) -> String {
        name(&self.file, self.set.as_ref().or(self.sets.first()))
    }
}

/// The file, and behind it the set where the run is one of several of the file: those have the name of the file alike.
pub(super) fn name(file: &str, set: Option<&String>) -> String {
    set.map_or_else(|| file.to_owned(), |set| format!("{file} {set}"))
}

pub(super) fn runs(root: &Table<'_>, lines: &mut Lines) -> Read<Vec<RunTable>> {
    let mut runs = Vec::new();
    for table in root.tables("run", "[[run]]")? {
        table.only_in::<RunTable>(&[])?;
        runs.push(run(&table)?);
        base::half_a_base(&table, runs.last())?;
        lines.note(&table);
    }
    Ok(runs)
}

fn run(table: &Table<'_>) -> Read<RunTable> {
    let frequency = above_zero(table, "frequency", "above 0 Hz")?;
    let kind = table.variant("kind")?.unwrap_or_default();
    let part = part(table)?;
    let sampling_hz = above_zero(table, "sampling_hz", "above 0 Hz")?;
    let (force_dof, force_n) = force(table)?;
    Ok(RunTable {
        file: table.need("file", "file = \"run-01.csv\"", table.text("file")?)?,
        frequency,
        kind,
        start_s: part.start_s,
        end_s: part.end_s,
        exponential_window_s: above_zero(table, "exponential_window_s", "above 0 s")?,
        session: table.label("session")?,
        level: table.whole("level")?,
        enabled: table.flag("use")?,
        force_dof,
        force_n,
        frequency_shift: frequency_shift(table)?,
        excitation: excitation::parse(table)?,
        set: table.text("set")?,
        sets: sets(table)?,
        sampling_hz,
        dofs: dofs(table, "dofs", "`dofs` of the [[run]]")?,
        base: table.word("base", &AXES, |word| AXES.contains(&word).then(|| word.to_owned()))?,
        base_m_s2: table.number("base_m_s2")?,
        response: table.variant("response")?,
    })
}

/// `sets`: one a `[[channel]]`, in place of `set`.
fn sets(table: &Table<'_>) -> Read<Vec<String>> {
    let sets = table.texts("sets")?;
    if sets.is_some() && table.text("set")?.is_some() {
        return Err(table.error("sets", TableProblem::SetAndSets));
    }
    Ok(sets.unwrap_or_default())
}

/// The DOF and the size of a force, which belong together.
fn force(table: &Table<'_>) -> Read<(Option<Label>, Option<f64>)> {
    let half = |key: &'static str, other: &'static str| table.error(key, TableProblem::HalfAForce { key, other });
    match (table.label("force_dof")?.map(Label), table.number("force_n")?) {
        (Some(_), None) => Err(half("force_dof", "force_n")),
        (None, Some(_)) => Err(half("force_n", "force_dof")),
        force => Ok(force),
    }
}

fn frequency_shift(table: &Table<'_>) -> Read<Option<f64>> {
    let shift = table.number("frequency_shift")?;
    match shift.filter(|shift| shift.abs() >= 0.5) {
        Some(value) => {
            let (key, range) = ("frequency_shift".to_owned(), "between -0.5 and 0.5; 5e-4 is 0.05 %");
            Err(table.error("frequency_shift", TableProblem::OutOfRange { key, value: value.to_string(), range }))
        }
        None => Ok(shift),
    }
}

/// `start_s` and `end_s`.
fn part(table: &Table<'_>) -> Read<TimeSpan> {
    let part = TimeSpan { start_s: table.number("start_s")?, end_s: table.number("end_s")? };
    if let (Some(start), Some(end)) = (part.start_s, part.end_s)
        && end <= start
    {
        let (key, range) = ("end_s".to_owned(), "later than start_s");
        return Err(table.error("end_s", TableProblem::OutOfRange { key, value: end.to_string(), range }));
    }
    Ok(part)
}

pub(super) fn harmonics(root: &Table<'_>, lines: &mut Lines) -> Read<Vec<HarmonicsTable>> {
    let mut files = Vec::new();
    for table in root.tables("harmonics", "[[harmonics]]")? {
        table.only_in::<HarmonicsTable>(&[])?;
        let phases = [Quantity::Displacement, Quantity::Velocity, Quantity::Acceleration].map(Quantity::word);
        files.push(HarmonicsTable {
            file: table.need("file", "file = \"harmonics.csv\"", table.text("file")?)?,
            force: table.text("force")?,
            response: table.text("response")?,
            phase_of: table
                .word("phase_of", &phases, |word| Quantity::from_word(word).filter(|q| *q != Quantity::Force))?,
            level: table.whole("level")?,
            session: table.text("session")?,
            enabled: table.flag("use")?,
            set: table.text("set")?,
            phases: phases_of(&table)?,
        });
        lines.note(&table);
    }
    Ok(files)
}

/// Columns of phases by the names of their channels.
fn phases_of(table: &Table<'_>) -> Read<BTreeMap<String, String>> {
    let Some(map) = table.table("phases", "[harmonics.phases]")? else { return Ok(BTreeMap::new()) };
    let mut phases = BTreeMap::new();
    for key in map.keys() {
        if let Some(column) = map.text(key)? {
            phases.insert(key.to_owned(), column);
        }
    }
    Ok(phases)
}
