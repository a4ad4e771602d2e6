//! From a start to the response: Newton's method, the force raised in steps where that fails, arc length in the force
//! where it turns back; then more harmonics until the watched ones rest.

use super::arc::level_arc;
use super::condense::{Condensed, split};
use super::dense::Lu;
use super::error::{ModelError, ResponseError};
use super::excitation::Excitation;
use super::fourier::amplitude;
use super::iterate::Ending;
use super::model::{ForwardModel, MOST_HARMONICS, RunModel};
use super::newton::Balance;
use super::nonlinear_leg::NonlinearLeg;
use super::outcome::{Attempt, ConvergenceStep, Response, SourceForce, Status};
use super::prepared::Prepared;
use super::settings::Settings;
use crate::control::Control;
use crate::effects::{Manner, Source};
use faer::Mat;
use std::f64::consts::TAU;

/// Smallest step of the force, as a share of the excitation.
const LEAST_LEVEL_STEP: f64 = 1e-4;
/// Most force levels on the way up.
const MOST_LEVELS: usize = 200;
/// Steps of the force for laws that may fold, so that the branch reached is that of a force raised slowly.
const FOLDING_LEVELS: f64 = 6.0;

impl ForwardModel {
    /// Periodic response to `excitation`; `start` is a response nearby (other force, frequency or sources).
    pub fn respond(
        &self,
        excitation: &Excitation,
        settings: &Settings,
        start: Option<&Response>,
        control: &Control,
    ) -> Result<Response, ResponseError> {
        self.at(excitation.omega).respond(self.sources(), excitation, settings, start, control)
    }
}

impl RunModel {
    /// Periodic response with `sources` (in place of those of the model) to `excitation`, whose frequency is that of
    /// this run; `start` is a response nearby.
    pub fn respond(
        &self,
        sources: &[Source],
        excitation: &Excitation,
        settings: &Settings,
        start: Option<&Response>,
        control: &Control,
    ) -> Result<Response, ResponseError> {
        let at = self.ready(sources, excitation)?;
        respond(&at, sources, excitation, settings, start, control)
    }
}

/// See [`RunModel::respond`].
pub(super) fn respond(
    run: &RunModel,
    sources: &[Source],
    excitation: &Excitation,
    settings: &Settings,
    start: Option<&Response>,
    control: &Control,
) -> Result<Response, ResponseError> {
    if !(excitation.omega > 0.0 && excitation.omega.is_finite()) {
        return Err(ResponseError::BadFrequency { frequency_hz: excitation.omega / TAU });
    }
    let driven = excitation.order();
    let legs = split(sources, run.compliance(1)).0;
    if legs.is_empty() {
        // A linear model answers at the driven harmonics only.
        let prepared = Prepared::new(run, sources, excitation, driven.clamp(1, MOST_HARMONICS))?;
        let mut u = vec![0.0; prepared.condensed.size()];
        if !prepared.balance().solve(&mut u, 1.0, settings.tolerance).converged {
            return Err(ModelError::SingularSources { frequency_hz: excitation.omega / TAU }.into());
        }
        return Ok(Response { status: Status::Linear, ..assemble(run, &prepared, excitation, u) });
    }
    let first = settings.harmonics.max(driven).clamp(1, MOST_HARMONICS);
    let mut ladder = Ladder { run, sources, excitation, settings, control, history: Vec::new() };
    let sharp = legs.iter().any(|leg| leg.manner() == Manner::SetValued);
    let coarse = if sharp { ((first - 1) / 2).max(excitation.essential()).max(1) } else { first };
    let bottom = ladder.lowest(coarse, driven.clamp(1, coarse), start)?;
    let mut response = if bottom.status == Status::FellBack {
        ladder.estimated(bottom)?
    } else if coarse < first {
        ladder.climb(bottom, first, sharp)?
    } else {
        ladder.estimated(bottom)?
    };
    while response.status != Status::FellBack && !rests(&response, settings) {
        let finer = (2 * response.order() + 1).min(MOST_HARMONICS);
        if finer > settings.most_harmonics || finer == response.order() {
            let fixed = settings.most_harmonics <= settings.harmonics;
            response.status = if fixed { Status::Converged } else { Status::HarmonicsExhausted };
            break;
        }
        response = ladder.climb(response, finer, sharp)?;
    }
    response.history = ladder.history;
    Ok(response)
}

/// Solutions of one run with growing numbers of harmonics.
struct Ladder<'a> {
    run: &'a RunModel,
    sources: &'a [Source],
    excitation: &'a Excitation,
    settings: &'a Settings,
    control: &'a Control,
    history: Vec<ConvergenceStep>,
}

