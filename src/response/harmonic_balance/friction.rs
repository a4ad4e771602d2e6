//! Set-valued friction in harmonic balance: `Phi = P [ g(v) + clamp(s) ]`, `s = F - g(v) + r v`, `clamp` to `low..high`.
//!
//! Jumps and kinks fall between samples. So the period is cut into cells around the samples, `s` is taken as straight
//! from edge to edge, and its clamped mean over the cell is exact:
//!
//! ```text
//! A(a, b) = (G(b) - G(a)) / (b - a),    G' = clamp,    dA/da = (A - clamp a)/(b - a),   dA/db = (clamp b - A)/(b - a)
//! ```
//!
//! The mean of a straight line takes `cos(h delta / 2)` of harmonic `h`, which is given back, so that stick, where nothing
//! is clamped, is exact; the rest is of second order in the sample.

use super::fourier::{Fourier, differentiate};
use super::nonlinear_leg::{LawEvaluation, NonlinearLeg, add_velocity_columns};
use crate::effects::SetValued;

/// Least and greatest force at rest, N.
fn bounds(leg: &NonlinearLeg) -> [f64; 2] {
    leg.law.set_valued().map_or([0.0; 2], |law| law.bounds(&leg.parameters))
}

/// Whether there is a smooth part beside the clamp.
fn is_falling(leg: &NonlinearLeg) -> bool {
    leg.law.set_valued().is_some_and(SetValued::has_smooth_part)
}

/// Smooth part `g(v)` and its slope; none for friction of constant size.
fn falling(leg: &NonlinearLeg, v: f64) -> [f64; 2] {
    leg.law.set_valued().map_or([0.0; 2], |law| law.smooth_part(&leg.parameters, v))
}

/// Derivative of the smooth part by parameter `k`.
fn falling_by(leg: &NonlinearLeg, k: usize, v: f64) -> f64 {
    leg.law.set_valued().map_or(0.0, |law| law.smooth_part_by(&leg.parameters, k, v))
}

/// Histories of one period: at the edges before each sample, and the velocity at the samples (only where friction falls).
struct Histories {
    /// `s` at the edges, N.
    edge: Vec<f64>,
    /// Velocity at the edges, m/s.
    edge_velocity: Vec<f64>,
    /// Velocity at the samples, m/s.
    velocity: Vec<f64>,
}

fn histories(leg: &NonlinearLeg, fourier: &Fourier, omega: f64, force: &[f64], motion: &[f64]) -> Histories {
    let blank = vec![0.0; fourier.samples()];
    let mut rate = vec![0.0; motion.len()];
    differentiate(omega, motion, &mut rate);
    let falls = is_falling(leg);
    let (mut velocity, mut edge_velocity, mut edge) = (blank.clone(), blank.clone(), blank);
    if falls {
        fourier.synthesise(&rate, &mut velocity);
        fourier.synthesise(&fourier.at_edges(&rate), &mut edge_velocity);
    }
    let prediction: Vec<f64> = force.iter().zip(&rate).map(|(f, v)| f + leg.weight * v).collect();
    fourier.synthesise(&fourier.at_edges(&prediction), &mut edge);
    if falls {
        edge.iter_mut().zip(&edge_velocity).for_each(|(s, &v)| *s -= falling(leg, v)[0]);
    }
    Histories { edge, edge_velocity, velocity }
}

/// Mean over a cell of the straight line from `a` to `b`, clamped to `low..high`, and its slopes by `a` and `b`.
fn cell(a: f64, b: f64, [low, high]: [f64; 2]) -> [f64; 3] {
    let (middle, bound) = (0.5 * (low + high), 0.5 * (high - low));
    let [mean, by_a, by_b] = symmetric_cell(a - middle, b - middle, bound);
    [middle + mean, by_a, by_b]
}

