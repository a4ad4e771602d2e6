//! Periodic responses by harmonic balance: one response against time stepping, a sweep through folds, growth in size, and
//! the comparison of a model with 24 runs.

#[path = "../tests/common/mod.rs"]
mod common;

use common::models::{cantilever, uniform_chain};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use dashpot::control::Control;
use dashpot::diagnosis::{Problem, compare};
use dashpot::effects::{Effect, Place, Source};
use dashpot::measurement::{Run, fit::fit};
use dashpot::response::harmonic_balance::{Excitation, ForwardModel, Settings, SweepSettings, sweep};
use dashpot::response::sensitivity::{Unknown, sensitivities};
use dashpot::response::simulation::{SteadyState, recorded, usual_channels};
use dashpot::response::synthesis::{Noise, sampling_times, synthesise};
use dashpot::response::time_integration::{Settling, TimeError, TimeModel};
use dashpot::session::workers::Threads;
use dashpot::structure::Structure;
use faer::{Mat, c64};
use std::f64::consts::TAU;
use std::hint::black_box;
use std::sync::Arc;

fn source(effect: Effect, dof: usize, parameters: &[f64]) -> Source {
    Source::known(effect, Place::Dofs(vec![dof]), parameters)
}

fn damped() -> Source {
    Source::known(Effect::StiffnessProportional, Place::Whole(None), &[2e-5])
}

/// Translation of a beam of `n` DOFs at a share of its length.
fn row(n: usize, share: f64) -> usize {
    2 * ((n / 2 - 1) as f64 * share) as usize
}

fn friction(n: usize, count: usize) -> Vec<Source> {
    let joint = |k: usize| source(Effect::Coulomb, row(n, (k + 1) as f64 / count as f64), &[0.3 / (k + 1) as f64]);
    [vec![damped(), source(Effect::Viscous, row(n, 0.2), &[0.2])], (0..count).map(joint).collect()].concat()
}

fn one_response(c: &mut Criterion) {
    // As the program does: threads cost more than they save on matrices of this size.
    faer::set_global_parallelism(faer::Par::Seq);
    let mut group = c.benchmark_group("one_response");
    let structure = cantilever(10);
    let sources = friction(20, 3);
    let excitation = Excitation::sine(TAU * 10.0, 18, c64::new(1.0, 0.0));
    let control = Control::unattended();
    for harmonics in [7, 15] {
        let settings = Settings { estimate: false, ..Settings::fixed(harmonics) };
        let model = ForwardModel::new(&structure, &sources).unwrap_or_else(|e| panic!("{e}"));
        group.bench_function(BenchmarkId::new("cold", harmonics), |b| {
            b.iter(|| model.respond(&excitation, &settings, None, &control).map(black_box));
        });
        let run = model.at(excitation.omega);
        group.bench_function(BenchmarkId::new("kept_receptance", harmonics), |b| {
            b.iter(|| run.respond(&sources, &excitation, &settings, None, &control).map(black_box));
        });
        let Ok(start) = run.respond(&sources, &excitation, &settings, None, &control) else { continue };
        let mut moved = sources.clone();
        moved[2].parameters[0] *= 1.05;
        group.bench_function(BenchmarkId::new("refit_step", harmonics), |b| {
            b.iter(|| run.respond(&moved, &excitation, &settings, Some(&start), &control).map(black_box));
        });
        let unknowns: Vec<Unknown> = (1..5).map(|source| Unknown::Source { source, parameter: 0 }).collect();
        group.bench_function(BenchmarkId::new("four_derivatives", harmonics), |b| {
            b.iter(|| {
                sensitivities(&run, &sources, &excitation, &start, &(0..run.len()).collect::<Vec<_>>(), &unknowns)
                    .map(black_box)
            });
        });
    }
    group.sample_size(10);
    // By mixing periods, and by waiting for the transients to die.
    for (name, steps, accelerate) in
        [("time_stepping", 4_000, true), ("time_stepping", 16_000, true), ("time_waiting", 4_000, false)]
    {
        group.bench_function(BenchmarkId::new(name, steps), |b| {
            b.iter(|| stepped(&structure, &sources, &excitation, steps, accelerate).map(black_box));
        });
    }
    group.finish();
    accuracies(&structure, &sources, &excitation);
}

/// Harmonics by time stepping from rest.
fn stepped(
    structure: &Structure,
    sources: &[Source],
    excitation: &Excitation,
    steps: usize,
    accelerate: bool,
) -> Result<Mat<c64>, TimeError> {
    let mut model = TimeModel::new(structure, sources, excitation, steps)?;
    let settling = Settling { accelerate, most_periods: 5_000, ..Settling::default() };
    model.settle(&settling, &Control::unattended())?;
    model.harmonics(7)
}

/// Prints how exact each way is, against harmonic balance with all the harmonics that matter.
fn accuracies(structure: &Structure, sources: &[Source], excitation: &Excitation) {
    let Ok(model) = ForwardModel::new(structure, sources) else { return };
    let respond = |settings: &Settings| model.respond(excitation, settings, None, &Control::unattended());
    let Ok(exact) = respond(&Settings { truncation: 1e-7, ..Settings::default() }) else { return };
    let report = |name: &str, amplitude: &dyn Fn(usize, usize) -> c64| {
        let off = |h: usize| {
            let largest = (0..20).fold(0.0_f64, |m, i| m.max(exact.amplitude(i, h).norm()));
            (0..20).fold(0.0_f64, |m, i| m.max((amplitude(i, h) - exact.amplitude(i, h)).norm())) / largest
        };
        println!("{name}: fundamental off by {:.1e}, third harmonic by {:.1e}", off(1), off(3));
    };
    for harmonics in [7, 15] {
        if let Ok(found) = respond(&Settings { estimate: false, ..Settings::fixed(harmonics) }) {
            report(&format!("{harmonics} harmonics"), &|i, h| found.amplitude(i, h));
        }
    }
    for steps in [1_000, 4_000, 16_000] {
        if let Ok(found) = stepped(structure, sources, excitation, steps, true) {
            report(&format!("{steps} steps"), &|i, h| found[(i, h - 1)]);
        }
    }
}

