//! Periodic responses by harmonic balance: one response against time stepping, a sweep through folds, growth in size.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use dashpot::control::Control;
use dashpot::effects::{Effect, Place, Source};
use dashpot::response::harmonic_balance::{Excitation, ForwardModel, Settings, SweepSettings, sweep};
use dashpot::response::sensitivity::{Unknown, sensitivities};
use dashpot::response::time_integration::{Settling, TimeModel};
use dashpot::structure::Structure;
use dashpot::structure::beam::{BeamParameters, Supports};
use faer::c64;
use std::f64::consts::TAU;
use std::hint::black_box;

fn beam(elements: usize) -> Structure {
    let (youngs_modulus, density, supports) = (69e9, 2700.0, Supports::ClampedFree);
    BeamParameters { length: 0.56, breadth: 0.04, depth: 0.004, youngs_modulus, density, elements, supports }
        .build(&[])
        .unwrap_or_else(|error| panic!("{error}"))
}

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
    let at = |k: usize| source(Effect::Coulomb, row(n, (k + 1) as f64 / count as f64), &[0.3 / (k + 1) as f64]);
    [vec![damped(), source(Effect::Viscous, row(n, 0.2), &[0.2])], (0..count).map(at).collect()].concat()
}

fn one_response(c: &mut Criterion) {
    let mut group = c.benchmark_group("one_response");
    let structure = beam(10);
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
            b.iter(|| sensitivities(&run, &sources, &excitation, &start, &unknowns).map(black_box));
        });
    }
    group.sample_size(10);
    for steps in [4_000, 16_000] {
        group.bench_function(BenchmarkId::new("time_stepping", steps), |b| {
            b.iter(|| {
                let mut model = TimeModel::new(&structure, &sources, &excitation, steps)?;
                model.settle(&Settling::default(), &control)?;
                model.harmonics(7).map(black_box)
            });
        });
    }
    group.finish();
}

fn folds(c: &mut Criterion) {
    let sources = [damped(), source(Effect::CubicStiffness, 18, &[5e6])];
    let Ok(model) = ForwardModel::new(&beam(10), &sources) else { return };
    let excitation = Excitation::sine(TAU * 10.0, 18, c64::new(0.5, 0.0));
    let settings = SweepSettings { largest_step: 0.005, ..SweepSettings::default() };
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
        let Ok(model) = ForwardModel::new(&beam(10), &sources) else { continue };
        let excitation = Excitation::sine(TAU * 10.0, 18, c64::new(1.0, 0.0));
        let run = model.at(excitation.omega);
        group.bench_function(BenchmarkId::new("nonlinear_dofs", count), |b| {
            b.iter(|| run.respond(&sources, &excitation, &settings, None, &control).map(black_box));
        });
    }
    for n in [20, 200, 2000] {
        let sources = friction(n, 3);
        let Ok(model) = ForwardModel::new(&beam(n / 2), &sources) else { continue };
        let excitation = Excitation::sine(TAU * 10.0, n - 2, c64::new(1.0, 0.0));
        group.bench_function(BenchmarkId::new("structure_dofs", n), |b| {
            b.iter(|| model.respond(&excitation, &settings, None, &control).map(black_box));
        });
    }
    group.finish();
}

criterion_group!(benches, one_response, folds, growth);
criterion_main!(benches);