impl Ladder<'_> {
    /// The balance at one number of harmonics, as it is.
    fn solve(&mut self, order: usize, start: Option<&Response>) -> Result<Response, ResponseError> {
        self.control.check()?;
        let prepared = Prepared::new(self.run, self.sources, self.excitation, order)?;
        at_order(self.run, &prepared, self.excitation, self.settings, start, self.control, &mut self.history)
    }

    /// The balance at `order` harmonics, or at the most for which one is found by halving them down to `least`.
    fn lowest(&mut self, order: usize, least: usize, start: Option<&Response>) -> Result<Response, ResponseError> {
        match self.solve(order, start) {
            Err(ResponseError::NotConverged { .. }) if order > least => {
                let fewer = ((order - 1) / 2).max(least);
                let below = self.lowest(fewer, least, start)?;
                match self.solve(order, Some(&below)) {
                    Err(ResponseError::NotConverged { .. }) => Ok(Response { status: Status::FellBack, ..below }),
                    other => other,
                }
            }
            other => other,
        }
    }

    /// From a solution to one with more harmonics; stays, and says so, where that does not converge.
    fn climb(&mut self, below: Response, order: usize, sharp: bool) -> Result<Response, ResponseError> {
        match self.solve(order, Some(&below)) {
            Ok(fine) if sharp => Ok(extrapolated(&below, fine)),
            Ok(fine) => {
                let by_dof = change(&below, &fine, fine.order(), 0.5);
                Ok(fine.with_truncation(by_dof))
            }
            Err(ResponseError::NotConverged { .. }) => {
                Ok(Response { status: Status::FellBack, ..self.estimated(below)? })
            }
            Err(other) => Err(other),
        }
    }

    /// The solution with its truncation error, by one Newton step with twice the harmonics.
    fn estimated(&self, response: Response) -> Result<Response, ResponseError> {
        if !self.settings.estimate {
            return Ok(response);
        }
        let order = (2 * response.order() + 1).min(MOST_HARMONICS);
        let prepared = Prepared::new(self.run, self.sources, self.excitation, order)?;
        let mut u = prepared.adapt(self.run, &response);
        let balance = prepared.balance();
        let state = balance.state(&u, 1.0);
        let mut step = state.residual.clone();
        if let Some(lu) = Lu::new(u.len(), balance.jacobian(&state.evaluations)) {
            lu.solve(&mut step);
            u.iter_mut().zip(&step).for_each(|(x, s)| *x -= s);
        }
        let finer = assemble(self.run, &prepared, self.excitation, u);
        let by_dof = change(&response, &finer, response.order(), 1.0);
        Ok(response.with_truncation(by_dof))
    }
}

/// Whether the watched harmonics rest within the tolerance.
fn rests(response: &Response, settings: &Settings) -> bool {
    let all = (0..response.order()).flat_map(|h| response.harmonics.col_as_slice(h));
    let largest = all.fold(0.0_f64, |m, x| m.max(x.norm_sqr())).sqrt();
    response.truncation.iter().take(settings.watched).all(|&t| t <= settings.truncation * largest)
}

/// `share` of the change of each harmonic of every DOF.
fn change(a: &Response, b: &Response, order: usize, share: f64) -> Mat<f64> {
    Mat::from_fn(b.mean.len(), order, |i, h| share * (b.amplitude(i, h + 1) - a.amplitude(i, h + 1)).norm_sqr().sqrt())
}

/// Weight of the correction `fine - coarse` that takes the error, proportional to `1 / (H + 1/2)` for jumps, away.
pub(crate) fn richardson(coarse: usize, fine: usize) -> f64 {
    (coarse as f64 + 0.5) / (fine - coarse) as f64
}

/// Limit of many harmonics for laws with jumps, whose error falls as `1 / (H + 1/2)` and so is known from two solutions.
/// Harmonics that the coarse one has not are left.
fn extrapolated(coarse: &Response, fine: Response) -> Response {
    let raw = |response: &Response| response.raw.clone().unwrap_or_else(|| response.harmonics.clone());
    let (below, above) = (raw(coarse), fine.harmonics.clone());
    let weight = richardson(coarse.order(), fine.order());
    let mut limit =
        Response { raw: Some(above.clone()), coarse: Some((coarse.order(), coarse.unknowns.clone())), ..fine };
    let mut corrections = Mat::zeros(above.nrows(), limit.order());
    for h in 0..below.ncols() {
        for i in 0..above.nrows() {
            let correction = (above[(i, h)] - below[(i, h)]) * weight;
            limit.harmonics[(i, h)] += correction;
            corrections[(i, h)] = correction.norm();
        }
    }
    // A second extrapolation shows what the first has left; one alone leaves a fifth
    // of itself at most where it is largest (see the tests), but that of a single DOF may be small by chance.
    if coarse.raw.is_some() {
        let by_dof = change(coarse, &limit, limit.order(), 0.5);
        return limit.with_truncation(by_dof);
    }
    let mut first = limit.with_truncation(corrections);
    first.truncation.iter_mut().for_each(|t| *t *= 0.2);
    first
}

