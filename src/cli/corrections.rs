//! What model updating corrected, written into a project: its own numbers, or `[[structure.correction]]` where it has none.

use crate::diagnosis::updating::correction::Correction;
use crate::diagnosis::updating::parameters::UpdatingParameter;
use crate::effects::{Place, Source, State};
use crate::exchange::Project;
use crate::exchange::project::correction::CorrectionTable;
use crate::structure::{Part, Structure};

/// Multiplies what the file states by the factor of a correction; whether it could.
pub(super) fn correct(document: &mut toml_edit::DocumentMut, project: &Project, correction: &Correction) -> bool {
    let factor = correction.factor;
    let part = match correction.parameter {
        UpdatingParameter::Known(index) => return resize(document, project, index, factor),
        UpdatingParameter::Structure(part) => part,
        UpdatingParameter::Gain(_)
        | UpdatingParameter::Delay(_)
        | UpdatingParameter::Shape { .. }
        | UpdatingParameter::Session(_) => return false,
    };
    let Some(structure) = document.get_mut("structure").and_then(toml_edit::Item::as_table_mut) else { return false };
    let entry = |structure: &mut toml_edit::Table, key: &str, k: usize| {
        let list = structure.get_mut(key).and_then(toml_edit::Item::as_array_mut);
        list.and_then(|l| l.get_mut(k)).is_some_and(|value| scale(value, factor))
    };
    let done = match part {
        Part::Stiffness if structure.contains_key("youngs_modulus") => {
            multiply(structure.get_mut("youngs_modulus"), factor)
        }
        Part::Stiffness if structure.contains_key("coupling_stiffness") => {
            multiply(structure.get_mut("coupling_stiffness"), factor)
                && multiply(structure.get_mut("ground_stiffness"), factor)
        }
        Part::Mass if structure.contains_key("density") || structure.contains_key("masses") => {
            if let Some(lumped) = structure.get_mut("lumped_mass").and_then(toml_edit::Item::as_array_of_tables_mut) {
                lumped.iter_mut().for_each(|table| {
                    multiply(table.get_mut("mass"), factor);
                });
            }
            let key = if structure.contains_key("density") { "density" } else { "masses" };
            multiply(structure.get_mut(key), factor)
        }
        Part::GroundSpring(dof) => entry(structure, "ground_stiffness", dof),
        Part::Coupling([first, second]) if second == first + 1 => entry(structure, "coupling_stiffness", first),
        Part::PointMass(dof) if !structure.contains_key("lumped_mass") => entry(structure, "masses", dof),
        _ => false,
    };
    done || add_correction(document, &project.structure, part, factor)
}

/// The size of a known source.
fn resize(document: &mut toml_edit::DocumentMut, project: &Project, index: usize, factor: f64) -> bool {
    let acts = |s: &&Source| s.state == State::Known && !matches!(s.place, Place::Channel(_));
    let known = project.sources.iter().enumerate().filter(|(_, s)| acts(s)).nth(index);
    let list = document.get_mut("source").and_then(toml_edit::Item::as_array_of_tables_mut);
    let (Some((row, source)), Some(list)) = (known, list) else { return false };
    let Some(table) = list.get_mut(row) else { return false };
    let mut keys = source.effect.scaled().iter().map(|&k| source.effect.parameters()[k].name);
    keys.all(|key| multiply(table.get_mut(key), factor))
}

/// Adds a `[[structure.correction]]` for a part that the file has no number for.
fn add_correction(document: &mut toml_edit::DocumentMut, structure: &Structure, part: Part, factor: f64) -> bool {
    let Ok(text) = toml::to_string(&CorrectionTable::of(structure, part, factor)) else { return false };
    let Ok(entry) = text.parse::<toml_edit::DocumentMut>() else { return false };
    let Some(table) = document.get_mut("structure").and_then(toml_edit::Item::as_table_mut) else { return false };
    let list = table.entry("correction").or_insert_with(|| toml_edit::ArrayOfTables::new().into());
    let Some(list) = list.as_array_of_tables_mut() else { return false };
    list.push(entry.as_table().clone());
    true
}

/// Multiplies a number, or every number of a list; whether there was one.
fn multiply(item: Option<&mut toml_edit::Item>, factor: f64) -> bool {
    let Some(value) = item.and_then(toml_edit::Item::as_value_mut) else { return false };
    match value.as_array_mut() {
        Some(list) => list.iter_mut().all(|v| scale(v, factor)),
        None => scale(value, factor),
    }
}

fn scale(value: &mut toml_edit::Value, factor: f64) -> bool {
    let number = value.as_float().or_else(|| value.as_integer().map(|i| i as f64));
    let decor = value.decor().clone();
    let Some(number) = number else { return false };
    *value = toml_edit::Value::from(number * factor);
    *value.decor_mut() = decor;
    true
}
