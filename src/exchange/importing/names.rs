//! Names of channels in a file of their own, one a line, beside a table or an array that has none.

use super::error::Result;
use super::request::Request;
use crate::exchange::mapping::{Proposal, propose};
use dashpot_datafiles::units::split;
use dashpot_datafiles::{Contents, listed_names, open};
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// The request without a file that lists names, whose names are kept; as it is where several files or all list names.
pub(super) fn taken(request: &Request) -> Cow<'_, Request> {
    let lists: Vec<(&PathBuf, Vec<String>)> =
        request.files.iter().filter_map(|file| Some((file, listed_names(file)?))).collect();
    let [(list, names)] = &lists[..] else { return Cow::Borrowed(request) };
    let files: Vec<PathBuf> = request.files.iter().filter(|file| file != list).cloned().collect();
    if files.is_empty() {
        return Cow::Borrowed(request);
    }
    Cow::Owned(Request { files, names: names.clone(), ..request.clone() })
}

/// What a file proposes, its columns called as the list has them; the mapping has the names of the file.
pub(super) fn proposed(request: &Request, file: &Path) -> Result<Proposal> {
    let file = open(file)?;
    let mut contents = file.contents().clone();
    let renamed = rename(&mut contents, &request.names);
    let mut proposal = propose(&contents);
    for table in proposal.channels.iter_mut().chain(&mut proposal.uncalibrated) {
        if let Some(column) = renamed.iter().find(|column| column.listed == table.name) {
            table.name.clone_from(&column.own);
            // The file itself does not say the unit.
            table.unit = table.unit.take().or_else(|| column.unit.clone());
        }
    }
    Ok(proposal)
}

/// A column that a list names: its name there and in the file, and its unit where only the list says it.
struct Column {
    listed: String,
    own: String,
    unit: Option<String>,
}

/// Gives the columns of sets without names those of the list, where it has as many.
fn rename(contents: &mut Contents, names: &[String]) -> Vec<Column> {
    let mut renamed = Vec::new();
    for set in &mut contents.sets {
        let places: Option<Vec<usize>> = set.channels.iter().map(|channel| place(&channel.name)).collect();
        let Some(places) = places.filter(|places| places.iter().max() == Some(&names.len())) else { continue };
        for (channel, place) in set.channels.iter_mut().zip(places) {
            let (listed, unit) = split(&names[place - 1]);
            let own = std::mem::replace(&mut channel.name, listed.clone());
            let unit = Some(unit).filter(|unit| channel.unit.is_empty() && !unit.is_empty());
            channel.unit = unit.clone().unwrap_or_else(|| channel.unit.clone());
            renamed.push(Column { listed, own, unit });
        }
    }
    renamed
}

/// The number of a column that has no name of its own: `column 3`, `data[3]`.
fn place(name: &str) -> Option<usize> {
    let number = name.strip_prefix("column ").or_else(|| name.strip_suffix(']')?.rsplit_once('[').map(|(_, n)| n))?;
    number.parse().ok().filter(|&number| number > 0)
}
