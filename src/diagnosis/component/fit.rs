//! Laws fitted to the forces of all loops: Levenberg and Marquardt over their parameters, the zero of every force cell free.

use crate::balance::loops::{ComponentError, LoopRecord, Loops};
use crate::control::Control;
use crate::diagnosis::records::variables::{at_variable, scales, slopes, variable};
use crate::effects::{Parameter, Source};
use crate::math::statistics::root_mean_square;
use dashpot_numerics::{EquilibratedCholesky, dot};
use faer::Mat;

/// Change of a variable by which derivatives are taken.
const STEP: f64 = 1e-4;
/// Largest change of a variable in one iteration.
const REACH: f64 = 1.0;
/// Share of what a pure number typically is that is nothing.
const LEAST_TOLD: f64 = 1e-3;
/// Share of the diagonal that is added where deviations are asked for.
const RIDGE: f64 = 1e-12;
/// Independent data of a record: what a law leaves is alike along each branch of a loop, and from one cycle to the next.
const PER_RECORD: f64 = 8.0;

/// Laws with what they leave.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Fitted {
    pub effects: Vec<Source>,
    /// Standard deviations of the parameters of all effects, in order.
    pub deviations: Vec<f64>,
    /// Sum over the records of the squared residual over the squared size of the force, a sample.
    pub square: f64,
}

impl Fitted {
    /// Relative error of the force, root mean square over the records.
    pub(super) fn error(&self, records: usize) -> f64 {
        (self.square / records as f64).sqrt()
    }
}

/// A fit with what it is ranked by.
pub(super) struct Ranked {
    pub fit: Fitted,
    /// Relative error on each record, fitted to the others; none where that was not asked.
    pub held_out: Option<f64>,
    /// Minus twice the logarithm of its density, smaller is better.
    pub criterion: f64,
}

/// Force that the known sources and `effects` give, without the zero of the force cell.
pub(super) fn predicted(loops: &Loops, one: &LoopRecord, effects: &[Source]) -> Result<Vec<f64>, ComponentError> {
    let mut sum: Vec<f64> = one.a.iter().map(|a| loops.mass * a).collect();
    for source in loops.known.iter().chain(effects) {
        let none = ComponentError::NoTimeDomain { law: source.effect.name() };
        let force = one.law_force(source).ok_or(none)?;
        sum.iter_mut().zip(force).for_each(|(s, f)| *s += f);
    }
    Ok(sum)
}

/// What is left of the force of a record, its mean taken out, over the size of the force; `parts` of the records only.
fn left(loops: &Loops, one: &LoopRecord, effects: &[Source]) -> Result<Vec<f64>, ComponentError> {
    let model = predicted(loops, one, effects)?;
    let rest: Vec<f64> = one.force.iter().zip(&model).map(|(f, m)| f - m).collect();
    let (mean, unit) = (rest.iter().sum::<f64>() / rest.len() as f64, one.size() * (rest.len() as f64).sqrt());
    Ok(rest.iter().map(|r| (r - mean) / unit).collect())
}

/// What is left of all records in `used`.
pub(super) fn residual(loops: &Loops, effects: &[Source], used: &[usize]) -> Result<Vec<f64>, ComponentError> {
    let mut all = Vec::new();
    for &k in used {
        all.extend(left(loops, &loops.list[k], effects)?);
    }
    Ok(all)
}

/// Fits without those that stand in the list before.
pub(super) fn without_repeats(fits: Vec<Fitted>) -> Vec<Fitted> {
    let mut different: Vec<Fitted> = Vec::new();
    for fit in fits {
        let same = |known: &Fitted| {
            known.effects.len() == fit.effects.len()
                && fit.effects.iter().all(|e| known.effects.iter().any(|k| k.is_same(e)))
        };
        if !different.iter().any(same) {
            different.push(fit);
        }
    }
    different
}

/// Independent data of `count` records.
pub(super) fn freedom(count: usize) -> f64 {
    PER_RECORD * count as f64
}

