//! One channel of a large file is read alone: the numbers are right, and neither the others' bytes nor copies of them are
//! taken. The files are holes in which a few numbers stand, so that nothing large is kept or written.
#![allow(clippy::disallowed_methods, clippy::unwrap_used, reason = "tests")]

#[path = "common/holes.rs"]
mod holes;

use dashpot_datafiles::{Values, open};
use holes::{ROWS, VECTOR, file, hole, tdms, told};
use std::path::Path;

/// What reading takes beside a channel itself, bytes: pieces, headers, the allocator.
const BESIDE: u64 = 24 << 20;

/// Reads a channel; only `marks` are not zero. At most `bytes` of the file may be read for it.
fn check(path: &Path, name: &str, count: u64, marks: &[(u64, f64)], bytes: u64) {
    let file = open(path).unwrap();
    let sets = file.contents().sets.iter().enumerate();
    let mut places = sets.flat_map(|(s, set)| set.channels.iter().enumerate().map(move |(c, channel)| (s, c, channel)));
    let (set, channel, entry) = places.find(|(_, _, channel)| channel.name == name).expect(name);
    assert_eq!(entry.count, count, "{name}");
    let before = (told("/proc/self/io", "rchar"), told("/proc/self/status", "VmRSS"));
    let Values::Real(values) = file.read(set, channel).unwrap() else { panic!("{name} is complex") };
    let after = (told("/proc/self/io", "rchar"), told("/proc/self/status", "VmHWM"));
    let found: Vec<(u64, f64)> =
        values.iter().enumerate().filter(|(_, value)| **value != 0.0).map(|(i, value)| (i as u64, *value)).collect();
    assert_eq!((values.len() as u64, found), (count, marks.to_vec()), "{}: {name}", path.display());
    if let ((Some(read), Some(memory)), (Some(all_read), Some(most))) = (before, after) {
        let (read, memory) = (all_read - read, most.saturating_sub(memory));
        assert!(read < bytes + (2 << 20), "{}: {name}: {read} bytes were read, {bytes} are enough", path.display());
        assert!(memory < 8 * count + BESIDE, "{}: {name}: {memory} bytes of memory", path.display());
    }
}

/// The start of a MAT file of version 5 with one matrix of doubles.
fn mat(rows: u32, columns: u32) -> Vec<u8> {
    let words = |words: &[u32]| words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
    let bytes = 8 * rows * columns;
    let mut head = vec![b' '; 124];
    head[..19].copy_from_slice(b"MATLAB 5.0 MAT-file");
    head[116..124].fill(0);
    head.extend(b"\x00\x01IM");
    head.extend(words(&[14, bytes + 48, 6, 8, 6, 0, 5, 8, rows, columns, 1 | 3 << 16]));
    head.extend(b"acc\0");
    head.extend(words(&[9, bytes]));
    head
}

#[test]
fn one_channel_of_a_large_file_is_read_alone() {
    let folder = tempfile::tempdir().unwrap();
    let (vector, rows) = (8 * VECTOR, 8 * 16 * ROWS);
    let ends = |count: u64| [(0, 1.5), (count / 2 + 7, -2.0), (count - 1, 3.25)];
    // The largest memory of a process never falls: short channels come first.
    // Columns of MATLAB lie behind each other, those of NumPy beside each other.
    let path = file(folder.path(), "columns.mat", &mat(ROWS as u32, 16));
    hole(&path, 16 * ROWS, &ends(ROWS).map(|(i, y)| (4 * ROWS + i, y)));
    check(&path, "acc[5]", ROWS, &ends(ROWS), 8 * ROWS);
    let shape = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({ROWS}, 16), }}\n");
    let head = [&b"\x93NUMPY\x01\x00"[..], &(shape.len() as u16).to_le_bytes(), shape.as_bytes()].concat();
    let path = file(folder.path(), "rows.npy", &head);
    hole(&path, 16 * ROWS, &ends(ROWS).map(|(i, y)| (16 * i + 9, y)));
    check(&path, "rows[10]", ROWS, &ends(ROWS), rows);
    // Vectors one behind the other, and rows of sixteen: of these all bytes are passed, and one value in sixteen is kept.
    let path = file(folder.path(), "vectors.h5", include_bytes!("large/head.h5"));
    let marks: Vec<(u64, f64)> =
        (0..5).flat_map(|c| ends(VECTOR).map(|(i, y)| (c * VECTOR + i, y * (c + 1) as f64))).collect();
    let row = (4 * VECTOR + 16 * 999_983 + 5, 7.0);
    hole(&path, 4 * VECTOR + 16 * ROWS, &[&marks[..12], &[row]].concat());
    check(&path, "rows[6]", ROWS, &[(999_983, 7.0)], rows);
    check(&path, "acc 3", VECTOR, &ends(VECTOR).map(|(i, y)| (i, 3.0 * y)), vector);
    let path = file(folder.path(), "contiguous.tdms", &tdms(false));
    hole(&path, 4 * VECTOR, &marks[..12]);
    check(&path, "acc 2", VECTOR, &ends(VECTOR).map(|(i, y)| (i, 2.0 * y)), vector);
    let path = file(folder.path(), "interleaved.tdms", &tdms(true));
    hole(&path, 4 * VECTOR, &ends(VECTOR).map(|(i, y)| (4 * i + 3, y)));
    check(&path, "acc 4", VECTOR, &ends(VECTOR), 4 * vector);
}

#[test]
fn chunks_of_several_channels_are_taken_apart() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/large/chunked.h5");
    let file = open(&path).unwrap();
    for (channel, of) in [(0, 1000), (1, 700)] {
        let Values::Real(values) = file.read(0, channel).unwrap() else { panic!("complex") };
        assert_eq!(values.len(), 600_000);
        assert!(values.iter().enumerate().all(|(i, value)| *value == (i / of) as f64), "channel {channel}");
    }
}
