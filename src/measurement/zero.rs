//! The zero of a channel: what it shows where nothing acts. Amplifiers, strain gauges and accelerometers that measure gravity have one,
//! and no test tells it apart from a constant force or a constant displacement but by what the rest of the record shows.
//!
//! The mean of a motion is taken for a zero. Of a force only what its own record proves is: what a hammer shows between its blows, and a
//! mean that stands out of the lines beside it (a force that is no constant has a spectrum that is smooth about 0 Hz).

use super::channel::Quantity;
use super::contacts::is_blow;
use super::finding::{Finding, Flag};
use super::kind::Kind;
use super::transient_run::TransientRun;
use crate::math::statistics::{mean, median, root_mean_square};
use dashpot_numerics::RealTransform;

/// Lines beside 0 Hz, and how many times their root mean square a mean is that no force has by chance: of Gaussian noise
/// one in two million (Student's t of 16 degrees of freedom).
const BESIDE: usize = 8;
const ABOVE: f64 = 8.0;
/// Deviations of the median of a resting force from which it is a zero.
const SURE: f64 = 6.0;
/// Deviation of the median over that of Gaussian noise times the root of the count, and over the median of its size.
const OF_MEDIAN: [f64; 2] = [1.2533, 1.4826];
/// Mean over the root mean square of the rest from which a zero is worth telling.
const TOLD: f64 = 0.1;

/// What a measured force shows where nothing acts; 0 where its record proves none.
fn zero(force: &[f64]) -> f64 {
    if is_blow(force) { resting(force) } else { constant(force) }
}

/// The level at which a hammer rests.
fn resting(force: &[f64]) -> f64 {
    let level = median(force);
    let sizes: Vec<f64> = force.iter().map(|f| (f - level).abs()).collect();
    let deviation = OF_MEDIAN[0] * OF_MEDIAN[1] * median(&sizes) / (force.len() as f64).sqrt();
    if level.abs() > SURE * deviation { level } else { 0.0 }
}

/// The mean where it stands out of the lines beside it.
fn constant(force: &[f64]) -> f64 {
    if force.len() < 8 * BESIDE {
        return 0.0;
    }
    let lines = RealTransform::new(force.len()).forward(&mut force.to_vec());
    let beside: Vec<f64> = lines[1..=BESIDE].iter().map(|line| line.norm()).collect();
    if lines[0].norm() > ABOVE * root_mean_square(&beside) { mean(force) } else { 0.0 }
}

/// A measured force without its zero.
pub(crate) fn without_zero(force: &[f64]) -> Vec<f64> {
    let zero = zero(force);
    force.iter().map(|f| f - zero).collect()
}

/// The zeros of the channels of a run that are worth telling.
pub(super) fn zeros(run: &TransientRun) -> Vec<Finding> {
    (0..run.channels().len()).filter_map(|c| told(run, c)).collect()
}

fn told(run: &TransientRun, c: usize) -> Option<Finding> {
    let (channel, samples) = (&run.channels()[c], run.samples(c));
    let zero = match channel.quantity {
        Quantity::Force if run.kind == Kind::Decay => return None,
        Quantity::Force | Quantity::Base => zero(samples),
        _ => mean(samples),
    };
    let rest: Vec<f64> = samples.iter().map(|y| y - zero).collect();
    let share = zero.abs() / root_mean_square(&rest).max(f64::MIN_POSITIVE);
    let reason = format!(
        "{channel} stands off zero by {:.0} % of its root mean square: taken as the zero of its sensor",
        100.0 * share
    );
    (share > TOLD).then(|| Finding::of_channel(Flag::Offset, channel, reason))
}

#[cfg(test)]
mod tests {
    use super::{without_zero, zero};
    use std::f64::consts::{PI, TAU};

    fn noise(n: usize) -> f64 {
        let x = (n as f64 * 12.9898).sin() * 43_758.545;
        x - x.floor() - 0.5
    }

    /// A sweep, noise and a blow have none; a constant beside them is found.
    #[test]
    fn a_zero_is_found_where_there_is_one() {
        let sweep = |n: usize| (TAU * (0.01 + 2e-5 * n as f64) * n as f64).sin();
        let blow = |n: usize| if (500..506).contains(&n) { 80.0 * (PI * (n as f64 - 499.5) / 6.0).sin() } else { 0.0 };
        let waves: [&dyn Fn(usize) -> f64; 3] = [&sweep, &noise, &|n| blow(n) + 1e-3 * noise(n)];
        for (wave, offset) in waves.into_iter().zip([0.2, 0.3, 0.05]) {
            let shifted = |level: f64| (0..4000).map(|n| level + wave(n)).collect::<Vec<f64>>();
            assert_eq!(zero(&shifted(0.0)), 0.0);
            assert!((zero(&shifted(offset)) / offset - 1.0).abs() < 0.1, "{} {offset}", zero(&shifted(offset)));
            assert!(zero(&without_zero(&shifted(offset))).abs() < 0.01 * offset);
        }
    }

    /// A force that holds a load and lets go of it, or a slow one, is no zero.
    #[test]
    fn a_slow_force_is_no_zero() {
        let slow: Vec<f64> = (0..4000).map(|n| 2.0 * (TAU * f64::from(n) / 3000.0).sin()).collect();
        let held: Vec<f64> = (0..4000).map(|n| if n < 2500 { 5.0 } else { 0.0 }).collect();
        assert_eq!(zero(&slow), 0.0);
        assert_eq!(zero(&held), 0.0);
    }
}
