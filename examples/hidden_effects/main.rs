//! Hides effects in projects, diagnoses them, and prints how often the right one was named: the tables of
//! `docs/held-out.md`, and the reliability plot.
//!
//! `cargo run --release --no-default-features --example hidden_effects -- make FOLDER [FILTER] [FIRST_SEED] [COUNT]`
//! writes the projects (a seed is one laboratory project and one project of every other class, structure and effect),
//! `... -- judge FOLDER [FILTER] [WORKERS] [-- DIAGNOSE OPTIONS]` diagnoses them and writes
//! `FOLDER/reliability.svg`. A filter is a part of the names, such as
//! `lab2`, `clean-beam` or `coulomb`. Laboratory seeds 0 to 999 are for development, 1000 and more are held out.
#![allow(clippy::unwrap_used, reason = "a study, not a library: a failure ends it with its place")]

mod answer;
mod cases;
mod errors;
mod files;
mod judge;
mod lab;
mod lab_records;
mod random;
mod records;
mod reliability;
mod sizing;
mod specimen;
#[allow(dead_code, reason = "shared with the tests, which use all of it")]
mod suite;
mod tally;
mod unsteady;

use dashpot::exchange::atomic::write_atomically;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use tally::Tally;

/// Projects made at the same time.
const WORKERS: usize = 2;

/// That of the program, whose time is reported.
#[global_allocator]
static GLOBAL: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() {
    // As the program does: threads of the linear algebra cost more than they give at these sizes.
    faer::set_global_parallelism(faer::Par::Seq);
    let mut arguments: Vec<String> = std::env::args().collect();
    let options = arguments.iter().position(|a| a == "--").map_or_else(Vec::new, |at| arguments.split_off(at));
    let argument = |k: usize| arguments.get(k).map_or("", String::as_str);
    let number = |k: usize, default: u64| argument(k).parse().unwrap_or(default);
    let folder = Path::new(argument(2));
    match argument(1) {
        "make" => make(folder, argument(3), number(4, 0), number(5, 1)),
        "judge" => judge_all(folder, argument(3), number(4, 1) as usize, options.get(1..).unwrap_or_default()),
        _ => println!(
            "make FOLDER [FILTER] [FIRST_SEED] [COUNT] | judge FOLDER [FILTER] [WORKERS] [-- DIAGNOSE OPTIONS]"
        ),
    }
}

/// Does `work` on every item, several at a time.
fn in_parallel<T: Send>(workers: usize, items: Vec<T>, work: impl Fn(T) + Sync) {
    let (next, items) = (AtomicUsize::new(0), Mutex::new(items.into_iter().map(Some).collect::<Vec<_>>()));
    let take = || items.lock().unwrap().get_mut(next.fetch_add(1, Ordering::Relaxed)).and_then(Option::take);
    std::thread::scope(|scope| {
        for _ in 0..workers.max(1) {
            scope.spawn(|| {
                while let Some(item) = take() {
                    work(item);
                }
            });
        }
    });
}

fn make(folder: &Path, filter: &str, first: u64, count: u64) {
    let wanted = cases::cases(first..first + count).into_iter().filter(|c| c.name.contains(filter)).collect();
    in_parallel(WORKERS, wanted, |mut case: cases::Case| {
        let target = folder.join(&case.name);
        if target.join("project.toml").exists() {
            return;
        }
        match case.make() {
            Some(project) => project.write(&target, &case.name),
            None => println!("{}: no project", case.name),
        }
    });
}

fn judge_all(folder: &Path, filter: &str, workers: usize, options: &[String]) {
    if workers > 1 {
        println!("note: projects judged at once share the threads of this process: times say nothing");
    }
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut folders: Vec<PathBuf> = entries.filter(|p| p.join("project.toml").exists()).collect();
    folders.retain(|p| p.file_name().unwrap().to_string_lossy().contains(filter));
    folders.sort();
    let tallies: Mutex<BTreeMap<String, Tally>> = Mutex::default();
    in_parallel(workers, folders, |path: PathBuf| {
        let name = path.file_name().unwrap().to_string_lossy().to_string();
        let judged = judge::judge(&path, &name, options);
        println!("{}", judged.line);
        let class = name.split('-').next().unwrap_or_default().to_string();
        tallies.lock().unwrap().entry(class).or_default().add(&judged.tally);
    });
    let tallies = tallies.into_inner().unwrap();
    let told: Vec<tally::Told> = tallies.values().flat_map(|tally| tally.told.iter().copied()).collect();
    write_atomically(&folder.join("reliability.svg"), reliability::plot(&told).as_bytes()).unwrap();
    println!("\n{}", tally::report(&tallies));
}
