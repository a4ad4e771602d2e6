//! One period of a relative motion, as harmonics and as equally spaced samples of displacement, velocity, acceleration.

use faer::c64;
use std::f64::consts::TAU;

/// A periodic motion `d(t) = mean + Re sum_h D_h exp(i h omega t)` with its samples over one period.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// Fundamental circular frequency, rad/s.
    pub omega: f64,
    /// Static offset, m.
    pub mean: f64,
    /// Complex amplitudes of harmonics 1, 2, ... in m.
    pub harmonics: Vec<c64>,
    /// Displacement, m, at `t_n = n T / N`.
    pub displacement: Vec<f64>,
    /// Velocity, m/s.
    pub velocity: Vec<f64>,
    /// Acceleration, m/s^2.
    pub acceleration: Vec<f64>,
}

impl Motion {
    /// Samples the harmonics at `samples` equal steps of one period.
    pub fn new(omega: f64, mean: f64, harmonics: &[c64], samples: usize) -> Self {
        let mut motion = Self {
            omega,
            mean,
            harmonics: harmonics.to_vec(),
            displacement: vec![mean; samples],
            velocity: vec![0.0; samples],
            acceleration: vec![0.0; samples],
        };
        let table: Vec<(f64, f64)> = (0..samples).map(|n| (TAU * n as f64 / samples as f64).sin_cos()).collect();
        for (index, &amplitude) in harmonics.iter().enumerate() {
            let h = index + 1;
            let w = h as f64 * omega;
            for n in 0..samples {
                let (sin, cos) = table[(h * n) % samples];
                let in_phase = amplitude.re * cos - amplitude.im * sin;
                let quadrature = -amplitude.re * sin - amplitude.im * cos;
                motion.displacement[n] += in_phase;
                motion.velocity[n] += w * quadrature;
                motion.acceleration[n] -= w * w * in_phase;
            }
        }
        motion
    }

    /// `d = amplitude cos(omega t)`.
    pub fn cosine(omega: f64, amplitude: f64, samples: usize) -> Self {
        Self::new(omega, 0.0, &[c64::new(amplitude, 0.0)], samples)
    }

    /// Number of samples in the period.
    pub fn len(&self) -> usize {
        self.displacement.len()
    }

    /// Whether there is no sample at all.
    pub fn is_empty(&self) -> bool {
        self.displacement.is_empty()
    }

    /// Period, s.
    pub fn period(&self) -> f64 {
        TAU / self.omega
    }

    /// Work in J of `force` (N, one value a sample) over one period: `integral d' F dt`.
    pub fn work(&self, force: &[f64]) -> f64 {
        let step = self.period() / self.len() as f64;
        self.velocity.iter().zip(force).map(|(v, f)| v * f).sum::<f64>() * step
    }

    /// Fills `force` with `Re sum_h z(h omega) D_h exp(i h omega t)` plus `z(0)` times the mean, for a linear law of
    /// dynamic stiffness `z`.
    pub fn apply_linear(&self, z: impl Fn(f64) -> c64, force: &mut [f64]) {
        let harmonics: Vec<c64> =
            self.harmonics.iter().enumerate().map(|(i, d)| z((i + 1) as f64 * self.omega) * d).collect();
        let result = Self::new(self.omega, z(0.0).re * self.mean, &harmonics, self.len());
        force.copy_from_slice(&result.displacement);
    }
}
