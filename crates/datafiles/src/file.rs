//! Opening a file and reading its channels.

use crate::contents::{Axis, Contents, Kind, Set};
use crate::detect;
use crate::error::{Error, Fault, Read};
use crate::gathered;
use crate::guard::guarded;
use crate::parts::{self, Pairing};
use crate::shared_times;
use crate::source::{MOST_VALUES, Source};
use crate::units::{is_unit, split};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use uff::Values;

/// Most notes of a set.
const MOST_NOTES: usize = 64;

/// A file that was opened: its tree, and its channels on request.
pub struct DataFile {
    path: PathBuf,
    contents: Contents,
    source: Box<dyn Source>,
}

impl std::fmt::Debug for DataFile {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("DataFile").field("path", &self.path).field("contents", &self.contents).finish_non_exhaustive()
    }
}

/// Opens the file at `path`: tells its format by its content and lists what is in it. Values are left in the file.
///
/// # Errors
/// [`Error`] for a file that cannot be read, is of no known format, or is damaged where its tree is written.
pub fn open(path: &Path) -> Result<DataFile, Error> {
    opened(path, parts::by_name)
}

/// Opens the file at `path` as [`open`] does, its real columns taken two by two as complex channels.
///
/// # Errors
/// As [`open`].
pub fn open_paired(path: &Path, pairing: Pairing) -> Result<DataFile, Error> {
    opened(path, |contents, source| parts::in_turn(contents, source, pairing))
}

type Tree = (Contents, Box<dyn Source>);

fn opened(path: &Path, join: impl FnOnce(Contents, Box<dyn Source>) -> Read<Tree>) -> Result<DataFile, Error> {
    let name = path.display().to_string();
    let opened = guarded(|| {
        let (contents, source) = detect::open(path)?;
        let (contents, source) = parts::among_channels(contents, source)?;
        let (contents, source) = join(contents, source)?;
        let (contents, source) = gathered::one_channel_each(contents, source)?;
        shared_times::beside(contents, source)
    });
    let (mut contents, source) = opened.map_err(|fault| fault.of(&name))?;
    units_of_names(&mut contents);
    tell_apart(&mut contents);
    Ok(DataFile { path: path.to_owned(), contents, source })
}

/// Channels without a unit have that which stands in brackets at the end of their name: `Acc 1 (g)`. The name stays.
fn units_of_names(contents: &mut Contents) {
    let measured = |set: &&mut Set| !matches!(set.kind, Kind::Matrix | Kind::Geometry | Kind::Shape);
    for channel in contents.sets.iter_mut().filter(measured).flat_map(|set| &mut set.channels) {
        let bracketed = channel.name.trim_end().ends_with([']', ')']);
        if let (true, (_, unit)) = (channel.unit.is_empty() && bracketed, split(&channel.name))
            && is_unit(&unit)
        {
            channel.unit = unit;
        }
    }
}

/// Channels of one set that have the same name are numbered from the second on: `Acc`, `Acc (2)`.
fn tell_apart(contents: &mut Contents) {
    for set in &mut contents.sets {
        let mut seen: HashMap<String, usize> = set.channels.iter().map(|channel| (channel.name.clone(), 0)).collect();
        if seen.len() == set.channels.len() {
            continue;
        }
        for channel in &mut set.channels {
            let Some(count) = seen.get_mut(&channel.name) else { continue };
            *count += 1;
            let mut number = *count;
            while number > 1 && seen.contains_key(&format!("{} ({number})", channel.name)) {
                number += 1;
            }
            if number > 1 {
                let again = format!("{} ({number})", channel.name);
                set.notes.push(
                    format!("\"{}\" stands twice in the file: the second is called \"{again}\"", channel.name).into(),
                );
                seen.insert(again.clone(), 1);
                channel.name = again;
            }
        }
        set.notes.truncate(MOST_NOTES);
    }
}

impl DataFile {
    /// What is in the file.
    pub fn contents(&self) -> &Contents {
        &self.contents
    }

    /// Path as it was given.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Reads channel number `channel` of set number `set`, in the unit of the file.
    ///
    /// # Errors
    /// [`Error`] for a channel that the file does not have, that is damaged, or that is too large for memory.
    pub fn read(&self, set: usize, channel: usize) -> Result<Values, Error> {
        self.check(set, channel)?;
        guarded(|| self.source.read(set, channel)).map_err(|fault| self.error(set, channel, fault))
    }

    /// Reads several channels of set number `set`, in one pass over the file where its rows or chunks hold them together.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn read_several(&self, set: usize, channels: &[usize]) -> Result<Vec<Values>, Error> {
        channels.iter().try_for_each(|&channel| self.check(set, channel))?;
        // Rows are passed from their first channel to the last.
        let mut order: Vec<usize> = (0..channels.len()).collect();
        order.sort_by_key(|&i| channels[i]);
        let ascending: Vec<usize> = order.iter().map(|&i| channels[i]).collect();
        if channels.len() > 1
            && ascending.windows(2).all(|pair| pair[0] < pair[1])
            && let Some(Ok(values)) = guarded(|| Ok(self.source.together(set, &ascending))).unwrap_or_default()
        {
            let mut found: Vec<(usize, Values)> = order.into_iter().zip(values).collect();
            found.sort_by_key(|(i, _)| *i);
            return Ok(found.into_iter().map(|(_, values)| values).collect());
        }
        // One by one, also where that failed: so it is told which channel is damaged.
        channels.iter().map(|&channel| self.read(set, channel)).collect()
    }

    /// Reads the abscissa of a channel in the unit of the set's abscissa; none where the file says none.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn axis(&self, set: usize, channel: usize) -> Result<Option<Vec<f64>>, Error> {
        self.check(set, channel)?;
        let entry = &self.contents.sets[set].channels[channel];
        match entry.axis {
            Axis::None => Ok(None),
            Axis::Even { start, step } => Ok(Some((0..entry.count).map(|i| start + i as f64 * step).collect())),
            Axis::Stored { .. } => {
                guarded(|| self.source.axis(set, channel)).map(Some).map_err(|fault| self.error(set, channel, fault))
            }
        }
    }

    fn error(&self, set: usize, channel: usize, fault: Fault) -> Error {
        let set = &self.contents.sets[set];
        let part = format!("set \"{}\", channel \"{}\"", set.name, set.channels[channel].name);
        fault.within(part).of(&self.path.display().to_string())
    }

    fn check(&self, set: usize, channel: usize) -> Result<(), Error> {
        let name = self.path.display().to_string();
        let sets = &self.contents.sets;
        let Some(entry) = sets.get(set).and_then(|set| set.channels.get(channel)) else {
            return Err(Fault::new(format!("there is no channel {channel} in set {set}; list the contents")).of(&name));
        };
        if entry.count > MOST_VALUES {
            let problem = format!(
                "has {} values, {:.0} GB in memory; cut the record into shorter ones",
                entry.count,
                entry.count as f64 * 8e-9
            );
            return Err(self.error(set, channel, Fault::new(problem)));
        }
        Ok(())
    }
}
