//! Real Fourier coefficients and equally spaced samples of one period, and the step between them.
//!
//! `y(t) = c_0 + sum_h c_h cos(h w t) + s_h sin(h w t)`, stored as `[c_0, c_1, s_1, c_2, s_2, ...]`, so that the complex
//! amplitude is `Y_h = c_h - i s_h`. With `N > 4 H` samples the projection of a sampled product is free of aliasing up to
//! the second power; kinks alias as `1 / N^2`.

use dashpot_numerics::RealTransform;
use faer::c64;
use std::f64::consts::TAU;
use std::sync::Arc;

/// The two transforms of one number of samples, for a number of harmonics.
#[derive(Debug, Clone)]
pub(crate) struct Fourier {
    harmonics: usize,
    samples: usize,
    transform: RealTransform,
    /// Cosine and sine at the samples of one turn.
    circle: Arc<Vec<[f64; 2]>>,
    parity: Parity,
}

/// Which entries of matrices from harmonics to harmonics are wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Parity {
    /// All.
    All,
    /// From odd harmonics to odd ones and from even ones to even ones.
    Split,
    /// From odd harmonics to odd ones.
    Odd,
}

impl Fourier {
    /// Harmonics 1..=`harmonics` at `samples` equal steps of one period; `samples` is even and above `4 harmonics`.
    pub(crate) fn new(harmonics: usize, samples: usize) -> Self {
        debug_assert!(samples.is_multiple_of(2) && samples > 4 * harmonics);
        let point_at = |n: usize| {
            let (sin, cos) = (TAU * n as f64 / samples as f64).sin_cos();
            [cos, sin]
        };
        let circle = Arc::new((0..samples).map(point_at).collect());
        Self { harmonics, samples, transform: RealTransform::new(samples), circle, parity: Parity::All }
    }

    /// The same with fewer entries of matrices wanted.
    pub(crate) fn with(&self, parity: Parity) -> Self {
        Self { parity, ..self.clone() }
    }

    /// Harmonics of wanted rows, without the mean.
    pub(crate) fn orders(&self) -> impl Iterator<Item = usize> + use<> {
        (1..=self.harmonics).step_by(1 + usize::from(self.parity == Parity::Odd))
    }

    /// Indices of wanted rows.
    pub(crate) fn rows(&self) -> impl Iterator<Item = usize> + use<> {
        let mean = if self.parity == Parity::Odd { None } else { Some(0) };
        mean.into_iter().chain(self.orders().flat_map(|h| [2 * h - 1, 2 * h]))
    }

    /// Harmonics of wanted columns in rows of harmonic `h`, without the mean.
    pub(crate) fn partners(&self, h: usize) -> impl Iterator<Item = usize> + use<> {
        let all = self.parity == Parity::All;
        let first = if all || h % 2 == 1 { 1 } else { 2 };
        (first..=self.harmonics).step_by(if all { 1 } else { 2 })
    }

    /// Highest harmonic.
    pub(crate) fn harmonics(&self) -> usize {
        self.harmonics
    }

    /// Samples in the period.
    pub(crate) fn samples(&self) -> usize {
        self.samples
    }

    /// Number of real coefficients, `2 H + 1`.
    pub(crate) fn width(&self) -> usize {
        2 * self.harmonics + 1
    }

    /// Samples of the periodic function of `coefficients`.
    pub(crate) fn synthesise(&self, coefficients: &[f64], samples: &mut [f64]) {
        let mut spectrum = vec![c64::new(0.0, 0.0); self.samples / 2 + 1];
        spectrum[0].re = coefficients[0];
        for (x, pair) in spectrum[1..].iter_mut().zip(coefficients[1..].chunks_exact(2)) {
            *x = c64::new(0.5 * pair[0], -0.5 * pair[1]);
        }
        self.transform.backward(&mut spectrum, samples);
    }

    /// Samples of the function whose coefficient number `k` is 1 and all others 0.
    pub(crate) fn wave(&self, k: usize, samples: &mut [f64]) {
        let h = k.div_ceil(2);
        let part = usize::from(k == 2 * h && k > 0);
        let mut at = 0;
        for s in samples.iter_mut() {
            *s = self.circle[at][part];
            at += h;
            if at >= self.samples {
                at -= self.samples;
            }
        }
    }

    /// Complex spectrum `sum_n y_n exp(-i k theta_n) / N` for `k` up to half the samples. Spoils `samples`.
    fn spectrum(&self, samples: &mut [f64]) -> Vec<c64> {
        let mut spectrum = self.transform.forward(samples);
        let scale = 1.0 / self.samples as f64;
        spectrum.iter_mut().for_each(|x| *x *= scale);
        spectrum
    }

    /// Coefficients of the sampled function, truncated to the harmonics.
    pub(crate) fn project(&self, samples: &[f64], coefficients: &mut [f64]) {
        let spectrum = self.spectrum(&mut samples.to_vec());
        coefficients[0] = spectrum[0].re;
        for (pair, x) in coefficients[1..].chunks_exact_mut(2).zip(&spectrum[1..]) {
            (pair[0], pair[1]) = (2.0 * x.re, -2.0 * x.im);
        }
    }

    /// Half the angle of harmonic `h` from one sample to the next.
    pub(crate) fn half_angle(&self, h: usize) -> f64 {
        std::f64::consts::PI * h as f64 / self.samples as f64
    }

