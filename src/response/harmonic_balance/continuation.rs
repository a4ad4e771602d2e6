//! Response over frequency through turning points, by arc-length continuation.
//!
//! ```text
//! R(F, w) = 0,      t_F (F - F_0) / F_ref^2 + t_w (w - w_0) / W^2 = s
//!
//! F_ref: a few times the size of F,  W: width of the range
//! ```
//!
//! Each point is predicted along the tangent `t` and corrected by Newton's method on both equations together, so that `w`
//! may turn back. The determinant of `dR/dF` changes its sign at turning points, and with it the stability; the first
//! point is judged by Floquet's multipliers.

use super::arc::bordered;
use super::dense::Lu;
use super::error::ResponseError;
use super::excitation::Excitation;
use super::model::{ForwardModel, RunModel};
use super::newton::relative;
use super::outcome::Response;
use super::prepared::Prepared;
use super::settings::Settings;
use super::solve::assemble;
use super::stability::is_stable;
use crate::control::Control;
use std::f64::consts::TAU;

/// How a sweep goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SweepSettings {
    /// Harmonics, everywhere the same.
    pub harmonics: usize,
    /// Relative residual of the force balance.
    pub tolerance: f64,
    /// Largest step in frequency, as a share of the range.
    pub largest_step: f64,
    /// Most points.
    pub most_points: usize,
}

impl Default for SweepSettings {
    fn default() -> Self {
        Self { harmonics: 7, tolerance: 1e-9, largest_step: 0.01, most_points: 5000 }
    }
}

/// Weight of a relative change of the leg forces beside one of the frequency by the whole range: forces may change by a
/// larger share in a step, since their size changes over decades along a curve.
const FORCE_WEIGHT: f64 = 0.04;

/// One point of the response curve.
#[derive(Debug, Clone)]
pub struct SweepPoint {
    /// Periodic response there.
    pub response: Response,
    /// Whether a small disturbance dies out.
    pub stable: bool,
}

/// Why a sweep ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SweepEnd {
    /// The end of the range was reached.
    Reached,
    /// The curve came back to where it had begun.
    Returned,
    /// Steps became too small.
    Stuck,
    /// The most points allowed.
    Exhausted,
}

/// Points in order along the curve.
#[derive(Debug, Clone)]
pub struct Sweep {
    /// The points.
    pub points: Vec<SweepPoint>,
    /// Why it ended.
    pub end: SweepEnd,
}

/// Where the curve is: leg forces and frequency, and the direction in which it goes on.
struct Place {
    u: Vec<f64>,
    omega: f64,
    tangent: Vec<f64>,
    /// Sign of the determinant of `dR/dF`.
    sign: f64,
}

struct Tracer<'a> {
    model: &'a ForwardModel,
    excitation: &'a Excitation,
    settings: &'a SweepSettings,
    width: f64,
}

