//! Files of every program changed at random: whatever comes, the readers answer in one line or with matrices whose memory
//! follows the file.
#![allow(clippy::unwrap_used, missing_docs, reason = "tests")]

use dashpot_fe_files::{FileError, Matrix, abaqus, calculix, inp, nastran, op4};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const BULK: &str = "$ model\nCORD2R  5       0       0.      0.      0.      0.      0.      1.\n\
+       1.      0.      0.\nGRID    11      5       0.      0.      0.\nGRID*                 12\n*                     1.\n\
GRID,13,,2.,0.,0.\nCBAR    1       1       11      12      0.      1.      0.\nCQUAD4,2,1,11,12,13,11\n\
DMIG    KAA     0       6       1       0\nDMIG    KAA     11      3               11      3       2.\n\
+       12      3       -1.0D+0\nDMIG*   KAA                           12               3\n\
*                     12               3 2.000000000E+00\nENDDATA\n";
const ASCII: &str = "       2       2       6       2KAA     1P,3E24.16\n       1       1       4\n  2.0000000000000000E+00 \
-1.0000000000000000E+00\n       2       1       4\n -1.0000000000000000E+00  2.0000000000000000E+00\n       3       1       1\n  1.0000000000000000E+00\n";
const INPUT: &str = "*NODE, NSET=ALL\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 1., 1., 0.\n4, 0., 1., 0.\n*ELEMENT, TYPE=S4, ELSET=E\n1, 1, 2, 3, 4\n\
*ELEMENT, TYPE=C3D8\n2, 1, 2, 3, 4, 1, 2, 3, 4\n";
const MATRIX_INPUT: &str =
    "*MATRIX INPUT, NAME=K, TYPE=SYMMETRIC\n*MATRIX ASSEMBLE\n1,3, 1,3, 2.0\n2,3, 1,3, -1.0\n2,3, 2,3, 2.0\n";
const LABELS: &str = "1 3 1 3 2.0\n2 3 1 3 -1.0\n2 3 2 3 2.0\n";
const COORDINATE: &str = "1 1 2.0\n2 1 -1.0\n2 2 2.0\n";

/// Binary OUTPUT4 of a matrix of two rows, dense.
fn binary() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut record = |words: &[i32], values: &[f64], name: &[u8]| {
        let mut part: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        part.extend(name);
        part.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        let length = (part.len() as u32).to_le_bytes();
        bytes.extend([&length[..], &part, &length].concat());
    };
    record(&[2, 2, 6, 2], &[], b"KAA     ");
    record(&[1, 1, 4], &[2.0, -1.0], b"");
    record(&[2, 1, 4], &[-1.0, 2.0], b"");
    record(&[3, 1, 2], &[1.0], b"");
    bytes
}

/// Reads bytes as a file of a program; number of matrix rows that were understood.
fn read(bytes: &[u8], program: usize) -> Result<usize, FileError> {
    let text = String::from_utf8_lossy(bytes);
    let rows = |matrices: &[Matrix]| matrices.iter().map(|matrix| matrix.size).sum();
    match program {
        0 => nastran::read(&text, "a.bdf").map(|bulk| rows(&bulk.matrices)),
        1 | 2 => op4::read(bytes, "a.op4").map(|matrices| rows(&matrices)),
        3 => inp::read(&text, "a.inp").map(|geometry| geometry.nodes.len()),
        4..=6 => abaqus::read_matrix(&text, "a.mtx").map(|matrix| matrix.size),
        _ => {
            let dofs = calculix::read_dofs("1.1\n2.1\n", "a.dof")?;
            let _ = calculix::read_dofs(&text, "b.dof");
            calculix::read_matrix(&text, "a.sti", &dofs).map(|matrix| matrix.size)
        }
    }
}

fn seeds() -> Vec<Vec<u8>> {
    let binary = binary();
    let texts = [INPUT, MATRIX_INPUT, LABELS, COORDINATE, COORDINATE];
    let mut seeds = vec![BULK.as_bytes().to_vec(), ASCII.as_bytes().to_vec(), binary];
    seeds.extend(texts.map(|text| text.as_bytes().to_vec()));
    seeds
}

fn mutate(bytes: &mut Vec<u8>, random: &mut ChaCha8Rng) {
    const WORDS: [&[u8]; 12] = [
        b"\n",
        b"99999999",
        b"-1",
        b"NaN",
        b"1e999",
        b"*",
        b",",
        b"DMIG    ",
        b"\xFF\xFF\xFF\x7F",
        b"\x00",
        b"+",
        b"2147483647 2147483647 1.0\n",
    ];
    for _ in 0..random.random_range(1..6) {
        if bytes.is_empty() {
            return;
        }
        let at = random.random_range(0..bytes.len());
        let end = (at + random.random_range(1..32)).min(bytes.len());
        match random.random_range(0..7) {
            0 => bytes[at] = random.random(),
            1 => bytes[at] ^= 1 << random.random_range(0..8),
            2 => drop(bytes.drain(at..end)),
            3 => bytes.truncate(at),
            4 => {
                let piece = bytes[at..end].to_vec();
                bytes.splice(at..at, piece);
            }
            5 => bytes[at] = b"0123456789+-.E,*"[random.random_range(0..16)],
            _ => drop(bytes.splice(at..at, WORDS[random.random_range(0..WORDS.len())].iter().copied())),
        }
    }
}

/// Most memory that the process has asked for, kB; none where the system does not tell.
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    status.lines().find_map(|line| line.strip_prefix("VmPeak:"))?.trim().trim_end_matches(" kB").parse().ok()
}

fn run(rounds: usize) {
    let seeds = seeds();
    let before = peak();
    let mut random = ChaCha8Rng::seed_from_u64(15);
    let (mut refused, mut understood) = (0, 0);
    for _ in 0..rounds {
        for (program, seed) in seeds.iter().enumerate() {
            let mut bytes = seed.clone();
            mutate(&mut bytes, &mut random);
            match read(&bytes, program) {
                Ok(_) => understood += 1,
                Err(error) => {
                    let text = error.to_string();
                    assert!(!text.contains('\n') && text.len() > 12, "{text}");
                    refused += 1;
                }
            }
        }
    }
    assert!(refused > rounds && understood > rounds, "{refused} {understood}");
    if let (Some(before), Some(after)) = (before, peak()) {
        assert!(after < before + 256 * 1024, "files below 1 kB took {} MB", (after - before) / 1024);
    }
}

#[test]
fn the_seeds_are_good() {
    for (program, seed) in seeds().iter().enumerate() {
        assert!(read(seed, program).unwrap_or_else(|error| panic!("{program}: {error}")) > 0);
    }
}

#[test]
fn changed_bytes_never_break_a_reader() {
    run(10_000);
}

#[test]
#[ignore = "ten million inputs each of eight kinds: some minutes in release"]
fn ten_million_changed_files_never_break_any_reader() {
    run(10_000_000);
}
