//! Steady runs and decays as plain numbers.

use dashpot::measurement::{
    Channel, ChannelFit, HarmonicFit, Kind, Quantity, Record, Run, TransientLabel, TransientRun,
};
use faer::{Mat, c64};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use std::sync::Arc;

/// A channel with these amplitudes; `deviation` is the standard deviation of each real and imaginary part, 0 where it is not
/// known.
pub fn channel(quantity: Quantity, dof: usize, amplitudes: Vec<c64>, deviation: f64) -> ChannelFit {
    let size = 2 * amplitudes.len();
    ChannelFit {
        channel: Channel { quantity, dof, label: format!("{}", dof + 1) },
        offset: 0.0,
        slope: 0.0,
        covariance: Mat::from_fn(size, size, |i, j| if i == j { deviation * deviation } else { 0.0 }),
        amplitudes,
        noise: deviation,
    }
}

/// A run at `omega` (rad/s).
pub fn run(name: String, omega: f64, channels: Vec<ChannelFit>) -> Run {
    let fit = HarmonicFit { omega, omega_deviation: 0.0, channels };
    Run::from_harmonics(name, None, true, fit, &[])
}

/// A run of one harmonic under a `force` (N) at a DOF, with displacements (m) of all DOFs in turn.
pub fn displacements_run(omega: f64, (dof, force): (usize, f64), motion: &[c64], deviation: f64) -> Run {
    let mut channels = vec![channel(Quantity::Force, dof, vec![c64::new(force, 0.0)], deviation * force)];
    for (dof, x) in motion.iter().enumerate() {
        channels.push(channel(Quantity::Displacement, dof, vec![*x], deviation * x.norm()));
    }
    run(format!("{omega} rad/s, {force} N"), omega, channels)
}

/// A decay sampled every `step` seconds, one row of displacements (m) a DOF.
pub fn decay(step: f64, rows: Vec<Vec<f64>>) -> TransientRun {
    let channel = |dof: usize| Channel { quantity: Quantity::Displacement, dof, label: format!("{}", dof + 1) };
    let time = (0..rows[0].len()).map(|k| step * k as f64).collect();
    let record = Record::new(time, (0..rows.len()).map(channel).collect(), rows).unwrap();
    let label = TransientLabel { file: "decay.csv".into(), kind: Kind::Decay, enabled: true, ..Default::default() };
    TransientRun::new(label, Arc::new(record), &[]).unwrap()
}

/// Adds noise of `relative` deviation of each channel's largest amplitude (real and imaginary part each) and states it.
pub fn with_noise(runs: &[Run], relative: f64, seed: u64) -> Vec<Run> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut noisy = runs.to_vec();
    for channel in noisy.iter_mut().flat_map(|r| r.fit.channels.iter_mut()) {
        let deviation = relative * channel.amplitudes.iter().fold(0.0_f64, |m, a| m.max(a.norm()));
        for amplitude in &mut channel.amplitudes {
            let mut sample = || -> f64 { StandardNormal.sample(&mut random) };
            *amplitude += c64::new(sample(), sample()) * deviation;
        }
        let size = 2 * channel.amplitudes.len();
        channel.covariance = Mat::from_fn(size, size, |i, j| if i == j { deviation * deviation } else { 0.0 });
    }
    noisy
}

/// Numbers from -0.5 to 0.5 that have nothing to do with each other, the same for a seed at every call (Knuth's linear congruential generator).
pub fn uniform(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    }
}
