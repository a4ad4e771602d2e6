//! The harmonic fit beside integration by Fourier transforms, for 8 runs of 10 channels: how both grow with the samples.
//!
//! The other route transforms every acceleration, divides by `i omega` and `(i omega)^2`, transforms back to velocity
//! and displacement histories, and sums `v f` over whole periods. It gives the energy without any deviation, and needs
//! whole periods and even steps.

#![allow(clippy::unwrap_used, missing_docs, reason = "a bench")]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use dashpot::measurement::{Channel, Quantity, Record, fit};
use realfft::RealFftPlanner;
use realfft::num_complex::Complex;
use std::f64::consts::TAU;
use std::hint::black_box;

const CHANNELS: usize = 10;
const RUNS: usize = 8;
const HARMONICS: usize = 7;
const FREQUENCY_HZ: f64 = 20.0;

/// A run of 50 whole periods: a force and nine accelerations with some friction and some noise.
fn record(samples: usize, run: usize) -> Record {
    let step = 50.0 / FREQUENCY_HZ / samples as f64;
    let time: Vec<f64> = (0..samples).map(|n| n as f64 * step).collect();
    let mut state = run as u64 + 1;
    let mut noise = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let channel = |c: usize| {
        let quantity = if c == 0 { Quantity::Force } else { Quantity::Acceleration };
        Channel { quantity, dof: c.max(1) - 1, label: c.max(1).to_string() }
    };
    let value = |c: usize, t: f64| {
        let theta = TAU * FREQUENCY_HZ * t + 0.3 * c as f64;
        theta.cos() + 0.05 * (3.0 * theta).sin()
    };
    let values = (0..CHANNELS).map(|c| time.iter().map(|&t| value(c, t) + 0.02 * noise()).collect()).collect();
    Record::new(time, (0..CHANNELS).map(channel).collect(), values).unwrap()
}

/// Energy that the force puts in at the DOF of channel 1, by transforms of all channels.
fn by_transforms(record: &Record, planner: &mut RealFftPlanner<f64>) -> f64 {
    let n = record.len();
    let (forward, backward) = (planner.plan_fft_forward(n), planner.plan_fft_inverse(n));
    let step = record.step();
    let mut energy = 0.0;
    for c in 1..CHANNELS {
        let mut samples = record.samples(c).to_vec();
        let mut lines = forward.make_output_vec();
        forward.process(&mut samples, &mut lines).unwrap();
        let mut histories = [vec![0.0; n], vec![0.0; n]];
        for (history, times) in histories.iter_mut().zip([1, 2]) {
            let mut integrated = lines.clone();
            for (k, line) in integrated.iter_mut().enumerate() {
                let omega = TAU * k as f64 / (n as f64 * step);
                let keep = k > 0 && (2 * k != n);
                *line = if keep { *line / Complex::new(0.0, omega).powi(times) / n as f64 } else { Complex::default() };
            }
            backward.process(&mut integrated, history).unwrap();
        }
        let power: f64 = histories[0].iter().zip(record.samples(0)).map(|(v, f)| v * f).sum();
        energy += if c == 1 { power * step / 50.0 } else { 0.0 };
        black_box(&histories);
    }
    energy
}

/// The same energy from the fit: `(T/2) sum_h Re(V_h^H F_h)`.
fn by_fit(record: &Record) -> f64 {
    let fit = fit(record, TAU * FREQUENCY_HZ, HARMONICS).unwrap();
    let (force, motion) = (fit.force(0).unwrap(), fit.displacement(0).unwrap());
    let harmonics = force.amplitudes.iter().zip(&motion.amplitudes).enumerate();
    let power: f64 =
        harmonics.map(|(i, (f, x))| ((x * faer::c64::new(0.0, (i + 1) as f64 * fit.omega)).conj() * f).re).sum();
    0.5 * fit.period() * power
}

fn bench(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("harmonic_fit");
    group.sample_size(10);
    for samples in [1_000, 10_000, 100_000] {
        let records: Vec<Record> = (0..RUNS).map(|run| record(samples, run)).collect();
        let mut planner = RealFftPlanner::new();
        let (one, other) = (by_fit(&records[0]), by_transforms(&records[0], &mut planner));
        assert!((one / other - 1.0).abs() < 1e-2, "both routes give one energy: {one} {other}");
        group.throughput(Throughput::Elements((samples * CHANNELS * RUNS) as u64));
        group.bench_with_input(BenchmarkId::new("fit", samples), &records, |bencher, records| {
            bencher.iter(|| records.iter().map(by_fit).sum::<f64>());
        });
        group.bench_with_input(BenchmarkId::new("transforms", samples), &records, |bencher, records| {
            bencher.iter(|| records.iter().map(|record| by_transforms(record, &mut planner)).sum::<f64>());
        });
    }
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
