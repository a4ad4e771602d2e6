//! A program that does nothing but save is killed at random moments: the disk always holds the old file or the new one.

use crate::support::file;
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
        save(&state(n), &path, Some(&path)).unwrap();
        writeln!(out, "saved {n}").unwrap();
    }
}

/// Number of the state that the file holds, complete to the last byte.
fn held(path: &Path) -> u64 {
    let text = std::fs::read_to_string(path).unwrap();
    whole(&text).unwrap_or_else(|| panic!("{} holds no whole state, but {} bytes", path.display(), text.len()))
}

/// Number of the state that the text is, if it is one to the last byte.
fn whole(text: &str) -> Option<u64> {
    let read = dashpot::exchange::project::ProjectFile::parse(text, "project.toml").ok()?.0;
    let n: u64 = read.project.title.parse().ok()?;
    (text == state(n).to_toml().unwrap()).then_some(n)
}

fn said(lines: &[String], word: &str) -> u64 {
    let last = lines.iter().rev().find_map(|line| line.strip_prefix(word)?.trim().parse().ok());
    last.unwrap_or(0)
}

fn kill_once(folder: &Path, after: Duration) -> u64 {
    let path = folder.join("project.toml");
    // Plainly: nobody kills this write, and a sync takes long on a busy disk.
    std::fs::write(&path, state(0).to_toml().unwrap()).unwrap();
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

/// In memory where the system has such a folder. What a killed program leaves is decided by the order of its calls, not by
/// the disk, and without waiting for syncs far more kills fall into the work. A power cut is another test than this.
fn folder_of_memory() -> tempfile::TempDir {
    tempfile::tempdir_in("/dev/shm").or_else(|_| tempfile::tempdir()).unwrap()
}

/// Time of an autosave and a save here and now: a sync takes a millisecond on one disk and a second on a busy one.
fn round_time() -> Duration {
    let folder = folder_of_memory();
    let path = folder.path().join("project.toml");
    let round = |number| {
        autosave(&state(number), &path).unwrap();
        save(&state(number), &path, Some(&path)).unwrap();
    };
    // The first writes all of the text, those after it what has changed.
    round(1);
    let start = std::time::Instant::now();
    round(2);
    start.elapsed()
}

fn kills(count: u64) {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let mut most = 0;
    let round = round_time();
    let start = std::time::Instant::now();
    for done in 0..count {
        if done % 10 == 0 {
            println!("{done} kills after {:.1} s, at most {most} saves", start.elapsed().as_secs_f64());
        }
        let folder = folder_of_memory();
        most = most.max(kill_once(folder.path(), round.mul_f64(random.random_range(0.0..4.0))));
    }
    assert!(most > 0, "no kill came after a save: the test tests nothing");
}

#[test]
fn hundred_kills_leave_the_old_file_or_the_new_one() {
    kills(100);
}

#[test]
#[ignore = "a minute"]
fn thousand_kills_leave_the_old_file_or_the_new_one() {
    kills(1000);
}

#[test]
fn a_state_that_is_not_whole_is_found_out() {
    let text = state(3).to_toml().unwrap();
    assert_eq!(whole(&text), Some(3));
    assert_eq!(whole(&text.replacen("000000003 ", "000000002 ", 1)), None, "one byte of another state");
    assert_eq!(whole(&text[..text.len() / 2]), None, "cut short");
    assert_eq!(whole(""), None);
}
