//! All damped modes of a cantilever with grounded dashpots.

#[path = "../tests/common/mod.rs"]
mod common;

use common::models::cantilever;
use criterion::{Criterion, criterion_group, criterion_main};
use dashpot::structure::damped_modes::damped_modes;
use faer::Mat;
use std::time::Duration;

fn bench(c: &mut Criterion) {
    let mut group = c.benchmark_group("damped modes");
    group.sample_size(10).warm_up_time(Duration::from_millis(100)).measurement_time(Duration::from_secs(2));
    for n in [20, 60, 180, 500, 1000] {
        let structure = cantilever(n / 2);
        let Some(matrices) = structure.matrices() else { panic!("a beam has matrices") };
        let damping = Mat::from_fn(n, n, |i, j| if i == j && i % 6 == 2 { 0.2 } else { 0.0 });
        group.bench_function(format!("n = {n}"), |bencher| {
            bencher.iter(|| {
                let found = damped_modes(matrices.mass.as_ref(), matrices.stiffness.as_ref(), damping.as_ref());
                found.unwrap_or_else(|error| panic!("{error}"))
            });
        });
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);
