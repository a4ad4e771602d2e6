//! The format of a file by its first bytes.

use crate::contents::Contents;
use crate::error::{Fault, Read};
use crate::source::Source;
use crate::{hdf5, mat, npy, npz, tdms, text, universal, wav, xlsx};
use std::fs::File;
use std::io::{BufReader, Read as _, Seek, SeekFrom};
use std::path::Path;

/// Bytes that are looked at.
const START: u64 = 4096;

/// Opens a file of any format.
pub(crate) fn open(path: &Path) -> Read<(Contents, Box<dyn Source>)> {
    let kind = std::fs::metadata(path)?;
    if kind.is_dir() {
        return Err(Fault::new("is a folder; name a file in it"));
    }
    let mut file = File::open(path)?;
    let mut start = Vec::new();
    file.by_ref().take(START).read_to_end(&mut start)?;
    if start.is_empty() {
        return Err(Fault::new("is empty (0 bytes); export the record again"));
    }
    if start.starts_with(b"TDSm") {
        return tdms::open(path);
    }
    if start.starts_with(b"TDSh") {
        return Err(Fault::new("is the index of a TDMS file; open the .tdms file beside it"));
    }
    if start.starts_with(b"MATLAB 7.3") && hdf5_at(&mut file)? {
        return hdf5::open(path, true);
    }
    if hdf5_at(&mut file)? {
        return hdf5::open(path, false);
    }
    if start.len() >= 128 && matches!(&start[124..128], [0, 1, b'I', b'M'] | [1, 0, b'M', b'I']) {
        return mat::open_v5(path);
    }
    if start.starts_with(b"MATLAB 5.0 MAT-file") || start.starts_with(b"MATLAB 7.3") {
        return Err(Fault::byte(124, "the header of the MAT file is damaged or cut short; save the file again"));
    }
    if start.starts_with(b"\x93NUMPY") {
        return npy::open(path);
    }
    if start.starts_with(b"RIFF") && start.get(8..12) == Some(b"WAVE") {
        return wav::open(path);
    }
    if start.starts_with(b"PK\x03\x04") {
        return zipped(path, file);
    }
    other(path, &start, kind.len())
}

/// First bytes of formats that are known and not read, and what to do with such a file.
const NOT_READ: [(&[u8], &str); 23] = [
    (
        b"\xD0\xCF\x11\xE0",
        "is a document of before 2007 or a scan of Polytec (SVD); save it as XLSX or CSV, a scan as Universal File",
    ),
    (b"%PDF", "is a PDF document; export the measurement as CSV, UFF or MAT"),
    (b"\x1F\x8B", "is packed by gzip; unpack it first (an RDS file of R: save its table by write.csv)"),
    (b"BZh", "is packed by bzip2; unpack it first"),
    (b"\xFD7zXZ", "is packed by xz; unpack it first"),
    (b"\x28\xB5\x2F\xFD", "is packed by zstd; unpack it first"),
    (b"7z\xBC\xAF", "is a 7z archive; unpack it first"),
    (b"Rar!", "is a RAR archive; unpack it first"),
    (b"RF64", "is a WAV file above 4 GB (RF64); cut it into shorter ones"),
    (b"CDF\x01", "is a NetCDF file of version 3; save it as NetCDF 4 or HDF5"),
    (b"CDF\x02", "is a NetCDF file of version 3; save it as NetCDF 4 or HDF5"),
    (b"\x89PNG", "is a picture; export the measurement as CSV, UFF or MAT"),
    (b"PAR1", "is a Parquet file; save its table as CSV, in Python by pandas: read_parquet(FILE).to_csv(NEW)"),
    (b"ARROW1", "is a Feather file; save its table as CSV, in Python by pandas: read_feather(FILE).to_csv(NEW)"),
    (b"FEA1", "is a Feather file; save its table as CSV, in Python by pandas: read_feather(FILE).to_csv(NEW)"),
    (b"\x80\x02", PICKLE),
    (b"\x80\x03", PICKLE),
    (b"\x80\x04", PICKLE),
    (b"\x80\x05", PICKLE),
    (b"SQLite format 3\0", "is a SQLite database; export the table of the measurement as CSV"),
    (b"RDX", "is data of R; save the table by write.csv"),
    (b"MDF     ", "is a file of ASAM MDF; export it as MAT, HDF5, TDMS or CSV"),
    (b"UnFinMF ", "is a file of ASAM MDF that was not finished; finish it, and export it as MAT, HDF5, TDMS or CSV"),
];
/// Objects of Python run code where they are read.
const PICKLE: &str =
    "is a pickle of Python, which may run code when it is read; save its arrays by numpy.savez, a table by to_csv";

/// What has no mark of its own, and what is known and not read.
fn other(path: &Path, start: &[u8], length: u64) -> Read<(Contents, Box<dyn Source>)> {
    if universal::is_universal(start, path) {
        return universal::open(path);
    }
    if mat::is_v4(start, length) {
        return mat::open_v4(path);
    }
    // The oldest pickles are text: a dictionary or a list, or an object by its module.
    if [&b"(dp0\n"[..], b"(lp0\n", b"ccopy_reg\n", b"cnumpy", b"cpandas"].iter().any(|mark| start.starts_with(mark)) {
        return Err(Fault::new(PICKLE));
    }
    if let Some((_, problem)) = NOT_READ.iter().find(|(mark, _)| start.starts_with(mark)) {
        return Err(Fault::new(*problem));
    }
    text::open(path)
}

/// Whether the mark of HDF5 stands at 0, 512, 1024, 2048 and so on, where a user block ends.
fn hdf5_at(file: &mut File) -> Read<bool> {
    let length = file.metadata()?.len();
    let mut at = 0;
    while at + 8 <= length && at <= 1 << 20 {
        let mut mark = [0; 8];
        file.seek(SeekFrom::Start(at))?;
        file.read_exact(&mut mark)?;
        if mark == *b"\x89HDF\r\n\x1a\n" {
            return Ok(true);
        }
        at = if at == 0 { 512 } else { at * 2 };
    }
    Ok(false)
}

/// A spreadsheet or an archive of arrays.
fn zipped(path: &Path, mut file: File) -> Read<(Contents, Box<dyn Source>)> {
    file.seek(SeekFrom::Start(0))?;
    let wrong = |error| Fault::new(format!("is a damaged ZIP archive ({error}); copy or save it again"));
    let zip = zip::ZipArchive::new(BufReader::new(file)).map_err(wrong)?;
    let names: Vec<String> = zip.file_names().filter_map(Result::ok).map(std::borrow::Cow::into_owned).collect();
    if !names.is_empty() && names.iter().all(|name| name.ends_with(".npy")) {
        return npz::open(path);
    }
    if names.iter().any(|name| name.starts_with("xl/")) {
        return xlsx::open(BufReader::new(File::open(path)?));
    }
    Err(Fault::new("is a ZIP archive that is neither XLSX nor NPZ; unpack it first"))
}
