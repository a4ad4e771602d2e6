//! `dashpot methods`: every classical method that the data allow, beside the reference where one is known.

use super::arguments::Methods;
use super::table::{number, significant, table};
use crate::classical::ModalData;
use crate::classical::reference_shapes::{Beside, Match};
use crate::classical::side_by_side::{Applied, Entry, Ratio, SideBySide, side_by_side};
use crate::control::Control;
use crate::exchange::Project;
use crate::exchange::project::load;
use crate::session::workers::Threads;
use anyhow::Context;
use faer::{Mat, c64};
use serde_json::{Map, Value, json};
use std::sync::Arc;

/// Ratios printed a method; `--json` has all.
const MOST_MODES: usize = 6;
/// DOFs up to which matrices are printed; `--json` has all.
const MOST_DOFS: usize = 8;

pub(super) fn run(arguments: &Methods) -> anyhow::Result<String> {
    let control = Control::unattended().with_workers(Arc::new(Threads));
    let project = load(&arguments.file, &control)?;
    super::remarks::tell_remarks(&project);
    let found = side_by_side(&project.structure, &project.sources, &project.runs, &project.reference_shapes, &control)
        .with_context(|| arguments.file.display().to_string())?;
    Ok(if arguments.json { format!("{:#}\n", document(&project, &found)) } else { report(&project, &found) })
}

fn report(project: &Project, found: &SideBySide) -> String {
    let mut text = format!("{}\n\n", project.title);
    if !found.modes_from.is_empty() {
        text += &format!("Complex modes: {}\n\n", found.modes_from);
    }
    let count = found.measured.min(MOST_MODES);
    let mut head: Vec<String> = ["method", "eps_C %", "eps_p %", "MAC error"].map(str::to_owned).to_vec();
    head.extend((1..=count).map(|mode| format!("zeta {mode} %")));
    let mut rows = vec![head];
    rows.extend(found.entries.iter().filter_map(|e| Some(row(e, e.outcome.as_ref().ok()?, count))));
    let named = |name: &str, value: &dyn Fn(usize) -> Option<f64>| -> Vec<String> {
        let first = [name, "", "", ""].map(str::to_owned);
        let cell = |mode| value(mode).map_or("-".to_owned(), |v| significant(100.0 * v, 3));
        first.into_iter().chain((0..count).map(cell)).collect()
    };
    rows.push(named("spread of the methods, %", &|mode| found.spread.iter().find(|s| s.0 == mode).map(|s| s.1)));
    if let Some(modal) = &found.modal {
        rows.push(named("complex modes as measured", &|mode| (mode < modal.len()).then(|| modal.damping_ratio(mode))));
    }
    if !found.reference_ratios.is_empty() {
        rows.push(named("reference", &|mode| found.reference_ratios.get(mode).map(|r| r.ratio)));
    }
    text += &format!("Methods\n{}\n", table(&rows));
    text += &of_other_programs(&found.beside);
    text += &notes(found);
    text += &matrices(project, found);
    text += "Cannot run\n";
    for entry in &found.entries {
        if let Err(why) = &entry.outcome {
            text += &format!("  {}: {why}\n", entry.method.title());
        }
    }
    text
}

fn row(entry: &Entry, applied: &Applied, count: usize) -> Vec<String> {
    let optional = |value: Option<f64>| value.map_or("-".to_owned(), number);
    let mut cells = vec![
        entry.method.title().to_owned(),
        optional(applied.errors.map(|e| e.eps_c)),
        optional(applied.eps_p),
        optional(applied.errors.map(|e| e.mac)),
    ];
    let ratio = |mode: usize| applied.ratios.iter().find(|r| r.mode == mode).map(|r| 100.0 * r.ratio);
    cells.extend((0..count).map(|mode| optional(ratio(mode))));
    cells
}

/// Modes and operating shapes of other programs beside ours.
fn of_other_programs(beside: &[Beside]) -> String {
    if beside.is_empty() {
        return String::new();
    }
    let mut rows = vec![
        ["other program", "Hz", "zeta %", "measured here Hz", "zeta %", "MAC", "model Hz", "MAC"]
            .map(str::to_owned)
            .to_vec(),
    ];
    let hz = |value: f64| significant(value, 5);
    let percent = |ratio: Option<f64>| ratio.map_or("-".to_owned(), |ratio| significant(100.0 * ratio, 3));
    for Beside { reference, measured, model } in beside {
        let match_cells = |found: &Option<Match>| {
            found
                .as_ref()
                .map_or(["-".to_owned(), "-".to_owned()], |found| [hz(found.frequency_hz), significant(found.mac, 3)])
        };
        let ([ours, mac], [undamped, undamped_mac]) = (match_cells(measured), match_cells(model));
        let ratio = percent(measured.as_ref().and_then(|found| found.damping_ratio));
        let name = format!("{} ({})", reference.name, reference.kind.word());
        let own = [name, hz(reference.frequency_hz), percent(reference.damping_ratio)];
        rows.push([&own[..], &[ours, ratio, mac, undamped, undamped_mac]].concat());
    }
    format!("Modes of other programs\n{}\n", table(&rows))
}

