//! What the noise of the measured forces does to records that are predicted from them.
//!
//! ```text
//! var y_c(n) = sum_j sigma_j^2 sum_(k <= n) h_cj(k)^2
//! ```
//!
//! `h_cj` is what channel `c` shows of a force of one sample at drive `j`, by the linear part of the stated model (Bendat and Piersol,
//! *Random Data*, chapter 6: noise at the input). A model whose damping is not known yet rings too long: where its record from the
//! measured force has more power than the measured one, the variance is less in that ratio. The noise is coloured by the
//! resonances, so that the mean square of what an exact model leaves scatters by more than that of white noise:
//!
//! ```text
//! var(mean square) / (mean square)^2 = (2 / N) sum_k rho(k)^2,    rho the correlation of h
//! ```

use super::channel_noise::noise_of;
use super::data::{RecordData, Records};
use crate::math::statistics::{median, root_mean_square};
use crate::response::transient::{Hold, TransientModel};
use dashpot_numerics::RealTransform;

/// Noise over the root mean square of a force from which on it cannot be told from the force.
const MOST: f64 = 0.2;
/// Samples before one of a band-limited force at which it is felt.
const AHEAD: usize = 12;
/// Median of the size of Gaussian noise over its deviation.
const MEDIAN: f64 = 0.6745;

/// Standard deviation of the noise of a sampled force: what is left while it rests, as after a blow, or in the highest quarter of the
/// band; 0 where neither is quiet.
pub(super) fn of_force(force: &[f64], step: f64) -> f64 {
    let centre = median(force);
    let sizes: Vec<f64> = force.iter().map(|f| (f - centre).abs()).collect();
    let noise = (median(&sizes) / MEDIAN).min(noise_of(force, step));
    if noise < MOST * root_mean_square(force) { noise } else { 0.0 }
}

impl Records<'_> {
    /// Adds to every record what the noise of its forces does to its channels.
    pub(super) fn with_force_noise(mut self) -> Self {
        let all: Vec<_> = self.list.iter().map(|record| self.by_force(record)).collect();
        for (record, variances) in self.list.iter_mut().zip(all) {
            (record.by_force, record.scatter) = variances.unwrap_or_default();
        }
        self
    }

    /// Variances of every channel and sample by the noise of the forces, and the deviation that follows of a mean squared residual
    /// over its variance; `None` where no force has noise, or the model does not predict.
    fn by_force(&self, record: &RecordData) -> Option<(Vec<Vec<f64>>, f64)> {
        let noise: Vec<f64> = record.forces.iter().map(|force| of_force(force, record.step)).collect();
        if noise.iter().all(|s| *s <= 0.0) {
            return None;
        }
        let model = self.model(record, &self.known, [1.0; 2], [&[]; 2], &[], &[]).ok()?;
        let trusted = trusted(record, &model);
        let mut variances = vec![vec![0.0; record.len()]; record.channels.len()];
        let mut lengths = vec![0.0_f64; record.channels.len()];
        for (drive, noise) in noise.iter().enumerate().filter(|(_, s)| **s > 0.0) {
            for (c, h) in pulse(&model, record, drive).iter().enumerate() {
                let scale = noise * noise * trusted[c];
                let squares = h.iter().scan(0.0, |sum, h| {
                    *sum += h * h;
                    Some(scale * *sum)
                });
                let squares = squares.skip(AHEAD);
                variances[c].iter_mut().zip(squares).for_each(|(v, more)| *v += more);
                lengths[c] = lengths[c].max(correlated(h));
            }
        }
        let scatter = scatter(record, &variances, &lengths);
        Some((variances, scatter))
    }

    /// Largest misfit up to which a model agrees, beside `least`: what an exact model leaves may be more by two deviations.
    pub(super) fn agreement(&self, least: f64) -> f64 {
        let count = self.list.iter().map(RecordData::len).sum::<usize>() as f64;
        let square: f64 = self.list.iter().map(|r| (r.scatter * r.len() as f64).powi(2)).sum();
        least.max(1.0 + 2.0 * square.sqrt() / count)
    }
}

