//! The balance of leg forces `R(F) = (1 + slack) F - Phi(F, D(F)) = 0` that Newton's method solves (`iterate`), with the
//! Jacobian `J = 1 + slack - Phi_F + Phi_D C`. Modes at resonance answer with `Phi = z D` at their one harmonic.

use super::condense::Condensed;
use super::fourier::Fourier;
use super::nonlinear_leg::{LawEvaluation, SLACK};
use super::unknown_subset::{DROPPED, UnknownSubset};
use dashpot_numerics::dot;
use faer::c64;

/// A condensed system with the tables of its harmonics.
pub(crate) struct Balance<'a> {
    pub condensed: &'a Condensed,
    pub fourier: &'a Fourier,
}

/// Residual with everything its Jacobian needs.
pub(crate) struct NewtonState {
    pub residual: Vec<f64>,
    pub evaluations: Vec<LawEvaluation>,
}

impl Balance<'_> {
    fn range(&self, leg: usize) -> std::ops::Range<usize> {
        let width = self.condensed.width();
        leg * width..(leg + 1) * width
    }

    fn slack(&self, leg: usize) -> f64 {
        if self.condensed.legs[leg].takes_force() { SLACK } else { 0.0 }
    }

    /// Residual at `u` under `level` times the excitation.
    pub(crate) fn residual(&self, u: &[f64], level: f64) -> Vec<f64> {
        let motion = self.condensed.motion(u, level);
        let mut residual = vec![0.0; u.len()];
        for (i, leg) in self.condensed.legs.iter().enumerate() {
            let range = self.range(i);
            let phi = leg.value(self.fourier, self.condensed.omega, &u[range.clone()], &motion[range.clone()]);
            for ((r, f), p) in residual[range.clone()].iter_mut().zip(&u[range]).zip(phi) {
                *r = f * (1.0 + self.slack(i)) - p;
            }
        }
        self.resonant_residual(u, &motion, &mut residual);
        residual
    }

    /// Residual and the laws' derivatives.
    pub(crate) fn state(&self, u: &[f64], level: f64) -> NewtonState {
        let motion = self.condensed.motion(u, level);
        let mut residual = vec![0.0; u.len()];
        let mut evaluations = Vec::with_capacity(self.condensed.legs.len());
        for (i, leg) in self.condensed.legs.iter().enumerate() {
            let range = self.range(i);
            let evaluation =
                leg.evaluate(self.fourier, self.condensed.omega, &u[range.clone()], &motion[range.clone()]);
            for ((r, f), p) in residual[range.clone()].iter_mut().zip(&u[range]).zip(&evaluation.value) {
                *r = f * (1.0 + self.slack(i)) - p;
            }
            evaluations.push(evaluation);
        }
        self.resonant_residual(u, &motion, &mut residual);
        NewtonState { residual, evaluations }
    }

    /// Harmonic, number there and stiffness of every mode at resonance.
    fn resonances(&self) -> impl Iterator<Item = (usize, usize, c64)> {
        let systems = self.condensed.systems.iter().enumerate();
        systems.flat_map(|(h, system)| system.resonant.iter().enumerate().map(move |(r, z)| (h, r, *z)))
    }

    /// `p - z d` of the modes at resonance.
    fn resonant_residual(&self, u: &[f64], motion: &[f64], residual: &mut [f64]) {
        let (condensed, count) = (self.condensed, self.condensed.legs.len());
        for (h, r, z) in self.resonances() {
            let j = count + r;
            condensed.add(residual, h, j, condensed.get(u, h, j) - z * condensed.get(motion, h, j));
        }
    }

    /// Jacobian `dR/dF`, row by row.
    pub(crate) fn jacobian(&self, evaluations: &[LawEvaluation]) -> Vec<f64> {
        self.jacobian_of(evaluations, &UnknownSubset::all(self.condensed))
    }

    /// The rows and columns of the Jacobian that belong to the unknowns `subset`.
    pub(crate) fn jacobian_of(&self, evaluations: &[LawEvaluation], subset: &UnknownSubset) -> Vec<f64> {
        let (size, width) = (subset.indices.len(), self.condensed.width());
        let mut jacobian = vec![0.0; size * size];
        for (i, evaluation) in evaluations.iter().enumerate() {
            for &row in &subset.rows {
                let own = subset.slot[i * width + row];
                let out = &mut jacobian[own * size..(own + 1) * size];
                self.add_coupled(i, &evaluation.by_motion[row * width..(row + 1) * width], subset, out);
                if let Some(by_force) = &evaluation.by_force {
                    for &column in &subset.rows {
                        out[subset.slot[i * width + column]] -= by_force[row * width + column];
                    }
                }
                out[own] += 1.0 + self.slack(i);
            }
        }
        self.resonant_rows(&mut jacobian, subset);
        jacobian
    }

    /// Rows `1 + z C` of the modes at resonance.
    fn resonant_rows(&self, jacobian: &mut [f64], subset: &UnknownSubset) {
        let (condensed, size) = (self.condensed, subset.indices.len());
        for (h, r, z) in self.resonances() {
            let (system, i) = (&condensed.systems[h], condensed.legs.len() + r);
            let row = subset.slot[condensed.resonant_index(h, r)];
            if row == DROPPED {
                continue;
            }
            jacobian[row * size + row] += 1.0;
            jacobian[(row + 1) * size + row + 1] += 1.0;
            for j in 0..system.count() {
                let slope = z * system.coupling(i, j);
                let column = subset.slot[condensed.index(h, j)];
                // (a - i b) -> slope (a - i b), cosine and sine.
                jacobian[row * size + column] += slope.re;
                jacobian[row * size + column + 1] += slope.im;
                jacobian[(row + 1) * size + column] -= slope.im;
                jacobian[(row + 1) * size + column + 1] += slope.re;
            }
        }
    }

    /// Adds a row of `Phi_D C_i`, the slopes of leg `i` by its own coefficients given.
    fn add_coupled(&self, i: usize, slopes: &[f64], subset: &UnknownSubset, out: &mut [f64]) {
        if subset.mean {
            let (system, width) = (&self.condensed.systems[0], self.condensed.width());
            for j in 0..system.count() {
                out[subset.slot[j * width]] += slopes[0] * system.coupling(i, j).re;
            }
        }
        for &h in &subset.orders {
            let (a, b) = (slopes[2 * h - 1], slopes[2 * h]);
            let system = &self.condensed.systems[h];
            for j in 0..system.count() {
                let (c, cos) = (system.coupling(i, j), subset.slot[self.condensed.index(h, j)]);
                out[cos] += a * c.re - b * c.im;
                out[cos + 1] += a * c.im + b * c.re;
            }
        }
    }

    /// Change of the laws' forces under a change `motion` of the relative motions (coefficients of all legs).
    pub(crate) fn force_change(&self, evaluations: &[LawEvaluation], motion: &[f64]) -> Vec<f64> {
        let width = self.condensed.width();
        let mut change = Vec::with_capacity(motion.len());
        for (evaluation, part) in evaluations.iter().zip(motion.chunks_exact(width)) {
            change.extend(evaluation.by_motion.chunks_exact(width).map(|row| dot(row, part)));
        }
        change.resize(motion.len(), 0.0);
        for (h, r, z) in self.resonances() {
            let j = evaluations.len() + r;
            self.condensed.add(&mut change, h, j, z * self.condensed.get(motion, h, j));
        }
        change
    }

    /// Derivative of the residual by the level of the excitation: `-Phi_D D_lin`.
    pub(crate) fn by_level(&self, evaluations: &[LawEvaluation]) -> Vec<f64> {
        let still = vec![0.0; self.condensed.size()];
        let mut change = self.force_change(evaluations, &self.condensed.motion(&still, 1.0));
        change.iter_mut().for_each(|c| *c = -*c);
        change
    }
}

/// Largest residual relative to the largest force.
pub(crate) fn relative(residual: &[f64], u: &[f64]) -> f64 {
    let largest = |x: &[f64]| x.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let size = largest(u) + largest(residual);
    if size == 0.0 { 0.0 } else { largest(residual) / size }
}