fn notes(found: &SideBySide) -> String {
    let notes_of = |entry: &Entry| -> Vec<String> {
        let damping = entry.outcome.as_ref().ok().and_then(|applied| applied.damping.as_ref());
        damping
            .map(|d| d.notes.iter().map(|note| format!("  {}: {note}\n", entry.method.title())).collect())
            .unwrap_or_default()
    };
    let lines: Vec<String> = found.entries.iter().flat_map(notes_of).collect();
    if lines.is_empty() { String::new() } else { format!("Remarks\n{}\n", lines.concat()) }
}

fn matrices(project: &Project, found: &SideBySide) -> String {
    if project.structure.len() > MOST_DOFS {
        return String::new();
    }
    let print = |title: &str, c: &Mat<f64>| {
        let labels = project.structure.dofs().iter().map(|dof| dof.label.clone());
        let mut rows = vec![std::iter::once("C, N s/m".to_owned()).chain(labels.clone()).collect::<Vec<_>>()];
        for (i, label) in labels.enumerate() {
            rows.push(std::iter::once(label).chain((0..c.ncols()).map(|j| number(c[(i, j)]))).collect());
        }
        format!("{title}\n{}\n", table(&rows))
    };
    let matrix_of = |entry: &Entry| -> Option<String> {
        let damping = entry.outcome.as_ref().ok()?.damping.as_ref()?;
        Some(print(entry.method.title(), &damping.viscous))
    };
    let reference = found.reference.as_ref().map(|c| print("Reference", c));
    reference.into_iter().chain(found.entries.iter().filter_map(matrix_of)).collect()
}

fn document(project: &Project, found: &SideBySide) -> Value {
    let labels: Vec<&str> = project.structure.dofs().iter().map(|dof| dof.label.as_str()).collect();
    let spread = found.spread.iter().map(|(mode, spread)| json!({"mode": mode + 1, "relative_deviation": spread}));
    json!({
        "title": project.title,
        "dofs": labels,
        "modes_from": found.modes_from,
        "measured_modes": found.measured,
        "complex_modes": found.modal.as_ref().map_or_else(Vec::new, complex_modes),
        "reference": found.reference.as_ref().map(rows),
        "reference_modes": found.reference_ratios.iter().map(ratio).collect::<Vec<_>>(),
        "reference_shapes": found.beside.iter().map(|beside| shape(beside, &labels)).collect::<Vec<_>>(),
        "methods": found.entries.iter().map(entry).collect::<Vec<_>>(),
        "spread": spread.collect::<Vec<_>>(),
    })
}

fn entry(entry: &Entry) -> Value {
    let [name, needs, limits] = entry.method.words();
    let mut map = Map::new();
    map.insert("method".into(), json!(entry.method));
    map.insert("name".into(), json!(name));
    map.insert("needs".into(), json!(needs));
    map.insert("limits".into(), json!(limits));
    match &entry.outcome {
        Err(why) => {
            map.insert("ran".into(), json!(false));
            map.insert("reason".into(), json!(why));
        }
        Ok(applied) => {
            map.insert("ran".into(), json!(true));
            map.insert("modes".into(), applied.ratios.iter().map(ratio).collect());
            if let Some(damping) = &applied.damping {
                map.insert("viscous".into(), rows(&damping.viscous));
                map.insert("structural".into(), json!(damping.structural.as_ref().map(rows)));
                map.insert("notes".into(), json!(damping.notes));
            }
            map.insert("eps_c_percent".into(), json!(applied.errors.map(|e| e.eps_c)));
            map.insert("eps_p_percent".into(), json!(applied.eps_p));
            map.insert("mac_error".into(), json!(applied.errors.map(|e| e.mac)));
            map.insert("ratio_error_percent".into(), json!(applied.errors.map(|e| e.ratios)));
        }
    }
    Value::Object(map)
}

/// A mode of another program, and the same mode here with its shape in the scale of the other.
fn shape(beside: &Beside, labels: &[&str]) -> Value {
    let Beside { reference, measured, model } = beside;
    let shape_values = |values: &[c64]| -> Vec<Value> {
        let rows = reference.at.iter().zip(values);
        rows.map(|((dof, _), value)| json!({"dof": labels[*dof], "value": [value.re, value.im]})).collect()
    };
    let matched = |found: &Option<Match>| {
        found.as_ref().map(|found| {
            json!({"mode": found.mode + 1, "frequency_hz": found.frequency_hz, "damping_ratio": found.damping_ratio,
                "mac": found.mac, "shape": shape_values(&found.at)})
        })
    };
    let own: Vec<c64> = reference.at.iter().map(|(_, value)| *value).collect();
    json!({"name": reference.name, "kind": reference.kind.word(), "frequency_hz": reference.frequency_hz,
        "damping_ratio": reference.damping_ratio, "shape": shape_values(&own), "measured": matched(measured), "model": matched(model)})
}

fn ratio(r: &Ratio) -> Value {
    json!({"mode": r.mode + 1, "frequency_hz": r.frequency_hz, "damping_ratio": r.ratio})
}

fn complex_modes(modal: &ModalData) -> Vec<Value> {
    let hz = |p: usize| modal.poles[p].norm() / std::f64::consts::TAU;
    (0..modal.len()).map(|p| json!({"frequency_hz": hz(p), "damping_ratio": modal.damping_ratio(p)})).collect()
}

fn rows(matrix: &Mat<f64>) -> Value {
    let row = |i: usize| (0..matrix.ncols()).map(|j| matrix[(i, j)]).collect::<Vec<_>>();
    json!((0..matrix.nrows()).map(row).collect::<Vec<_>>())
}