/// The same for limits of `+-bound`.
fn symmetric_cell(a: f64, b: f64, bound: f64) -> [f64; 3] {
    let clamp = |s: f64| s.clamp(-bound, bound);
    let inside = a.abs() < bound && b.abs() < bound;
    if inside {
        return [0.5 * (a + b), 0.5, 0.5];
    }
    if a.abs() >= bound && b.abs() >= bound && (a > 0.0) == (b > 0.0) {
        return [bound * a.signum(), 0.0, 0.0];
    }
    // Not both outside on one side, so they differ.
    let whole = |s: f64| if s.abs() < bound { 0.5 * s * s } else { bound * s.abs() - 0.5 * bound * bound };
    let width = b - a;
    let mean = if width == 0.0 { clamp(a) } else { (whole(b) - whole(a)) / width };
    if width.abs() <= 1e-12 * bound {
        return [mean, 0.25, 0.25];
    }
    [mean, (mean - clamp(a)) / width, (clamp(b) - mean) / width]
}

/// Gives back what the mean over a cell takes of each harmonic.
fn restore(fourier: &Fourier, coefficients: &mut [f64]) {
    for h in 1..=fourier.harmonics() {
        let factor = 1.0 / fourier.half_angle(h).cos();
        coefficients[2 * h - 1] *= factor;
        coefficients[2 * h] *= factor;
    }
}

fn projected(leg: &NonlinearLeg, fourier: &Fourier, clamped: &[f64], smooth: &[f64]) -> Vec<f64> {
    let mut value = vec![0.0; fourier.width()];
    fourier.project(clamped, &mut value);
    restore(fourier, &mut value);
    if is_falling(leg) {
        let mut rest = vec![0.0; fourier.width()];
        fourier.project(smooth, &mut rest);
        value.iter_mut().zip(rest).for_each(|(v, r)| *v += r);
    }
    value
}

fn next(n: usize, edges: &[f64]) -> usize {
    if n + 1 == edges.len() { 0 } else { n + 1 }
}

/// `Phi`.
pub(crate) fn value(leg: &NonlinearLeg, fourier: &Fourier, omega: f64, force: &[f64], motion: &[f64]) -> Vec<f64> {
    let at = histories(leg, fourier, omega, force, motion);
    let bounds = bounds(leg);
    let clamped: Vec<f64> =
        (0..at.edge.len()).map(|n| cell(at.edge[n], at.edge[next(n, &at.edge)], bounds)[0]).collect();
    let smooth: Vec<f64> = at.velocity.iter().map(|&v| falling(leg, v)[0]).collect();
    projected(leg, fourier, &clamped, &smooth)
}

/// `Phi` with its derivatives.
pub(crate) fn evaluate(
    leg: &NonlinearLeg,
    fourier: &Fourier,
    omega: f64,
    force: &[f64],
    motion: &[f64],
) -> LawEvaluation {
    let at = histories(leg, fourier, omega, force, motion);
    let bounds = bounds(leg);
    let cells: Vec<[f64; 3]> =
        (0..at.edge.len()).map(|n| cell(at.edge[n], at.edge[next(n, &at.edge)], bounds)).collect();
    let clamped: Vec<f64> = cells.iter().map(|c| c[0]).collect();
    let smooth: Vec<f64> = at.velocity.iter().map(|&v| falling(leg, v)[0]).collect();
    let value = projected(leg, fourier, &clamped, &smooth);
    let by_force = edge_multiplier(fourier, cells.iter().map(|c| [c[1], c[2]]));
    let mut by_velocity: Vec<f64> = by_force.iter().map(|x| x * leg.weight).collect();
    if is_falling(leg) {
        let slopes: Vec<f64> = at.edge_velocity.iter().map(|&v| falling(leg, v)[1]).collect();
        let pairs = cells.iter().enumerate().map(|(n, c)| [c[1] * slopes[n], c[2] * slopes[next(n, &slopes)]]);
        let taken = edge_multiplier(fourier, pairs);
        let given: Vec<f64> = at.velocity.iter().map(|&v| falling(leg, v)[1]).collect();
        let given = fourier.multiplier(&given);
        by_velocity.iter_mut().zip(taken.iter().zip(&given)).for_each(|(x, (t, g))| *x += g - t);
    }
    let mut by_motion = vec![0.0; fourier.width() * fourier.width()];
    add_velocity_columns(&mut by_motion, &by_velocity, omega, fourier);
    LawEvaluation { value, by_force: Some(by_force), by_motion }
}

