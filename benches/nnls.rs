//! Non-negative least squares on energy-like columns: positive, nearly collinear, of very different size.

use criterion::{Criterion, criterion_group, criterion_main};
use dashpot::math::nnls::nnls;
use faer::Mat;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::hint::black_box;

fn problem(rows: usize, columns: usize) -> (Mat<f64>, Vec<f64>) {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let a = Mat::from_fn(rows, columns, |_, j| [1e-2, 0.1, 1.0, 10.0, 100.0][j % 5] * (0.3 + rng.random::<f64>()));
    let b =
        (0..rows).map(|i| (0..5).map(|k| a[(i, 3 * k)]).sum::<f64>() * (1.0 + 0.05 * rng.random::<f64>())).collect();
    (a, b)
}

fn bench(c: &mut Criterion) {
    for (rows, columns) in [(24, 20), (24, 40), (24, 80), (48, 80)] {
        let (a, b) = problem(rows, columns);
        c.bench_function(&format!("nnls {rows} x {columns}"), |bencher| {
            bencher.iter(|| nnls(black_box(a.as_ref()), black_box(&b)));
        });
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);
