//! How often, and how well, the sources of the cantilever of section 5.2 are found in noise.
//!
//! Records are steady-state responses to an equal force at DOF 19 with white noise of 5 % of each accelerometer's root mean
//! square; the force is recorded clean, as in the thesis (`--force-noise` adds it to the force too). Every record goes
//! through the same harmonic fit and identification as a project's.
//!
//! `cargo run --release --no-default-features --example monte_carlo -- [seeds] [case] [--force-noise]`, case one of `1`, `2`,
//! `rounded`, `all`.

use anyhow::{Context, Result};
use dashpot::control::Control;
use dashpot::effects::{Effect, Place, Source};
use dashpot::identify::{Form, Settings, identify};
use dashpot::measurement::{Channel, Quantity, Record, Run};
use dashpot::response::dynamic_stiffness::DynamicStiffness;
use dashpot::structure::Structure;
use dashpot::structure::beam::{BeamParameters, Supports};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};
use std::f64::consts::TAU;
use std::sync::Arc;

const NOISE: f64 = 0.05;
const DRIVE: usize = 18;
const SENSORS: [usize; 3] = [6, 10, 18];
/// Periods in a record.
const PERIODS: f64 = 10.0;

/// One experiment, repeated with other noise.
struct Case {
    name: &'static str,
    dashpots: [(usize, f64); 4],
    frequencies_hz: Vec<f64>,
    samples: usize,
}

/// What the repetitions gave.
#[derive(Default)]
struct Tally {
    hits: usize,
    right_count: usize,
    right_all: usize,
    response_form: usize,
    /// Relative errors and z-scores of the four coefficients, where the four places were found.
    errors: Vec<[f64; 4]>,
    scores: Vec<[f64; 4]>,
}

fn main() -> Result<()> {
    faer::set_global_parallelism(faer::Par::Seq);
    let words: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with("--")).collect();
    let force_noise = std::env::args().any(|a| a == "--force-noise");
    let seeds: u64 =
        words.first().map_or(Ok(200), |w| w.parse()).context("the first argument is the number of seeds")?;
    let wanted = words.get(1).map_or("all", String::as_str);
    let structure = BeamParameters {
        length: 0.56,
        breadth: 0.04,
        depth: 0.004,
        youngs_modulus: 69e9,
        density: 2700.0,
        elements: 10,
        supports: Supports::ClampedFree,
    }
    .build(&[])?;
    println!(
        "{seeds} seeds, {} % noise on {}",
        NOISE * 100.0,
        if force_noise { "all channels" } else { "accelerometers" }
    );
    println!(
        "case      samples  places  number  both    form   rms error % (DOF 3, 5, 13, 17)    deviation of z-scores"
    );
    for case in cases(&structure)?.iter().filter(|c| wanted == "all" || c.name == wanted) {
        let started = std::time::Instant::now();
        let tally = repeat(&structure, case, seeds, force_noise)?;
        print_row(case, &tally, seeds, started.elapsed().as_secs_f64());
    }
    Ok(())
}

fn cases(structure: &Structure) -> Result<Vec<Case>> {
    let modes = structure.modes()?;
    let resonances: Vec<f64> = (0..8).map(|r| modes.frequency_hz(r)).collect();
    let case_1 = [(2, 0.1), (4, 0.1), (12, 0.1), (16, 0.1)];
    let case_2 = [(2, 0.01), (4, 0.5), (12, 0.1), (16, 1.0)];
    let rounded = vec![10.0, 65.0, 182.0, 358.0, 593.0, 889.0, 1247.0, 1671.0];
    Ok(vec![
        Case { name: "1", dashpots: case_1, frequencies_hz: resonances.clone(), samples: 1000 },
        Case { name: "2", dashpots: case_2, frequencies_hz: resonances, samples: 1000 },
        Case { name: "rounded", dashpots: case_2, frequencies_hz: rounded, samples: 10_000 },
    ])
}

