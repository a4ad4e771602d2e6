//! Hides effects in projects, diagnoses them, and prints how often the right one was named: the table of
//! `docs/explain.md`.
//!
//! `cargo run --profile suite --example hidden_effects -- make FOLDER [FILTER] [SEEDS]` writes the projects,
//! `... -- judge FOLDER [FILTER]` diagnoses them. A filter is a part of the names, such as `clean-beam` or `coulomb`.
#![allow(clippy::unwrap_used, reason = "a study, not a library: a failure ends it with its place")]

mod files;
mod judge;
mod random;
mod records;
mod sizing;
mod specimen;
#[allow(dead_code, reason = "shared with the tests, which use all of it")]
mod suite;

use dashpot::effects::{Effect, effect::Kind};
use judge::Tally;
use random::Random;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use suite::{Kindness, hidden};

/// Projects diagnosed at the same time.
const WORKERS: usize = 2;

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let argument = |k: usize| arguments.get(k).map_or("", String::as_str);
    let folder = Path::new(argument(2));
    match argument(1) {
        "make" => make(folder, argument(3), argument(4).parse().unwrap_or(1)),
        "judge" => judge_all(folder, argument(3)),
        _ => println!("make FOLDER [FILTER] [SEEDS] | judge FOLDER [FILTER]"),
    }
}

/// One project to be made.
struct Case {
    name: String,
    effects: Vec<Effect>,
    kindness: Kindness,
    random: Random,
}

fn cases(seeds: u64) -> Vec<Case> {
    let mut cases = Vec::new();
    for seed in 0..seeds {
        for (c, class) in ["clean", "hard", "detuned", "two", "none", "points"].into_iter().enumerate() {
            for (k, &effect) in Effect::ALL.iter().enumerate() {
                for beam in [true, false] {
                    let number = seed * 10_000 + c as u64 * 1000 + k as u64 * 10 + u64::from(beam);
                    cases.extend(case(class, effect, beam, seed, Random::new(number)));
                }
            }
        }
    }
    cases
}

fn case(class: &str, effect: Effect, beam: bool, seed: u64, mut random: Random) -> Option<Case> {
    let relative = |e: Effect| matches!(e.kind(), Kind::Relative(_)) && e.dissipates();
    if class == "points" && (beam || !relative(effect)) {
        return None;
    }
    let r = &mut random;
    let clean = Kindness {
        beam,
        points: false,
        sensors: 3 + r.below(5),
        runs: 12 + r.below(13),
        levels: 2 + r.below(3),
        noise: r.within(0.002, 0.015),
        size: r.within(0.08, 0.4),
        detuned: 0.0,
        unsettled: r.uniform() < 0.15,
    };
    let kindness = match class {
        "hard" => {
            let (noise, size) = (r.within(0.02, 0.03), r.within(0.02, 0.06));
            Kindness { sensors: 3, runs: 8 + r.below(3), levels: 2, noise, size, ..clean }
        }
        "detuned" => Kindness { detuned: r.within(0.001, 0.02) * r.sign(), ..clean },
        "points" => Kindness { points: true, noise: r.within(0.002, 0.01), ..clean },
        "none" => Kindness { noise: r.within(0.002, 0.03), points: !beam && r.uniform() < 0.3, ..clean },
        _ => clean,
    };
    let effects = match class {
        "none" => vec![],
        "two" => vec![effect, Effect::ALL[r.below(Effect::ALL.len())]],
        _ => vec![effect],
    };
    let structure = if beam { "beam" } else { "chain" };
    let names: Vec<&str> = effects.iter().map(|e| e.name()).collect();
    let word = if names.is_empty() { effect.name().to_string() } else { names.join("+") };
    Some(Case { name: format!("{class}-{structure}-{word}-{seed}"), effects, kindness, random })
}

/// Does `work` on every item, several at a time.
fn in_parallel<T: Send>(items: Vec<T>, work: impl Fn(T) + Sync) {
    let (next, items) = (AtomicUsize::new(0), Mutex::new(items.into_iter().map(Some).collect::<Vec<_>>()));
    let take = || items.lock().unwrap().get_mut(next.fetch_add(1, Ordering::Relaxed)).and_then(Option::take);
    std::thread::scope(|scope| {
        for _ in 0..WORKERS {
            scope.spawn(|| {
                while let Some(item) = take() {
                    work(item);
                }
            });
        }
    });
}

fn make(folder: &Path, filter: &str, seeds: u64) {
    let wanted = cases(seeds).into_iter().filter(|c| c.name.contains(filter)).collect();
    in_parallel(wanted, |mut case: Case| {
        let target = folder.join(&case.name);
        if target.join("project.toml").exists() {
            return;
        }
        // Some effects at some places cannot be made as large as wanted, or have no periodic motion: another draw.
        let project = (0..6).find_map(|_| hidden(&case.effects, case.kindness, &mut case.random));
        match project {
            Some(project) => files::write(&target, &case.name, &project),
            None => println!("{}: no project", case.name),
        }
    });
}

fn judge_all(folder: &Path, filter: &str) {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut folders: Vec<PathBuf> = entries.filter(|p| p.join("project.toml").exists()).collect();
    folders.retain(|p| p.file_name().unwrap().to_string_lossy().contains(filter));
    folders.sort();
    let tallies: Mutex<BTreeMap<String, Tally>> = Mutex::default();
    in_parallel(folders, |path: PathBuf| {
        let (line, tally) = judge::judge(&path);
        println!("{line}");
        let name = path.file_name().unwrap().to_string_lossy().to_string();
        let class = name.split('-').next().unwrap_or_default().to_string();
        tallies.lock().unwrap().entry(class).or_default().add(&tally);
    });
    println!("{}", Tally::head());
    let tallies = tallies.into_inner().unwrap();
    for (class, tally) in &tallies {
        println!("{class:10} | {}", tally.row());
    }
    println!("{}", judge::totals(&tallies));
}