    /// Coefficients of the function half a sample earlier: its samples are those at the edges of the cells around the
    /// samples.
    pub(crate) fn at_edges(&self, coefficients: &[f64]) -> Vec<f64> {
        let mut shifted = coefficients.to_vec();
        for h in 1..=self.harmonics {
            let (sin, cos) = self.half_angle(h).sin_cos();
            let (c, s) = (coefficients[2 * h - 1], coefficients[2 * h]);
            shifted[2 * h - 1] = c * cos - s * sin;
            shifted[2 * h] = c * sin + s * cos;
        }
        shifted
    }

    /// The matrix of "synthesise, multiply by `weight` sample by sample, project": `width x width`, row by row.
    /// Products of two harmonics are sums of harmonics, so the spectrum of `weight` up to `2 H` is all that is needed.
    /// Entries that are not wanted are zero or undefined.
    pub(crate) fn multiplier(&self, weight: &[f64]) -> Vec<f64> {
        let width = self.width();
        let spectrum = self.spectrum(&mut weight.to_vec());
        let cos = |q: usize| spectrum[q].re;
        let sin = |q: isize| -spectrum[q.unsigned_abs()].im * q.signum() as f64;
        let mut matrix = vec![0.0; width * width];
        matrix[0] = spectrum[0].re;
        for h in self.orders() {
            let (c, s) = (2 * h - 1, 2 * h);
            (matrix[c], matrix[s]) = (cos(h), sin(h as isize));
            (matrix[c * width], matrix[s * width]) = (2.0 * cos(h), 2.0 * sin(h as isize));
            for k in self.partners(h) {
                let (ck, sk) = (2 * k - 1, 2 * k);
                let (sum, difference) = (h + k, h.abs_diff(k));
                let sin_difference = sin(h as isize - k as isize);
                matrix[c * width + ck] = cos(difference) + cos(sum);
                matrix[s * width + sk] = cos(difference) - cos(sum);
                matrix[c * width + sk] = sin(sum as isize) - sin_difference;
                matrix[s * width + ck] = sin(sum as isize) + sin_difference;
            }
        }
        matrix
    }
}

/// Coefficients of the time derivative.
pub(crate) fn differentiate(omega: f64, coefficients: &[f64], derivative: &mut [f64]) {
    derivative[0] = 0.0;
    for h in 1..=(coefficients.len() - 1) / 2 {
        let w = h as f64 * omega;
        derivative[2 * h - 1] = w * coefficients[2 * h];
        derivative[2 * h] = -w * coefficients[2 * h - 1];
    }
}

/// Mean and complex amplitudes of real coefficients.
pub(crate) fn to_complex(coefficients: &[f64]) -> (f64, Vec<c64>) {
    let harmonics = coefficients[1..].chunks_exact(2).map(|pair| c64::new(pair[0], -pair[1])).collect();
    (coefficients[0], harmonics)
}

/// Amplitude of harmonic `h` (0 is the mean) of real coefficients; 0 beyond their end.
pub(crate) fn amplitude(coefficients: &[f64], h: usize) -> c64 {
    match h {
        0 => c64::new(coefficients[0], 0.0),
        h if 2 * h < coefficients.len() => c64::new(coefficients[2 * h - 1], -coefficients[2 * h]),
        _ => c64::new(0.0, 0.0),
    }
}

/// Adds the complex amplitude of harmonic `h` to real coefficients.
pub(crate) fn add_amplitude(coefficients: &mut [f64], h: usize, value: c64) {
    if h == 0 {
        coefficients[0] += value.re;
    } else {
        coefficients[2 * h - 1] += value.re;
        coefficients[2 * h] -= value.im;
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn projection_undoes_synthesis() {
        let fourier = Fourier::new(4, 32);
        let given: Vec<f64> = (0..9).map(|k| f64::from(k) - 3.3).collect();
        let (mut samples, mut back) = (vec![0.0; 32], vec![0.0; 9]);
        fourier.synthesise(&given, &mut samples);
        fourier.project(&samples, &mut back);
        for (g, b) in given.iter().zip(&back) {
            assert!((g - b).abs() < 1e-13);
        }
    }

    #[test]
    fn the_multiplier_is_synthesis_product_projection() {
        let fourier = Fourier::new(3, 40);
        let weight: Vec<f64> = (0..40).map(|n| (f64::from(n) * 0.37).sin() + 0.1 * f64::from(n % 7)).collect();
        let matrix = fourier.multiplier(&weight);
        for k in 0..7 {
            let mut unit = vec![0.0; 7];
            unit[k] = 1.0;
            let (mut samples, mut column, mut wave) = (vec![0.0; 40], vec![0.0; 7], vec![0.0; 40]);
            fourier.synthesise(&unit, &mut samples);
            fourier.wave(k, &mut wave);
            assert!(samples.iter().zip(&wave).all(|(s, w)| (s - w).abs() < 1e-14), "{k}");
            samples.iter_mut().zip(&weight).for_each(|(s, w)| *s *= w);
            fourier.project(&samples, &mut column);
            for row in 0..7 {
                assert!((matrix[row * 7 + k] - column[row]).abs() < 1e-13, "{row} {k}");
            }
        }
    }

    #[test]
    fn the_derivative_is_that_of_the_complex_amplitude() {
        let given = [0.5, 1.0, 2.0, -3.0, 0.25];
        let mut derivative = [0.0; 5];
        differentiate(3.0, &given, &mut derivative);
        for h in 1..=2 {
            let expected = amplitude(&given, h) * c64::new(0.0, 3.0 * h as f64);
            assert!((amplitude(&derivative, h) - expected).norm() < 1e-14);
        }
    }
}
