//! Periodic forces on a structure.

use crate::effects::Leg;
use faer::c64;

/// A periodic force on one DOF.
#[derive(Debug, Clone, PartialEq)]
pub struct HarmonicForce {
    /// Row of the matrices.
    pub dof: usize,
    /// Static part, N.
    pub mean: f64,
    /// Complex amplitudes of harmonics 1, 2, ..., N.
    pub harmonics: Vec<c64>,
}

impl HarmonicForce {
    /// Complex amplitude of harmonic `h`, N; 0 is the static part.
    pub fn amplitude(&self, h: usize) -> c64 {
        match h {
            0 => c64::new(self.mean, 0.0),
            h => self.harmonics.get(h - 1).copied().unwrap_or(c64::new(0.0, 0.0)),
        }
    }

    pub(crate) fn leg(&self) -> Leg {
        Leg { first: self.dof, second: None }
    }
}

/// Forces below this share of all shape no motion.
const SMALL_SHARE: f64 = 0.05;

/// What drives the structure in one run.
#[derive(Debug, Clone, PartialEq)]
pub struct Excitation {
    /// Fundamental circular frequency, rad/s.
    pub omega: f64,
    /// Forces.
    pub forces: Vec<HarmonicForce>,
}

impl Excitation {
    /// A sinusoidal force `Re amplitude exp(i omega t)` at one DOF; `omega` in rad/s, `amplitude` in N.
    pub fn sine(omega: f64, dof: usize, amplitude: c64) -> Self {
        Self { omega, forces: vec![HarmonicForce { dof, mean: 0.0, harmonics: vec![amplitude] }] }
    }

    /// Whether all forces have odd harmonics only.
    pub(crate) fn is_odd(&self) -> bool {
        let even = |force: &HarmonicForce| {
            force.mean == 0.0 && force.harmonics.iter().skip(1).step_by(2).all(|f| f.norm_sqr() == 0.0)
        };
        self.forces.iter().all(even)
    }

    /// Highest harmonic of the forces.
    pub fn order(&self) -> usize {
        self.forces.iter().map(|force| force.harmonics.len()).max().unwrap_or(0)
    }

    /// Highest harmonic above which there is only a small share of the forces.
    pub(crate) fn essential(&self) -> usize {
        let power = |h: usize| self.forces.iter().map(|force| force.amplitude(h).norm_sqr()).sum::<f64>();
        let powers: Vec<f64> = (1..=self.order()).map(power).collect();
        let small = SMALL_SHARE * SMALL_SHARE * powers.iter().sum::<f64>();
        let above = powers.iter().rev().scan(0.0, |sum, p| {
            *sum += p;
            Some(*sum)
        });
        self.order() - above.take_while(|&sum| sum <= small).count()
    }

    /// The same forces at another frequency (rad/s).
    #[must_use]
    pub fn at(&self, omega: f64) -> Self {
        Self { omega, forces: self.forces.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn harmonics_of_noise_are_not_essential() {
        let real = |x: &f64| c64::new(*x, 0.0);
        let essential = |values: &[f64]| {
            let harmonics = values.iter().map(real).collect();
            Excitation { omega: 1.0, forces: vec![HarmonicForce { dof: 0, mean: 0.0, harmonics }] }.essential()
        };
        assert_eq!(essential(&[1.0]), 1);
        assert_eq!(essential(&[1.0, 0.01, 0.02, 0.0]), 1);
        assert_eq!(essential(&[1.0, 0.01, 0.2, 0.03]), 3);
        assert_eq!(essential(&[0.0, 0.0]), 0);
    }
}
