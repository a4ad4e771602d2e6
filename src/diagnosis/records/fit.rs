//! The fit of a model to records by prediction with derivatives, by Levenberg and Marquardt.
//!
//! ```text
//! chi^2 = sum_records sum_channels,samples ((y - y_model) / sigma)^2 + u sum_k (v_k / s_k)^2
//! ```
//!
//! `u` is 1 where the model leaves noise, more where it leaves more ([`super::evidence`]).

use super::chord_steps::ChordJacobian;
use super::data::RecordDiagnosisError;
use super::evidence::{alike, scale};
use super::fitted::FittedRecords;
use super::normal_equations::{Equations, Left, Normal, solve};
use super::problem::FitProblem;
use super::variables::{scales, slopes};
use dashpot_numerics::EquilibratedCholesky;
use std::sync::Arc;

/// Dampings that are tried for a step, and for one whose derivatives are held: where three fail new ones are better.
const ATTEMPTS: usize = 6;
const ATTEMPTS_HELD: usize = 3;
/// Gain of a step below which a fit has ended: as a share of what is left, and in units of what one squared deviation is worth (a
/// parameter then moves by less than a seventh of its deviation).
const LEAST_GAIN: f64 = 1e-7;
const NO_GAIN: f64 = 0.02;
/// Gain of a round, in the same units, below which there is no other: what derivatives that are held have missed is a small share of it.
const LITTLE: f64 = 2.0;

/// Share of the weight of the priors below which what a fit leaves asks for another round with less of it: they held the model to what is
/// stated more strongly than what is left demands.
const HELD: f64 = 0.5;
/// Share of the diagonal that is added where deviations are asked for: what the data do not tell is very uncertain.
const RIDGE: f64 = 1e-11;

/// What the priors weigh: what the start leaves demands it, so that many samples of one error do not bend what is known.
fn unit_of(start: &FittedRecords) -> f64 {
    if start.count > 0 { scale(start) } else { 1.0 }
}

/// Where a descent is: the fit, and its equations.
type Iterate = (FittedRecords, Normal);

/// How far a descent goes: most steps and attempts at each, and the share of what is left below which a step gains nothing.
#[derive(Clone, Copy)]
struct Limits {
    steps: usize,
    attempts: usize,
    least_gain: f64,
}

