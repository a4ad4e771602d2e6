//! Import of tables of amplitudes and phases over frequency: a `[[harmonics]]` each file and sheet, the columns mapped by `[[channel]]`.

use super::error::{ImportError, Result};
use super::model::head;
use super::numbers::placed;
use super::records::{channels, labels, unused};
use super::request::{Imported, Request};
use super::text::{comment, named, points};
use crate::control::Control;
use crate::exchange::mapping::{AmplitudeColumns, Proposal, Stepped, sets_with};
use crate::exchange::project::plan;
use crate::math::numerals::counted;
use crate::measurement::Quantity;
use dashpot_datafiles::{DataFile, Values, open};
use std::path::Path;
use std::path::PathBuf;

/// Largest relative difference of the mean forces of tables of one level.
const SAME_LEVEL: f64 = 0.05;

/// A table: its file, its set where the file has several, the mean amplitude of its force.
struct Table {
    file: PathBuf,
    set: Option<String>,
    force: f64,
}

/// The project of the tables of all files that have the columns of the first.
pub(super) fn import(
    request: &Request,
    stepped: &Stepped,
    amplitudes: &AmplitudeColumns,
    out: &Path,
    control: &Control,
) -> Result<Imported> {
    let mut mapping = amplitudes.mapping.clone();
    if request.kept.is_some() {
        mapping = placed(mapping, &head(request, out, "", 0.0)?, out)?;
    }
    let tables = tables(request, amplitudes)?;
    let head = head(request, out, &points(&labels(&mapping)), 2.0 * stepped.band_hz[1])?;
    let text = text(&tables, amplitudes, &mapping, out)?;
    let loaded = plan(&format!("{head}{text}"), out).and_then(|plan| plan.load(control));
    let loaded = loaded.map_err(ImportError::Unwritten)?;
    let mut stated: Vec<i64> = loaded.runs.iter().filter_map(|run| run.level).collect();
    stated.sort_unstable();
    stated.dedup();
    let summary = summary(&mapping, &tables, [loaded.runs.len(), stated.len().max(1)], out);
    Ok(Imported { head, tables: text, summary, remarks: Vec::new() })
}

/// What was made of the tables, for the user.
fn summary(mapping: &Proposal, tables: &[Table], [runs, levels]: [usize; 2], out: &Path) -> String {
    let assumed = mapping.assumed.iter().map(|(name, what)| format!("assumed: {name}: {what}\n"));
    let left = mapping.left.iter().map(|(name, why)| format!("not mapped: \"{name}\" ({why})\n"));
    format!(
        "{}amplitudes and phases of {} in {} at {} are in {}\n",
        assumed.chain(left).collect::<String>(),
        counted(runs, "run"),
        counted(tables.len(), "table"),
        counted(levels, "level"),
        out.display()
    )
}

fn tables(request: &Request, amplitudes: &AmplitudeColumns) -> Result<Vec<Table>> {
    let mut tables = Vec::new();
    for path in &request.files {
        let file = open(path)?;
        let sets = sets_with(file.contents(), amplitudes);
        if sets.is_empty() {
            return Err(ImportError::of(path, "has no table with the columns of the first file; import it by itself"));
        }
        let several = file.contents().sets.len() > 1;
        for set in sets {
            let force = mean_force(&file, set, amplitudes)?;
            tables.push(Table { file: path.clone(), set: several.then(|| set.to_owned()), force });
        }
    }
    Ok(tables)
}

/// Mean amplitude of the first force of a set, in the unit of the file.
fn mean_force(file: &DataFile, set: &str, amplitudes: &AmplitudeColumns) -> Result<f64> {
    let force = amplitudes.mapping.channels.iter().find(|table| table.quantity == Quantity::Force);
    let sets = file.contents().sets.iter().enumerate();
    let place = sets.filter(|(_, own)| own.name == set).find_map(|(s, own)| {
        let c = own.channels.iter().position(|channel| force.is_some_and(|force| force.name == channel.name))?;
        Some((s, c))
    });
    let Some((s, c)) = place else { return Ok(0.0) };
    Ok(match file.read(s, c)? {
        Values::Real(values) if !values.is_empty() => values.iter().sum::<f64>() / values.len() as f64,
        _ => 0.0,
    })
}

/// Number of the level of each table, from 1 in the order of the forces.
fn levels(tables: &[Table]) -> Vec<usize> {
    let mut forces: Vec<f64> = tables.iter().map(|table| table.force).collect();
    forces.sort_by(f64::total_cmp);
    forces.dedup_by(|a, b| (*a - *b).abs() <= SAME_LEVEL * b.abs());
    let level = |force: f64| forces.iter().rposition(|least| force >= *least).map_or(1, |at| at + 1);
    tables.iter().map(|table| level(table.force)).collect()
}

fn text(tables: &[Table], amplitudes: &AmplitudeColumns, mapping: &Proposal, out: &Path) -> Result<String> {
    let quoted = |text: &str| toml::Value::from(text).to_string();
    let phases: String =
        amplitudes.phases.iter().map(|(name, phase)| format!("{} = {}\n", quoted(name), quoted(phase))).collect();
    let mut text = channels(mapping) + &unused(mapping);
    let levels = levels(tables);
    if levels.iter().any(|level| *level != levels[0]) {
        text.push_str(&comment("Levels are numbered by the mean amplitude of the force of each table."));
    }
    for (table, level) in tables.iter().zip(&levels) {
        text.push_str(&format!("[[harmonics]]\nfile = {}\n", quoted(&named(&table.file, out)?)));
        if let Some(set) = &table.set {
            text.push_str(&format!("set = {}\n", quoted(set)));
        }
        if tables.len() > 1 {
            text.push_str(&format!("level = {level}\n"));
        }
        text.push_str(&format!("[harmonics.phases]\n{phases}\n"));
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_numbered_by_the_force() {
        let table = |force: f64| Table { file: PathBuf::new(), set: None, force };
        assert_eq!(levels(&[2.0, 8.0, 4.0, 2.05, 7.9].map(table)), [1, 3, 2, 1, 3]);
    }
}
