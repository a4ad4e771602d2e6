//! What becomes of a fault of a measuring channel: its mapping is mended.

mod responses;

use super::command::{Command, Mending};
use super::refusal::Refusal;
use super::sensors::{further, set_sensor};
use crate::diagnosis::channels::{ChannelFault, Fault};
use crate::effects::{Effect, Place, Source};
use crate::exchange::Project;
use crate::exchange::mapping::ChannelTable;
use crate::exchange::project::file::ProjectFile;
use crate::measurement::channel::parse_name;
use crate::measurement::{Channel, Quantity};
use crate::structure::Structure;

/// Behind the name of a channel that not all records have; no label ends so.
const OF_SOME: &str = " ?";

/// The command that mends a fault.
///
/// # Errors
/// [`Refusal::NotMended`]: the fault is none that a mapping can mend.
pub(super) fn command(fault: &ChannelFault, project: &Project) -> Result<Command, Refusal> {
    let factor = match fault.fault {
        Fault::Factor(factor) | Fault::Common(factor) => Some(factor),
        Fault::Exchanged | Fault::Elsewhere(_) | Fault::Late(_) => None,
        Fault::Unreliable(_) => {
            return Err(not_mended(&fault.channels, "a channel that scatters has no mapping that mends it"));
        }
    };
    let elsewhere = matches!(fault.fault, Fault::Elsewhere(_));
    let late = if let Fault::Late(delay) = fault.fault { Some(delay) } else { None };
    let (channels, driven) = (fault.channels.clone(), driven(project));
    Ok(Command::MendChannels(Mending { channels, factor, late, elsewhere, driven, records: of_records(project) }))
}

fn not_mended(channels: &[String], reason: &str) -> Refusal {
    Refusal::NotMended { channel: channels.join(" and "), reason: reason.to_owned() }
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

/// The channels of the records, each once; those that not all have end in [`OF_SOME`].
fn of_records(project: &Project) -> Vec<String> {
    let names = |channels: &[Channel]| channels.iter().map(ToString::to_string).collect::<Vec<_>>();
    let steady = project.runs.iter().filter_map(|run| run.record.as_ref()).map(|record| names(record.channels()));
    let all: Vec<Vec<String>> = steady.chain(project.transient_runs.iter().map(|run| names(run.channels()))).collect();
    let mut different: Vec<String> = Vec::new();
    for name in all.iter().flatten() {
        if !different.contains(name) {
            different.push(name.clone());
        }
    }
    let everywhere = |name: &String| all.iter().all(|own| own.contains(name));
    let marked = |name: String| if everywhere(&name) { name } else { name + OF_SOME };
    different.into_iter().map(marked).collect()
}

/// Mends the mapping of the channels: their `[[channel]]`, those that are written for all channels of the records, and the
/// `[frf.dofs]`; of a channel that is late its `[[sensor]]`.
pub(super) fn mend(file: &mut ProjectFile, mending: &Mending, on: &Structure) -> Result<(), Refusal> {
    if let Some(more) = mending.late {
        let channel = &mending.channels[0];
        let late = Source::known(Effect::Delay, Place::Channel(channel.clone()), &[more]);
        return set_sensor(file, channel, further(file, channel, &late), on);
    }
    let cannot = |reason: &str| not_mended(&mending.channels, reason);
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
            return Err(cannot("no record has it"));
        }
        file.channel = mending.records.iter().filter_map(|name| plain(name)).collect();
    }
    in_mapping(&mut file.channel, mending).map_err(|reason| cannot(&reason))
}

/// The table of a channel that a record names as the project does.
fn plain(marked: &str) -> Option<ChannelTable> {
    let name = marked.strip_suffix(OF_SOME).unwrap_or(marked);
    let (quantity, dof) = parse_name(name).ok()?;
    let optional = name != marked;
    let name = name.to_owned();
    let table =
        ChannelTable { name, set: None, quantity, dof, unit: None, sign: None, factor: None, delay: None, optional };
    Some(table)
}

/// Mends every table of the channels: one channel has several where it is of several sets.
fn in_mapping(tables: &mut [ChannelTable], mending: &Mending) -> Result<(), String> {
    let rows_of = |name: &String| {
        let rows: Vec<usize> = (0..tables.len()).filter(|&row| tables[row].channel() == *name).collect();
        if rows.is_empty() { Err(format!("no [[channel]] is {name}")) } else { Ok(rows) }
    };
    if mending.elsewhere {
        let label = responses::label_of(&mending.channels[1]);
        rows_of(&mending.channels[0])?.into_iter().for_each(|row| label.clone_into(&mut tables[row].dof));
        return Ok(());
    }
    let rows = mending.channels.iter().map(rows_of).collect::<Result<Vec<_>, _>>()?;
    match (mending.factor, &rows[..]) {
        (Some(factor), rows) => rows.iter().flatten().for_each(|&row| divide(&mut tables[row], factor)),
        (None, [first, second]) => {
            let [a, b] = [first, second].map(|rows| tables[rows[0]].dof.clone());
            first.iter().for_each(|&row| tables[row].dof.clone_from(&b));
            second.iter().for_each(|&row| tables[row].dof.clone_from(&a));
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
