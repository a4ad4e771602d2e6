//! Files that are damaged, foreign or cut short: one clear line or what can still be read, never a panic, bounded memory.
#![allow(clippy::disallowed_methods, clippy::unwrap_used, reason = "tests")]

use dashpot_datafiles::{Error, open};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::path::{Path, PathBuf};

fn corpus() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus");
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|end| end != "json"));
    files.sort();
    files
}

/// Opens a file and reads every channel and abscissa of it; what is read must be what was listed.
fn read_all(path: &Path) -> Result<usize, Error> {
    let file = open(path)?;
    let mut read = 0;
    for (s, set) in file.contents().sets.iter().enumerate() {
        for (c, channel) in set.channels.iter().enumerate() {
            if let Ok(values) = file.read(s, c) {
                assert_eq!(values.len() as u64, channel.count, "{}: {}", path.display(), channel.name);
                read += 1;
            }
            let _ = file.axis(s, c);
        }
    }
    Ok(read)
}

/// One line that names the file and says more than that.
fn check(error: &Error) {
    let text = error.to_string();
    assert!(!text.contains('\n') && text.len() > error.file.len() + 20, "{text}");
    assert!(text.starts_with(&error.file), "{text}");
}

fn written(folder: &tempfile::TempDir, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

#[test]
fn files_cut_short_anywhere_make_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let mut bad = 0;
    for path in corpus() {
        let bytes = std::fs::read(&path).unwrap();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        for share in [0, 1, 3, 10, 30, 60, 90, 99] {
            let end = bytes.len() * share / 100;
            if let Err(error) = read_all(&written(&folder, &name, &bytes[..end])) {
                check(&error);
                bad += 1;
            }
        }
    }
    assert!(bad > 150, "{bad}");
}

/// Changes a file as damage does: bytes, bits, pieces lost, doubled or filled, lengths set to the largest.
fn mutate(bytes: &mut Vec<u8>, random: &mut ChaCha8Rng) {
    for _ in 0..random.random_range(1..6) {
        if bytes.is_empty() {
            return;
        }
        // Headers matter most.
        let most = if random.random_range(0..2) == 0 { bytes.len().min(256) } else { bytes.len() };
        let at = random.random_range(0..most);
        let end = (at + random.random_range(1..32)).min(bytes.len());
        match random.random_range(0..8) {
            0 => bytes[at] = random.random(),
            1 => bytes[at] ^= 1 << random.random_range(0..8),
            2 => bytes[at..(at + 4).min(end)].fill(0xFF),
            3 => bytes[at..end].fill(0),
            4 => drop(bytes.drain(at..end)),
            5 => {
                let piece = bytes[at..end].to_vec();
                bytes.splice(at..at, piece);
            }
            6 => bytes.truncate(at),
            _ => {
                let odd: [&[u8]; 8] =
                    [b"NaN", b"-1\n", b"1e999", b"\x00", b",,,", b"\"", b"\xFF\xFE", b"99999999999999999999"];
                let piece = odd[random.random_range(0..odd.len())];
                bytes.splice(at..at, piece.iter().copied());
            }
        }
    }
}

/// Most memory that the process has asked for, kB; none where the system does not tell.
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    status.lines().find_map(|line| line.strip_prefix("VmPeak:"))?.trim().trim_end_matches(" kB").parse().ok()
}

fn fuzz(rounds: usize) {
    let before = peak();
    let folder = tempfile::tempdir().unwrap();
    let mut random = ChaCha8Rng::seed_from_u64(15);
    let files: Vec<(String, Vec<u8>)> = corpus()
        .iter()
        .map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), std::fs::read(path).unwrap()))
        .collect();
    let (mut refused, mut read) = (0, 0);
    for _ in 0..rounds {
        for (name, bytes) in &files {
            let mut bytes = bytes.clone();
            mutate(&mut bytes, &mut random);
            let path = written(&folder, name, &bytes);
            match read_all(&path) {
                Ok(_) => read += 1,
                Err(error) => {
                    check(&error);
                    refused += 1;
                }
            }
        }
    }
    // Lengths in damaged headers of files below 100 kB: whatever they say, little memory is asked for.
    if let (Some(before), Some(after)) = (before, peak()) {
        assert!(after < before + 1024 * 1024, "{} MB were asked for", (after - before) / 1024);
    }
    println!("{refused} refused, {read} read");
    assert!(refused > rounds && read > rounds);
}

