//! A program that does nothing but save is killed at random moments: the disk always holds the old file or the new one.

use crate::support::{BEAM, file};
use dashpot::session::save::{autosave, autosave_path, save};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

const FOLDER: &str = "DASHPOT_KILL_FOLDER";

/// State number `n` of the project: as long as a large project, and different in every byte of its notes.
fn state(n: u64) -> dashpot::exchange::project::ProjectFile {
    let mut file = file();
    file.project.title = n.to_string();
    file.project.notes = format!("{n:09} ").repeat(20_000);
    file
}

/// Not a test of its own: what the killed program does. It says on its output which states are safe.
#[test]
#[ignore = "the program that `kills` starts"]
fn victim() {
    let Ok(folder) = std::env::var(FOLDER) else { return };
    let path = Path::new(&folder).join("project.toml");
    let mut out = std::io::stderr();
    for n in 1.. {
        autosave(&state(n), &path).unwrap();
        writeln!(out, "kept {n}").unwrap();
        save(&state(n), &path).unwrap();
        writeln!(out, "saved {n}").unwrap();
    }
}

/// Number of the state that the file holds, complete to the last byte.
fn held(path: &Path) -> u64 {
    let text = std::fs::read_to_string(path).unwrap();
    let read = dashpot::exchange::project::ProjectFile::parse(&text, "project.toml").unwrap().0;
    let n: u64 = read.project.title.parse().unwrap();
    assert_eq!(text, state(n).to_toml().unwrap(), "state {n} is not whole");
    n
}

fn said(lines: &[String], word: &str) -> u64 {
    let last = lines.iter().rev().find_map(|line| line.strip_prefix(word)?.trim().parse().ok());
    last.unwrap_or(0)
}

fn kill_once(folder: &Path, after: Duration) -> u64 {
    let path = folder.join("project.toml");
    save(&state(0), &path).unwrap();
    let mut child = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "kill::victim", "--ignored", "--nocapture"])
        .env(FOLDER, folder)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
    // The clock starts when it works, so that the kill falls into the work and not into the start of the program.
    let first = lines.next().unwrap().unwrap();
    let reader = std::thread::spawn(move || lines.map_while(Result::ok).collect::<Vec<_>>());
    std::thread::sleep(after);
    child.kill().unwrap();
    child.wait().unwrap();
    let mut lines = reader.join().unwrap();
    lines.insert(0, first);
    let (saved, now) = (said(&lines, "saved"), held(&path));
    assert!(now == saved || now == saved + 1, "said saved {saved}, holds {now}");
    if autosave_path(&path).exists() {
        let kept = held(&autosave_path(&path));
        assert!(kept == now || kept == now + 1, "holds {now}, keeps {kept}");
    }
    now
}

fn kills(count: u64) {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let mut most = 0;
    for _ in 0..count {
        let folder = tempfile::tempdir().unwrap();
        most = most.max(kill_once(folder.path(), Duration::from_micros(random.random_range(0..20_000))));
    }
    assert!(most > 0, "no kill came after a save: the test tests nothing");
}

#[test]
fn hundred_kills_leave_the_old_file_or_the_new_one() {
    kills(100);
}

#[test]
#[ignore = "half a minute"]
fn thousand_kills_leave_the_old_file_or_the_new_one() {
    kills(1000);
}

#[test]
fn the_beam_of_the_tests_is_what_they_kill() {
    assert!(BEAM.contains("clamped-free") && held_is_exact());
}

/// The check of [`held`] can fail: a file cut short is found out.
fn held_is_exact() -> bool {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cut.toml");
    let text = state(3).to_toml().unwrap();
    std::fs::write(&path, text.replace("000000003 \"", "000000002 \"")).unwrap();
    std::panic::catch_unwind(|| held(&path)).is_err()
}
