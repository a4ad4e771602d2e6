//! Text tables: CSV and TXT of any dialect, and LabVIEW measurement files.

mod decode;
mod dialect;
mod lvm;
mod names;
mod torn;

use crate::contents::{Contents, Format};
use crate::error::{Fault, Read};
use crate::note::Note;
use crate::source::Source;
use crate::table::{Blocks, TableSource, finish};
pub(crate) use decode::decode;
use decode::rows;
use dialect::{Dialect, Separator};
pub use names::listed_names;
use std::path::Path;

/// Largest text file that is read, bytes: its numbers are kept in memory.
const MOST_TEXT: u64 = 4 << 30;

/// Opens the text file at `path`.
pub(crate) fn open(path: &Path) -> Read<(Contents, Box<dyn Source>)> {
    let length = std::fs::metadata(path)?.len();
    if length > MOST_TEXT {
        let size = length as f64 * 1e-9;
        return Err(Fault::new(format!(
            "is {size:.0} GB of text, too much for memory; cut it or export it as TDMS or HDF5"
        )));
    }
    read(&std::fs::read(path)?)
}

/// Opens the bytes of a text file.
pub(crate) fn read(bytes: &[u8]) -> Read<(Contents, Box<dyn Source>)> {
    let (text, note) = decode(bytes)?;
    // A lone CR ended lines once.
    let text = if !text.contains('\n') && text.contains('\r') { text.replace('\r', "\n") } else { text.into_owned() };
    let text = text.as_str();
    if text.trim().is_empty() {
        return Err(Fault::new("is empty; export the record again"));
    }
    let (mut contents, source) =
        if text.trim_start().starts_with("LabVIEW Measurement") { lvm::read(text)? } else { table(text)? };
    contents.notes.extend(note.map(Note::from));
    Ok((contents, Box::new(source)))
}

fn table(text: &str) -> Read<(Contents, TableSource)> {
    let Some(dialect) = Dialect::sniff(text) else {
        return Err(Fault::new(
            "is text without a row of numbers; export the measurement with its samples (names of the columns of another file: import both together)",
        ));
    };
    if let Some((line, problem)) = torn::decimal_commas(text, dialect) {
        return Err(Fault::line(line, problem));
    }
    let mut blocks = Blocks::default();
    let mut cells = Vec::new();
    let mut last = 0;
    for (line, row) in rows(text) {
        dialect.cells(&row, &mut cells);
        blocks.push(line, &cells)?;
        last = line;
    }
    let (blocks, behind) = blocks.finish();
    if blocks.is_empty() {
        return Err(Fault::line(last, "there is no row of numbers; export the measurement with its samples"));
    }
    let letter = matches!(dialect.separator, Separator::Letter(_));
    let mut contents = Contents::new(if letter { Format::Csv } else { Format::Txt });
    if behind > 0 {
        contents.notes.push(format!("{behind} lines of text follow the last numbers").into());
    }
    let (sets, columns) = finish("", blocks);
    contents.sets = sets;
    // One column has no separator to tell the format by.
    if contents.sets.iter().all(|set| set.channels.len() + usize::from(!set.axis_unit.is_empty()) < 2)
        && !text.contains([',', ';', '\t'])
    {
        contents.format = Format::Txt;
    }
    Ok((contents, TableSource { sets: columns }))
}