/// Follows the response of `model` from `range[0]` to `range[1]` (rad/s, either order) through all turning points.
pub fn sweep(
    model: &ForwardModel,
    excitation: &Excitation,
    range: [f64; 2],
    settings: &SweepSettings,
    control: &Control,
) -> Result<Sweep, ResponseError> {
    let [from, to] = range;
    if let Some(bad) = range.into_iter().find(|w| !(*w > 0.0 && w.is_finite())) {
        return Err(ResponseError::BadFrequency { frequency_hz: bad / TAU });
    }
    let tracer = Tracer { model, excitation, settings, width: (to - from).abs().max(1e-9 * from) };
    let fixed = Settings { tolerance: settings.tolerance, estimate: false, ..Settings::fixed(settings.harmonics) };
    let first = model.respond(&excitation.at(from), &fixed, None, control)?;
    if first.legs == 0 {
        return tracer.linear(range, control);
    }
    let start = tracer.prepared(from)?.adapt(&tracer.run(from), &first);
    let mut place = tracer.begin(start, from, (to - from).signum())?;
    let anchor = tracer.point(&place, true)?;
    let stable = is_stable(&model.at(from), model.sources(), &excitation.at(from), &anchor.response);
    let upright = if stable { place.sign } else { -place.sign };
    let mut points = vec![SweepPoint { stable, ..anchor }];
    let mut step = 0.1 * settings.largest_step;
    while points.len() < settings.most_points {
        control.check()?;
        match tracer.advance(&place, step) {
            Some((next, iterations)) => {
                if (next.omega - from) * (to - from) < 0.0 {
                    return Ok(Sweep { points, end: SweepEnd::Returned });
                }
                place = next;
                points.push(tracer.point(&place, place.sign == upright)?);
                if (place.omega - to) * (to - from) >= 0.0 {
                    return Ok(Sweep { points, end: SweepEnd::Reached });
                }
                control.report((place.omega - from) / (to - from));
                step *= if iterations <= 3 {
                    1.4
                } else if iterations > 5 {
                    0.6
                } else {
                    1.0
                };
            }
            None => step *= 0.3,
        }
        step = step.min(2.0 * settings.largest_step);
        if step < 1e-9 {
            return Ok(Sweep { points, end: SweepEnd::Stuck });
        }
    }
    Ok(Sweep { points, end: SweepEnd::Exhausted })
}

impl Tracer<'_> {
    fn run(&self, omega: f64) -> RunModel {
        self.model.plain_at(omega)
    }

    fn prepared(&self, omega: f64) -> Result<Prepared, ResponseError> {
        Prepared::new(&self.run(omega), self.model.sources(), &self.excitation.at(omega), self.settings.harmonics)
    }

    /// A linear model has one response everywhere.
    fn linear(&self, [from, to]: [f64; 2], control: &Control) -> Result<Sweep, ResponseError> {
        let count = (1.0 / self.settings.largest_step).ceil().max(1.0) as usize;
        let mut points = Vec::with_capacity(count + 1);
        for k in 0..=count.min(self.settings.most_points) {
            let omega = from + (to - from) * k as f64 / count as f64;
            let response = self.model.respond(&self.excitation.at(omega), &Settings::default(), None, control)?;
            points.push(SweepPoint { response, stable: true });
        }
        Ok(Sweep { points, end: SweepEnd::Reached })
    }

    fn point(&self, place: &Place, stable: bool) -> Result<SweepPoint, ResponseError> {
        let prepared = self.prepared(place.omega)?;
        let excitation = self.excitation.at(place.omega);
        let response = assemble(&self.run(place.omega), &prepared, &excitation, place.u.clone());
        Ok(SweepPoint { response, stable })
    }

    /// Weights of the arc length: of a leg force and of the frequency.
    fn weights(&self, u: &[f64]) -> (f64, f64) {
        let size = u.iter().map(|x| x * x).sum::<f64>().max(f64::MIN_POSITIVE);
        (FORCE_WEIGHT / size, 1.0 / (self.width * self.width))
    }

    /// Derivative of the residual by the frequency (rad/s).
    fn by_omega(&self, u: &[f64], omega: f64, residual: &[f64]) -> Option<Vec<f64>> {
        let step = 1e-7 * omega;
        let ahead = self.prepared(omega + step).ok()?.balance().residual(u, 1.0);
        Some(ahead.iter().zip(residual).map(|(a, r)| (a - r) / step).collect())
    }

    /// The first place, going in the direction of `sign` in frequency.
    fn begin(&self, u: Vec<f64>, omega: f64, sign: f64) -> Result<Place, ResponseError> {
        let mut tangent = vec![0.0; u.len() + 1];
        tangent[u.len()] = sign;
        let failed = ResponseError::BadFrequency { frequency_hz: omega / TAU };
        self.oriented(u, omega, &tangent).ok_or(failed)
    }

    /// A place with its tangent, in the direction of `previous`.
    fn oriented(&self, u: Vec<f64>, omega: f64, previous: &[f64]) -> Option<Place> {
        let prepared = self.prepared(omega).ok()?;
        let balance = prepared.balance();
        let state = balance.state(&u, 1.0);
        let jacobian = balance.jacobian(&state.evaluations);
        let column = self.by_omega(&u, omega, &state.residual)?;
        let sign = Lu::new(u.len(), jacobian.clone())?.sign();
        let (wu, ww) = self.weights(&u);
        let mut tangent = vec![0.0; u.len() + 1];
        tangent[u.len()] = 1.0;
        bordered(&jacobian, &column, previous, wu, ww)?.solve(&mut tangent);
        let norm = tangent[..u.len()].iter().map(|t| t * t * wu).sum::<f64>() + tangent[u.len()].powi(2) * ww;
        let scale = 1.0 / norm.sqrt();
        tangent.iter_mut().for_each(|t| *t *= scale);
        Some(Place { u, omega, tangent, sign })
    }

    /// A step of arc length `step` with the number of corrections; `None` if they do not converge.
    fn advance(&self, place: &Place, step: f64) -> Option<(Place, usize)> {
        let count = place.u.len();
        let (wu, ww) = self.weights(&place.u);
        let mut u: Vec<f64> = place.u.iter().zip(&place.tangent).map(|(x, t)| x + step * t).collect();
        let mut omega = place.omega + step * place.tangent[count];
        let mut column: Option<Vec<f64>> = None;
        for iteration in 0..10 {
            if !(omega > 0.0 && omega.is_finite()) {
                return None;
            }
            let prepared = self.prepared(omega).ok()?;
            let balance = prepared.balance();
            let state = balance.state(&u, 1.0);
            if relative(&state.residual, &u) <= self.settings.tolerance {
                return Some((self.oriented(u, omega, &place.tangent)?, iteration));
            }
            if column.is_none() || iteration == 3 {
                column = Some(self.by_omega(&u, omega, &state.residual)?);
            }
            let lu = bordered(&balance.jacobian(&state.evaluations), column.as_ref()?, &place.tangent, wu, ww)?;
            let along: f64 = u.iter().zip(&place.u).zip(&place.tangent).map(|((x, o), t)| (x - o) * t * wu).sum();
            let mut change = state.residual;
            change.push(along + (omega - place.omega) * place.tangent[count] * ww - step);
            lu.solve(&mut change);
            u.iter_mut().zip(&change).for_each(|(x, c)| *x -= c);
            omega -= change[count];
        }
        None
    }
}

