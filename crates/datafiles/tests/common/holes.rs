//! Files of gigabytes that are holes in which a few numbers stand, so that nothing large is kept or written; and what a
//! process has read and taken.

use std::fs::{File, OpenOptions};
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Numbers of a channel that is a vector, and rows of 16 channels (scripts/interchange/make_heads.py).
pub(crate) const VECTOR: u64 = 1 << 22;
pub(crate) const ROWS: u64 = 1 << 20;

/// A number of `/proc`: bytes that were read by the process, or its largest memory in bytes; none where there is no `/proc`.
pub(crate) fn told(file: &str, word: &str) -> Option<u64> {
    let text = std::fs::read_to_string(file).ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix(word))?;
    let number: u64 = line.trim_start_matches(':').split_whitespace().next()?.parse().ok()?;
    Some(if line.contains("kB") { number * 1024 } else { number })
}

/// Lengthens a file by a hole of doubles and writes `(place, value)` among them.
pub(crate) fn hole(path: &Path, doubles: u64, marks: &[(u64, f64)]) {
    let mut file = OpenOptions::new().write(true).open(path).unwrap();
    let start = file.metadata().unwrap().len();
    file.set_len(start + 8 * doubles).unwrap();
    for (place, value) in marks {
        file.seek(SeekFrom::Start(start + 8 * place)).unwrap();
        file.write_all(&value.to_le_bytes()).unwrap();
    }
}

/// A file with its head.
pub(crate) fn file(folder: &Path, name: &str, head: &[u8]) -> PathBuf {
    let path = folder.join(name);
    File::create(&path).unwrap().write_all(head).unwrap();
    path
}

fn text(text: &str) -> Vec<u8> {
    [&(text.len() as u32).to_le_bytes(), text.as_bytes()].concat()
}

/// A TDMS file of four channels in one segment; `interleaved` where their values alternate.
pub(crate) fn tdms(interleaved: bool) -> Vec<u8> {
    let mut meta = 4_u32.to_le_bytes().to_vec();
    for channel in 1..=4 {
        meta.extend(text(&format!("/'log'/'acc {channel}'")));
        for word in [20_u32, 10, 1] {
            meta.extend(word.to_le_bytes());
        }
        meta.extend(VECTOR.to_le_bytes());
        meta.extend(0_u32.to_le_bytes());
    }
    let toc: u32 = 2 | 4 | 8 | if interleaved { 32 } else { 0 };
    let (raw, next) = (meta.len() as u64, meta.len() as u64 + 4 * 8 * VECTOR);
    let lead = [&b"TDSm"[..], &toc.to_le_bytes(), &4713_u32.to_le_bytes(), &next.to_le_bytes(), &raw.to_le_bytes()];
    [lead.concat(), meta].concat()
}