/// Share of the response of the model to the pulses that is plausible, by channel: no more power than was measured.
fn trusted(record: &RecordData, model: &TransientModel) -> Vec<f64> {
    let forced = model.forced(&record.forces, Hold::BandLimited, record.step, 1);
    let power = |y: &[f64]| root_mean_square(y).powi(2);
    let share = |(y, m): (&Vec<f64>, &Vec<f64>)| (power(y) / power(m).max(f64::MIN_POSITIVE)).min(1.0);
    record.samples.iter().zip(&forced).map(share).collect()
}

/// What every channel shows of a unit force at a drive that lasts one sample, from [`AHEAD`] samples before it on.
fn pulse(model: &TransientModel, record: &RecordData, drive: usize) -> Vec<Vec<f64>> {
    let mut forces = vec![vec![0.0; record.len() + AHEAD]; record.forces.len()];
    forces[drive][AHEAD] = 1.0;
    model.forced(&forces, Hold::BandLimited, record.step, 1)
}

/// Samples over which noise that passes `h` stays alike: the sum of its squared correlation over all lags.
fn correlated(h: &[f64]) -> f64 {
    let n = (2 * h.len()).next_power_of_two();
    let mut padded = h.to_vec();
    padded.resize(n, 0.0);
    let powers: Vec<f64> = RealTransform::new(n).forward(&mut padded).iter().map(faer::c64::norm_sqr).collect();
    let inner = &powers[1..powers.len() - 1];
    let sum: f64 = inner.iter().sum();
    let fourth: f64 = inner.iter().map(|p| p * p).sum();
    if sum > 0.0 { 0.5 * n as f64 * fourth / (sum * sum) } else { 0.0 }
}

/// Deviation of the mean squared residual over its variance by the noise of the forces, which all channels of a record share.
fn scatter(record: &RecordData, variances: &[Vec<f64>], lengths: &[f64]) -> f64 {
    let n = record.len() as f64;
    let channel_scatter = |((variances, noise), length): ((&Vec<f64>, &f64), &f64)| {
        let share = variances.iter().map(|v| v / (v + noise * noise)).sum::<f64>() / n;
        share * (2.0 * length / n).sqrt()
    };
    let all: f64 = variances.iter().zip(&record.noise).zip(lengths).map(channel_scatter).sum();
    all / variances.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::{correlated, of_force};
    use crate::common::runs::uniform;
    use std::f64::consts::{PI, TAU};

    /// Uniform numbers of unit variance.
    fn noise(count: usize) -> Vec<f64> {
        let mut uniform = uniform(1);
        (0..count).map(|_| uniform() * 12.0_f64.sqrt()).collect()
    }

    /// A short blow fills the band up to Nyquist's frequency: its noise is that of the time in which it rests. A slow sine never
    /// rests: its noise is that above it. Of white noise nothing is known.
    #[test]
    fn the_noise_of_a_force_is_told_where_the_force_is_not() {
        let noise = noise(4000);
        let blow =
            |n: usize| if (2000..2004).contains(&n) { 50.0 * (PI * (n as f64 - 1999.5) / 4.0).sin() } else { 0.0 };
        let sine = |n: usize| 10.0 * (TAU * 0.01 * n as f64).sin();
        let noise_beside = |clean: &dyn Fn(usize) -> f64| {
            let force: Vec<f64> = noise.iter().enumerate().map(|(n, e)| clean(n) + 0.1 * e).collect();
            of_force(&force, 1e-3)
        };
        // Half of uniform noise is nearer to 0 than 0.866 of its deviation, where it is 0.6745 of Gaussian noise.
        assert!((noise_beside(&blow) / (0.1 * 0.866 / 0.6745) - 1.0).abs() < 0.1, "{}", noise_beside(&blow));
        assert!((noise_beside(&sine) / 0.1 - 1.0).abs() < 0.1, "{}", noise_beside(&sine));
        assert_eq!(noise_beside(&|_| 0.0), 0.0);
    }

    /// `h = a^k` has the correlation `a^|k|`: the sum of its squares is `(1 + a^2) / (1 - a^2)`.
    #[test]
    fn a_decaying_pulse_is_alike_as_long_as_it_lasts() {
        let a: f64 = 0.97;
        let h: Vec<f64> = (0..2000).map(|k| a.powi(k)).collect();
        let expected = (1.0 + a * a) / (1.0 - a * a);
        assert!((correlated(&h) / expected - 1.0).abs() < 0.05, "{} {expected}", correlated(&h));
    }
}
