//! The force raised from nothing along the arc, so that the path may turn back: the last resort of a single response,
//! and the way to all responses that fold over each other.
//!
//! ```text
//! R(F, s) = 0,  D = s D_lin - C F,      t_F (F - F_0) / F_ref^2 + t_s (s - s_0) = step
//! ```
//!
//! Each point at which the path passes the full force, `s = 1`, is an answer.

use super::dense::Lu;
use super::error::ResponseError;
use super::iterate::Ending;
use super::newton::{Balance, relative};
use super::settings::Settings;
use crate::control::Control;

/// Most points of the path.
const MOST_POINTS: usize = 400;
/// Share of the force up to which the path is followed for all answers.
const TOP: f64 = 3.0;
/// Answers closer than this share of their size are one.
const SAME: f64 = 1e-6;
/// Newton steps back to the path.
const CORRECTIONS: usize = 12;
/// Smallest and largest step of the arc.
const STEPS: [f64; 2] = [1e-7, 0.2];

/// What the arc came to.
pub(crate) struct ArcEnding {
    pub ending: Ending,
    /// Greatest share of the excitation on the path.
    pub reached: f64,
}

/// A point of the path with its direction.
struct Point {
    u: Vec<f64>,
    level: f64,
    tangent: Vec<f64>,
}

/// Leg forces under the whole excitation, if the path from nothing comes there.
pub(crate) fn level_arc(
    balance: &Balance,
    settings: &Settings,
    control: &Control,
) -> Result<(Option<Vec<f64>>, ArcEnding), ResponseError> {
    let mut found = None;
    let gives_up = |steps: usize| settings.gives_up(steps, control);
    let ending = trace(balance, ([settings.tolerance, 1.0], &gives_up), control, |u, last| {
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
    trace(balance, ([tolerance, TOP], &|_| false), control, |u, last| {
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

/// Follows the path up to `top` times the force and shows each answer at the full force to `visit`, until that has
/// enough or `gives_up` says so of the number of steps made.
fn trace(
    balance: &Balance,
    ([tolerance, top], gives_up): ([f64; 2], &dyn Fn(usize) -> bool),
    control: &Control,
    mut visit: impl FnMut(&[f64], Ending) -> bool,
) -> Result<ArcEnding, ResponseError> {
    let size = balance.condensed.size();
    let mut result = ArcEnding { ending: Ending { converged: false, steps: 0, residual: f64::INFINITY }, reached: 0.0 };
    let least = reference(balance);
    let mut up = vec![0.0; size + 1];
    up[size] = 1.0;
    let Some(mut point) = oriented(balance, vec![0.0; size], 0.0, &up, least) else {
        return Ok(result);
    };
    let mut step = 0.02;
    for _ in 0..MOST_POINTS {
        control.check()?;
        if gives_up(result.ending.steps) {
            break;
        }
        let Some((next, steps)) = advance(balance, &point, step, tolerance, least) else {
            result.ending.steps += CORRECTIONS;
            step *= 0.3;
            if step < STEPS[0] {
                break;
            }
            continue;
        };
        result.ending.steps += steps;
        result.reached = result.reached.max(next.level.min(1.0));
        if (point.level < 1.0) != (next.level < 1.0) {
            let share = (1.0 - point.level) / (next.level - point.level);
            let mut u: Vec<f64> = point.u.iter().zip(&next.u).map(|(a, b)| a + share * (b - a)).collect();
            let last = balance.solve(&mut u, 1.0, tolerance);
            result.ending = Ending { steps: result.ending.steps + last.steps, ..last };
            if !visit(&u, last) {
                break;
            }
        }
        if next.level >= top || next.level < 0.0 {
            break;
        }
        point = next;
        step = if steps <= 3 { (1.5 * step).min(STEPS[1]) } else { step };
    }
    Ok(result)
}

/// What leg forces are measured by, N^2: their own size, which grows along the path.
fn measure(u: &[f64], least: f64) -> f64 {
    u.iter().map(|x| x * x).sum::<f64>().max(least)
}

/// Least size of the leg forces, N^2: of the laws' answers to the motion without any force.
fn reference(balance: &Balance) -> f64 {
    let still = vec![0.0; balance.condensed.size()];
    let answer = balance.residual(&still, 1.0);
    answer.iter().map(|x| x * x).sum::<f64>().clamp(f64::MIN_POSITIVE, f64::MAX)
}

/// The point with its tangent in the direction of `previous`.
fn oriented(balance: &Balance, u: Vec<f64>, level: f64, previous: &[f64], least: f64) -> Option<Point> {
    let scale = measure(&u, least);
    let state = balance.state(&u, level);
    let column = balance.by_level(&state.evaluations);
    let mut tangent = vec![0.0; u.len() + 1];
    tangent[u.len()] = 1.0;
    bordered(&balance.jacobian(&state.evaluations), &column, previous, 1.0 / scale, 1.0)?.solve(&mut tangent);
    let (last, forces) = tangent.split_last()?;
    let norm = (forces.iter().map(|t| t * t / scale).sum::<f64>() + last * last).sqrt();
    tangent.iter_mut().for_each(|t| *t /= norm);
    Some(Point { u, level, tangent })
}

/// One step along the arc with its number of corrections; `None` if they do not converge.
fn advance(balance: &Balance, point: &Point, step: f64, tolerance: f64, least: f64) -> Option<(Point, usize)> {
    let scale = measure(&point.u, least);
    let count = point.u.len();
    let mut u: Vec<f64> = point.u.iter().zip(&point.tangent).map(|(x, t)| x + step * t).collect();
    let mut level = point.level + step * point.tangent[count];
    for iteration in 0..CORRECTIONS {
        let state = balance.state(&u, level);
        if relative(&state.residual, &u) <= 1e3 * tolerance {
            return Some((oriented(balance, u, level, &point.tangent, least)?, iteration));
        }
        let column = balance.by_level(&state.evaluations);
        let lu = bordered(&balance.jacobian(&state.evaluations), &column, &point.tangent, 1.0 / scale, 1.0)?;
        let along: f64 = u.iter().zip(&point.u).zip(&point.tangent).map(|((x, o), t)| (x - o) * t / scale).sum();
        let mut change = state.residual;
        change.push(along + (level - point.level) * point.tangent[count] - step);
        lu.solve(&mut change);
        u.iter_mut().zip(&change).for_each(|(x, c)| *x -= c);
        level -= change[count];
    }
    None
}

/// Factors of `[J, column; t_F w_u, t_last w_last]`.
pub(crate) fn bordered(jacobian: &[f64], column: &[f64], tangent: &[f64], weight: f64, last_weight: f64) -> Option<Lu> {
    let n = column.len();
    let mut matrix = Vec::with_capacity((n + 1) * (n + 1));
    for (row, last) in jacobian.chunks_exact(n).zip(column) {
        matrix.extend_from_slice(row);
        matrix.push(*last);
    }
    matrix.extend(tangent[..n].iter().map(|t| t * weight));
    matrix.push(tangent[n] * last_weight);
    Lu::new(n + 1, matrix)
}
