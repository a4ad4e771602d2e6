//! Filters without delay: every line of the discrete Fourier transform of a signal times a real gain.
//!
//! The transform takes a signal for periodic. One that does not close is extended first, as `filtfilt` of Scipy and Matlab does
//! (Gustafsson, *IEEE Trans. Signal Processing* 44, 1996, on ends): evenly its values do not jump where it begins again, oddly its
//! slopes do not either.

use dashpot_numerics::RealTransform;

/// How a signal goes on beyond its ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Extension {
    /// It begins again.
    Periodic,
    /// As in a mirror, the samples at the ends twice.
    Even,
    /// Beside the line through its ends, which is left out, by its negative, as a string beyond its supports.
    Odd,
}

impl Extension {
    /// One period of the extended signal, which begins with the signal.
    fn extended(self, signal: &[f64]) -> Vec<f64> {
        match self {
            Self::Periodic => signal.to_vec(),
            Self::Even => signal.iter().chain(signal.iter().rev()).copied().collect(),
            Self::Odd => {
                let last = signal.len() - 1;
                let slope = (signal[last] - signal[0]) / last as f64;
                let beside_line = |k: usize| signal[k] - signal[0] - slope * k as f64;
                (0..last).map(beside_line).chain((1..=last).rev().map(|k| -beside_line(k))).collect()
            }
        }
    }
}

/// A signal, sampled every `step` seconds, with each of its lines times the `gain` at its frequency (Hz).
pub(crate) fn filtered(signal: &[f64], step: f64, extension: Extension, gain: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut work = extension.extended(signal);
    let length = work.len();
    let transform = RealTransform::new(length);
    let mut lines = transform.forward(&mut work);
    for (k, line) in lines.iter_mut().enumerate() {
        *line *= gain(k as f64 / (length as f64 * step)) / length as f64;
    }
    // Real by definition; rounding leaves a trace that the transform back refuses.
    lines[0].im = 0.0;
    if length.is_multiple_of(2) {
        lines[length / 2].im = 0.0;
    }
    transform.backward(&mut lines, &mut work);
    work.truncate(signal.len());
    work
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
        assert_eq!(a.len(), b.len());
        a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    /// Lengths even and odd, a signal that does not close: a gain of one leaves what there is, less the line through the ends of an odd
    /// extension.
    #[test]
    fn a_gain_of_one_changes_nothing() {
        for count in [24, 25] {
            let signal: Vec<f64> = (0..count).map(|k| (0.3 * f64::from(k)).sin() + 0.1 * f64::from(k)).collect();
            for extension in [Extension::Periodic, Extension::Even] {
                assert!(largest_difference(&filtered(&signal, 0.1, extension, |_| 1.0), &signal) < 1e-14);
            }
            let line =
                |k: usize| signal[0] + (signal[signal.len() - 1] - signal[0]) * k as f64 / (signal.len() - 1) as f64;
            let beside: Vec<f64> = signal.iter().enumerate().map(|(k, y)| y - line(k)).collect();
            assert!(largest_difference(&filtered(&signal, 0.1, Extension::Odd, |_| 1.0), &beside) < 1e-14);
        }
    }

    /// Waves that each extension closes are eigenfunctions: they come back times the gain at their frequency, in place.
    #[test]
    fn a_wave_is_multiplied_by_the_gain_at_its_frequency() {
        let (count, step, waves) = (40_usize, 0.02, 3.0);
        let gain = |hz: f64| 1.0 / (1.0 + hz * hz);
        // By extension: the period of a wave in samples, and its phase at a sample.
        let half = (count - 1) as f64;
        let cases: [(Extension, f64, &dyn Fn(f64) -> f64); 3] = [
            (Extension::Periodic, count as f64 / waves, &|k| (2.0 * PI * waves * k / count as f64 + 0.4).cos()),
            (Extension::Even, 2.0 * count as f64 / waves, &|k| (PI * waves * (k + 0.5) / count as f64).cos()),
            (Extension::Odd, 2.0 * half / waves, &|k| (PI * waves * k / half).sin()),
        ];
        for (extension, period, wave) in cases {
            let signal: Vec<f64> = (0..count).map(|k| wave(k as f64)).collect();
            let passed: Vec<f64> = signal.iter().map(|y| y * gain(1.0 / (period * step))).collect();
            assert!(largest_difference(&filtered(&signal, step, extension, gain), &passed) < 1e-14, "{extension:?}");
        }
    }
}