impl FitProblem<'_> {
    /// Improves a start in at most `iterations` steps; fewer where time is up.
    pub(super) fn improve(
        &self,
        start: &FittedRecords,
        iterations: usize,
    ) -> Result<FittedRecords, RecordDiagnosisError> {
        self.improve_to(start, iterations, LEAST_GAIN)
    }

    /// The same until a step gains less than a share `least_gain` of what is left.
    pub(super) fn improve_to(
        &self,
        start: &FittedRecords,
        iterations: usize,
        least_gain: f64,
    ) -> Result<FittedRecords, RecordDiagnosisError> {
        let scales = scales(&start.effects);
        let unit = unit_of(start);
        let normal = |at: &FittedRecords| self.normal(at, &scales, unit);
        let equations = Equations { normal: &normal, left: &|at| self.left(at) };
        let place = (start.clone(), normal(start)?);
        let (best, equations) = self
            .descend(place, Limits { steps: iterations, attempts: ATTEMPTS, least_gain }, &scales, unit, &equations)?
            .0;
        Ok(self.finish(best, &scales, equations))
    }

    /// The same in at most `rounds` of `steps` steps; in each round all variables but those of the laws are differentiated once
    /// ([`ChordJacobian`]).
    pub(super) fn chord_fit(
        &self,
        start: &FittedRecords,
        rounds: [usize; 2],
    ) -> Result<FittedRecords, RecordDiagnosisError> {
        self.chord_fit_from(start, rounds, &mut None)
    }

    /// The same, in the first round with the derivatives `chord` of a start at the same place where there are any; those of the last round
    /// are left there.
    pub(super) fn chord_fit_from(
        &self,
        start: &FittedRecords,
        rounds: [usize; 2],
        chord: &mut Option<ChordJacobian>,
    ) -> Result<FittedRecords, RecordDiagnosisError> {
        self.chord_rounds(start, rounds, unit_of(start), chord)
    }

    /// The same with priors that weigh as if the start left noise alone, then what it leaves: where the priors of a start that leaves much
    /// hold corrections so fast that what they would take away stays.
    pub(super) fn freed(
        &self,
        start: &FittedRecords,
        rounds: [usize; 2],
    ) -> Result<FittedRecords, RecordDiagnosisError> {
        let free = self.chord_rounds(start, rounds, 1.0, &mut None)?;
        self.chord_fit(&free, rounds)
    }

    fn chord_rounds(
        &self,
        start: &FittedRecords,
        [rounds, steps]: [usize; 2],
        mut unit: f64,
        chord: &mut Option<ChordJacobian>,
    ) -> Result<FittedRecords, RecordDiagnosisError> {
        let scales = scales(&start.effects);
        let mut best = start.clone();
        for round in 0..rounds {
            let defect = self.defect(&best)?;
            let normal = match chord {
                Some(chord) if round == 0 => chord.normal(self, &best, &scales, unit, &defect)?,
                _ => match ChordJacobian::new(self, &best, &scales, unit, &defect)? {
                    Some((own, normal)) => {
                        *chord = Some(own);
                        normal
                    }
                    None => return self.improve(&best, rounds * steps),
                },
            };
            let Some(chord) = chord else { break };
            let renewed = |at: &FittedRecords| chord.normal(self, at, &scales, unit, &defect);
            let there = Equations { normal: &renewed, left: &|at| self.left_beside(at, &defect) };
            let ended;
            let equations;
            let before = normal.left.total(unit);
            let limits = Limits { steps, attempts: ATTEMPTS_HELD, least_gain: LEAST_GAIN };
            ((best, equations), ended) = self.descend((best, normal), limits, &scales, unit, &there)?;
            let little = before - equations.left.total(unit) < LITTLE * unit;
            best = self.finish(best, &scales, equations);
            let held = unit_of(&best) < HELD * unit;
            if (ended || little) && !held || self.control.is_late() {
                return Ok(best);
            }
            unit = if held { unit_of(&best) } else { unit };
        }
        Ok(best)
    }

    /// Steps from a place; whether the first of them gained nothing.
    fn descend(
        &self,
        (mut best, mut equations): Iterate,
        limits: Limits,
        scales: &[Vec<f64>],
        unit: f64,
        by: &Equations,
    ) -> Result<(Iterate, bool), RecordDiagnosisError> {
        let mut damping = 1e-3;
        for k in 0..limits.steps {
            self.control.check()?;
            if self.control.is_late() {
                break;
            }
            let before = equations.left.total(unit);
            let least = (limits.least_gain * before).max(NO_GAIN * unit);
            let next = self.step(&best, scales, unit, (&equations, by), &mut damping, (limits.attempts, least))?;
            let Some((next, there)) = next else { return Ok(((best, equations), k == 0)) };
            let gain = before - there.left.total(unit);
            (best, equations) = (next, there);
            if gain < least {
                return Ok(((best, equations), k == 0));
            }
        }
        Ok(((best, equations), false))
    }

    /// One step that leaves less, with the equations there; `None` where none of some `attempts` does, or a step is expected to gain less
    /// than `least`.
    fn step(
        &self,
        best: &FittedRecords,
        scales: &[Vec<f64>],
        unit: f64,
        (equations, by): (&Normal, &Equations),
        damping: &mut f64,
        (attempts, least): (usize, f64),
    ) -> Result<Option<Iterate>, RecordDiagnosisError> {
        let before = equations.left.total(unit);
        for attempt in 0..attempts {
            let Some(step) = solve(equations, *damping) else {
                *damping *= 10.0;
                continue;
            };
            // More damping would gain even less.
            if step.expected_gain < least {
                return Ok(None);
            }
            let trial = self.moved(best, scales, &step.change);
            // The first step is mostly one that leaves less; later ones are looked at without derivatives.
            let there = if attempt == 0 {
                (by.normal)(&trial).map(|there| (there.left.total(unit), Some(there)))
            } else {
                (by.left)(&trial).map(|there| (there.total(unit), None))
            };
            match there {
                Ok((total, there)) if total < before => {
                    *damping = (*damping * 0.2).max(1e-12);
                    let there = there.map_or_else(|| (by.normal)(&trial), Ok)?;
                    return Ok(Some((trial, there)));
                }
                // A model that runs away is no step.
                Ok(_) | Err(RecordDiagnosisError::Model { .. }) => *damping = (*damping * 8.0).max(1e-6),
                Err(other) => return Err(other),
            }
            if self.control.is_late() {
                break;
            }
        }
        Ok(None)
    }

    /// Adds deviations and what is left.
    fn finish(&self, mut best: FittedRecords, scales: &[Vec<f64>], normal: Normal) -> FittedRecords {
        let shared = self.shared(&best);
        // Where the equations have no solution the data tell no parameter: derivatives that run away, as those of friction that falls
        // with speed may over a long record.
        let factor = EquilibratedCholesky::new(normal.matrix.as_ref(), RIDGE);
        let deviations = factor.map_or_else(|| vec![f64::INFINITY; shared], |factor| factor.deviations());
        let slopes = slopes(&best.effects, scales);
        let deviation = |k: usize| {
            let deviation = deviations[k] * slopes.get(k).copied().unwrap_or(1.0).abs();
            if deviation.is_nan() { f64::INFINITY } else { deviation }
        };
        best.deviations = (0..shared).map(deviation).collect();
        best.alike = alike(self.records, self.share);
        let Left { chi_square, prior, count, residual } = normal.left;
        (best.chi_square, best.prior, best.count) = (chi_square, prior, count);
        best.residual = Arc::new(residual);
        best
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::chain;
    use crate::common::runs::decay;
    use crate::control::Control;
    use crate::diagnosis::records::data::Records;
    use crate::diagnosis::records::problem::Free;

    /// Derivatives that run away leave the fit where it is, and tell nothing of its parameters.
    #[test]
    fn equations_without_a_solution_tell_no_parameter() {
        let structure = chain(&[2.0, 1.0], &[800.0, 0.0], &[1500.0]);
        let wave = |n: usize| (-1e-3 * n as f64).exp() * (0.07 * n as f64).cos();
        let run = decay(4e-3, (0..2).map(|_| (0..2000).map(wave).collect()).collect());
        let (records, control) = (Records::new(&structure, &[], &[run]).unwrap(), Control::unattended());
        let problem = FitProblem { records: &records, free: Free::all(&records), share: 1.0, control: &control };
        let start = FittedRecords::start(&records, &[]);
        let normal = || problem.normal(&start, &[], 1.0).unwrap();
        let sound = problem.finish(start.clone(), &[], normal());
        assert!(!sound.deviations.is_empty() && sound.deviations.iter().all(|d| d.is_finite()));
        let mut away = normal();
        let last = away.gradient.len() - 1;
        away.matrix[(last, last)] = f64::INFINITY;
        let fit = problem.finish(start.clone(), &[], away);
        assert!(fit.deviations.iter().all(|d| d.is_infinite()), "{:?}", fit.deviations);
        assert_eq!(fit.chi_square, sound.chi_square);
    }
}
