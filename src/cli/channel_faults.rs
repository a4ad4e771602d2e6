//! Faults of channels in `dashpot diagnose`: said, and mended in the mapping of the project.

use super::label::label;
use super::table::number;
use crate::diagnosis::channels::{ChannelFault, Fault};
use crate::exchange::Project;
use crate::measurement::Channel;
use crate::structure::Direction;
use serde_json::{Map, Value, json};
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, value};

/// What is said of runs that are lines of frequency responses.
pub(super) const NO_AMPLITUDE: &str =
    "frequency responses have no amplitude: laws whose force is not in proportion to the motion are not looked for";

/// As suggestions in the JSON document: a gain, or `exchanged` with `channels`.
pub(super) fn suggestions(faults: &[ChannelFault]) -> impl Iterator<Item = Value> + '_ {
    // A channel that is not to be relied on is no effect that could be added: it is told under `channel_faults`.
    let mendable = faults.iter().filter(|fault| !matches!(fault.fault, Fault::Unreliable(_)));
    mendable.map(|fault| {
        let mut map = Map::new();
        match fault.fault {
            Fault::Unreliable(_) => {}
            Fault::Factor(factor) => {
                map.insert("effect".into(), json!("gain"));
                map.insert("channel".into(), json!(fault.channels[0]));
                map.insert("parameters".into(), json!({ "gain": factor }));
                map.insert("standard_deviation".into(), json!({ "gain": null }));
            }
            Fault::Exchanged => {
                map.insert("effect".into(), json!("exchanged"));
                map.insert("dofs".into(), json!([]));
                map.insert("channels".into(), json!(fault.channels));
                map.insert("parameters".into(), json!({}));
                map.insert("standard_deviation".into(), json!({}));
            }
        }
        map.insert("error_after".into(), json!(fault.error_after));
        map.insert("held_out_error_after".into(), json!(fault.error_after));
        map.insert("probability".into(), json!(1.0));
        map.insert("evidence".into(), json!([fault.words(), fault.evidence()]));
        map.insert("indistinguishable_from".into(), json!([]));
        Value::Object(map)
    })
}

/// A fault in the JSON document.
pub(super) fn document(fault: &ChannelFault) -> Value {
    let (kind, factor) = match fault.fault {
        Fault::Exchanged => ("exchanged", None),
        Fault::Unreliable(_) => ("unreliable", None),
        Fault::Factor(-1.0) => ("reversed", Some(-1.0)),
        Fault::Factor(factor) => ("factor", Some(factor)),
    };
    json!({
        "fault": kind,
        "channels": fault.channels,
        "factor": factor,
        "scatter": if let Fault::Unreliable(scatter) = fault.fault { Some(scatter) } else { None },
        "words": fault.words(),
        "error_before": fault.error_before,
        "error_after": fault.error_after,
        "own_error_before": fault.own_error[0],
        "own_error_after": fault.own_error[1],
    })
}

/// The faults in sentences.
pub(super) fn text(faults: &[ChannelFault]) -> String {
    if faults.is_empty() {
        return String::new();
    }
    let mut text = "\nchannels first; all that follows is with them mended\n".to_owned();
    for fault in faults {
        let [before, after] = [fault.error_before, fault.error_after].map(|error| number(100.0 * error));
        text.push_str(&format!("  {}: error {before} % before, {after} % after\n", fault.words()));
        text.push_str(&format!("    {}\n", fault.evidence()));
    }
    text
}

/// Mends the mapping of the channel: in its `[[channel]]`, in those that are written for all channels of the records, or
/// under `[frf.dofs]`.
///
/// # Errors
/// One sentence where the project has no place for it.
pub(super) fn mend(document: &mut DocumentMut, project: &Project, fault: &ChannelFault) -> Result<(), String> {
    if let Fault::Unreliable(_) = fault.fault {
        return Ok(());
    }
    let frf = document.get("frf").is_some();
    if document.get("harmonics").is_some() {
        return Err("its harmonics were fitted elsewhere; mend the file".to_owned());
    }
    if frf {
        mend_responses(document, project, fault)?;
    }
    if document.get("run").is_none() {
        return Ok(());
    }
    if document.get("channel").is_none() {
        write_mapping(document, project)?;
    }
    let tables = document.get_mut("channel").and_then(Item::as_array_of_tables_mut);
    mend_tables(tables.ok_or("write `channel` as [[channel]] tables, so that one can be mended")?, fault)
}

/// Words of a channel table: `acc@7`.
fn named(table: &Table) -> String {
    let dof = table.get("dof").map_or_else(String::new, |dof| match dof.as_str() {
        Some(text) => text.to_owned(),
        None => dof.as_integer().map_or_else(String::new, |number| number.to_string()),
    });
    format!("{}@{dof}", table.get("quantity").and_then(Item::as_str).unwrap_or_default())
}

