//! Frequencies at which a record moves.

use super::amplitude::peaks;
use crate::math::spectrum::Spectrum;
use crate::math::statistics::root_mean_square;
use dashpot_numerics::RealTransform;

/// Height over the noise from which a peak of the spectrum counts as a mode that is seen.
const SEEN: f64 = 20.0;

/// Channels of motion in equal steps.
pub(super) struct Motions<'a> {
    /// Their samples, SI, all of one length.
    pub samples: &'a [Vec<f64>],
    /// Standard deviation of the noise of each.
    pub noise: &'a [f64],
    /// Time between samples, s.
    pub step: f64,
}

impl Motions<'_> {
    fn len(&self) -> usize {
        self.samples[0].len()
    }

    /// Frequency (Hz) of the peak that stands highest over the noise.
    pub(super) fn dominant_hz(&self) -> f64 {
        let best = |y: &Vec<f64>| Spectrum::new(y, self.step).and_then(|s| s.highest_peak());
        let strongest = |c: usize| best(&self.samples[c]).map(|p| (p.amplitude / self.noise[c], p.frequency_hz));
        let all = (0..self.samples.len()).filter_map(strongest);
        all.max_by(|a, b| a.0.total_cmp(&b.0)).map_or(1.0 / (self.step * self.len() as f64), |p| p.1)
    }

    /// Frequency (Hz) that halves the power above the noise of the channel that stands out most: where a law feeds modes that are far from
    /// the highest peak, their lines are broad and low, and hold most of the motion all the same.
    pub(super) fn median_hz(&self) -> f64 {
        let above = |c: usize| ((root_mean_square(&self.samples[c]) / self.noise[c]).powi(2), c);
        let Some((_, c)) = (0..self.samples.len()).map(above).max_by(|a, b| a.0.total_cmp(&b.0)) else { return 0.0 };
        let mut work = self.samples[c].clone();
        let lines = RealTransform::new(work.len()).forward(&mut work);
        let floor = self.len() as f64 * self.noise[c].powi(2);
        let powers: Vec<f64> = lines.iter().skip(1).map(|line| (line.norm_sqr() - floor).max(0.0)).collect();
        let half = 0.5 * powers.iter().sum::<f64>();
        let mut sum = 0.0;
        let reaches = |power: &f64| {
            sum += power;
            sum >= half
        };
        let number = 1 + powers.iter().position(reaches).unwrap_or(0);
        number as f64 / (self.len() as f64 * self.step)
    }

    /// Highest frequency (Hz), at least `least_hz`, at which a channel shows a peak well above the noise and not far below the highest.
    pub(super) fn highest_hz(&self, least_hz: f64) -> f64 {
        let mut highest = least_hz;
        for (y, noise) in self.samples.iter().zip(self.noise) {
            let Some(spectrum) = Spectrum::new(y, self.step) else { continue };
            let floor = SEEN * noise * (6.0 / y.len() as f64).sqrt();
            let seen = spectrum.peaks(0.003).into_iter().filter(|p| p.amplitude > floor);
            highest = seen.map(|p| p.frequency_hz).fold(highest, f64::max);
        }
        let shown = peaks(&self.samples[0], self.step, 0.05, 1);
        shown.into_iter().fold(highest, f64::max)
    }
}
