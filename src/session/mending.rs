//! What becomes of a fault of a measuring channel: its mapping is mended. The command line and the window mend by the same
//! command.

mod responses;

use super::command::{Command, Mending};
use super::refusal::Refusal;
use crate::diagnosis::channels::{ChannelFault, Fault};
use crate::exchange::Project;
use crate::exchange::mapping::ChannelTable;
use crate::exchange::project::file::ProjectFile;
use crate::measurement::Quantity;
use crate::measurement::channel::parse_name;
use crate::structure::Structure;

/// The command that mends a fault.
///
/// # Errors
/// One sentence: the fault is none that a mapping can mend, or the records do not have one mapping.
pub(crate) fn command(fault: &ChannelFault, project: &Project) -> Result<Command, String> {
    let factor = match fault.fault {
        Fault::Factor(factor) | Fault::Common(factor) => Some(factor),
        Fault::Exchanged | Fault::Elsewhere(_) => None,
        Fault::Unreliable(_) => return Err("a channel that scatters has no mapping that mends it".to_owned()),
    };
    let elsewhere = matches!(fault.fault, Fault::Elsewhere(_));
    let (channels, driven) = (fault.channels.clone(), driven(project));
    Ok(Command::MendChannels(Mending { channels, factor, elsewhere, driven, records: of_records(project) }))
}

/// Labels of the DOFs where the forces of frequency responses act.
fn driven(project: &Project) -> Vec<String> {
    let runs = project.runs.iter().filter(|run| run.per_unit_force);
    let forces = runs.flat_map(|run| &run.fit.channels).filter(|fit| fit.channel.quantity == Quantity::Force);
    let mut labels: Vec<String> = forces.map(|fit| fit.channel.label.clone()).collect();
    labels.sort_unstable();
    labels.dedup();
    labels
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
        responses::mend(table, mending, on).map_err(|reason| cannot(&reason))?;
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
    if mending.elsewhere {
        let [row, label] = [&mending.channels[0], &mending.channels[1]];
        let row = place(row)?;
        responses::label_of(label).clone_into(&mut tables[row].dof);
        return Ok(());
    }
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
