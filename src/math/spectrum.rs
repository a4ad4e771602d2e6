//! Amplitude spectrum of an evenly sampled signal through a Hann window, and its peaks.
//!
//! A sine of amplitude `a` at the middle of a bin shows as `a`; the mean is taken out before the window is applied.

use dashpot_numerics::RealTransform;
use std::f64::consts::TAU;

/// One-sided amplitude spectrum.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Spectrum {
    /// Distance of two lines, Hz.
    pub resolution_hz: f64,
    /// Amplitude at `k * resolution_hz`, k = 0, 1, ..., in the unit of the signal.
    pub amplitude: Vec<f64>,
}

/// A peak between two lines of a spectrum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Peak {
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Amplitude in the unit of the signal.
    pub amplitude: f64,
}

impl Spectrum {
    /// Spectrum of `signal`, sampled every `time_step` seconds; `None` for fewer than four samples, a time step that is
    /// not positive, or a value that is not finite.
    pub(crate) fn new(signal: &[f64], time_step: f64) -> Option<Self> {
        let n = signal.len();
        if n < 4 || !(time_step > 0.0 && time_step.is_finite()) || signal.iter().any(|v| !v.is_finite()) {
            return None;
        }
        let mean = super::statistics::mean(signal);
        let window = |k: usize| 0.5 - 0.5 * (TAU * k as f64 / n as f64).cos();
        let mut input: Vec<f64> = signal.iter().enumerate().map(|(k, v)| (v - mean) * window(k)).collect();
        let lines = RealTransform::new(n).forward(&mut input);
        let gain = 4.0 / n as f64; // the window's mean is 1/2, and half of the amplitude is at negative frequencies
        let amplitude = lines.iter().map(|z| gain * z.re.hypot(z.im)).collect();
        Some(Self { resolution_hz: 1.0 / (n as f64 * time_step), amplitude })
    }

    /// Spectrum with the mean power of others of the same length; `None` where one of them is none, or there are none.
    pub(crate) fn mean(spectra: impl Iterator<Item = Option<Self>>) -> Option<Self> {
        let mut sum: Option<Self> = None;
        let mut count = 0.0;
        for spectrum in spectra {
            let mut spectrum = spectrum?;
            spectrum.amplitude.iter_mut().for_each(|a| *a *= *a);
            count += 1.0;
            match &mut sum {
                Some(sum) => sum.amplitude.iter_mut().zip(&spectrum.amplitude).for_each(|(sum, a)| *sum += a),
                None => sum = Some(spectrum),
            }
        }
        let mut mean = sum?;
        mean.amplitude.iter_mut().for_each(|a| *a = (*a / count).sqrt());
        Some(mean)
    }

    /// Frequency of line `k`, Hz.
    pub(crate) fn frequency_hz(&self, k: usize) -> f64 {
        k as f64 * self.resolution_hz
    }

    /// Local peak at line `k`, by a parabola through the logarithms of three lines: for a lone sine within 2 % of a line.
    pub(crate) fn interpolate(&self, k: usize) -> Peak {
        let log_amplitude = |i: usize| self.amplitude.get(i).copied().unwrap_or(0.0).max(f64::MIN_POSITIVE).ln();
        if k == 0 || k + 1 >= self.amplitude.len() {
            return Peak {
                frequency_hz: self.frequency_hz(k),
                amplitude: self.amplitude.get(k).copied().unwrap_or(0.0),
            };
        }
        let (left, centre, right) = (log_amplitude(k - 1), log_amplitude(k), log_amplitude(k + 1));
        let curvature = left - 2.0 * centre + right;
        let shift = if curvature < 0.0 { (0.5 * (left - right) / curvature).clamp(-0.5, 0.5) } else { 0.0 };
        Peak {
            frequency_hz: (k as f64 + shift) * self.resolution_hz,
            amplitude: (centre - 0.25 * (left - right) * shift).exp(),
        }
    }

    /// The highest peak above the first line; `None` for a signal without any oscillation.
    pub(crate) fn highest_peak(&self) -> Option<Peak> {
        let (k, value) = self.amplitude.iter().enumerate().skip(1).max_by(|a, b| a.1.total_cmp(b.1))?;
        (*value > 0.0).then(|| self.interpolate(k))
    }

    /// Local peaks of at least `fraction` of the highest, in order of frequency.
    pub(crate) fn peaks(&self, fraction: f64) -> Vec<Peak> {
        let highest = self.amplitude.iter().skip(1).fold(0.0_f64, |m, v| m.max(*v));
        (1..self.amplitude.len().saturating_sub(1))
            .filter(|&k| {
                let value = self.amplitude[k];
                value > 0.0
                    && value >= fraction * highest
                    && value > self.amplitude[k - 1]
                    && value >= self.amplitude[k + 1]
            })
            .map(|k| self.interpolate(k))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    fn signal(frequency: f64) -> Vec<f64> {
        (0..1000).map(|k| 5.0 + 2.0 * (TAU * frequency * f64::from(k) * 1e-3 + 0.3).sin()).collect()
    }

    #[test]
    fn amplitude_at_a_line_is_exact() {
        let spectrum = Spectrum::new(&signal(20.0), 1e-3).unwrap();
        let peak = spectrum.highest_peak().unwrap();
        assert!((peak.frequency_hz - 20.0).abs() < 1e-6 && (peak.amplitude - 2.0).abs() < 1e-9, "{peak:?}");
    }

    #[test]
    fn between_two_lines_within_a_fiftieth_of_a_line() {
        for frequency in [20.3, 20.5, 47.81] {
            let peak = Spectrum::new(&signal(frequency), 1e-3).unwrap().highest_peak().unwrap();
            assert!((peak.frequency_hz - frequency).abs() < 0.02, "{peak:?}");
            assert!((peak.amplitude - 2.0).abs() < 0.1, "{peak:?}");
        }
    }

    #[test]
    fn two_tones_are_told_apart_and_bad_signals_refused() {
        let two: Vec<f64> = signal(20.0).iter().zip(signal(60.4)).map(|(a, b)| a + 0.1 * b).collect();
        let peaks = Spectrum::new(&two, 1e-3).unwrap().peaks(0.05);
        assert_eq!(peaks.len(), 2);
        assert!((peaks[1].frequency_hz - 60.4).abs() < 0.03);
        assert!(Spectrum::new(&[1.0, f64::NAN, 0.0, 1.0], 1.0).is_none());
        assert!(Spectrum::new(&[1.0; 8], 1.0).unwrap().highest_peak().is_none());
    }
}
