//! `excitation = { ... }` of a run: what `simulate` does to the structure in a test that is not steady.

use super::error::{ProjectError, TableProblem};
use super::label::Label;
use super::reader::Table;
use crate::response::recording::Loading;
use serde::{Deserialize, Serialize};

/// Longest record, s.
const LONGEST: f64 = 1e6;

/// Table `excitation` of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ExcitationTable {
    /// DOF of the force; of a release, the one whose displacement is given. A base has none.
    pub dof: Option<Label>,
    /// Of a moving base: the record with its acceleration.
    pub file: Option<String>,
    /// Length of the record, s.
    pub duration_s: f64,
    /// What is done.
    #[serde(flatten)]
    pub loading: Loading,
}

/// Reads the table.
pub(super) fn parse(run: &Table<'_>) -> Result<Option<ExcitationTable>, ProjectError> {
    let Some(table) = run.table("excitation", "excitation")? else { return Ok(None) };
    let kind = table.word("kind", &Loading::KINDS, |word| Loading::KINDS.iter().position(|&kind| kind == word))?;
    let kind = table.need("kind", "kind = \"impulse\"", kind)?;
    let own: &[&str] = match kind {
        0 => &["peak_n", "width_s", "at_s", "again_s"],
        1 => &["force_n", "from_hz", "to_hz", "logarithmic"],
        2 => &["rms_n", "from_hz", "to_hz", "seed"],
        3 => &["rms_n", "from_hz", "to_hz", "odd", "seed"],
        5 => &["amplitude_m", "frequency_hz", "ramp_s"],
        6 => &["file"],
        _ => &["displacement_m", "mode"],
    };
    let known: Vec<&str> = ["kind", "dof", "duration_s"].into_iter().chain(own.iter().copied()).collect();
    table.only(&known)?;
    let loading = match kind {
        0 => impulse(&table)?,
        1 => sweep(&table)?,
        2 => random(&table)?,
        3 => multisine(&table)?,
        5 => cycles(&table)?,
        6 => Loading::Base,
        _ => release(&table)?,
    };
    let (mut dof, mut file) = (table.label("dof")?.map(Label), None);
    if loading == Loading::Base {
        file = Some(table.need("file", "file = \"base.csv\"", table.text("file")?)?);
    } else {
        dof = Some(table.need("dof", "dof = 19", dof)?);
    }
    let duration_s = positive(&table, "duration_s", "duration_s = 2.0")?;
    if duration_s > LONGEST {
        return Err(out_of_range(&table, "duration_s", duration_s, "at most 1e6 s"));
    }
    Ok(Some(ExcitationTable { dof, file, duration_s, loading }))
}

fn impulse(table: &Table<'_>) -> Result<Loading, ProjectError> {
    let at_s = table.number("at_s")?.unwrap_or(0.0);
    let width_s = positive(table, "width_s", "width_s = 0.002")?;
    let again_s = table.number("again_s")?;
    if let Some(again) = again_s.filter(|again| *again < at_s + width_s) {
        return Err(out_of_range(table, "again_s", again, "after the first contact"));
    }
    Ok(Loading::Impulse { peak_n: needed(table, "peak_n", "peak_n = 100.0")?, width_s, at_s, again_s })
}

fn sweep(table: &Table<'_>) -> Result<Loading, ProjectError> {
    Ok(Loading::Sweep {
        force_n: needed(table, "force_n", "force_n = 1.0")?,
        from_hz: positive(table, "from_hz", "from_hz = 5.0")?,
        to_hz: positive(table, "to_hz", "to_hz = 50.0")?,
        logarithmic: table.flag("logarithmic")?.unwrap_or(false),
    })
}

fn random(table: &Table<'_>) -> Result<Loading, ProjectError> {
    let [from_hz, to_hz] = band(table)?;
    Ok(Loading::Random { rms_n: needed(table, "rms_n", "rms_n = 1.0")?, from_hz, to_hz, seed: seed(table)? })
}

fn multisine(table: &Table<'_>) -> Result<Loading, ProjectError> {
    let [from_hz, to_hz] = band(table)?;
    let rms_n = needed(table, "rms_n", "rms_n = 1.0")?;
    Ok(Loading::Multisine { rms_n, from_hz, to_hz, odd: table.flag("odd")?.unwrap_or(false), seed: seed(table)? })
}

fn release(table: &Table<'_>) -> Result<Loading, ProjectError> {
    let displacement_m = needed(table, "displacement_m", "displacement_m = 0.003")?;
    Ok(Loading::Release { displacement_m, mode: table.count("mode", 1, 100_000, "at least 1")? })
}

fn cycles(table: &Table<'_>) -> Result<Loading, ProjectError> {
    let ramp_s = table.number("ramp_s")?.unwrap_or(0.0);
    if ramp_s < 0.0 {
        return Err(out_of_range(table, "ramp_s", ramp_s, "at least 0"));
    }
    let amplitude_m = positive(table, "amplitude_m", "amplitude_m = 0.01")?;
    Ok(Loading::Cycles { amplitude_m, frequency_hz: positive(table, "frequency_hz", "frequency_hz = 1.0")?, ramp_s })
}

fn band(table: &Table<'_>) -> Result<[f64; 2], ProjectError> {
    let [from, to] = [positive(table, "from_hz", "from_hz = 5.0")?, positive(table, "to_hz", "to_hz = 50.0")?];
    if to <= from {
        return Err(out_of_range(table, "to_hz", to, "above from_hz"));
    }
    Ok([from, to])
}

fn seed(table: &Table<'_>) -> Result<u64, ProjectError> {
    Ok(table.count("seed", 0, usize::MAX >> 1, "at least 0")?.unwrap_or(1) as u64)
}

fn needed(table: &Table<'_>, key: &'static str, example: &str) -> Result<f64, ProjectError> {
    table.need(key, example, table.number(key)?)
}

fn positive(table: &Table<'_>, key: &'static str, example: &str) -> Result<f64, ProjectError> {
    let value = needed(table, key, example)?;
    if value > 0.0 { Ok(value) } else { Err(out_of_range(table, key, value, "above 0")) }
}

fn out_of_range(table: &Table<'_>, key: &str, value: f64, range: &'static str) -> ProjectError {
    table.error(key, TableProblem::OutOfRange { key: key.into(), value: value.to_string(), range })
}
