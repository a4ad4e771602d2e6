//! Several channels of a large file whose rows or chunks hold them together are read in one pass over it.
#![allow(clippy::disallowed_methods, clippy::unwrap_used, reason = "tests")]

#[path = "common/holes.rs"]
mod holes;

use dashpot_datafiles::open;
use holes::{ROWS, VECTOR, file, hole, tdms, told};
use std::path::Path;

/// Reads two channels at once: as each alone, and at most `bytes` of the file.
fn check_together(path: &Path, channels: [usize; 2], bytes: u64) {
    let file = open(path).unwrap();
    let before = told("/proc/self/io", "rchar");
    let both = file.read_several(0, &channels).unwrap();
    let after = told("/proc/self/io", "rchar");
    for (values, channel) in both.iter().zip(channels) {
        assert_eq!(*values, file.read(0, channel).unwrap(), "{}: {channel}", path.display());
    }
    if let (Some(before), Some(after)) = (before, after) {
        let read = after - before;
        assert!(read < bytes + (2 << 20), "{}: {read} bytes were read, {bytes} are enough", path.display());
    }
}

#[test]
fn channels_that_share_their_rows_are_read_in_one_pass() {
    let folder = tempfile::tempdir().unwrap();
    let (rows, count) = (8 * 16 * ROWS, ROWS);
    let marks = [(3, 1.5), (11, -2.0), (16 * (count / 2) + 3, 4.0), (16 * (count - 1) + 11, 3.25)];
    let shape = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({ROWS}, 16), }}\n");
    let head = [&b"\x93NUMPY\x01\x00"[..], &(shape.len() as u16).to_le_bytes(), shape.as_bytes()].concat();
    let path = file(folder.path(), "rows.npy", &head);
    hole(&path, 16 * ROWS, &marks);
    check_together(&path, [3, 11], rows);
    let path = file(folder.path(), "interleaved.tdms", &tdms(true));
    hole(&path, 4 * VECTOR, &[(4, 1.5), (7, -2.0), (4 * VECTOR - 4, 4.0), (4 * VECTOR - 1, 3.25)]);
    check_together(&path, [0, 3], 4 * 8 * VECTOR);
    check_together(&path, [3, 0], 4 * 8 * VECTOR);
    // 16 tracks of 32 bit.
    let mut head = b"RIFF\x00\x00\x00\x00WAVEfmt \x10\x00\x00\x00\x03\x00\x10\x00".to_vec();
    for word in [48_000, 48_000 * 64, 64 | 32 << 16, u32::from_le_bytes(*b"data"), 64 * ROWS as u32] {
        head.extend(word.to_le_bytes());
    }
    head.splice(4..8, (64 * ROWS as u32 + 36).to_le_bytes());
    let path = file(folder.path(), "tracks.wav", &head);
    hole(&path, 8 * ROWS, &[(1, 1.5), (5, -2.0), (8 * (count / 2) + 1, 4.0), (8 * (count - 1) + 5, 3.25)]);
    check_together(&path, [3, 11], 64 * ROWS);
    // Rows of one data set of HDF5, contiguous, and chunks that hold both channels.
    let chunked = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/large/chunked.h5");
    check_together(&chunked, [0, 1], std::fs::metadata(&chunked).unwrap().len());
    let path = file(folder.path(), "vectors.h5", include_bytes!("large/head.h5"));
    hole(&path, 4 * VECTOR + 16 * ROWS, &[(4 * VECTOR + 16 * 999 + 5, 7.0), (4 * VECTOR + 16 * 9999 + 9, 8.0)]);
    let opened = open(&path).unwrap();
    let set = &opened.contents().sets[0];
    let channel_number = |name: &str| set.channels.iter().position(|channel| channel.name == name).expect(name);
    check_together(&path, [channel_number("rows[6]"), channel_number("rows[10]")], rows);
}