/// Fits `start` to the records in `used`.
pub(super) fn improved(
    loops: &Loops,
    start: &[Source],
    used: &[usize],
    iterations: usize,
    control: &Control,
) -> Result<Fitted, ComponentError> {
    let scales = scales(start);
    let mut best = start.to_vec();
    let mut at = residual(loops, &best, used)?;
    let mut damping = 1e-3;
    let mut jacobian = derivatives(loops, &best, &scales, used, &at)?;
    for _ in 0..iterations {
        control.check()?;
        let Some(change) = step(&jacobian, &at, damping) else { break };
        let trial = moved(&best, &scales, &change);
        let there = residual(loops, &trial, used)?;
        let (before, after) = (dot(&at, &at), dot(&there, &there));
        if after.is_finite() && after < before {
            (best, at) = (trial, there);
            damping = (damping * 0.2).max(1e-9);
            if before - after < 1e-5 * before {
                break;
            }
            jacobian = derivatives(loops, &best, &scales, used, &at)?;
        } else {
            damping *= 10.0;
            if damping > 1e6 {
                break;
            }
        }
    }
    let square = dot(&at, &at);
    let variance = square / (freedom(used.len()) - jacobian.len() as f64).max(1.0);
    let slopes = slopes(&best, &scales);
    let count = jacobian.len();
    let factor = EquilibratedCholesky::new(normal_matrix(&jacobian).as_ref(), RIDGE);
    let known = factor.map_or_else(|| vec![f64::INFINITY; count], |factor| factor.deviations());
    let deviation = |k: usize| known[k] * variance.sqrt() * slopes[k].abs();
    Ok(Fitted { effects: best, deviations: (0..count).map(deviation).collect(), square })
}

/// Relative error of `effects` on the records in `used`.
pub(super) fn error(loops: &Loops, effects: &[Source], used: &[usize]) -> Result<f64, ComponentError> {
    let residual_norm = |k: &usize| -> Result<f64, ComponentError> {
        let rest = left(loops, &loops.list[*k], effects)?;
        Ok(dot(&rest, &rest).sqrt())
    };
    let all: Vec<f64> = used.iter().map(residual_norm).collect::<Result<_, _>>()?;
    Ok(root_mean_square(&all))
}

/// Share of the force of all records together that `effects` leave, root of the ratio of squares: that of a record in which the component
/// gives no force, whose error is all noise, counts for nothing.
pub(super) fn left_of_all(loops: &Loops, effects: &[Source]) -> Result<f64, ComponentError> {
    let (mut rest, mut size) = (0.0, 0.0);
    for one in &loops.list {
        let share = left(loops, one, effects)?;
        size += one.size().powi(2);
        rest += dot(&share, &share) * one.size().powi(2);
    }
    Ok((rest / size).sqrt())
}

fn moved(effects: &[Source], scales: &[Vec<f64>], change: &[f64]) -> Vec<Source> {
    let mut next = effects.to_vec();
    let mut k = 0;
    for (effect, scales) in next.iter_mut().zip(scales) {
        for (j, parameter) in effect.effect.parameters().iter().enumerate() {
            let now = variable(parameter, scales[j], effect.parameters[j]);
            let value = at_variable(parameter, scales[j], now + change[k].clamp(-REACH, REACH))[0];
            effect.parameters[j] = value.max(least_told(parameter));
            k += 1;
        }
    }
    next
}

/// The least value that loops can tell from nothing of a parameter that is a pure number from 0 upwards: below it derivatives by the
/// logarithm, in which it is varied, are those of rounding.
fn least_told(parameter: &Parameter) -> f64 {
    let is_number = parameter.unit.is_empty() && parameter.least == 0.0;
    if is_number { LEAST_TOLD * parameter.typical.abs() } else { f64::NEG_INFINITY }
}

/// Derivatives of the residual by every variable, one list each.
fn derivatives(
    loops: &Loops,
    effects: &[Source],
    scales: &[Vec<f64>],
    used: &[usize],
    at: &[f64],
) -> Result<Vec<Vec<f64>>, ComponentError> {
    let count: usize = effects.iter().map(|e| e.parameters.len()).sum();
    let derivative = |k: usize| -> Result<Vec<f64>, ComponentError> {
        let mut change = vec![0.0; count];
        change[k] = STEP;
        let there = residual(loops, &moved(effects, scales, &change), used)?;
        Ok(there.iter().zip(at).map(|(b, a)| (b - a) / STEP).collect())
    };
    (0..count).map(derivative).collect()
}

fn normal_matrix(jacobian: &[Vec<f64>]) -> Mat<f64> {
    Mat::from_fn(jacobian.len(), jacobian.len(), |i, j| dot(&jacobian[i], &jacobian[j]))
}

fn step(jacobian: &[Vec<f64>], at: &[f64], damping: f64) -> Option<Vec<f64>> {
    let down: Vec<f64> = jacobian.iter().map(|column| -dot(column, at)).collect();
    Some(EquilibratedCholesky::new(normal_matrix(jacobian).as_ref(), damping)?.solve(&down))
}
