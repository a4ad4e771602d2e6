//! Damped Newton method on the balance of leg forces `R(F) = (1 + slack) F - Phi(F, D(F)) = 0`, with the Jacobian
//! `J = 1 + slack - Phi_F + Phi_D C`. Modes at resonance answer with `Phi = z D` at their one harmonic.

use super::condense::Condensed;
use super::dense::Lu;
use super::fourier::Fourier;
use super::legs::{Answer, SLACK};
use faer::c64;

/// Halvings of a Newton step before it is taken all the same.
const HALVINGS: usize = 7;
/// Even harmonics below this share of the largest force are rounding.
const EVEN: f64 = 1e-13;
/// Newton steps at one level.
const STEPS: usize = 60;

/// A condensed system with the tables of its harmonics.
pub(crate) struct Balance<'a> {
    pub condensed: &'a Condensed,
    pub fourier: &'a Fourier,
}

/// Residual with everything its Jacobian needs.
pub(crate) struct State {
    pub residual: Vec<f64>,
    pub answers: Vec<Answer>,
}

/// How a Newton solve ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ending {
    pub converged: bool,
    pub steps: usize,
    /// Largest residual relative to the largest leg force.
    pub residual: f64,
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
    pub fn residual(&self, u: &[f64], level: f64) -> Vec<f64> {
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
    pub fn state(&self, u: &[f64], level: f64) -> State {
        let motion = self.condensed.motion(u, level);
        let mut residual = vec![0.0; u.len()];
        let mut answers = Vec::with_capacity(self.condensed.legs.len());
        for (i, leg) in self.condensed.legs.iter().enumerate() {
            let range = self.range(i);
            let answer = leg.answer(self.fourier, self.condensed.omega, &u[range.clone()], &motion[range.clone()]);
            for ((r, f), p) in residual[range.clone()].iter_mut().zip(&u[range]).zip(&answer.value) {
                *r = f * (1.0 + self.slack(i)) - p;
            }
            answers.push(answer);
        }
        self.resonant_residual(u, &motion, &mut residual);
        State { residual, answers }
    }

    /// Harmonic, number there and stiffness of every mode at resonance.
    fn resonances(&self) -> impl Iterator<Item = (usize, usize, c64)> {
        let levels = self.condensed.levels.iter().enumerate();
        levels.flat_map(|(h, level)| level.resonant.iter().enumerate().map(move |(r, z)| (h, r, *z)))
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
    pub fn jacobian(&self, answers: &[Answer]) -> Vec<f64> {
        let (size, width) = (self.condensed.size(), self.condensed.width());
        let mut jacobian = vec![0.0; size * size];
        for (i, answer) in answers.iter().enumerate() {
            for row in 0..width {
                let out = &mut jacobian[(i * width + row) * size..(i * width + row + 1) * size];
                let slopes = &answer.by_motion[row * width..(row + 1) * width];
                self.add_coupled(i, slopes, out);
                if let Some(by_force) = &answer.by_force {
                    let own = &by_force[row * width..(row + 1) * width];
                    out[i * width..(i + 1) * width].iter_mut().zip(own).for_each(|(x, s)| *x -= s);
                }
                out[i * width + row] += 1.0 + self.slack(i);
            }
        }
        self.resonant_rows(&mut jacobian);
        jacobian
    }

    /// Rows `1 + z C` of the modes at resonance.
    fn resonant_rows(&self, jacobian: &mut [f64]) {
        let (condensed, size) = (self.condensed, self.condensed.size());
        for (h, r, z) in self.resonances() {
            let (level, i) = (&condensed.levels[h], condensed.legs.len() + r);
            let row = condensed.resonant_index(h, r);
            jacobian[row * size + row] += 1.0;
            jacobian[(row + 1) * size + row + 1] += 1.0;
            for j in 0..level.count() {
                let slope = z * level.coupling(i, j);
                let column = self.columns(h, j)[0];
                // (a - i b) -> slope (a - i b), cosine and sine.
                jacobian[row * size + column] += slope.re;
                jacobian[row * size + column + 1] += slope.im;
                jacobian[(row + 1) * size + column] -= slope.im;
                jacobian[(row + 1) * size + column + 1] += slope.re;
            }
        }
    }

    /// Indices of cosine and sine of kept leg `j` at harmonic `h >= 1`.
    fn columns(&self, h: usize, j: usize) -> [usize; 2] {
        let (count, width) = (self.condensed.legs.len(), self.condensed.width());
        let first = if j < count { j * width + 2 * h - 1 } else { self.condensed.resonant_index(h, j - count) };
        [first, first + 1]
    }

    /// Adds a row of `Phi_D C_i`, the slopes of leg `i` by its own coefficients given.
    fn add_coupled(&self, i: usize, slopes: &[f64], out: &mut [f64]) {
        for (h, level) in self.condensed.levels.iter().enumerate() {
            for j in 0..level.count() {
                let c = level.coupling(i, j);
                if h == 0 {
                    out[j * self.condensed.width()] += slopes[0] * c.re;
                    continue;
                }
                let (a, b) = (slopes[2 * h - 1], slopes[2 * h]);
                let [cos, sin] = self.columns(h, j);
                out[cos] += a * c.re - b * c.im;
                out[sin] += a * c.im + b * c.re;
            }
        }
    }

    /// Change of the laws' answers under a change `motion` of the relative motions (coefficients of all legs).
    pub fn answer_change(&self, answers: &[Answer], motion: &[f64]) -> Vec<f64> {
        let width = self.condensed.width();
        let mut change = Vec::with_capacity(motion.len());
        for (answer, part) in answers.iter().zip(motion.chunks_exact(width)) {
            change.extend(answer.by_motion.chunks_exact(width).map(|row| super::fourier::dot(row, part)));
        }
        change.resize(motion.len(), 0.0);
        for (h, r, z) in self.resonances() {
            let j = answers.len() + r;
            self.condensed.add(&mut change, h, j, z * self.condensed.get(motion, h, j));
        }
        change
    }

    /// Derivative of the residual by the level of the excitation: `-Phi_D D_lin`.
    pub fn by_level(&self, answers: &[Answer]) -> Vec<f64> {
        let still = vec![0.0; self.condensed.size()];
        let mut change = self.answer_change(answers, &self.condensed.motion(&still, 1.0));
        change.iter_mut().for_each(|c| *c = -*c);
        change
    }

    /// Iterates `u` to the balance under `level` times the excitation.
    pub fn solve(&self, u: &mut Vec<f64>, level: f64, tolerance: f64) -> Ending {
        let mut state = self.state(u, level);
        let mut best = (f64::INFINITY, u.clone());
        for steps in 0..STEPS {
            let residual = relative(&state.residual, u);
            if residual < best.0 {
                best = (residual, u.clone());
            }
            if residual <= tolerance {
                return Ending { converged: true, steps, residual };
            }
            let Some(step) = self.step(u, &state) else { break };
            if step.iter().any(|x| !x.is_finite()) {
                break;
            }
            *u = self.damped(u, &step, &state.residual, level);
            state = self.state(u, level);
        }
        u.clone_from(&best.1);
        // A residual at the level of rounding of a stiff law is an answer.
        Ending { converged: best.0 <= 100.0 * tolerance, steps: STEPS, residual: best.0 }
    }

    /// Newton's step. A motion of odd harmonics alone stays one, and only they are solved for.
    fn step(&self, u: &[f64], state: &State) -> Option<Vec<f64>> {
        let jacobian = self.jacobian(&state.answers);
        let size = u.len();
        let Some(kept) = self.odd_unknowns(u, &state.residual) else {
            let mut step = state.residual.clone();
            Lu::new(size, jacobian)?.solve(&mut step);
            return Some(step);
        };
        let block = kept.iter().flat_map(|&i| kept.iter().map(move |&j| (i, j))).map(|(i, j)| jacobian[i * size + j]);
        let mut part: Vec<f64> = kept.iter().map(|&i| state.residual[i]).collect();
        Lu::new(kept.len(), block.collect())?.solve(&mut part);
        let mut step = vec![0.0; size];
        kept.iter().zip(part).for_each(|(&i, s)| step[i] = s);
        Some(step)
    }

    /// Indices of the unknowns of odd harmonics, if all others and their residuals are nothing but rounding.
    fn odd_unknowns(&self, u: &[f64], residual: &[f64]) -> Option<Vec<usize>> {
        let condensed = self.condensed;
        if !condensed.odd {
            return None;
        }
        let mut is_odd = vec![false; u.len()];
        for (h, level) in condensed.levels.iter().enumerate().filter(|(h, _)| h % 2 == 1) {
            (0..level.count()).flat_map(|j| self.columns(h, j)).for_each(|k| is_odd[k] = true);
        }
        let largest = u.iter().chain(residual).fold(0.0_f64, |m, x| m.max(x.abs()));
        let silent = |k: usize| u[k].abs() <= EVEN * largest && residual[k].abs() <= EVEN * largest;
        if (0..u.len()).any(|k| !is_odd[k] && !silent(k)) {
            return None;
        }
        Some((0..u.len()).filter(|&k| is_odd[k]).collect())
    }

    /// The longest of the halved steps that lowers the residual; the full step if none does.
    fn damped(&self, u: &[f64], step: &[f64], residual: &[f64], level: f64) -> Vec<f64> {
        let norm = |x: &[f64]| x.iter().map(|v| v * v).sum::<f64>();
        let before = norm(residual);
        let moved = |share: f64| -> Vec<f64> { u.iter().zip(step).map(|(x, s)| x - share * s).collect() };
        let mut best = (f64::INFINITY, 1.0);
        let mut share = 1.0;
        for _ in 0..HALVINGS {
            let after = norm(&self.residual(&moved(share), level));
            if after < before * (1.0 - 1e-4 * share) {
                return moved(share);
            }
            if after < best.0 {
                best = (after, share);
            }
            share *= 0.5;
        }
        moved(best.1)
    }
}

/// Largest residual relative to the largest force.
pub(crate) fn relative(residual: &[f64], u: &[f64]) -> f64 {
    let largest = |x: &[f64]| x.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let answer = largest(u) + largest(residual);
    if answer == 0.0 { 0.0 } else { largest(residual) / answer }
}
