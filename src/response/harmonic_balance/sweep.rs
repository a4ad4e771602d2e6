//! Response over frequency through turning points, by pseudo-arclength continuation ([`super::continuation`]).
//!
//! ```text
//! R(F, w) = 0,      weights of the arc length 0.04 / |F|^2 and 1 / W^2,      W: width of the range
//! ```
//!
//! The determinant of `dR/dF` changes its sign at turning points, and with it the stability; the first point is judged by Floquet's
//! multipliers.

use super::continuation::{Advance, Continuation, Curve, CurvePoint, StepControl};
use super::error::ResponseError;
use super::excitation::Excitation;
use super::model::{ForwardModel, RunModel};
use super::newton::{Balance, NewtonState};
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

/// The balances at all frequencies.
struct ByFrequency<'a> {
    model: &'a ForwardModel,
    excitation: &'a Excitation,
    settings: &'a SweepSettings,
    width: f64,
}

impl Curve for ByFrequency<'_> {
    fn at<T>(&self, omega: f64, work: impl FnOnce(&Balance<'_>, f64) -> Option<T>) -> Option<T> {
        if !(omega > 0.0 && omega.is_finite()) {
            return None;
        }
        work(&self.prepared(omega).ok()?.balance(), 1.0)
    }

    /// By a difference over a small step in frequency.
    fn slope(&self, _: &Balance<'_>, state: &NewtonState, u: &[f64], omega: f64) -> Option<Vec<f64>> {
        let step = 1e-7 * omega;
        let ahead = self.prepared(omega + step).ok()?.balance().residual(u, 1.0);
        Some(ahead.iter().zip(&state.residual).map(|(a, r)| (a - r) / step).collect())
    }

    fn weights(&self, u: &[f64]) -> [f64; 2] {
        let size = u.iter().map(|x| x * x).sum::<f64>().max(f64::MIN_POSITIVE);
        [FORCE_WEIGHT / size, 1.0 / (self.width * self.width)]
    }
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
    let curve = ByFrequency { model, excitation, settings, width: (to - from).abs().max(1e-9 * from) };
    let fixed = Settings { tolerance: settings.tolerance, estimate: false, ..Settings::fixed(settings.harmonics) };
    let first = model.respond(&excitation.at(from), &fixed, None, control)?;
    if first.legs == 0 {
        return curve.linear(range, control);
    }
    let start = curve.prepared(from)?.adapt(&curve.run(from), &first);
    // Slopes are differences, each of which prepares another balance.
    let limits = [1e-9, 2.0 * settings.largest_step];
    let steps = StepControl { tolerance: settings.tolerance, limits, held: 3 };
    let direction = (to - from).signum();
    let begun = Continuation::new(&curve, steps, start, [from, direction, 0.1 * settings.largest_step]);
    let mut path = begun.ok_or(ResponseError::BadFrequency { frequency_hz: from / TAU })?;
    let anchor = curve.point(&path.point, true)?;
    let stable = is_stable(&model.at(from), model.sources(), &excitation.at(from), &anchor.response);
    let upright = if stable { path.point.sign } else { -path.point.sign };
    let mut points = vec![SweepPoint { stable, ..anchor }];
    while points.len() < settings.most_points {
        control.check()?;
        match path.advance() {
            Advance::Reached { .. } => {}
            Advance::Shortened => continue,
            Advance::Stuck => return Ok(Sweep { points, end: SweepEnd::Stuck }),
        }
        let share = (path.point.parameter - from) / (to - from);
        if share < 0.0 {
            return Ok(Sweep { points, end: SweepEnd::Returned });
        }
        points.push(curve.point(&path.point, path.point.sign == upright)?);
        if share >= 1.0 {
            return Ok(Sweep { points, end: SweepEnd::Reached });
        }
        control.report(share);
    }
    Ok(Sweep { points, end: SweepEnd::Exhausted })
}

impl ByFrequency<'_> {
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

    fn point(&self, at: &CurvePoint, stable: bool) -> Result<SweepPoint, ResponseError> {
        let (prepared, excitation) = (self.prepared(at.parameter)?, self.excitation.at(at.parameter));
        let response = assemble(&self.run(at.parameter), &prepared, &excitation, at.u.clone());
        Ok(SweepPoint { response, stable })
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