fn mend_tables(tables: &mut ArrayOfTables, fault: &ChannelFault) -> Result<(), String> {
    let rows: Vec<usize> = fault
        .channels
        .iter()
        .map(|name| tables.iter().position(|table| named(table) == *name).ok_or(format!("no [[channel]] is {name}")))
        .collect::<Result<_, _>>()?;
    match fault.fault {
        Fault::Unreliable(_) => {}
        Fault::Factor(factor) => {
            let Some(table) = tables.get_mut(rows[0]) else { return Ok(()) };
            if factor < 0.0 {
                let sign = table.get("sign").and_then(Item::as_integer).unwrap_or(1);
                table["sign"] = value(-sign);
            }
            if factor.abs() != 1.0 {
                let known = |item: &Item| item.as_float().or_else(|| item.as_integer().map(|i| i as f64));
                let before = table.get("factor").and_then(known).unwrap_or(1.0);
                table["factor"] = value(before / factor.abs());
            }
        }
        Fault::Exchanged => {
            let dofs: Vec<Option<Item>> =
                rows.iter().map(|&row| tables.get(row).and_then(|t| t.get("dof")).cloned()).collect();
            for (row, dof) in rows.iter().zip(dofs.into_iter().rev()) {
                if let (Some(table), Some(dof)) = (tables.get_mut(*row), dof) {
                    table["dof"] = dof;
                }
            }
        }
    }
    Ok(())
}

/// Tables for all channels of the records as their files name them.
fn write_mapping(document: &mut DocumentMut, project: &Project) -> Result<(), String> {
    let mut all: Vec<Vec<&Channel>> = Vec::new();
    all.extend(project.runs.iter().filter_map(|run| Some(run.record.as_ref()?.channels().iter().collect())));
    all.extend(project.transient_runs.iter().map(|run| run.channels().iter().collect()));
    let Some(first) = all.first() else { return Err("the project has no record".to_owned()) };
    let same = |other: &Vec<&Channel>| {
        other.len() == first.len() && first.iter().all(|a| other.iter().any(|b| a.to_string() == b.to_string()))
    };
    if !all.iter().all(same) {
        return Err("the records have different channels, so that one mapping does not hold for all".to_owned());
    }
    let mut tables = ArrayOfTables::new();
    for channel in first {
        let mut table = Table::new();
        table["name"] = value(channel.to_string());
        table["quantity"] = value(channel.quantity.word());
        table["dof"] = value(label(channel.label.clone()));
        tables.push(table);
    }
    document["channel"] = Item::ArrayOfTables(tables);
    Ok(())
}

/// Turns or exchanges the DOFs of frequency responses.
fn mend_responses(document: &mut DocumentMut, project: &Project, fault: &ChannelFault) -> Result<(), String> {
    let tables = document.get_mut("frf").and_then(Item::as_array_of_tables_mut);
    let tables = tables.ok_or("write `frf` as [[frf]] tables, so that one can be mended")?;
    let labels: Vec<&str> = fault.channels.iter().filter_map(|name| Some(name.split_once('@')?.1)).collect();
    let reversed = |label: &str| match label.strip_prefix('-') {
        Some(plain) => plain.to_owned(),
        None => format!("-{label}"),
    };
    for table in tables.iter_mut() {
        let dofs = table.entry("dofs").or_insert_with(|| Item::Table(Table::new()));
        let dofs = dofs.as_table_like_mut().ok_or("write [frf.dofs] as a table, so that one can be mended")?;
        for name in &labels {
            let key = file_dof(project, name).ok_or(format!("DOF {name} has no node and direction"))?;
            let there =
                dofs.iter().any(|(_, item)| written_label(item).is_some_and(|t| t.trim_start_matches('-') == *name));
            if !there {
                dofs.insert(&key, value(*name));
            }
        }
        let keys: Vec<String> = dofs.iter().map(|(key, _)| key.to_owned()).collect();
        for key in keys {
            let Some(now) = dofs.get(&key).and_then(written_label) else { continue };
            let (minus, plain) = (now.starts_with('-'), now.trim_start_matches('-').to_owned());
            let Some(at) = labels.iter().position(|name| *name == plain) else { continue };
            match fault.fault {
                Fault::Unreliable(_) => {}
                Fault::Factor(-1.0) => {
                    dofs.insert(&key, value(reversed(&now)));
                }
                Fault::Factor(_) => {
                    return Err("frequency responses have no factor a channel; mend the file".to_owned());
                }
                Fault::Exchanged => {
                    let other = labels[1 - at];
                    dofs.insert(&key, value(if minus { reversed(other) } else { other.to_owned() }));
                }
            }
        }
    }
    Ok(())
}

/// A label, written as text or as a whole number.
fn written_label(item: &Item) -> Option<String> {
    item.as_str().map(str::to_owned).or_else(|| item.as_integer().map(|i| i.to_string()))
}

/// A DOF as Universal Files name it.
fn file_dof(project: &Project, name: &str) -> Option<String> {
    let structure = &project.structure;
    let dof = &structure.dofs()[structure.dof(name)?];
    let direction = match dof.direction {
        Direction::X => "+X",
        Direction::Y => "+Y",
        Direction::Z => "+Z",
        Direction::Rx => "+RX",
        Direction::Ry => "+RY",
        Direction::Rz => "+RZ",
        Direction::Q => return None,
    };
    Some(format!("{}:{direction}", structure.nodes()[dof.node].label))
}
