//! Files of every format changed at random: one clear line or what can still be read, never a panic in this crate, bounded
//! memory.
//!
//! `cargo test --release -p dashpot-datafiles --test fuzz -- --ignored hdf5` is ten million files of one reader. It goes on with
//! others where `FUZZ_SEED` names another seed, for as many as `FUZZ_INPUTS` says.
#![allow(clippy::disallowed_methods, clippy::unwrap_used, reason = "tests")]

mod common;

use common::{check, corpus, read_all};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Readers and the endings of their files in the corpus.
const READERS: [(&str, &[&str]); 8] = [
    ("uff", &["uff"]),
    ("mat", &["mat"]),
    ("hdf5", &["h5"]),
    ("tdms", &["tdms"]),
    ("text", &["csv", "txt", "lvm"]),
    ("xlsx", &["xlsx"]),
    ("wav", &["wav"]),
    ("numpy", &["npy", "npz"]),
];

/// Ten million, and the seed of the first run.
const MANY: (usize, u64) = (10_000_000, 2024);

/// A whole number that the environment names.
fn named(variable: &str) -> Option<u64> {
    std::env::var(variable).ok()?.parse().ok()
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

/// Panics that began in this crate. Those of libraries are caught and told as damage; ours would be faults.
static OURS: AtomicUsize = AtomicUsize::new(0);

/// Counts panics of this crate, also those that are caught, and shows where they began.
fn watch_panics(path: &Path) {
    let _ = read_all(path); // sets the hook that keeps caught panics quiet, which is then replaced
    std::panic::set_hook(Box::new(|info| {
        let file = info.location().map_or("", std::panic::Location::file);
        if file.contains("datafiles/") || file.contains("uff/") || file.starts_with("src") {
            OURS.fetch_add(1, Ordering::Relaxed);
            println!("{info}");
        }
    }));
}

/// Changes files of one reader `inputs` times and reads all of each.
fn fuzz(reader: &str, inputs: usize, seed: u64) {
    let (_, endings) = READERS.iter().find(|(name, _)| *name == reader).unwrap();
    let seeds: Vec<(String, Vec<u8>)> = corpus()
        .iter()
        .filter(|path| endings.iter().any(|end| path.extension().is_some_and(|found| found == *end)))
        .map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), std::fs::read(path).unwrap()))
        .collect();
    let memory = Path::new("/dev/shm");
    let folder = if memory.is_dir() { tempfile::tempdir_in(memory) } else { tempfile::tempdir() }.unwrap();
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    watch_panics(folder.path());
    let (mut refused, mut read, before) = (0, 0, peak());
    for i in 0..inputs {
        if i > 0 && i % 500_000 == 0 {
            println!("{reader}: {i} inputs, {refused} refused, {read} read");
        }
        let (name, bytes) = &seeds[i % seeds.len()];
        let mut bytes = bytes.clone();
        mutate(&mut bytes, &mut random);
        let path = folder.path().join(name);
        std::fs::write(&path, &bytes).unwrap();
        match read_all(&path) {
            Ok(_) => read += 1,
            Err(error) => {
                check(&error);
                refused += 1;
            }
        }
        if OURS.load(Ordering::Relaxed) > 0 {
            println!("{reader}, input {i}: a panic in this crate; kept as {}", folder.keep().display());
            panic!("a reader panicked");
        }
    }
    // Lengths in damaged headers of files below 20 kB: whatever they say, no more memory is asked for than such a file unpacks to.
    if let (Some(before), Some(after)) = (before, peak()) {
        assert!(after < before + 512 * 1024, "{} MB were asked for", (after - before) / 1024);
    }
    println!("{reader}: {inputs} inputs, {refused} refused, {read} read");
    assert!(refused > inputs / 100 && read > inputs / 100, "{refused} {read}");
}

#[test]
fn damaged_files_never_panic() {
    for (reader, _) in READERS {
        fuzz(reader, 300, 15);
    }
}

macro_rules! many {
    ($($name:ident $reader:literal),*) => { $(
        #[test]
        #[ignore = "ten million files"]
        fn $name() {
            let inputs = named("FUZZ_INPUTS").map_or(MANY.0, |inputs| inputs as usize);
            fuzz($reader, inputs, named("FUZZ_SEED").unwrap_or(MANY.1));
        }
    )* };
}

many!(many_uff "uff", many_mat "mat", many_hdf5 "hdf5", many_tdms "tdms", many_text "text", many_xlsx "xlsx", many_wav "wav",
    many_numpy "numpy");
