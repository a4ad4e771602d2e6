//! Bytes of good files changed at random: whatever comes, the reader answers, takes no more memory than the file could
//! fill, and reads back what it understood once that is written again.
#![allow(clippy::unwrap_used, clippy::too_many_lines, missing_docs, reason = "tests")]

mod common;

use common::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use uff::{File, Set, to_bytes};

/// Small files, each of one or two sets.
fn seeds() -> Vec<Vec<u8>> {
    let sets = everything();
    let mut seeds: Vec<Vec<u8>> = sets.iter().map(|set| to_bytes(std::slice::from_ref(set)).unwrap()).collect();
    seeds.extend(sets.windows(2).step_by(5).map(|pair| to_bytes(pair).unwrap()));
    seeds
}

/// Words that mean something to the reader.
const WORDS: [&[u8]; 24] = [
    b"    -1\n",
    b"-1",
    b"\n",
    b"\r\n",
    b"    58\n",
    b"    58b     1     2          11         184",
    b"NaN",
    b"*****",
    b"1.#QNAN",
    b"-999999999",
    b"9999999999",
    b"         0",
    b"D+",
    b"E-400",
    b"E+999",
    b" ",
    b"        ",
    b"\x00",
    b"\xff\xfe",
    b".",
    b"NONE",
    b"   2411\n",
    b"   2414\n",
    b"    55\n",
];

/// A file with one to eight changes.
fn mutated(seed: &[u8], other: &[u8], random: &mut ChaCha8Rng) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for _ in 0..random.random_range(1..=8) {
        let at = random.random_range(0..=bytes.len());
        let end = (at + random.random_range(0..40_usize)).min(bytes.len());
        match random.random_range(0..9) {
            0 if at < bytes.len() => bytes[at] = random.random(),
            1 if at < bytes.len() => bytes[at] ^= 1 << random.random_range(0..8),
            2 => drop(bytes.drain(at..end)),
            3 => bytes.truncate(at),
            4 => drop(bytes.splice(at..at, WORDS[random.random_range(0..WORDS.len())].iter().copied())),
            5 => {
                let word = WORDS[random.random_range(0..WORDS.len())];
                let end = (at + word.len()).min(bytes.len());
                drop(bytes.splice(at..end, word.iter().copied()));
            }
            6 => {
                let part = bytes[at..end].to_vec();
                drop(bytes.splice(at..at, part));
            }
            7 => {
                let from = random.random_range(0..=other.len());
                let part = &other[from..(from + 120).min(other.len())];
                drop(bytes.splice(at..at, part.iter().copied()));
            }
            _ if at < bytes.len() => bytes[at] = b"0123456789+-.E"[random.random_range(0..14)],
            _ => {}
        }
    }
    bytes
}

/// Numbers that a set holds.
fn held(set: &Set) -> usize {
    match set {
        Set::Nodes(nodes) | Set::DoubleNodes(nodes) => 7 * nodes.len(),
        Set::Elements(elements) => elements.iter().map(|element| 9 + element.nodes.len()).sum(),
        Set::TraceLine(line) => line.nodes.len(),
        Set::Shape(shape) => shape.nodes.len() + 2 * shape.values.len(),
        Set::Analysis(data) => data.labels.iter().map(Vec::len).sum::<usize>() + 2 * data.values.len(),
        Set::Function(function) => 3 * function.values.len(),
        Set::Unknown(unknown) => unknown.bytes.len(),
        _ => 0,
    }
}

/// Reads a file in full and checks what every file must keep.
fn check(bytes: &[u8]) {
    let Ok(mut file) = File::from_bytes(bytes) else { return };
    let mut ends = 0;
    for entry in file.sets().to_vec() {
        assert!(
            entry.bytes.start >= ends && entry.bytes.start <= entry.bytes.end && entry.bytes.end <= bytes.len() as u64
        );
        ends = entry.bytes.end;
    }
    for i in 0..file.sets().len() {
        let length = file.sets()[i].bytes.clone();
        match file.read(i) {
            Ok(reading) => {
                // Two bytes a number, and short rows are filled up to 64 numbers of at least four bytes a row.
                assert!(held(&reading.set) as u64 <= 64 * (length.end - length.start) + 64, "{:?}", reading.set);
                written_again(&reading.set);
            }
            Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
        }
    }
}

/// What was understood can be written, unless it does not fit, and is then one set again.
fn written_again(set: &Set) {
    if matches!(set, Set::Unknown(_)) {
        return;
    }
    let Ok(bytes) = to_bytes(std::slice::from_ref(set)) else { return };
    let mut file =
        File::from_bytes(&bytes).unwrap_or_else(|error| panic!("{error}\n{}", String::from_utf8_lossy(&bytes)));
    let again = file.read(0).unwrap_or_else(|error| panic!("{error}\n{}", String::from_utf8_lossy(&bytes)));
    assert_eq!(again.set.number(), set.number());
    assert_eq!(held(&again.set), held(set), "{}", String::from_utf8_lossy(&bytes));
}

fn run(inputs: usize, seed: u64) {
    let seeds = seeds();
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    for _ in 0..inputs {
        let other = random.random_range(0..seeds.len());
        let bytes = mutated(&seeds[random.random_range(0..seeds.len())], &seeds[other], &mut random);
        let outcome = std::panic::catch_unwind(|| check(&bytes));
        assert!(outcome.is_ok(), "this file broke the reader: {:?}", String::from_utf8_lossy(&bytes));
    }
}

#[test]
fn changed_bytes_never_break_the_reader() {
    run(100_000, 58);
}

#[test]
#[ignore = "ten million inputs: some ten minutes in release"]
fn ten_million_changed_files_never_break_the_reader() {
    run(10_000_000, 2414);
}
