//! The whole search for one missing effect on a beam, every effect at every place: growth with sensors and runs, and by law.
#![allow(missing_docs, clippy::unwrap_used, reason = "a benchmark")]

#[path = "../examples/hidden_effects/random.rs"]
#[allow(dead_code, reason = "shared with the example, which uses all of it")]
mod random;
#[path = "../examples/hidden_effects/records.rs"]
mod records;
#[path = "../examples/hidden_effects/sizing.rs"]
mod sizing;
#[path = "../examples/hidden_effects/specimen.rs"]
#[allow(dead_code, reason = "shared with the example, which uses all of it")]
mod specimen;
#[path = "../examples/hidden_effects/suite.rs"]
#[allow(dead_code, reason = "shared with the example, which uses all of it")]
mod suite;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use dashpot::control::Control;
use dashpot::diagnosis::diagnose;
use dashpot::effects::Effect;
use dashpot::session::workers::Threads;
use random::Random;
use std::sync::Arc;
use suite::{Hidden, Kindness, hidden};

fn project(effect: Effect, sensors: usize, runs: usize) -> Hidden {
    let kindness = Kindness {
        beam: true,
        points: false,
        sensors,
        runs,
        levels: 2,
        noise: 0.01,
        size: 0.25,
        detuned: 0.0,
        unsettled: false,
    };
    hidden(&[effect], kindness, &mut Random::new(1)).unwrap()
}

fn measure(criterion: &mut Criterion) {
    faer::set_global_parallelism(faer::Par::Seq);
    let control = || Control::unattended().with_workers(Arc::new(Threads));
    let mut group = criterion.benchmark_group("diagnose");
    group.sample_size(10);
    let mut measure_case = |name: String, effect: Effect, sensors: usize, runs: usize| {
        let project = project(effect, sensors, runs);
        group.bench_with_input(BenchmarkId::new(effect.name(), name), &project, |b, project| {
            b.iter(|| diagnose(&project.problem(), &control()).unwrap());
        });
    };
    for sensors in [3, 6, 10] {
        measure_case(format!("24 runs, {sensors} sensors"), Effect::Viscous, sensors, 24);
    }
    for runs in [12, 48] {
        measure_case(format!("{runs} runs, 6 sensors"), Effect::Viscous, 6, runs);
    }
    for effect in [Effect::Coulomb, Effect::CubicStiffness, Effect::Mass, Effect::LossFactor, Effect::Delay] {
        measure_case("24 runs, 6 sensors".to_owned(), effect, 6, 24);
    }
    group.finish();
}

criterion_group!(benches, measure);
criterion_main!(benches);
