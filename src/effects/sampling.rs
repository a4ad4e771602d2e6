//! Fast change between harmonics and samples: the sines of one number of samples, computed once.

use super::motion::Motion;
use dashpot_numerics::{scalar_products, sum};
use faer::c64;
use std::borrow::Cow;
use std::f64::consts::TAU;

/// Sine and cosine at the equal steps of one period; make one for a solver and reuse it.
#[derive(Debug, Clone)]
pub struct Sampling {
    table: Vec<(f64, f64)>,
    /// Cosine, then sine of harmonic 1, 2, ... at every sample, of those that are kept.
    waves: Vec<f64>,
}

impl Sampling {
    /// For periods of `samples` equal steps.
    pub fn new(samples: usize) -> Self {
        let table = (0..samples).map(|n| (TAU * n as f64 / samples as f64).sin_cos()).collect();
        Self { table, waves: Vec::new() }
    }

    /// For periods of `samples` equal steps of which the harmonics up to `harmonics` are asked for many times.
    pub fn with_harmonics(samples: usize, harmonics: usize) -> Self {
        let sampling = Self::new(samples);
        let waves = (1..=harmonics).flat_map(|h| sampling.computed(h)).collect();
        Self { waves, ..sampling }
    }

    /// Number of samples in the period.
    pub fn len(&self) -> usize {
        self.table.len()
    }

    /// Whether there is no sample at all.
    pub fn is_empty(&self) -> bool {
        self.table.is_empty()
    }

    /// Motion of `mean` (m) and complex amplitudes of harmonics 1, 2, ... (m) at `omega` (rad/s).
    pub fn motion(&self, omega: f64, mean: f64, harmonics: &[c64]) -> Motion {
        let zeros = vec![0.0; self.len()];
        let mut motion = Motion {
            omega,
            mean,
            harmonics: harmonics.to_vec(),
            displacement: zeros.clone(),
            velocity: zeros.clone(),
            acceleration: zeros,
        };
        self.refresh(&mut motion);
        motion
    }

    /// Computes the samples of `motion` anew from its `omega`, `mean` and `harmonics`. Allocates nothing if the motion
    /// has as many samples as `self` already and its harmonics are kept.
    pub fn refresh(&self, motion: &mut Motion) {
        let Motion { omega, mean, harmonics, displacement, velocity, acceleration } = motion;
        displacement.clear();
        displacement.resize(self.len(), *mean);
        for samples in [&mut *velocity, &mut *acceleration] {
            samples.clear();
            samples.resize(self.len(), 0.0);
        }
        for (index, amplitude) in harmonics.iter().enumerate() {
            if amplitude.re == 0.0 && amplitude.im == 0.0 {
                continue;
            }
            let w = (index + 1) as f64 * *omega;
            let wave = self.wave(index + 1);
            let (cos, sin) = wave.split_at(self.len());
            let outputs = displacement.iter_mut().zip(velocity.iter_mut()).zip(acceleration.iter_mut());
            for (((d, v), a), (cos, sin)) in outputs.zip(cos.iter().zip(sin)) {
                let in_phase = amplitude.re * cos - amplitude.im * sin;
                *d += in_phase;
                *v -= w * (amplitude.re * sin + amplitude.im * cos);
                *a -= w * w * in_phase;
            }
        }
    }

    /// Complex amplitudes of harmonics 1, 2, ... of `values` (one a sample) into `harmonics`; returns the mean. Harmonics
    /// from half the number of samples upwards are aliases of lower ones.
    pub fn analyse(&self, values: &[f64], harmonics: &mut [c64]) -> f64 {
        let scale = 2.0 / self.len() as f64;
        let orders = harmonics.len();
        let rows = match self.waves.get(..2 * orders * self.len()) {
            Some(waves) => Cow::Borrowed(waves),
            None => Cow::Owned((1..=orders).flat_map(|h| self.computed(h)).collect()),
        };
        let mut products = Vec::with_capacity(2 * orders);
        scalar_products(&rows, values, self.len(), &mut products);
        for (amplitude, pair) in harmonics.iter_mut().zip(products.chunks_exact(2)) {
            *amplitude = c64::new(scale * pair[0], -scale * pair[1]);
        }
        0.5 * scale * sum(values)
    }

    /// Cosine, then sine of harmonic `h` at every sample.
    fn wave(&self, h: usize) -> Cow<'_, [f64]> {
        let kept = self.waves.get(2 * (h - 1) * self.len()..2 * h * self.len());
        kept.map_or_else(|| Cow::Owned(self.computed(h)), Cow::Borrowed)
    }

    fn computed(&self, h: usize) -> Vec<f64> {
        let waves = (0..self.len()).map(|n| self.table[n * h % self.len()]);
        let (sin, mut cos): (Vec<f64>, Vec<f64>) = waves.unzip();
        cos.extend(sin);
        cos
    }
}

impl Motion {
    /// Samples the harmonics at `samples` equal steps of one period.
    pub fn new(omega: f64, mean: f64, harmonics: &[c64], samples: usize) -> Self {
        Sampling::new(samples).motion(omega, mean, harmonics)
    }

    /// `d = amplitude cos(omega t)`.
    pub fn cosine(omega: f64, amplitude: f64, samples: usize) -> Self {
        Self::new(omega, 0.0, &[c64::new(amplitude, 0.0)], samples)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analysis_undoes_synthesis() {
        let harmonics = [c64::new(1.0, -2.0), c64::new(0.0, 0.0), c64::new(0.3, 0.1)];
        let sampling = Sampling::new(24);
        let motion = sampling.motion(7.0, 0.25, &harmonics);
        let mut found = [c64::new(0.0, 0.0); 3];
        assert!((sampling.analyse(&motion.displacement, &mut found) - 0.25).abs() < 1e-15);
        for (a, b) in found.iter().zip(&harmonics) {
            assert!((a - b).norm() < 1e-14);
        }
        let mean = sampling.analyse(&motion.velocity, &mut found);
        assert!(mean.abs() < 1e-13 && (found[2] - c64::new(0.0, 21.0) * harmonics[2]).norm() < 1e-12);
        let [d, v, a] = motion.at(motion.step() * 5.0);
        assert!((d - motion.displacement[5]).abs() < 1e-14);
        assert!((v - motion.velocity[5]).abs() < 1e-12 && (a - motion.acceleration[5]).abs() < 1e-10);
    }

    #[test]
    fn harmonics_that_are_kept_are_those_that_are_computed() {
        let harmonics = [c64::new(1.0, -2.0), c64::new(0.0, 0.7), c64::new(0.3, 0.1), c64::new(0.2, -0.4)];
        let (plain, kept) = (Sampling::new(40), Sampling::with_harmonics(40, 3));
        let motion = kept.motion(7.0, 0.25, &harmonics);
        assert_eq!(motion, plain.motion(7.0, 0.25, &harmonics));
        let mut found = [[c64::new(0.0, 0.0); 4]; 2];
        plain.analyse(&motion.velocity, &mut found[0]);
        kept.analyse(&motion.velocity, &mut found[1]);
        assert_eq!(found[0], found[1]);
    }

    #[test]
    fn a_motion_is_refreshed_in_place() {
        let sampling = Sampling::new(16);
        let mut motion = sampling.motion(2.0, 0.0, &[c64::new(1.0, 0.0)]);
        motion.harmonics[0] = c64::new(0.0, 3.0);
        motion.mean = 1.0;
        sampling.refresh(&mut motion);
        assert_eq!(motion, Motion::new(2.0, 1.0, &[c64::new(0.0, 3.0)], 16));
    }
}
