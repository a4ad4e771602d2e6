//! The best sets proved by branch and bound, and by looking at every set where that ends.

use criterion::{Criterion, criterion_group, criterion_main};
use dashpot::control::Control;
use dashpot::math::subsets::{SubsetProblem, branch_and_bound, exhaustive};
use faer::Mat;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::time::Duration;

/// Squares of sums of sines, as the energies of dashpots on a beam are; five in use, 2 % noise.
fn problem(rows: usize, columns: usize) -> (Mat<f64>, Vec<f64>) {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    let weights = Mat::from_fn(rows, 12, |_, _| rng.random::<f64>() - 0.5);
    let shape =
        |mode: usize, j: usize| ((mode + 1) as f64 * std::f64::consts::PI * (j as f64 + 0.37) / columns as f64).sin();
    let a = Mat::from_fn(rows, columns, |i, j| (0..12).map(|m| weights[(i, m)] * shape(m, j)).sum::<f64>().powi(2));
    let used = [columns / 9, columns / 4, columns / 2, 2 * columns / 3, columns - 3];
    let b = (0..rows)
        .map(|i| used.iter().map(|&j| a[(i, j)]).sum::<f64>() * (1.0 + 0.04 * (rng.random::<f64>() - 0.5)))
        .collect();
    (a, b)
}

fn bench(c: &mut Criterion) {
    let mut group = c.benchmark_group("best 5");
    group.sample_size(10).warm_up_time(Duration::from_millis(100)).measurement_time(Duration::from_secs(2));
    for (rows, columns) in [(8, 40), (24, 40), (8, 90), (24, 90), (8, 180), (24, 180), (60, 180)] {
        let (a, b) = problem(rows, columns);
        let question = SubsetProblem { a: a.as_ref(), b: &b, size: 5, keep: 5, forced: &[], node_limit: u64::MAX };
        let control = Control::unattended();
        let found = branch_and_bound(&question, &control);
        let found = found.unwrap_or_else(|error| panic!("{error}"));
        println!("{rows} x {columns}: proved {} with {} nodes", found.proved, found.nodes);
        group.bench_function(format!("of {columns}, {rows} rows, branch and bound"), |bencher| {
            bencher.iter(|| branch_and_bound(&question, &control));
        });
        if columns == 40 {
            group.bench_function(format!("of {columns}, {rows} rows, exhaustive"), |bencher| {
                bencher.iter(|| exhaustive(&question, &control));
            });
        }
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);
