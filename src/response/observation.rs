//! What is observed of the linear rest at one harmonic, as rows of its receptance: `a^T A` with `a` the pattern of a leg or of
//! a DOF. `A` is symmetric, so that a row is the response to a unit force of that pattern, and serves any number of loads.

use super::harmonic_balance::{Condensed, RunModel};
use crate::effects::Leg;
use faer::c64;

/// The rows of one harmonic.
pub(crate) struct Observation {
    /// Of what is kept in the balance, in the order of its unknowns: nonlinear legs, modes at resonance, linear legs.
    kept: Vec<Vec<c64>>,
    /// Of the DOFs.
    dofs: Vec<Vec<c64>>,
    /// Displacement of each DOF by a unit force of each kept pattern, the patterns of one DOF together, m/N.
    coupling: Vec<c64>,
}

/// The observations of `dofs` and of what the balance keeps, for harmonics 0 to the highest.
pub(crate) fn observations(condensed: &Condensed, run: &RunModel, dofs: &[usize]) -> Vec<Observation> {
    (0..=condensed.harmonics).map(|h| Observation::new(condensed, run, h, dofs)).collect()
}

impl Observation {
    fn new(condensed: &Condensed, run: &RunModel, h: usize, dofs: &[usize]) -> Self {
        let compliance = run.compliance(h);
        let row = |pattern: &[c64]| condensed.linear_response(compliance, h, pattern);
        let mut patterns: Vec<Vec<c64>> = condensed.legs.iter().map(|leg| of_leg(leg.leg, run.len())).collect();
        let of_mode = |pattern: &Vec<f64>| pattern.iter().map(|&v| c64::new(v, 0.0)).collect();
        patterns.extend(compliance.resonant.iter().map(|mode| of_mode(&mode.pattern)));
        patterns.extend(condensed.kept_linear(h).map(|(_, leg)| of_leg(leg, run.len())));
        let kept: Vec<Vec<c64>> = patterns.iter().map(|pattern| row(pattern)).collect();
        // The mean of a motion is not asked for.
        let dofs: &[usize] = if h == 0 { &[] } else { dofs };
        let dofs: Vec<Vec<c64>> =
            dofs.iter().map(|&first| row(&of_leg(Leg { first, second: None }, run.len()))).collect();
        let coupling = dofs.iter().flat_map(|dof| patterns.iter().map(|pattern| product(dof, pattern))).collect();
        Self { kept, dofs, coupling }
    }

    /// Motion of each kept pattern of the linear rest under `load` (N, by DOF; empty is none).
    pub(super) fn motions(&self, load: &[c64]) -> impl Iterator<Item = c64> {
        self.kept.iter().map(move |row| product(row, load))
    }

    /// Displacement of DOF number `i` under `load` and under the `forces` of the kept patterns, which resist.
    pub(super) fn displacement(&self, i: usize, load: &[c64], forces: impl Fn(usize) -> c64) -> c64 {
        let coupling = self.coupling.iter().skip(i * self.kept.len()).take(self.kept.len()).enumerate();
        coupling.fold(product(&self.dofs[i], load), |x, (j, c)| x - *c * forces(j))
    }
}

/// Pattern of a leg: 1 at its first DOF, -1 at its second.
fn of_leg(leg: Leg, size: usize) -> Vec<c64> {
    let mut pattern = vec![c64::new(0.0, 0.0); size];
    pattern[leg.first].re += 1.0;
    if let Some(second) = leg.second {
        pattern[second].re -= 1.0;
    }
    pattern
}

/// Scalar product without conjugation, of what both have.
fn product(row: &[c64], load: &[c64]) -> c64 {
    row.iter().zip(load).fold(c64::new(0.0, 0.0), |sum, (a, f)| sum + *a * *f)
}
