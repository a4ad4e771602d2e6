//! Damped Newton method on the balance of leg forces.
//!
//! Laws that answer the opposite motion by the opposite force have motions of odd harmonics alone under forces of odd
//! harmonics alone, and only those are solved for. Where the even harmonics are small, as those of a measured force are,
//! odd and even ones depend on each other only weakly: each is corrected by its own part of the Jacobian, an eighth of the
//! work, and the factors of the even part are kept as long as they serve.

use super::dense::Lu;
use super::fourier::Parity;
use super::newton::{Balance, NewtonState, relative};
use super::unknown_subset::UnknownSubset;

/// Smallest share of a Newton step that is tried before it is taken all the same.
const LEAST_SHARE: f64 = 1.0 / 64.0;
/// Even harmonics below this share of the odd ones are rounding.
const ROUNDING: f64 = 1e-13;
/// Even harmonics below this share of the odd ones are small.
const SMALL: f64 = 0.1;
/// Share to which a step must lower the residual of the even harmonics for their factors to be kept.
const SERVES: f64 = 0.2;
/// Newton steps at one level.
const STEPS: usize = 60;
/// Newton steps with odd and even harmonics apart.
const STEPS_APART: usize = 25;
/// Steps without a lower residual after which none is to be hoped for.
const STALLED: usize = 10;

/// How a Newton solve ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ending {
    pub converged: bool,
    pub steps: usize,
    /// Largest residual relative to the largest leg force.
    pub residual: f64,
}

impl Balance<'_> {
    /// Iterates `u` to the balance under `level` times the excitation.
    pub(crate) fn solve(&self, u: &mut Vec<f64>, level: f64, tolerance: f64) -> Ending {
        let mut steps = 0;
        if let Some((parity, sets)) = self.decoupled(u, level) {
            let start = u.clone();
            if parity == Parity::Odd {
                let even = UnknownSubset::even(self.condensed);
                even.indices.iter().for_each(|&k| u[k] = 0.0);
            }
            let table = self.fourier.with(parity);
            let apart = Balance { condensed: self.condensed, fourier: &table };
            let most = if parity == Parity::Odd { STEPS } else { STEPS_APART };
            let ending = apart.iterate(u, &sets, level, tolerance, most);
            if ending.converged || parity == Parity::Odd {
                return ending;
            }
            steps = ending.steps;
            *u = start;
        }
        let ending = self.iterate(u, &[UnknownSubset::all(self.condensed)], level, tolerance, STEPS);
        Ending { steps: steps + ending.steps, ..ending }
    }

    /// The sets of unknowns that may be corrected each for itself; none if all depend on each other.
    fn decoupled(&self, u: &[f64], level: f64) -> Option<(Parity, Vec<UnknownSubset>)> {
        if !self.condensed.mirrored {
            return None;
        }
        let (odd, even) = (UnknownSubset::odd(self.condensed), UnknownSubset::even(self.condensed));
        let motion = self.condensed.motion(u, level);
        let below = |share: f64| {
            even.largest(u) <= share * odd.largest(u) && even.largest(&motion) <= share * odd.largest(&motion)
        };
        if self.condensed.odd && below(ROUNDING) {
            return Some((Parity::Odd, vec![odd]));
        }
        below(SMALL).then(|| (Parity::Split, vec![odd, even]))
    }

    fn iterate(&self, u: &mut Vec<f64>, sets: &[UnknownSubset], level: f64, tolerance: f64, most: usize) -> Ending {
        let mut state = self.state(u, level);
        let mut best = (f64::INFINITY, u.clone());
        let mut factors = Factors::default();
        let (mut done, mut since) = (0, 0);
        for steps in 0..most {
            let residual = relative(&state.residual, u);
            if residual < best.0 {
                best = (residual, u.clone());
                since = 0;
            }
            since += 1;
            if since > STALLED {
                break;
            }
            if residual <= tolerance {
                return Ending { converged: true, steps, residual };
            }
            let Some(step) = self.step(&state, sets, &mut factors) else { break };
            if step.iter().any(|x| !x.is_finite()) {
                break;
            }
            (*u, state) = self.moved(u, &step, &state.residual, level);
            done = steps + 1;
        }
        u.clone_from(&best.1);
        // A residual at the level of rounding of a stiff law is an answer.
        Ending { converged: best.0 <= 100.0 * tolerance, steps: done, residual: best.0 }
    }

    /// Newton's step, each set of unknowns by its own part of the Jacobian.
    fn step(&self, state: &NewtonState, sets: &[UnknownSubset], factors: &mut Factors) -> Option<Vec<f64>> {
        let mut step = vec![0.0; state.residual.len()];
        for (number, subset) in sets.iter().enumerate() {
            let mut part: Vec<f64> = subset.indices.iter().map(|&i| state.residual[i]).collect();
            let fresh = || Lu::new(part.len(), self.jacobian_of(&state.evaluations, subset));
            if number == 0 {
                fresh()?.solve(&mut part);
            } else {
                let largest = subset.largest(&state.residual);
                if factors.lu.is_none() || largest > SERVES * factors.residual {
                    factors.lu = Some(fresh()?);
                }
                factors.residual = largest;
                factors.lu.as_ref()?.solve(&mut part);
            }
            subset.indices.iter().zip(part).for_each(|(&i, s)| step[i] = s);
        }
        Some(step)
    }

    /// The longest of the halved steps that lowers the residual, the full step if none does: where it leads.
    fn moved(&self, u: &[f64], step: &[f64], residual: &[f64], level: f64) -> (Vec<f64>, NewtonState) {
        let norm = |x: &[f64]| x.iter().map(|v| v * v).sum::<f64>();
        let before = norm(residual);
        let shortened = |share: f64| -> Vec<f64> { u.iter().zip(step).map(|(x, s)| x - share * s).collect() };
        let better = |after: f64, share: f64| after < before * (1.0 - 1e-4 * share);
        let full = shortened(1.0);
        let state = self.state(&full, level);
        let mut best = (norm(&state.residual), 1.0);
        let mut share = 1.0;
        while !better(best.0, best.1) && share > LEAST_SHARE {
            share *= 0.5;
            let after = norm(&self.residual(&shortened(share), level));
            if after < best.0 || best.0.is_nan() {
                best = (after, share);
            }
        }
        if best.1 == 1.0 {
            return (full, state);
        }
        let chosen = shortened(best.1);
        let state = self.state(&chosen, level);
        (chosen, state)
    }
}

/// Factors of the part of the even harmonics that were made last, and the residual there when they were used last.
#[derive(Default)]
struct Factors {
    lu: Option<Lu>,
    residual: f64,
}
