//! Pseudo-arclength continuation: a curve of balances through its turning points (Krack and Gross, Harmonic Balance for Nonlinear Vibration
//! Problems, 2019, chapter 4).
//!
//! ```text
//! R(F, p) = 0,      w_F t_F^T (F - F_0) + w_p t_p (p - p_0) = s
//! ```
//!
//! Each point is predicted along the tangent `t`, of unit length by the weights `w`, and corrected by Newton's method on both equations
//! together, so that the parameter `p` may turn back: the level of the force (`arc`), or its frequency (`sweep`).

use super::dense::Lu;
use super::newton::{Balance, NewtonState, relative};

/// Newton steps back to the curve.
pub(super) const CORRECTIONS: usize = 10;

/// A curve of balances.
pub(super) trait Curve {
    /// `work` with the balance at a parameter and the level of its force; none where there is no balance, or it has no result.
    fn at<T>(&self, parameter: f64, work: impl FnOnce(&Balance<'_>, f64) -> Option<T>) -> Option<T>;

    /// Derivative `dR/dp` at forces `u`.
    fn slope(&self, balance: &Balance<'_>, state: &NewtonState, u: &[f64], parameter: f64) -> Option<Vec<f64>>;

    /// Weights of the arc length at forces `u`: of a force, and of the parameter.
    fn weights(&self, u: &[f64]) -> [f64; 2];
}

/// How steps are taken.
#[derive(Debug, Clone, Copy)]
pub(super) struct StepControl {
    /// Relative residual of a point.
    pub tolerance: f64,
    /// Smallest and largest arc length of a step.
    pub limits: [f64; 2],
    /// Corrections for which a slope `dR/dp` is held.
    pub held: usize,
}

/// A point of a curve.
#[derive(Debug, Clone)]
pub(super) struct CurvePoint {
    /// Leg forces.
    pub u: Vec<f64>,
    pub parameter: f64,
    /// Direction in which the curve goes on.
    tangent: Vec<f64>,
    /// Sign of the determinant of `dR/dF`, which changes at turning points.
    pub sign: f64,
}

/// What came of a step.
pub(super) enum Advance {
    /// The next point was reached from `from` with so many corrections.
    Reached { from: CurvePoint, corrections: usize },
    /// The corrections did not converge; the next step is shorter.
    Shortened,
    /// The same, and the next step would be too short.
    Stuck,
}

/// A curve that is being followed.
pub(super) struct Continuation<'a, C> {
    curve: &'a C,
    control: StepControl,
    step: f64,
    pub point: CurvePoint,
}

impl<'a, C: Curve> Continuation<'a, C> {
    /// From forces `u` at a parameter, which first moves in the direction of `sign`, by a first step of arc length `step`; `None` where the
    /// curve has no tangent.
    pub(super) fn new(
        curve: &'a C,
        control: StepControl,
        u: Vec<f64>,
        [parameter, sign, step]: [f64; 3],
    ) -> Option<Self> {
        let mut ahead = vec![0.0; u.len()];
        ahead.push(sign);
        Some(Self { curve, control, step, point: oriented(curve, u, parameter, &ahead)? })
    }

    /// Goes on by a step; the next one is longer where few corrections were needed, and shorter where many.
    pub(super) fn advance(&mut self) -> Advance {
        let Some((next, corrections)) = self.corrected() else {
            self.step *= 0.3;
            return if self.step < self.control.limits[0] { Advance::Stuck } else { Advance::Shortened };
        };
        let factor = match corrections {
            ..=3 => 1.4,
            4..=5 => 1.0,
            _ => 0.6,
        };
        self.step = (factor * self.step).min(self.control.limits[1]);
        Advance::Reached { from: std::mem::replace(&mut self.point, next), corrections }
    }

    /// The point that a step predicts, corrected, with the number of corrections; `None` if they do not converge.
    fn corrected(&self) -> Option<(CurvePoint, usize)> {
        let CurvePoint { u: start, parameter: first, tangent, .. } = &self.point;
        let (count, weights) = (start.len(), self.curve.weights(start));
        let mut u: Vec<f64> = start.iter().zip(tangent).map(|(x, t)| x + self.step * t).collect();
        let mut parameter = first + self.step * tangent[count];
        let mut slope = None;
        for corrections in 0..CORRECTIONS {
            let change = self.curve.at(parameter, |balance, level| {
                let state = balance.state(&u, level);
                if relative(&state.residual, &u) <= self.control.tolerance {
                    return Some(None);
                }
                if corrections.is_multiple_of(self.control.held) {
                    slope = self.curve.slope(balance, &state, &u, parameter);
                }
                let lu = bordered(&balance.jacobian(&state.evaluations), slope.as_ref()?, tangent, weights)?;
                let along: f64 = u.iter().zip(start).zip(tangent).map(|((x, o), t)| (x - o) * t * weights[0]).sum();
                let mut change = state.residual;
                change.push(along + (parameter - first) * tangent[count] * weights[1] - self.step);
                lu.solve(&mut change);
                Some(Some(change))
            })?;
            let Some(change) = change else {
                return Some((oriented(self.curve, u, parameter, tangent)?, corrections));
            };
            u.iter_mut().zip(&change).for_each(|(x, c)| *x -= c);
            parameter -= change[count];
        }
        None
    }
}

/// The point with its tangent in the direction of `previous`.
fn oriented<C: Curve>(curve: &C, u: Vec<f64>, parameter: f64, previous: &[f64]) -> Option<CurvePoint> {
    let (count, [by_force, by_parameter]) = (u.len(), curve.weights(&u));
    let lu = curve.at(parameter, |balance, level| {
        let state = balance.state(&u, level);
        let slope = curve.slope(balance, &state, &u, parameter)?;
        bordered(&balance.jacobian(&state.evaluations), &slope, previous, [by_force, by_parameter])
    })?;
    let mut tangent = vec![0.0; count + 1];
    tangent[count] = 1.0;
    lu.solve(&mut tangent);
    // By Cramer's rule the last entry is the determinant of dR/dF over that of the bordered matrix.
    let sign = lu.sign() * tangent[count].signum();
    let square = tangent[..count].iter().map(|t| t * t * by_force).sum::<f64>() + tangent[count].powi(2) * by_parameter;
    tangent.iter_mut().for_each(|t| *t /= square.sqrt());
    Some(CurvePoint { u, parameter, tangent, sign })
}

/// Factors of `[J, dR/dp; w_F t_F, w_p t_p]`.
fn bordered(jacobian: &[f64], slope: &[f64], tangent: &[f64], weights: [f64; 2]) -> Option<Lu> {
    let n = slope.len();
    let mut matrix = Vec::with_capacity((n + 1) * (n + 1));
    for (row, last) in jacobian.chunks_exact(n).zip(slope) {
        matrix.extend_from_slice(row);
        matrix.push(*last);
    }
    matrix.extend(tangent[..n].iter().map(|t| t * weights[0]));
    matrix.push(tangent[n] * weights[1]);
    Lu::new(n + 1, matrix)
}
