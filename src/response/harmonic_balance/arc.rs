//! The force raised from nothing by pseudo-arclength continuation ([`super::continuation`]), so that the path may turn back: the last resort
//! of a single response, and the way to all responses that fold over each other.
//!
//! ```text
//! R(F, s) = 0,  D = s D_lin - C F
//! ```
//!
//! Each point at which the path passes the full force, `s = 1`, is an answer.

use super::continuation::{Advance, CORRECTIONS, Continuation, Curve, StepControl};
use super::error::ResponseError;
use super::iterate::Ending;
use super::newton::{Balance, NewtonState};
use super::settings::Settings;
use crate::control::Control;

/// Most points of the path.
const MOST_POINTS: usize = 400;
/// Share of the force up to which the path is followed for all answers.
const TOP: f64 = 3.0;
/// Answers closer than this share of their size are one.
const SAME: f64 = 1e-6;
/// Smallest and largest step of the arc, and the first.
const STEPS: [f64; 2] = [1e-7, 0.2];
const FIRST: f64 = 0.02;
/// Points of the path are as exact as they serve to find the next, so many times the tolerance of an answer.
const ROUGH: f64 = 1e3;

/// What the arc came to.
pub(crate) struct ArcEnding {
    pub ending: Ending,
    /// Greatest share of the excitation on the path.
    pub reached: f64,
}

/// The balances under all levels of the force.
struct ByLevel<'a> {
    balance: &'a Balance<'a>,
    /// Least size of the leg forces, N^2: of the laws' answers to the motion without any force.
    least: f64,
}

impl Curve for ByLevel<'_> {
    fn at<T>(&self, level: f64, work: impl FnOnce(&Balance<'_>, f64) -> Option<T>) -> Option<T> {
        work(self.balance, level)
    }

    fn slope(&self, balance: &Balance<'_>, state: &NewtonState, _: &[f64], _: f64) -> Option<Vec<f64>> {
        Some(balance.by_level(&state.evaluations))
    }

    /// Leg forces are measured by their own size, which grows along the path.
    fn weights(&self, u: &[f64]) -> [f64; 2] {
        [u.iter().map(|x| x * x).sum::<f64>().max(self.least).recip(), 1.0]
    }
}

/// Leg forces under the whole excitation, if the path from nothing comes there.
pub(crate) fn level_arc(
    balance: &Balance,
    settings: &Settings,
    control: &Control,
) -> Result<(Option<Vec<f64>>, ArcEnding), ResponseError> {
    let mut found = None;
    let gives_up = |steps: usize| settings.gives_up(steps, control);
    let extent = Extent { tolerance: settings.tolerance, top: 1.0, gives_up: &gives_up };
    let ending = trace(balance, extent, control, |u, last| {
        found = last.converged.then(|| u.to_vec());
        false
    })?;
    Ok((found, ending))
}

/// Leg forces of every answer on the path up to three times the force, in order along it.
pub(crate) fn all_crossings(
    balance: &Balance,
    tolerance: f64,
    control: &Control,
) -> Result<Vec<Vec<f64>>, ResponseError> {
    let mut found: Vec<Vec<f64>> = Vec::new();
    let extent = Extent { tolerance, top: TOP, gives_up: &|_| false };
    trace(balance, extent, control, |u, last| {
        if last.converged && !found.iter().any(|other| alike(other, u)) {
            found.push(u.to_vec());
        }
        true
    })?;
    Ok(found)
}

/// Whether two lists of forces are one answer.
fn alike(a: &[f64], b: &[f64]) -> bool {
    let size = a.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    a.iter().zip(b).all(|(x, y)| (x - y).abs() <= SAME * size)
}

/// How far the path is followed.
struct Extent<'a> {
    /// Relative residual of an answer.
    tolerance: f64,
    /// Greatest share of the force.
    top: f64,
    /// Whether so many Newton steps are enough.
    gives_up: &'a dyn Fn(usize) -> bool,
}

/// Follows the path and shows each answer at the full force to `visit`, until that has enough.
fn trace(
    balance: &Balance,
    Extent { tolerance, top, gives_up }: Extent<'_>,
    control: &Control,
    mut visit: impl FnMut(&[f64], Ending) -> bool,
) -> Result<ArcEnding, ResponseError> {
    let still = vec![0.0; balance.condensed.size()];
    let answer: f64 = balance.residual(&still, 1.0).iter().map(|x| x * x).sum();
    let curve = ByLevel { balance, least: answer.clamp(f64::MIN_POSITIVE, f64::MAX) };
    let steps = StepControl { tolerance: ROUGH * tolerance, limits: STEPS, held: 1 };
    let mut result = ArcEnding { ending: Ending { converged: false, steps: 0, residual: f64::INFINITY }, reached: 0.0 };
    let Some(mut path) = Continuation::new(&curve, steps, still, [0.0, 1.0, FIRST]) else { return Ok(result) };
    for _ in 0..MOST_POINTS {
        control.check()?;
        if gives_up(result.ending.steps) {
            break;
        }
        let (from, corrections) = match path.advance() {
            Advance::Reached { from, corrections } => (from, corrections),
            Advance::Shortened => {
                result.ending.steps += CORRECTIONS;
                continue;
            }
            Advance::Stuck => break,
        };
        result.ending.steps += corrections;
        let level = path.point.parameter;
        result.reached = result.reached.max(level.min(1.0));
        if (from.parameter < 1.0) != (level < 1.0) {
            let share = (1.0 - from.parameter) / (level - from.parameter);
            let mut u: Vec<f64> = from.u.iter().zip(&path.point.u).map(|(a, b)| a + share * (b - a)).collect();
            let last = balance.solve(&mut u, 1.0, tolerance);
            result.ending = Ending { steps: result.ending.steps + last.steps, ..last };
            if !visit(&u, last) {
                break;
            }
        }
        if level >= top || level < 0.0 {
            break;
        }
    }
    Ok(result)
}
