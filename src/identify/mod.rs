//! Which sources, how large, how certain: from runs to identified damping.
//!
//! Two equations are at hand, both linear in the coefficients at a given motion:
//! the energy equation `G c = e` (one row a run, [`crate::balance`]), and, where mass and stiffness are known and agree with
//! the data, the response equation (real and imaginary part of every sensor and harmonic, `response_form`), whose
//! least squares solution is the maximum likelihood estimate. [`identify`] searches the best sets of each size, decides
//! where to stop, and says why.

mod assembly;
pub mod change;
mod collinear;
pub(crate) mod error;
mod exchange;
mod finish;
mod found;
mod layouts;
mod measurements;
mod negligible;
mod observable;
pub(crate) mod outcome;
mod problem;
mod promising;
mod ratio_rows;
mod ratios;
mod response_form;
pub(crate) mod results;
mod search;
pub(crate) mod settings;
mod solve;
mod sparse_start;
mod state;
mod stopping;
mod system;
#[cfg(test)]
mod tests;
mod warnings;
mod window_columns;

pub use error::IdentifyError;
pub use measurements::Measurements;
pub use outcome::{Estimate, Form, Outcome, RankedAlternative, RunOutcome, SelectionStatus, SelectionStep};
pub use results::Results;
pub use settings::Settings;

use crate::balance::{Expansion, Weights};
use crate::control::Control;
use crate::effects::Source;
use crate::measurement::Run;
use crate::structure::Structure;
use found::Found;
use problem::Problem;
use search::{SizeRanking, search};
use state::IdentificationState;
use stopping::Pass;
use system::System;

/// Most passes of search and refit; each starts from the motion that the last accepted set gives.
const PASSES: usize = 5;
/// Steps from the start to a damping that balances the energy.
const START_STEPS: usize = 8;
/// Part of its standard deviation that a coefficient may still move by when the motion has settled.
const SETTLED: f64 = 1e-4;

/// Identifies the sources of `runs`: all that are enabled.
///
/// `sources` in state known act at their values; candidates and forced ones are the columns; the others are ignored.
///
/// ```
/// use dashpot::{control::Control, exchange::project::load, identify::identify};
///
/// let control = Control::unattended();
/// let project = load("sample-data/five-masses/project.toml".as_ref(), &control)?;
/// let found = identify(&project.structure, &project.sources, &project.runs, &project.settings, &control)?;
/// for estimate in found.sources.iter().filter(|estimate| estimate.coefficient > 0.0) {
///     let source = &project.sources[estimate.source];
///     println!("{} {:?}: {:.3} +- {:.3}", source.effect, source.place, estimate.coefficient, estimate.deviation);
/// }
/// assert!(found.sources.iter().any(|estimate| estimate.coefficient > 0.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`IdentifyError`]: what is missing and how to mend it; or cancelled.
pub fn identify(
    structure: &Structure,
    sources: &[Source],
    runs: &[Run],
    settings: &Settings,
    control: &Control,
) -> Result<Outcome, IdentifyError> {
    let measured = Measurements { runs, transient_runs: &[], ratios: &[] };
    identify_measured(structure, sources, measured, settings, control)
}

/// [`identify`] from steady runs, decays, transients and damping ratios together: all that are enabled, each row weighted by
/// the covariance of its noise.
///
/// # Errors
/// As [`identify`]; records whose windows give no energy equation; ratios that belong to no mode, or that stand beside laws whose damping
/// depends on the amplitude.
pub fn identify_measured(
    structure: &Structure,
    sources: &[Source],
    measured: Measurements<'_>,
    settings: &Settings,
    control: &Control,
) -> Result<Outcome, IdentifyError> {
    let mut problem = Problem::new(structure, sources, measured, settings, control)?;
    let mut first = IdentificationState::start(&problem)?;
    problem.drop_unobservable(&first)?;
    if first.coefficients.len() != problem.columns.len() {
        first = IdentificationState::start(&problem)?;
    }
    let start = balanced_start(&problem, first, control)?;
    control.report(0.1);
    let found = match response_start(&problem, &start, control)? {
        Some(state) => passes(&problem, state, Form::Response, control)?,
        None => energy_passes(&problem, start, control)?,
    };
    control.report(0.9);
    finish::outcome(&problem, &found)
}

/// A motion and coefficients (of all columns) that balance the energy, however they may be distributed.
fn balanced_start(
    problem: &Problem<'_>,
    first: IdentificationState,
    control: &Control,
) -> Result<IdentificationState, IdentifyError> {
    let mut state = first;
    if problem.expander.method() != Expansion::Dynamic {
        return Ok(state);
    }
    for step in 0..START_STEPS {
        control.check()?;
        let coefficients = solve::all_columns(&System::energy(problem, &state, Weights::Energy))?;
        if step > 1 && close(&coefficients, &state.coefficients, 1e-4) {
            break;
        }
        let model_error = if step < START_STEPS / 2 { 0.1 } else { 0.01 };
        state = state.moved_to(problem, coefficients, model_error)?;
    }
    Ok(state)
}