/// All periodic responses at the excitation's frequency that lie on the curve through `range` (rad/s), each with its
/// stability by Floquet's multipliers, in order along the curve. For callers of the library, and a second route to those of
/// [`RunModel::branches`], which follows the level of the force.
pub fn branches(
    model: &ForwardModel,
    excitation: &Excitation,
    range: [f64; 2],
    settings: &SweepSettings,
    control: &Control,
) -> Result<Vec<SweepPoint>, ResponseError> {
    let curve = sweep(model, excitation, range, settings, control)?;
    let run = model.at(excitation.omega);
    let fixed = Settings { tolerance: settings.tolerance, estimate: false, ..Settings::fixed(settings.harmonics) };
    let mut found: Vec<SweepPoint> = Vec::new();
    for pair in curve.points.windows(2) {
        let [a, b] = [&pair[0].response, &pair[1].response];
        let (before, after) = (a.omega - excitation.omega, b.omega - excitation.omega);
        if before * after > 0.0 || (before == 0.0 && !found.is_empty()) {
            continue;
        }
        let share = if before == after { 0.0 } else { before / (before - after) };
        let mut start = a.clone();
        start.unknowns.iter_mut().zip(&b.unknowns).for_each(|(x, y)| *x += share * (y - *x));
        let response = run.respond(model.sources(), excitation, &fixed, Some(&start), control)?;
        let stable = is_stable(&run, model.sources(), excitation, &response);
        found.push(SweepPoint { response, stable });
    }
    Ok(found)
}
