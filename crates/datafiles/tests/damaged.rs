//! Files that are damaged, foreign or cut short: one clear line or what can still be read, never a panic, bounded memory.
#![allow(clippy::disallowed_methods, clippy::unwrap_used, reason = "tests")]

mod common;

use common::{check, corpus, read_all};
use dashpot_datafiles::open;
use std::path::PathBuf;

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

#[test]
fn what_is_wrong_and_how_to_mend_it_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let message = |name: &str, bytes: &[u8]| {
        let path = written(&folder, name, bytes);
        let error = read_all(&path).expect_err(name);
        check(&error);
        error.to_string().replace(&format!("{}{}", folder.path().display(), std::path::MAIN_SEPARATOR), "")
    };
    let cases: [(&str, &[u8], &str); 24] = [
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
            "a.csv, line 4: column 2: \"x\" is not a number; write one such as 1.25e-3, or remove the row",
        ),
        ("a.csv", b"time,a\n0,1\n1,2\n2,3,4\n", "a.csv, line 4: there are 3 cells and 2 columns above"),
        ("a.mat", b"MATLAB 5.0 MAT-file, cut", "a.mat, byte 124: the header of the MAT file is damaged or cut short"),
        ("a.tdms", b"TDSm", "a.tdms"),
        ("a.tdms_index", b"TDSh....", "is the index of a TDMS file; open the .tdms file beside it"),
        ("a.xls", b"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1", "save it as XLSX or CSV"),
        ("a.zip", b"PK\x03\x04....", "ZIP archive"),
        ("a.pdf", b"%PDF-1.7", "is a PDF document"),
        ("a.parquet", b"PAR1\x15\x04", "is a Parquet file; save its table as CSV"),
        ("a.feather", b"ARROW1\0\0", "is a Feather file; save its table as CSV"),
        ("a.pkl", b"\x80\x04\x95\x10", "is a pickle of Python"),
        ("b.pkl", b"(dp0\nVa\np1\n", "save its arrays by numpy.savez"),
        ("a.rdata", b"RDX3\nX\n", "save the table by write.csv"),
        ("a.sqlite", b"SQLite format 3\0", "is a SQLite database; export the table"),
        ("a.mf4", b"MDF     4.10    ", "is a file of ASAM MDF; export it as MAT"),
        ("a.xz", b"\xFD7zXZ\0", "is packed by xz; unpack it first"),
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

#[test]
fn a_short_part_of_a_mat_file_that_says_it_is_long_is_refused() {
    // A 3 x 3 matrix whose numbers are said to be 72 bytes within their tag of eight.
    let words = |words: &[u32]| words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
    let mut bytes = b"MATLAB 5.0 MAT-file".to_vec();
    bytes.resize(124, b' ');
    bytes.splice(116..124, [0; 8]);
    bytes.extend(b"\x00\x01IM");
    bytes.extend(words(&[14, 56, 6, 8, 6, 0, 5, 8, 3, 3, 1 | 1 << 16]));
    bytes.extend(b"K\0\0\0");
    bytes.extend(words(&[9 | 72 << 16, 0, 0, 0]));
    let folder = tempfile::tempdir().unwrap();
    let error = open(&written(&folder, "a.mat", &bytes)).expect_err("damaged").to_string();
    assert!(error.contains("a part of 72 bytes is said to be in four"), "{error}");
}