fn repeat(structure: &Structure, case: &Case, seeds: u64, force_noise: bool) -> Result<Tally> {
    let candidates: Vec<Source> =
        (0..structure.len()).map(|dof| Source::candidate(Effect::Viscous, Place::Dofs(vec![dof]))).collect();
    let settings = Settings { keep: 0, max_sources: 6, harmonics: 1, ..Settings::default() };
    let clean = clean_runs(structure, case)?;
    let places: Vec<usize> = case.dashpots.iter().map(|d| d.0).collect();
    let mut tally = Tally::default();
    for seed in 0..seeds {
        let runs = noisy_runs(case, &clean, seed, force_noise)?;
        let outcome = identify(structure, &candidates, &runs, &settings, &Control::unattended())?;
        let four = outcome.steps.iter().find(|s| s.count == 4);
        let found = four.filter(|s| s.sources.iter().map(|e| e.source).eq(places.iter().copied()));
        tally.right_count += usize::from(outcome.accepted_step().count == 4);
        tally.response_form += usize::from(outcome.form == Form::Response);
        let Some(step) = found else { continue };
        tally.hits += 1;
        tally.right_all += usize::from(outcome.accepted_step().count == 4);
        let error = |k: usize| step.sources[k].coefficient - case.dashpots[k].1;
        tally.errors.push(std::array::from_fn(|k| error(k) / case.dashpots[k].1));
        tally.scores.push(std::array::from_fn(|k| error(k) / step.sources[k].deviation));
    }
    Ok(tally)
}

/// Acceleration amplitudes (complex) of the sensors in each run under a unit force.
fn clean_runs(structure: &Structure, case: &Case) -> Result<Vec<Vec<faer::c64>>> {
    let sources: Vec<Source> =
        case.dashpots.iter().map(|&(dof, c)| Source::known(Effect::Viscous, Place::Dofs(vec![dof]), &[c])).collect();
    let stiffness = DynamicStiffness::new(structure, &sources)?;
    let mut force = vec![faer::c64::new(0.0, 0.0); structure.len()];
    force[DRIVE] = faer::c64::new(1.0, 0.0);
    let clean_run = |f: &f64| {
        let omega = TAU * f;
        let x = stiffness.solve(omega, &force)?;
        Ok(SENSORS.iter().map(|&dof| -x[dof] * omega * omega).collect())
    };
    case.frequencies_hz.iter().map(clean_run).collect()
}

fn noisy_runs(case: &Case, clean: &[Vec<faer::c64>], seed: u64, force_noise: bool) -> Result<Vec<Run>> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let noisy_run = |(frequency, amplitudes): (&f64, &Vec<faer::c64>)| -> Result<Run> {
        let period = 1.0 / frequency;
        let time: Vec<f64> = (0..case.samples).map(|n| PERIODS * period * n as f64 / case.samples as f64).collect();
        let unit = faer::c64::new(1.0, 0.0);
        let mut channels = vec![named(Quantity::Force, DRIVE)];
        let mut samples =
            vec![signal(&time, TAU * frequency, unit, if force_noise { NOISE } else { 0.0 }, &mut random)?];
        for (&dof, &amplitude) in SENSORS.iter().zip(amplitudes) {
            channels.push(named(Quantity::Acceleration, dof));
            samples.push(signal(&time, TAU * frequency, amplitude, NOISE, &mut random)?);
        }
        let record = Record::new(time, channels, samples)?;
        Ok(Run::from_record(format!("{frequency:.1} Hz"), None, true, Arc::new(record), Some(*frequency), 1, &[])?)
    };
    case.frequencies_hz.iter().zip(clean).map(noisy_run).collect()
}

fn named(quantity: Quantity, dof: usize) -> Channel {
    Channel { quantity, dof, label: (dof + 1).to_string() }
}

/// `Re(amplitude exp(i omega t))` with white noise of `noise` times its root mean square.
fn signal(time: &[f64], omega: f64, amplitude: faer::c64, noise: f64, random: &mut ChaCha8Rng) -> Result<Vec<f64>> {
    let white = Normal::new(0.0, noise * amplitude.norm() / std::f64::consts::SQRT_2)?;
    let value = |t: &f64| amplitude.re * (omega * t).cos() - amplitude.im * (omega * t).sin();
    Ok(time.iter().map(|t| value(t) + white.sample(random)).collect())
}

fn print_row(case: &Case, tally: &Tally, seeds: u64, seconds: f64) {
    let percent = |count: usize| 100.0 * count as f64 / seeds as f64;
    let rms = |rows: &[[f64; 4]], k: usize| {
        (rows.iter().map(|row| row[k].powi(2)).sum::<f64>() / rows.len().max(1) as f64).sqrt()
    };
    let errors: Vec<String> = (0..4).map(|k| format!("{:7.3}", 100.0 * rms(&tally.errors, k))).collect();
    let scores: Vec<String> = (0..4).map(|k| format!("{:5.2}", rms(&tally.scores, k))).collect();
    println!(
        "{:<9} {:>7} {:>6.1} {:>7.1} {:>6.1} {:>6.1}   {}    {}   {seconds:.1} s",
        case.name,
        case.samples,
        percent(tally.hits),
        percent(tally.right_count),
        percent(tally.right_all),
        percent(tally.response_form),
        errors.join(" "),
        scores.join(" ")
    );
}
