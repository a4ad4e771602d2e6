//! Tables `[[run]]` and `[[harmonics]]` of a project.

use super::error::{Problem, ProjectError};
use super::file::{HarmonicsTable, Lines, RunTable};
use super::keys::key_lines;
use super::label::Label;
use super::reader::Table;
use super::{base, excitation};
use crate::measurement::base::AXES;
use crate::measurement::{Kind, Part, Quantity};

type Read<T> = Result<T, ProjectError>;

const RUN: [&str; 18] = [
    "base",
    "base_m_s2",
    "response",
    "set",
    "sampling_hz",
    "file",
    "frequency",
    "kind",
    "start_s",
    "end_s",
    "session",
    "level",
    "use",
    "force_dof",
    "force_n",
    "frequency_shift",
    "excitation",
    "exponential_window_s",
];

impl RunTable {
    /// A steady run of a record of which nothing else is said.
    pub fn of(file: String) -> Self {
        Self { file, ..Self::default() }
    }
}

pub(super) fn runs(root: &Table<'_>, lines: &mut Lines) -> Read<Vec<RunTable>> {
    let mut runs = Vec::new();
    for table in root.tables("run", "[[run]]")? {
        table.only(&RUN)?;
        let frequency = table.number("frequency")?;
        if let Some(value) = frequency.filter(|f| *f <= 0.0) {
            let (key, range) = ("frequency".to_owned(), "above 0 Hz");
            return Err(table.error("frequency", Problem::OutOfRange { key, value: value.to_string(), range }));
        }
        let kind = table.word("kind", &Kind::NAMES, Kind::from_name)?.unwrap_or_default();
        let part = part(&table)?;
        let sampling_hz = table.number("sampling_hz")?;
        if let Some(value) = sampling_hz.filter(|f| *f <= 0.0) {
            let (key, range) = ("sampling_hz".to_owned(), "above 0 Hz");
            return Err(table.error("sampling_hz", Problem::OutOfRange { key, value: value.to_string(), range }));
        }
        let (force_dof, force_n) = (table.label("force_dof")?.map(Label), table.number("force_n")?);
        match (&force_dof, force_n) {
            (Some(_), None) => {
                let problem = Problem::HalfAForce { key: "force_dof", other: "force_n" };
                return Err(table.error("force_dof", problem));
            }
            (None, Some(_)) => {
                return Err(table.error("force_n", Problem::HalfAForce { key: "force_n", other: "force_dof" }));
            }
            _ => {}
        }
        runs.push(RunTable {
            file: table.need("file", "file = \"run-01.csv\"", table.text("file")?)?,
            frequency,
            kind,
            start_s: part.start_s,
            end_s: part.end_s,
            exponential_window_s: exponential_window(&table)?,
            session: table.label("session")?,
            level: table.whole("level")?,
            enabled: table.flag("use")?,
            force_dof,
            force_n,
            frequency_shift: frequency_shift(&table)?,
            excitation: excitation::parse(&table)?,
            set: table.text("set")?,
            sampling_hz,
            base: table.word("base", &AXES, |word| AXES.contains(&word).then(|| word.to_owned()))?,
            base_m_s2: table.number("base_m_s2")?,
            response: base::response(&table)?,
        });
        base::half_a_base(&table, runs.last())?;
        lines.run.push(key_lines(&table));
    }
    Ok(runs)
}

fn frequency_shift(table: &Table<'_>) -> Read<Option<f64>> {
    let shift = table.number("frequency_shift")?;
    match shift.filter(|shift| shift.abs() >= 0.5) {
        Some(value) => {
            let (key, range) = ("frequency_shift".to_owned(), "between -0.5 and 0.5; 5e-4 is 0.05 %");
            Err(table.error("frequency_shift", Problem::OutOfRange { key, value: value.to_string(), range }))
        }
        None => Ok(shift),
    }
}

fn exponential_window(table: &Table<'_>) -> Read<Option<f64>> {
    let constant = table.number("exponential_window_s")?;
    match constant.filter(|constant| *constant <= 0.0) {
        Some(value) => {
            let (key, range) = ("exponential_window_s".to_owned(), "above 0 s");
            Err(table.error("exponential_window_s", Problem::OutOfRange { key, value: value.to_string(), range }))
        }
        None => Ok(constant),
    }
}

/// `start_s` and `end_s`.
fn part(table: &Table<'_>) -> Read<Part> {
    let part = Part { start_s: table.number("start_s")?, end_s: table.number("end_s")? };
    if let (Some(start), Some(end)) = (part.start_s, part.end_s)
        && end <= start
    {
        let (key, range) = ("end_s".to_owned(), "later than start_s");
        return Err(table.error("end_s", Problem::OutOfRange { key, value: end.to_string(), range }));
    }
    Ok(part)
}

pub(super) fn harmonics(root: &Table<'_>, lines: &mut Lines) -> Read<Vec<HarmonicsTable>> {
    let mut files = Vec::new();
    for table in root.tables("harmonics", "[[harmonics]]")? {
        table.only(&["file", "force", "response", "phase_of", "level", "session", "use"])?;
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
        });
        lines.harmonics.push(table.line());
    }
    Ok(files)
}