/// The solution at one number of harmonics.
fn at_order(
    run: &RunModel,
    prepared: &Prepared,
    excitation: &Excitation,
    settings: &Settings,
    start: Option<&Response>,
    control: &Control,
    history: &mut Vec<ConvergenceStep>,
) -> Result<Response, ResponseError> {
    let balance = prepared.balance();
    let harmonics = prepared.condensed.harmonics;
    let mut record = |attempt: Attempt, ending: Ending| {
        let Ending { converged, steps, residual } = ending;
        history.push(ConvergenceStep { harmonics, attempt, steps, residual, converged });
    };
    let folds = prepared.condensed.legs.iter().any(NonlinearLeg::folds);
    let mut u = start.map_or_else(|| vec![0.0; prepared.condensed.size()], |s| prepared.adapt(run, s));
    if start.is_some() || !folds {
        let ending = balance.solve(&mut u, 1.0, settings.tolerance);
        record(Attempt::Newton, ending);
        if ending.converged {
            return Ok(assemble(run, prepared, excitation, u));
        }
    }
    let (ending, mut reached) = raise(&balance, &mut u, settings, control)?;
    record(Attempt::Level, ending);
    if ending.converged {
        return Ok(assemble(run, prepared, excitation, u));
    }
    let (found, arc) = level_arc(&balance, settings, control)?;
    record(Attempt::Arc, arc.ending);
    reached = reached.max(arc.reached);
    if let Some(u) = found {
        return Ok(assemble(run, prepared, excitation, u));
    }
    Err(ResponseError::NotConverged {
        frequency_hz: excitation.omega / TAU,
        level: reached,
        harmonics,
        steps: history.iter().map(|s| s.steps).sum(),
        residual: arc.ending.residual.min(ending.residual),
    })
}

/// Raises the force from nothing in steps that adapt; gives the ending and the level reached.
fn raise(
    balance: &Balance,
    u: &mut Vec<f64>,
    settings: &Settings,
    control: &Control,
) -> Result<(Ending, f64), ResponseError> {
    u.fill(0.0);
    let (mut level, mut step) = (0.0, 1.0 / FOLDING_LEVELS);
    let mut before = (0.0, u.clone());
    let mut total = Ending { converged: false, steps: 0, residual: f64::INFINITY };
    for _ in 0..MOST_LEVELS {
        control.check()?;
        if settings.gives_up(total.steps, control) {
            break;
        }
        let next = f64::min(level + step, 1.0);
        let mut trial = predicted(u, level, &before, next);
        let ending = balance.solve(&mut trial, next, settings.tolerance);
        total.steps += ending.steps;
        if ending.converged {
            before = (level, std::mem::replace(u, trial));
            level = next;
            step *= 1.6;
            if level >= 1.0 {
                return Ok((Ending { converged: true, residual: ending.residual, ..total }, 1.0));
            }
        } else {
            step *= 0.4;
            total.residual = ending.residual;
            if step < LEAST_LEVEL_STEP {
                break;
            }
        }
    }
    Ok((total, level))
}

/// Secant prediction from the two last levels.
fn predicted(u: &[f64], level: f64, before: &(f64, Vec<f64>), next: f64) -> Vec<f64> {
    if level <= before.0 {
        return u.to_vec();
    }
    let share = (next - level) / (level - before.0);
    u.iter().zip(&before.1).map(|(now, old)| now + share * (now - old)).collect()
}

/// Displacements of all DOFs and forces of all sources from the nonlinear leg forces.
pub(crate) fn assemble(run: &RunModel, prepared: &Prepared, excitation: &Excitation, u: Vec<f64>) -> Response {
    let condensed = &prepared.condensed;
    let (order, width) = (condensed.harmonics, condensed.width());
    let x = prepared.displacements(run, excitation, &u);
    let mut forces = blank_forces(condensed);
    for h in 0..=order {
        let nonlinear = u[..condensed.leg_size()].chunks_exact(width).map(|c| amplitude(c, h));
        let values = nonlinear.chain(condensed.linear_forces(h, &u, 1.0));
        for (force, value) in forces.iter_mut().zip(values) {
            if h == 0 { force.mean = value.re } else { force.harmonics.push(value) }
        }
    }
    Response {
        omega: excitation.omega,
        mean: x[0].iter().map(|x| x.re).collect(),
        harmonics: Mat::from_fn(run.len(), order, |i, h| x[h + 1][i]),
        status: Status::Converged,
        truncation: vec![0.0; order],
        truncation_by_dof: Mat::zeros(run.len(), order),
        forces,
        history: Vec::new(),
        legs: condensed.legs.len(),
        unknowns: u,
        coarse: None,
        raw: None,
    }
}

fn blank_forces(condensed: &Condensed) -> Vec<SourceForce> {
    let blank =
        |source, leg| SourceForce { source, leg, mean: 0.0, harmonics: Vec::with_capacity(condensed.harmonics) };
    let nonlinear = condensed.legs.iter().map(|l| blank(l.source, l.leg));
    nonlinear.chain(condensed.linear_legs.iter().map(|l| blank(l.source, l.leg))).collect()
}
