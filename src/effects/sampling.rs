//! Fast change between harmonics and samples: the sines of one number of samples, computed once.

use super::Motion;
use faer::c64;
use std::f64::consts::TAU;

/// Sine and cosine at the equal steps of one period; make one for a solver and reuse it.
#[derive(Debug, Clone)]
pub struct Sampling {
    table: Vec<(f64, f64)>,
}

impl Sampling {
    /// For periods of `samples` equal steps.
    pub fn new(samples: usize) -> Self {
        Self { table: (0..samples).map(|n| (TAU * n as f64 / samples as f64).sin_cos()).collect() }
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
    /// has as many samples as `self` already.
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
            let outputs = displacement.iter_mut().zip(velocity.iter_mut()).zip(acceleration.iter_mut());
            for (((d, v), a), (sin, cos)) in outputs.zip(self.waves(index + 1)) {
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
        for (index, amplitude) in harmonics.iter_mut().enumerate() {
            let (mut re, mut im) = (0.0, 0.0);
            for (value, (sin, cos)) in values.iter().zip(self.waves(index + 1)) {
                re += value * cos;
                im -= value * sin;
            }
            *amplitude = c64::new(scale * re, scale * im);
        }
        0.5 * scale * values.iter().sum::<f64>()
    }

    /// Sine and cosine of harmonic `h` at every sample.
    fn waves(&self, h: usize) -> impl Iterator<Item = (f64, f64)> {
        let count = self.len();
        let step = h % count.max(1);
        let mut at = 0;
        (0..count).map(move |_| {
            let wave = self.table[at];
            at += step;
            if at >= count {
                at -= count;
            }
            wave
        })
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
    fn a_motion_is_refreshed_in_place() {
        let sampling = Sampling::new(16);
        let mut motion = sampling.motion(2.0, 0.0, &[c64::new(1.0, 0.0)]);
        motion.harmonics[0] = c64::new(0.0, 3.0);
        motion.mean = 1.0;
        sampling.refresh(&mut motion);
        assert_eq!(motion, Motion::new(2.0, 1.0, &[c64::new(0.0, 3.0)], 16));
    }
}