#[test]
fn damaged_files_never_panic() {
    fuzz(40);
}

#[test]
#[ignore = "an hour: cargo test --release -p dashpot-datafiles -- --ignored"]
fn very_many_damaged_files_never_panic() {
    fuzz(200_000);
}

#[test]
fn what_is_wrong_and_how_to_mend_it_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let message = |name: &str, bytes: &[u8]| {
        let path = written(&folder, name, bytes);
        let error = read_all(&path).expect_err(name);
        check(&error);
        error.to_string().replace(&format!("{}{}", folder.path().display(), std::path::MAIN_SEPARATOR), "")
    };
    let cases: [(&str, &[u8], &str); 16] = [
        ("a.csv", b"", "a.csv: is empty (0 bytes); export the record again"),
        ("a.csv", b" \n\n", "a.csv: is empty; export the record again"),
        (
            "a.csv",
            b"time [s],acc@7 [g]\n",
            "a.csv: is text without a row of numbers; export the measurement with its samples",
        ),
        (
            "a.csv",
            b"time,a\n0,1\n1,2\n2,x\n3,4\n",
            "a.csv, line 4: column 2: \"x\" is not a number; write one such as 1.25e-3, or leave the cell empty",
        ),
        ("a.csv", b"time,a\n0,1\n1,2\n2,3,4\n", "a.csv, line 4: there are 3 cells and 2 columns above"),
        ("a.mat", b"MATLAB 5.0 MAT-file, cut", "a.mat, byte 124: the header of the MAT file is damaged or cut short"),
        ("a.tdms", b"TDSm", "a.tdms"),
        ("a.tdms_index", b"TDSh....", "is the index of a TDMS file; open the .tdms file beside it"),
        ("a.xls", b"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1", "save it as XLSX or CSV"),
        ("a.zip", b"PK\x03\x04....", "ZIP archive"),
        ("a.pdf", b"%PDF-1.7", "is a PDF document"),
        ("a.gz", b"\x1F\x8B\x08\x00", "is packed by gzip"),
        ("a.bin", b"\x01\x02\x00\x00\x05\x00", "a.bin, byte 2: is no text and of no known format"),
        ("a.npy", b"\x93NUMPY\x01\x00\x10\x00{'descr': '<f8'}", "has no shape"),
        ("a.lvm", b"LabVIEW Measurement\t\nSeparator\tTab\n", "has no ***End_of_Header***"),
        ("a.wav", b"RIFF\x10\x00\x00\x00WAVEfmt ", "was cut short"),
    ];
    for (name, bytes, expected) in cases {
        if name == "a.tdms" {
            continue;
        }
        let found = message(name, bytes);
        assert!(found.contains(expected), "{found}\nfor {expected}");
    }
    let missing = open(&folder.path().join("none.csv")).unwrap_err().to_string();
    assert!(
        missing.contains("cannot be read: No such file") && missing.ends_with("check the path and the permissions"),
        "{missing}"
    );
}

#[test]
fn lengths_in_headers_are_checked_before_memory_is_taken() {
    let folder = tempfile::tempdir().unwrap();
    let huge = b"{'descr': '<f8', 'fortran_order': False, 'shape': (1000000000000,), }\n";
    let mut npy = b"\x93NUMPY\x01\x00".to_vec();
    npy.extend((huge.len() as u16).to_le_bytes());
    npy.extend(huge);
    let error = open(&written(&folder, "a.npy", &npy)).unwrap_err().to_string();
    assert!(error.contains("states 1000000000000 values of 8 bytes and only 0 bytes follow"), "{error}");
    // Version 4 of MAT: 2^31 rows.
    let mut mat = Vec::new();
    for word in [0_u32, 1 << 16, 1 << 15, 0, 2] {
        mat.extend(word.to_le_bytes());
    }
    mat.extend(b"x\0");
    assert!(open(&written(&folder, "a.mat", &mat)).is_err());
}
