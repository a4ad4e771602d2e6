//! Identification of large structures: chains of n masses, 2.5 n candidates to the ground, between neighbours and between
//! next neighbours, 60 runs with ten sensors; four dashpots in truth. States how time grows with n.

#[path = "../tests/common/mod.rs"]
mod common;

use common::models;
use criterion::{Criterion, criterion_group, criterion_main};
use dashpot::control::Control;
use dashpot::effects::{Effect, Place, Source};
use dashpot::identify::{Settings, identify};
use dashpot::measurement::{Channel, ChannelFit, HarmonicFit, Quantity, Run};
use dashpot::response::dynamic_stiffness::DynamicStiffness;
use dashpot::session::workers::Threads;
use dashpot::structure::Structure;
use faer::{Mat, c64};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use std::sync::Arc;
use std::time::{Duration, Instant};

const RUNS: usize = 60;
const SENSORS: usize = 10;
/// Where the dashpots are, as parts of the chain.
const PLACES: [f64; 4] = [0.21, 0.47, 0.66, 0.9];
/// Standard deviation of each part of a channel over its amplitude.
const NOISE: f64 = 1e-3;

fn chain(n: usize) -> Structure {
    let masses: Vec<f64> = (0..n).map(|i| 1.0 + 0.1 * (0.7 * i as f64).sin()).collect();
    let ground: Vec<f64> = (0..n).map(|i| if i % 50 == 0 { 1e4 } else { 100.0 }).collect();
    let coupling: Vec<f64> = (1..n).map(|i| 1e6 * (1.0 + 0.2 * (0.3 * i as f64).cos())).collect();
    models::chain(&masses, &ground, &coupling)
}

fn candidates(n: usize) -> Vec<Source> {
    let grounded = (0..n).map(|i| vec![i]);
    let near = (0..n - 1).map(|i| vec![i, i + 1]);
    let far = (0..n - 2).step_by(2).map(|i| vec![i, i + 2]);
    grounded.chain(near).chain(far).map(|dofs| Source::candidate(Effect::Viscous, Place::Dofs(dofs))).collect()
}

fn runs(structure: &Structure, seed: u64) -> Vec<Run> {
    let n = structure.len();
    let dof_at = |part: f64| (part * n as f64) as usize;
    let truth: Vec<Source> = PLACES
        .iter()
        .zip([3.0, 2.0, 5.0, 1.0])
        .map(|(&part, c)| Source::known(Effect::Viscous, Place::Dofs(vec![dof_at(part)]), &[c]))
        .collect();
    let stiffness = DynamicStiffness::new(structure, &truth).unwrap_or_else(|error| panic!("{error}"));
    let drives = [dof_at(0.03), dof_at(0.36), dof_at(0.75)];
    let sensors: Vec<usize> = (0..SENSORS).map(|s| dof_at((s as f64 + 0.5) / SENSORS as f64)).chain(drives).collect();
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut normal = move || -> f64 { StandardNormal.sample(&mut random) };
    (0..RUNS)
        .map(|r| {
            let omega = 11.0 + 0.9 * (r / 3) as f64;
            let drive = drives[r % 3];
            let column = stiffness.factorise(omega).receptance_column(drive).unwrap_or_else(|error| panic!("{error}"));
            let channel = |quantity, dof: usize, value: c64| {
                let variance = (NOISE * value.norm()).powi(2);
                ChannelFit {
                    channel: Channel { quantity, dof, label: structure.label(dof).to_string() },
                    offset: 0.0,
                    slope: 0.0,
                    amplitudes: vec![value],
                    covariance: Mat::from_fn(2, 2, |i, j| if i == j { variance } else { 0.0 }),
                    noise: NOISE * value.norm(),
                }
            };
            let mut channels = vec![channel(Quantity::Force, drive, c64::new(1.0, 0.0))];
            channels.extend(sensors.iter().map(|&dof| {
                let noise = c64::new(normal(), normal()) * NOISE * column[dof].norm();
                channel(Quantity::Displacement, dof, column[dof] + noise)
            }));
            let fit = HarmonicFit { omega, omega_deviation: 0.0, channels };
            Run {
                file: format!("{r}"),
                level: None,
                session: None,
                insisted: false,
                enabled: true,
                record: None,
                fit,
                noise_ratio: 0.0,
                findings: vec![],
                per_unit_force: false,
                functions: None,
                on_moving_base: false,
            }
        })
        .collect()
}

/// Peak memory of this process, GB; 0 where the system does not say.
fn peak_gigabytes() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok()).unwrap_or(0.0) / 1e6
}

/// Processor time of this process, all threads, s; 0 where the system does not say.
fn processor_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<f64> = stat.split_whitespace().skip(13).take(2).filter_map(|word| word.parse().ok()).collect();
    fields.iter().sum::<f64>() / 100.0
}

fn bench(c: &mut Criterion) {
    let mut group = c.benchmark_group("identify");
    group.sample_size(10).warm_up_time(Duration::from_millis(1)).measurement_time(Duration::from_secs(5));
    // A number on the command line is the only size, a second one the seed of the noise.
    let mut numbers = std::env::args().filter_map(|argument| argument.parse::<usize>().ok());
    let (only, seed) = (numbers.next(), numbers.next().unwrap_or(15) as u64);
    for n in [250, 500, 1000, 2000].into_iter().filter(|&n| only.is_none_or(|only| n == only)) {
        let structure = chain(n);
        let (sources, runs) = (candidates(n), runs(&structure, seed));
        let settings = Settings { max_sources: 6, harmonics: 1, ..Settings::default() };
        let title = format!("{n} DOFs, {} candidates, {RUNS} runs", sources.len());
        let control = Control::unattended().with_workers(Arc::new(Threads));
        let (start, before) = (Instant::now(), processor_seconds());
        let outcome = identify(&structure, &sources, &runs, &settings, &control);
        let (seconds, processor) = (start.elapsed().as_secs_f64(), processor_seconds() - before);
        let outcome = outcome.unwrap_or_else(|error| panic!("{error}"));
        let step = outcome.accepted_step();
        let found: Vec<String> = step.sources.iter().map(|e| format!("{}: {:.3}", e.source, e.coefficient)).collect();
        let gigabytes = peak_gigabytes();
        let true_places: Vec<Source> = PLACES
            .iter()
            .map(|&part| Source::candidate(Effect::Viscous, Place::Dofs(vec![(part * n as f64) as usize])))
            .collect();
        let known =
            identify(&structure, &true_places, &runs, &settings, &control).unwrap_or_else(|error| panic!("{error}"));
        let truth = known.steps.last().map_or(f64::NAN, |step| step.chi_square);
        println!(
            "{title}: {seconds:.2} s, {processor:.2} s of processors, {gigabytes:.2} GB at most; {:?}, chi-square {:.1} (at the true places {truth:.1}), {}",
            outcome.form,
            step.chi_square,
            found.join(", ")
        );
        // Once is enough for the large ones.
        if n <= 500 && only.is_none() {
            group.bench_function(title, |bencher| {
                bencher.iter(|| identify(&structure, &sources, &runs, &settings, &control));
            });
        }
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);
