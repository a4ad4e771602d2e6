//! From where on a record moves so slowly that long steps of its model resolve it.
//!
//! A blow moves all modes, of which the fast ones have soon died out; what rings on may need a tenth of the steps. The linear part of a
//! model is exact in steps of any length: what they must resolve is the motion that a law sees, its displacement and velocity. Steps
//! are long where the velocities faster than they resolve are a small share of all, in all channels together and above their noise.

use super::compare::struck;
use super::data::RecordData;
use super::weights::local;
use crate::math::zero_phase::{Extension, filtered};
use crate::response::transient::StepLength;
use std::f64::consts::TAU;

/// Phase of the fastest motion that is resolved, rad, that a long step covers: a third of what short ones cover of the highest motion
/// ([`super::steps`]), for it is most of what a law sees.
const STEP_PHASE: f64 = 0.13;
/// Share of the velocity that may be faster.
const FASTER: f64 = 0.05;
/// Variance of noise over that which it has in the mean from which on a velocity is no noise.
const NOISE: f64 = 2.0;
/// Lowest frequency of velocities over the dominant one: below, integrated noise is more than they are.
const LOWEST: f64 = 0.5;

impl RecordData {
    /// Number of the first sample from which on steps of 2, 4, 8, ... samples resolve the motion, up to `most` samples; none where a
    /// force acts all along.
    pub(super) fn settled(&self, most: usize) -> Vec<usize> {
        let after = if self.forces.is_empty() { Some(0.0) } else { struck(self) };
        let Some(after) = after else { return Vec::new() };
        let blow = (after * self.len() as f64).ceil() as usize;
        let lengths = std::iter::successors(Some(2), |m| Some(2 * m)).take_while(|m| *m <= most);
        let mut least = blow;
        let from = |m: usize| {
            least = least.max(self.slow_from(STEP_PHASE / (TAU * m as f64 * self.step)));
            least
        };
        lengths.map(from).collect()
    }

    /// The sample from which on velocities above a frequency are a small share of all.
    fn slow_from(&self, hz: f64) -> usize {
        let (n, lowest) = (self.len(), LOWEST * self.dominant_hz);
        let half = ((1.0 / (hz * self.step)).ceil() as usize).clamp(2, n.max(2));
        let mut squares = [vec![0.0; n], vec![0.0; n]];
        for (c, channel) in self.channels.iter().enumerate() {
            let Some(order) = channel.quantity.derivatives() else { continue };
            for (sum, from) in squares.iter_mut().zip([hz, lowest]) {
                let noise = NOISE * self.noise[c].powi(2) * velocity_of_noise(from, self.step, order);
                let sizes = local(&velocity(&self.samples[c], self.step, order, from), half);
                sum.iter_mut().zip(sizes).for_each(|(sum, v)| *sum += (v * v - noise).max(0.0));
            }
        }
        let [fast, all] = &squares;
        (0..n).rev().find(|&k| fast[k] > FASTER.powi(2) * all[k]).map_or(0, |k| k + 1)
    }

    /// How the model is stepped through the record: `longest` samples at a time where the motion has settled, less where it has not.
    pub(super) fn step_lengths(&self, longest: usize) -> Vec<StepLength> {
        let long = self
            .settled
            .iter()
            .zip(1..)
            .map(|(from, k)| StepLength { from: from.next_multiple_of(self.every), samples: 1 << k });
        long.take_while(|length| length.samples <= longest.min(self.every)).collect()
    }
}

/// The velocity above a frequency that a signal shows, which is displacement differentiated `order` times.
fn velocity(signal: &[f64], step: f64, order: i32, from_hz: f64) -> Vec<f64> {
    let gain = |hz: f64| if hz > from_hz { (TAU * hz).powi(1 - order) } else { 0.0 };
    filtered(signal, step, Extension::Even, gain)
}

/// Variance of that velocity of white noise of variance 1.
fn velocity_of_noise(from_hz: f64, step: f64, order: i32) -> f64 {
    let nyquist = 0.5 / step;
    let power = 2 * (1 - order) + 1;
    let integral = |hz: f64| TAU.powi(power - 1) * hz.powi(power) / f64::from(power);
    if from_hz < nyquist { 2.0 * step * (integral(nyquist) - integral(from_hz)) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::chain;
    use crate::common::runs::{decay, uniform};
    use crate::diagnosis::records::data::Records;

    /// A fast mode that dies out beside a slow one: steps of 4 samples resolve the motion from where the fast velocity is a twentieth.
    #[test]
    fn steps_grow_where_the_fast_mode_has_died_out() {
        let (step, slow, fast) = (1e-3, 2.0, 60.0);
        let wave = |n: usize| {
            let t = step * n as f64;
            (TAU * slow * t).cos() + (fast / slow).recip() * (-2.0 * t).exp() * (TAU * fast * t).sin()
        };
        let structure = chain(&[2.0, 1.0], &[800.0, 0.0], &[1500.0]);
        let run = decay(step, vec![(0..6000).map(wave).collect(), (0..6000).map(wave).collect()]);
        let records = Records::new(&structure, &[], std::slice::from_ref(&run)).unwrap();
        let mut record = records.list[0].clone();
        (record.samples, record.step, record.dominant_hz) = (vec![(0..6000).map(wave).collect(); 2], step, slow);
        record.noise = vec![1e-6; 2];
        let settled = record.settled(16);
        // Two samples hold 0.75 rad of the fast mode, eight 0.10 rad of the slow one.
        let died_out = 20.0_f64.ln() / 2.0 / step;
        assert!(settled[..3].iter().all(|n| (*n as f64 / died_out - 1.0).abs() < 0.1), "{settled:?} {died_out}");
        assert_eq!(settled[3], 6000);
    }

    /// Acceleration noise of one standard deviation has that velocity.
    #[test]
    fn noise_has_the_velocity_of_its_spectrum() {
        let mut uniform = uniform(1);
        let noise: Vec<f64> = (0..20_000).map(|_| 12.0_f64.sqrt() * uniform()).collect();
        for order in 0..3 {
            let v = velocity(&noise, 1e-3, order, 20.0);
            let variance = v.iter().map(|v| v * v).sum::<f64>() / v.len() as f64;
            let told = velocity_of_noise(20.0, 1e-3, order);
            assert!((variance / told - 1.0).abs() < 0.1, "{order}: {variance} {told}");
        }
    }
}
