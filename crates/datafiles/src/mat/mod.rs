//! MAT files of versions 4 to 7 (version 7.3 is HDF5).

mod input;
mod numbers;
mod v4;
mod v5;

use crate::contents::{Contents, Format};
use crate::error::Read;
use crate::source::Source;
use crate::tree::{TreeSource, sets};
use std::path::Path;

/// Opens a MAT file of version 5 to 7.
pub(crate) fn open_v5(path: &Path) -> Read<(Contents, Box<dyn Source>)> {
    let (entries, arrays) = v5::tree(path)?;
    finish(&entries, Box::new(arrays))
}

/// Opens a MAT file of version 4.
pub(crate) fn open_v4(path: &Path) -> Read<(Contents, Box<dyn Source>)> {
    let (entries, arrays) = v4::tree(path)?;
    finish(&entries, Box::new(arrays))
}

pub(crate) use v4::is_v4;

fn finish(entries: &[crate::tree::Entry], arrays: Box<dyn crate::tree::Arrays>) -> Read<(Contents, Box<dyn Source>)> {
    let (sets, places) = sets(entries, &[], arrays.as_ref())?;
    let mut contents = Contents::new(Format::Mat);
    contents.sets = sets;
    Ok((contents, Box::new(TreeSource::new(arrays, places))))
}
