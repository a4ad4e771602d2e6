//! A channel of a set that is the abscissa of the others: a column of times in TDMS, HDF5 and MAT files without increments.

use super::source::{Column, Joined};
use crate::axis::{ascending, even_step, kind_of};
use crate::contents::{Axis, Contents, Kind, Number, Set};
use crate::error::Read;
use crate::source::Source;
use uff::Values;

/// Most values of a channel that is read to see whether it is an abscissa.
const MOST_READ: u64 = 1 << 24;

/// A channel that is an abscissa.
struct Found {
    channel: usize,
    step: Option<f64>,
    kind: Kind,
    /// Prefix of the names of the channels that it is for; none: for all of the set.
    array: Option<String>,
}

/// Gives the channels of a set the abscissa that stands among them, where the file says none.
pub(crate) fn among_channels(mut contents: Contents, source: Box<dyn Source>) -> Read<(Contents, Box<dyn Source>)> {
    let mut columns: Vec<Vec<Column>> =
        contents.sets.iter().map(|set| (0..set.channels.len()).map(Column::Plain).collect()).collect();
    let mut any = false;
    for (s, set) in contents.sets.iter_mut().enumerate() {
        for found in in_set(s, set, source.as_ref())? {
            any |= give(set, &mut columns[s], &found);
        }
    }
    if !any {
        return Ok((contents, source));
    }
    Ok((contents, Box::new(Joined::new(source, columns))))
}

fn in_set(s: usize, set: &Set, source: &dyn Source) -> Read<Vec<Found>> {
    let mut found = Vec::new();
    if set.kind == Kind::Table && set.channels.iter().all(|channel| channel.axis == Axis::None) {
        for (c, channel) in set.channels.iter().enumerate() {
            let Some(kind) = kind_of(&channel.name, &channel.unit).filter(|_| set.channels.len() > 1) else { continue };
            if let Some(values) = rising(s, c, set, source)? {
                return Ok(vec![Found { channel: c, step: even_step(&values), kind, array: None }]);
            }
        }
    }
    // The first column of an array without names, where it rises evenly and does not count the rows.
    for (c, channel) in set.channels.iter().enumerate() {
        let Some(array) = channel.name.strip_suffix("[1]").filter(|_| matches!(set.kind, Kind::Table | Kind::Time))
        else {
            continue;
        };
        let second = format!("{array}[2]");
        if matches!(channel.axis, Axis::Stored { .. }) || set.channels.iter().all(|other| other.name != second) {
            continue;
        }
        let Some(step) = rising(s, c, set, source)?.as_deref().and_then(even_step) else { continue };
        let known = channel.axis.step();
        let fits = known.map_or(step != 1.0, |known| (known - step).abs() < 1e-6 * step);
        if fits && channel.count > 3 {
            found.push(Found { channel: c, step: Some(step), kind: Kind::Time, array: Some(array.to_owned()) });
        }
    }
    Ok(found)
}

fn rising(s: usize, c: usize, set: &Set, source: &dyn Source) -> Read<Option<Vec<f64>>> {
    let channel = &set.channels[c];
    let others = set.channels.iter().enumerate().any(|(i, other)| i != c && other.count == channel.count);
    // The first values tell most columns that are none, without reading: there may be one a test.
    let falls = channel.first.windows(2).any(|pair| matches!(pair, [Number::Real(a), Number::Real(b)] if b < a));
    if channel.complex || channel.count < 2 || channel.count > MOST_READ || !others || falls {
        return Ok(None);
    }
    Ok(match source.read(s, c)? {
        Values::Real(values) if ascending(&values) && values[0] < values[values.len() - 1] => Some(values),
        _ => None,
    })
}

/// Lays the abscissa under the channels that it is for; whether there are any.
fn give(set: &mut Set, columns: &mut [Column], found: &Found) -> bool {
    let count = set.channels[found.channel].count;
    let unit = set.channels[found.channel].unit.clone();
    let mut any = false;
    let members: Vec<usize> = (0..set.channels.len())
        .filter(|&c| c != found.channel && set.channels[c].count == count)
        .filter(|&c| {
            found.array.as_ref().is_none_or(|array| {
                set.channels[c].name.strip_prefix(array.as_str()).is_some_and(|rest| rest.starts_with('['))
            })
        })
        .collect();
    let alone = members.len() == 1;
    for &c in &members {
        set.channels[c].axis = Axis::Stored { step: found.step };
        columns[c] = Column::WithAxis(Box::new(columns[c].clone()), found.channel);
        any = true;
        // One signal beside its times has the name of the array.
        if let Some(array) = found.array.as_ref().filter(|_| alone) {
            set.channels[c].name.clone_from(array);
        }
    }
    if let Some(array) = found.array.as_ref().filter(|_| any) {
        set.channels[found.channel].name =
            if alone { format!("time of {array}") } else { set.channels[found.channel].name.clone() };
        set.notes.push(format!("the first column of {array} rises evenly: it is taken as the time in s").into());
    }
    if any && set.kind == Kind::Table {
        let complex = set.channels.iter().any(|channel| channel.complex);
        set.kind = if found.kind == Kind::Spectrum && complex { Kind::Frf } else { found.kind };
        let usual = if found.kind == Kind::Time { "s" } else { "Hz" };
        set.axis_unit = if unit.is_empty() { usual.to_owned() } else { unit };
    }
    any
}