fn folds(c: &mut Criterion) {
    let sources = [damped(), source(Effect::CubicStiffness, 18, &[5e6])];
    let Ok(model) = ForwardModel::new(&cantilever(10), &sources) else { return };
    let excitation = Excitation::sine(TAU * 10.0, 18, c64::new(0.003, 0.0));
    let settings = SweepSettings { largest_step: 0.01, ..SweepSettings::default() };
    let range = [TAU * 6.0, TAU * 20.0];
    let mut group = c.benchmark_group("sweep");
    group.sample_size(10);
    if let Ok(curve) = sweep(&model, &excitation, range, &settings, &Control::unattended()) {
        let turns = curve.points.windows(2).filter(|p| p[0].stable != p[1].stable).count();
        println!("sweep: {} points, {turns} folds, {:?}", curve.points.len(), curve.end);
    }
    group.bench_function("through_folds", |b| {
        b.iter(|| sweep(&model, &excitation, range, &settings, &Control::unattended()).map(black_box));
    });
    group.finish();
}

fn growth(c: &mut Criterion) {
    let mut group = c.benchmark_group("growth");
    group.sample_size(10);
    let settings = Settings { estimate: false, ..Settings::fixed(7) };
    let control = Control::unattended();
    for count in [1, 2, 4, 8] {
        let sources = friction(20, count);
        let Ok(model) = ForwardModel::new(&cantilever(10), &sources) else { continue };
        let excitation = Excitation::sine(TAU * 10.0, 18, c64::new(1.0, 0.0));
        let run = model.at(excitation.omega);
        group.bench_function(BenchmarkId::new("nonlinear_dofs", count), |b| {
            b.iter(|| run.respond(&sources, &excitation, &settings, None, &control).map(black_box));
        });
    }
    // A chain, not a beam: a beam of a thousand elements has no digits left in its first modes.
    for n in [20, 200, 2000] {
        let friction_at = |share: usize, f: f64| source(Effect::Coulomb, n * share / 4 - 1, &[f]);
        let sources = [damped(), friction_at(1, 0.1), friction_at(2, 0.2), friction_at(4, 0.3)];
        let structure = uniform_chain(n, 1.0 / n as f64, 1e3 * n as f64);
        let Ok(model) = ForwardModel::new(&structure, &sources) else { continue };
        let excitation = Excitation::sine(TAU * 7.0, n - 1, c64::new(1.0, 0.0));
        group.bench_function(BenchmarkId::new("structure_dofs", n), |b| {
            b.iter(|| model.respond(&excitation, &settings, None, &control).map(black_box));
        });
    }
    group.finish();
}

/// 24 runs of the beam with friction: eight frequencies, three forces.
fn measured() -> (Structure, Vec<Source>, Vec<Run>) {
    let (structure, sources) = (cantilever(10), friction(20, 3));
    let mut runs = Vec::new();
    let Ok(model) = ForwardModel::new(&structure, &sources) else { return (structure, sources, runs) };
    for k in 0..24 {
        let hz = [9.5, 10.2, 11.0, 60.0, 65.0, 70.0, 175.0, 185.0][k % 8];
        let excitation = Excitation::sine(TAU * hz, 18, c64::new([1.0, 2.0, 4.0][k / 8], 0.0));
        let Ok(response) = model.respond(&excitation, &Settings::default(), None, &Control::unattended()) else {
            continue;
        };
        let state = SteadyState { mean: response.mean, harmonics: response.harmonics };
        let motions = recorded(&state, &excitation, &usual_channels(&structure, &excitation)[..5], &[]);
        let noise = Noise { ratio: 0.01, seed: 1, stream: k as u64 };
        let time = sampling_times(excitation.omega, 20.0, 1000);
        let Ok(record) = synthesise(excitation.omega, &time, &motions, Some(noise)) else { continue };
        let Ok(fit) = fit(&record, excitation.omega, 7) else { continue };
        let file = format!("run-{k:02}.csv");
        let run = Run { noise_ratio: 0.01, findings: Vec::new(), ..Run::from_harmonics(file, None, true, fit, &[]) };
        runs.push(run);
    }
    (structure, sources, runs)
}

fn comparison(c: &mut Criterion) {
    let (structure, sources, runs) = measured();
    let mut group = c.benchmark_group("compare");
    group.sample_size(10);
    for (name, sources) in [("linear_model", &sources[..2]), ("three_frictions", &sources[..])] {
        let problem = Problem { structure: &structure, sources, runs: &runs };
        let shared = Control::unattended().with_workers(Arc::new(Threads));
        for (threads, control) in [("one_thread", Control::unattended()), ("all_threads", shared)] {
            group.bench_function(BenchmarkId::new(format!("{name}/{threads}"), runs.len()), |b| {
                b.iter(|| compare(&problem, &[], &control).map(black_box));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, one_response, folds, growth, comparison);
criterion_main!(benches);
