//! Archives of NumPy arrays (`.npz`): a ZIP file with one `.npy` an array.

use crate::contents::{Contents, Format};
use crate::error::{Fault, Read};
use crate::npy::Header;
use crate::source::Source;
use crate::tree::{Arrays, Entry, Flat, Node, TreeSource, sets};
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use zip::ZipArchive;

struct Npz {
    path: PathBuf,
}

fn archive(path: &Path) -> Read<ZipArchive<BufReader<File>>> {
    ZipArchive::new(BufReader::new(File::open(path)?)).map_err(wrong)
}

fn wrong(error: zip::result::ZipError) -> Fault {
    Fault::new(format!("is no readable ZIP archive ({error}); it was cut short or is damaged: save it again"))
}

/// Opens an archive of NumPy arrays.
pub(crate) fn open(path: &Path) -> Read<(Contents, Box<dyn Source>)> {
    let mut zip = archive(path)?;
    let mut entries = Vec::new();
    for id in 0..zip.len() {
        let mut file = zip.by_index(id).map_err(wrong)?;
        let name = file.name().map_err(wrong)?.trim_end_matches(".npy").to_owned();
        let within = |fault: Fault| fault.within(format!("array \"{name}\""));
        let header = Header::read(&mut file).map_err(within)?;
        let available = file.size();
        let texts = header.texts(&mut file);
        let node = match texts {
            Some(texts) => Node::Text(texts),
            // Packed arrays are unpacked whole for their first values.
            None => header.node(id, available, |wanted| Ok(header.values(&mut file)?.peek(wanted))).map_err(within)?,
        };
        entries.push(Entry::new(name, node));
    }
    let arrays = Npz { path: path.to_owned() };
    let (sets, places) = sets(&entries, &[], &arrays)?;
    let mut contents = Contents::new(Format::Npz);
    contents.sets = sets;
    Ok((contents, Box::new(TreeSource::new(Box::new(arrays), places))))
}

impl Arrays for Npz {
    fn read(&self, id: usize) -> Read<Flat> {
        let mut zip = archive(&self.path)?;
        let mut file = zip.by_index(id).map_err(wrong)?;
        Header::read(&mut file)?.values(&mut file)
    }
}
