//! Hides effects, diagnoses, and prints how often the right one was named: the table of `docs/explain.md`.
//!
//! `cargo run --example hidden_effects -- [seeds] [effect name or all] [clean|hard|detuned|two|none]`
#![allow(clippy::unwrap_used, reason = "a study, not a library: a failure ends it with its place")]

mod suite;

use dashpot::control::Control;
use dashpot::effects::{Effect, Source};
use dashpot::explain::diagnose::{Diagnosis, diagnose};
use std::time::Instant;
use suite::{Hidden, Kindness, Random, hidden};

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let seeds: u64 = args.get(1).and_then(|a| a.parse().ok()).unwrap_or(1);
    let which = args.get(2).map_or("all", String::as_str);
    let mode = args.get(3).map_or("clean", String::as_str);
    let mut tally = Tally::default();
    let effects: Vec<Effect> = Effect::ALL.into_iter().filter(|e| which == "all" || e.name() == which).collect();
    for seed in 0..seeds {
        for (k, &effect) in effects.iter().enumerate() {
            for beam in [true, false] {
                let mut random = Random::new(seed * 1000 + k as u64 * 10 + u64::from(beam) + 7);
                let kindness = kindness(mode, beam, &mut random);
                let set = match mode {
                    "none" => vec![],
                    "two" => vec![effect, effects[random.below(effects.len())]],
                    _ => vec![effect],
                };
                let Some(project) = hidden(&set, kindness, &mut random) else {
                    println!("{:<24} no project", effect.name());
                    continue;
                };
                run(&project, kindness, &mut tally);
            }
        }
    }
    println!("{tally:?}");
}

fn kindness(mode: &str, beam: bool, random: &mut Random) -> Kindness {
    let many = if beam { 8 } else { 5 };
    let clean = Kindness { beam, sensors: many, runs: 18, noise: 0.005, size: 0.3, detuned: 0.0 };
    match mode {
        "hard" => Kindness { sensors: 3, runs: 9, noise: 0.025, size: random.within(0.02, 0.06), ..clean },
        "detuned" => Kindness { detuned: random.within(0.001, 0.02), sensors: 5, ..clean },
        _ => Kindness {
            sensors: 3 + random.below(many - 2),
            noise: random.within(0.002, 0.03),
            size: random.within(0.1, 0.5),
            ..clean
        },
    }
}

#[derive(Debug, Default)]
struct Tally {
    projects: usize,
    first: usize,
    top3: usize,
    place: usize,
    all_found: usize,
    adequate: usize,
    parameters_within_3: usize,
    to_floor: usize,
    seconds: f64,
}

fn run(project: &Hidden, kindness: Kindness, tally: &mut Tally) {
    let start = Instant::now();
    let diagnosis = diagnose(&project.problem(), &Control::unattended());
    let seconds = start.elapsed().as_secs_f64();
    let diagnosis = match diagnosis {
        Ok(diagnosis) => diagnosis,
        Err(error) => {
            println!("failed: {error}");
            tally.projects += 1;
            return;
        }
    };
    tally.projects += 1;
    tally.seconds += seconds;
    tally.adequate += usize::from(diagnosis.suggestions.is_empty());
    let hits = |s: &Source| project.truth.iter().any(|t| t.effect == s.effect);
    let first = diagnosis.suggestions.first();
    tally.first += usize::from(first.is_some_and(|s| hits(&s.added.source)));
    tally.top3 += usize::from(diagnosis.suggestions.iter().take(3).any(|s| hits(&s.added.source)));
    let place = |s: &Source| project.truth.iter().any(|t| t.place.is_same(&s.place));
    let placed = first.is_some_and(|s| place(&s.added.source) || s.indistinguishable_from.iter().any(place));
    tally.place += usize::from(placed);
    let last = &diagnosis.steps[diagnosis.steps.len() - 1];
    let found = project.truth.iter().all(|t| last.added.iter().any(|a| a.source.is_same(t)))
        && last.added.len() == project.truth.len();
    tally.all_found += usize::from(found);
    tally.to_floor += usize::from(last.error <= 1.2 * diagnosis.noise_floor);
    if let Some(suggestion) = first
        && let Some(truth) = project.truth.iter().find(|t| t.is_same(&suggestion.added.source))
    {
        let pairs = truth.parameters.iter().zip(&suggestion.added.source.parameters).zip(&suggestion.added.deviations);
        tally.parameters_within_3 +=
            usize::from(pairs.clone().all(|((t, p), d)| (t - p).abs() <= 3.0 * d + 1e-3 * t.abs()));
    }
    report(project, kindness, &diagnosis, found, seconds);
}

fn report(project: &Hidden, kindness: Kindness, diagnosis: &Diagnosis, found: bool, seconds: f64) {
    let name = |s: &Source| {
        let values: Vec<String> = s.parameters.iter().map(|p| format!("{p:.4e}")).collect();
        format!("{} {:?} {}", s.effect.name(), s.place, values.join(" "))
    };
    let truth: Vec<String> = project.truth.iter().map(name).collect();
    let mark = if found { "ok  " } else { "MISS" };
    println!(
        "{mark} {seconds:5.2}s {} s{} n{:.3} | {} | {:.4} -> {:.4} floor {:.4} {}",
        if kindness.beam { "beam" } else { "chain" },
        kindness.sensors,
        kindness.noise,
        truth.join(" + "),
        diagnosis.error_before,
        diagnosis.steps[diagnosis.steps.len() - 1].error,
        diagnosis.noise_floor,
        diagnosis.verdict.word(),
    );
    let shown = if found { 1 } else { 4 };
    for s in diagnosis.suggestions.iter().take(shown) {
        let d: Vec<String> = s.added.deviations.iter().map(|d| format!("{d:.1e}")).collect();
        println!(
            "        p={:.3} err {:.4} held {:.4} {} +-{}  ~{}",
            s.probability,
            s.error_after,
            s.held_out_error_after,
            name(&s.added.source),
            d.join(","),
            s.indistinguishable_from.len()
        );
    }
}