/// The matrix of "take the values at the edges of each cell, weigh and add the two, project, restore".
fn edge_multiplier(fourier: &Fourier, weights: impl Iterator<Item = [f64; 2]>) -> Vec<f64> {
    let width = fourier.width();
    let (mut sum, mut difference) = (Vec::new(), Vec::new());
    for [a, b] in weights {
        sum.push(a + b);
        difference.push(b - a);
    }
    let mut matrix = fourier.multiplier(&sum);
    let sharp = difference.iter().any(|&d| d != 0.0);
    let odd = if sharp { fourier.multiplier(&difference) } else { Vec::new() };
    let angles: Vec<(f64, f64)> = (0..=fourier.harmonics()).map(|h| fourier.half_angle(h).sin_cos()).collect();
    for row in fourier.rows() {
        let given = 1.0 / angles[row.div_ceil(2)].1;
        matrix[row * width] *= given;
        for h in fourier.partners(row.div_ceil(2)) {
            let (sin, cos) = angles[h];
            let (c, s) = (row * width + 2 * h - 1, row * width + 2 * h);
            // cos(h (t +- e)) = cos h t cos h e -+ sin h t sin h e, and alike for the sine.
            let (oc, os) = if sharp { (odd[c], odd[s]) } else { (0.0, 0.0) };
            matrix[c] = given * (matrix[c] * cos - os * sin);
            matrix[s] = given * (matrix[s] * cos + oc * sin);
        }
    }
    matrix
}

/// Derivative of `Phi` by parameter `k`, force and motion held.
pub(crate) fn by_parameter(
    leg: &NonlinearLeg,
    fourier: &Fourier,
    omega: f64,
    k: usize,
    force: &[f64],
    motion: &[f64],
) -> Vec<f64> {
    let at = histories(leg, fourier, omega, force, motion);
    let bounds = bounds(leg);
    let bounds_by = leg.law.set_valued().map_or([0.0; 2], |law| law.bounds_by(&leg.parameters, k));
    let clamped: Vec<f64> = (0..at.edge.len())
        .map(|n| {
            let (m, edges) = (next(n, &at.edge), &at.edge);
            let [_, by_a, by_b] = cell(edges[n], edges[m], bounds);
            let direct = by_bounds(edges[n], edges[m], bounds, bounds_by);
            direct - by_a * falling_by(leg, k, at.edge_velocity[n]) - by_b * falling_by(leg, k, at.edge_velocity[m])
        })
        .collect();
    let smooth: Vec<f64> = at.velocity.iter().map(|&v| falling_by(leg, k, v)).collect();
    projected(leg, fourier, &clamped, &smooth)
}

/// Change of the clamped mean over a cell when the bounds change by `by`: the shares of the cell that are clamped.
fn by_bounds(a: f64, b: f64, [low, high]: [f64; 2], by: [f64; 2]) -> f64 {
    let (least, most) = (a.min(b), a.max(b));
    if least == most {
        return if least >= high {
            by[1]
        } else if least <= low {
            by[0]
        } else {
            0.0
        };
    }
    let above = (most - least.max(high)).max(0.0);
    let below = (most.min(low) - least).max(0.0);
    (above * by[1] + below * by[0]) / (most - least)
}

/// Local stiffness and damping at an instant: a damping that holds where friction sticks.
pub(crate) fn slope(leg: &NonlinearLeg, f: f64, v: f64) -> [f64; 2] {
    let [g, slope] = falling(leg, v);
    let ([low, high], s) = (bounds(leg), f - g + leg.weight * v);
    let sticks = s > low && s < high;
    if leg.flexibility > 0.0 {
        return [if sticks { 1.0 / leg.flexibility } else { 0.0 }, 0.0];
    }
    [0.0, if sticks { 1e3 * leg.weight } else { slope }]
}