/// The state for the response form, if that form is wanted and even possible: with all columns at its disposal the model
/// must reach the data.
fn response_start(
    problem: &Problem<'_>,
    start: &IdentificationState,
    control: &Control,
) -> Result<Option<IdentificationState>, IdentifyError> {
    let wanted = matches!(problem.settings.weights, Weights::Auto | Weights::Noise);
    if problem.expander.method() != Expansion::Dynamic || !wanted || problem.columns.is_empty() {
        return Ok(None);
    }
    if problem.columns.len() > promising::MANY
        && let Some(state) = sparse_start::sparse_start(problem, start, control)?
    {
        return Ok(Some(state));
    }
    let mut state = start.in_motion(problem, start.coefficients.clone(), 0.0)?;
    let mut best: Option<(f64, IdentificationState)> = None;
    for step in 0..START_STEPS {
        control.check()?;
        let system = System::of(Form::Response, problem, &state);
        let mut coefficients = solve::all_columns(&system)?;
        if coefficients.iter().all(|&c| c == 0.0) {
            return Ok(None);
        }
        let chi_square = response_form::chi_square(problem, &system, &coefficients);
        if response_form::is_adequate(problem, &system, &coefficients, chi_square)
            && best.as_ref().is_none_or(|(least, _)| chi_square < *least)
        {
            best = Some((chi_square, state.clone()));
        }
        if close(&coefficients, &state.coefficients, 1e-3) {
            break;
        }
        // Whole steps may swing between two motions for ever.
        if step > 0 {
            coefficients.iter_mut().zip(&state.coefficients).for_each(|(new, old)| *new = 0.5 * (*new + old));
        }
        state = state.in_motion(problem, coefficients, 0.0)?;
    }
    best.map(|(_, state)| state.balanced(problem)).transpose()
}

fn energy_passes(problem: &Problem<'_>, start: IdentificationState, control: &Control) -> Result<Found, IdentifyError> {
    let start = if problem.expander.method() == Expansion::Dynamic {
        let model_error = start.adequate_model_error(problem)?;
        start.moved_to(problem, start.coefficients.clone(), model_error)?
    } else {
        start
    };
    passes(problem, start, Form::Energy, control)
}

/// Search, decide, refit at the accepted set; again until the set does not change.
fn passes(
    problem: &Problem<'_>,
    start: IdentificationState,
    form: Form,
    control: &Control,
) -> Result<Found, IdentifyError> {
    let mut state = start;
    let mut last: Option<Vec<usize>> = None;
    let mut best: Option<Found> = None;
    for number in 1..=PASSES {
        let system = System::of(form, problem, &state);
        let pass = Pass { problem, state: &state, system: &system, form };
        let rankings = ranked(&pass, control)?;
        let decision = pass.decide(&rankings);
        let set = rankings[decision.accepted].best().columns.clone();
        let settled = last.as_ref() == Some(&set);
        let coefficients = rankings[decision.accepted].best().coefficients.clone();
        state = refit(problem, &state, &set, &coefficients, form, control)?;
        let system = System::of(form, problem, &state);
        best = Some(Found { state: state.clone(), system, rankings, decision, form });
        control.report(0.1 + 0.8 * number as f64 / PASSES as f64);
        if settled {
            break;
        }
        last = Some(set);
    }
    let mut found = best.ok_or(IdentifyError::NoCandidates)?;
    // The history is told at the motion that was accepted.
    let pass = Pass { problem, state: &found.state, system: &found.system, form };
    found.rankings = ranked(&pass, control)?;
    found.decision = pass.decide(&found.rankings);
    Ok(found)
}

/// The best sets of each size, as far as they may decide.
fn ranked(pass: &Pass<'_, '_>, control: &Control) -> Result<Vec<SizeRanking>, IdentifyError> {
    let mut rankings = search(pass.problem, pass.system, &|rankings| pass.is_decided(rankings), control)?;
    negligible::lift_the_rule(pass.problem, pass.state, &mut rankings);
    Ok(rankings)
}

/// Solves for the coefficients of one set, moves to the motion that they give, and so on until nothing changes.
fn refit(
    problem: &Problem<'_>,
    state: &IdentificationState,
    set: &[usize],
    coefficients: &[f64],
    form: Form,
    control: &Control,
) -> Result<IdentificationState, IdentifyError> {
    let model_error = state.model_error;
    let mut state = state.moved_to(problem, solve::scattered(problem.columns.len(), set, coefficients), model_error)?;
    if problem.expander.method() != Expansion::Dynamic && !problem.weights_follow_coefficients() {
        return Ok(state);
    }
    for _ in 0..20 {
        control.check()?;
        let own: Vec<usize> = (0..set.len()).collect();
        let fit = solve::fit(&System::of_set(form, problem, &state, set), &own)?;
        let next = solve::scattered(problem.columns.len(), set, &fit.coefficients);
        let still = |k: usize| {
            let change = (next[set[k]] - state.coefficients[set[k]]).abs();
            let noise = if problem.is_noisy() { SETTLED * fit.deviations[k] } else { 0.0 };
            change <= (1e-11 * next[set[k]].abs()).max(noise)
        };
        let settled = own.iter().all(|&k| still(k));
        state = match form {
            Form::Response => state.in_motion(problem, next, model_error)?,
            Form::Energy => state.moved_to(problem, next, model_error)?,
        };
        if settled {
            break;
        }
    }
    if form == Form::Response { state.balanced(problem) } else { Ok(state) }
}

/// Whether two coefficient vectors differ by no more than `tolerance` relative to each coefficient.
fn close(a: &[f64], b: &[f64], tolerance: f64) -> bool {
    a.iter().zip(b).all(|(x, y)| (x - y).abs() <= tolerance * x.abs().max(y.abs()))
}
