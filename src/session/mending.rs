//! What becomes of a fault of a measuring channel: its mapping is mended. The command line and the window mend by the same
//! command.

use super::command::{Command, Mending};
use super::refusal::Refusal;
use crate::diagnosis::channels::{ChannelFault, Fault};
use crate::exchange::Project;
use crate::exchange::mapping::ChannelTable;
use crate::exchange::project::file::{Label, ProjectFile};
use crate::exchange::project::frf::FrfTable;
use crate::measurement::channel::parse_name;
use crate::structure::{Direction, Structure};

/// The command that mends a fault.
///
/// # Errors
/// One sentence: the fault is none that a mapping can mend, or the records do not have one mapping.
pub(crate) fn command(fault: &ChannelFault, project: &Project) -> Result<Command, String> {
    let factor = match fault.fault {
        Fault::Factor(factor) | Fault::Common(factor) => Some(factor),
        Fault::Exchanged => None,
        Fault::Unreliable(_) => return Err("a channel that scatters has no mapping that mends it".to_owned()),
    };
    Ok(Command::MendChannels(Mending { channels: fault.channels.clone(), factor, records: of_records(project) }))
}

/// The channels of the records; none where their files have different ones.
fn of_records(project: &Project) -> Vec<String> {
    let steady = project.runs.iter().filter_map(|run| run.record.as_ref()).map(|record| record.channels());
    let all = steady.map(<[_]>::iter).map(|channels| channels.map(ToString::to_string).collect::<Vec<_>>());
    let others = project.transient_runs.iter().map(|run| run.channels().iter().map(ToString::to_string).collect());
    let mut all = all.chain(others);
    let first: Vec<String> = all.next().unwrap_or_default();
    let same = |other: Vec<String>| other.len() == first.len() && first.iter().all(|name| other.contains(name));
    if all.all(same) { first } else { Vec::new() }
}

/// Mends the mapping of the channels: their `[[channel]]`, those that are written for all channels of the records, and the
/// `[frf.dofs]`.
pub(super) fn mend(file: &mut ProjectFile, mending: &Mending, on: &Structure) -> Result<(), Refusal> {
    let cannot =
        |reason: &str| Refusal::NotMended { channel: mending.channels.join(" and "), reason: reason.to_owned() };
    if !file.harmonics.is_empty() {
        return Err(cannot("its harmonics were fitted elsewhere; mend their file"));
    }
    for table in &mut file.frf {
        in_responses(table, mending, on).map_err(|reason| cannot(&reason))?;
    }
    if file.run.is_empty() {
        return Ok(());
    }
    if file.channel.is_empty() {
        if mending.records.is_empty() {
            return Err(cannot("the records have different channels, so that one mapping does not hold for all"));
        }
        file.channel = mending.records.iter().filter_map(|name| plain(name)).collect();
    }
    in_mapping(&mut file.channel, mending).map_err(|reason| cannot(&reason))
}

/// The table of a channel that a record names as the project does.
fn plain(name: &str) -> Option<ChannelTable> {
    let (quantity, dof) = parse_name(name).ok()?;
    let name = name.to_owned();
    let table = ChannelTable {
        name,
        set: None,
        quantity,
        dof,
        unit: None,
        sign: None,
        factor: None,
        delay: None,
        optional: false,
    };
    Some(table)
}

fn in_mapping(tables: &mut [ChannelTable], mending: &Mending) -> Result<(), String> {
    let place = |name: &String| {
        tables.iter().position(|table| table.channel() == *name).ok_or_else(|| format!("no [[channel]] is {name}"))
    };
    let rows = mending.channels.iter().map(place).collect::<Result<Vec<usize>, _>>()?;
    match (mending.factor, &rows[..]) {
        (Some(factor), rows) => rows.iter().for_each(|&row| divide(&mut tables[row], factor)),
        (None, &[a, b]) => {
            let dof = tables[a].dof.clone();
            tables[a].dof = std::mem::replace(&mut tables[b].dof, dof);
        }
        (None, _) => return Err("two channels are exchanged, no more and no fewer".to_owned()),
    }
    Ok(())
}

/// A channel that reads `factor` times too large, as it should read.
fn divide(table: &mut ChannelTable, factor: f64) {
    if factor < 0.0 {
        table.sign = Some(-table.sign.unwrap_or(1)).filter(|sign| *sign != 1);
    }
    if factor.abs() != 1.0 {
        table.factor = Some(table.factor.unwrap_or(1.0) / factor.abs());
    }
}

/// Turns or exchanges the DOFs of frequency responses, or scales all of them.
fn in_responses(table: &mut FrfTable, mending: &Mending, on: &Structure) -> Result<(), String> {
    let labels: Vec<&str> = mending.channels.iter().filter_map(|name| Some(name.split_once('@')?.1)).collect();
    let of_force = mending.channels.iter().all(|name| name.starts_with("force@"));
    match mending.factor {
        // One scale holds for all functions of a file.
        Some(factor) if of_force || mending.channels.len() > 1 => {
            let scale = table.scale.unwrap_or(1.0);
            table.scale = Some(if of_force { scale * factor } else { scale / factor });
            Ok(())
        }
        Some(factor) if factor != -1.0 => Err("frequency responses have no factor a channel; mend the file".to_owned()),
        _ => turn_or_exchange(table, &labels, mending.factor.is_some(), on),
    }
}

/// Turns DOFs of frequency responses, or exchanges two of them.
fn turn_or_exchange(table: &mut FrfTable, labels: &[&str], turn: bool, on: &Structure) -> Result<(), String> {
    for label in labels {
        if !table.dofs.values().any(|known| known.0.trim_start_matches('-') == *label) {
            let key = of_file(on, label).ok_or_else(|| format!("DOF {label} has no node and direction"))?;
            table.dofs.insert(key, Label((*label).to_owned()));
        }
    }
    for known in table.dofs.values_mut() {
        let (minus, plain) = (known.0.starts_with('-'), known.0.trim_start_matches('-').to_owned());
        let Some(at) = labels.iter().position(|label| *label == plain) else { continue };
        let other = labels.get(1 - at.min(1)).map_or(plain.clone(), |other| (*other).to_owned());
        let (minus, plain) = if turn { (!minus, plain) } else { (minus, other) };
        known.0 = if minus { format!("-{plain}") } else { plain };
    }
    Ok(())
}

/// A DOF as Universal Files name it.
fn of_file(structure: &Structure, label: &str) -> Option<String> {
    let dof = &structure.dofs()[structure.dof(label)?];
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
