//! Where the response form begins among very many columns.
//!
//! Non-negative least squares on all columns spread each source over its neighbours. The motion that they give is not that of
//! the few true sources, and among thousands of columns the steps towards it do not end. Here each step keeps only a small set,
//! found by exchange: first of the energies, whose motion needs no model of the damping, then of the response at the motion
//! that the last set gives (Gauss-Newton with the set chosen anew at each step).

use super::error::IdentifyError;
use super::exchange::Exchange;
use super::outcome::Form;
use super::problem::Problem;
use super::state::IdentificationState;
use super::system::System;
use super::{response_form, solve};
use crate::balance::Weights;
use crate::control::Control;

/// Most steps.
const STEPS: usize = 8;
/// A step that leaves more than this part of what the best has left ends them.
const SETTLED: f64 = 0.999;
/// Sources of the set, where the settings do not ask for more.
const SOURCES: usize = 10;

/// The state whose set leaves least of the data, with the motion of that set; `None` where no step brings the model to them.
pub(super) fn sparse_start(
    problem: &Problem<'_>,
    start: &IdentificationState,
    control: &Control,
) -> Result<Option<IdentificationState>, IdentifyError> {
    let energies = System::energy(problem, start, Weights::Energy);
    let mut state = start.in_motion(problem, best_set(problem, &energies)?, 0.0)?;
    let mut best: Option<(f64, IdentificationState)> = None;
    for _ in 0..STEPS {
        control.check()?;
        let system = System::of(Form::Response, problem, &state);
        let coefficients = best_set(problem, &system)?;
        let chi_square = response_form::chi_square(problem, &system, &coefficients);
        let least = best.as_ref().map_or(f64::INFINITY, |(least, _)| *least);
        if chi_square < least && response_form::is_adequate(problem, &system, &coefficients, chi_square) {
            best = Some((chi_square, state.clone()));
        }
        if chi_square > SETTLED * least {
            break;
        }
        state = state.in_motion(problem, coefficients, 0.0)?;
    }
    best.map(|(_, state)| state.balanced(problem)).transpose()
}

/// Coefficients of all columns: those of a good set by exchange, zero elsewhere.
fn best_set(problem: &Problem<'_>, system: &System) -> Result<Vec<f64>, IdentifyError> {
    let most = problem.settings.max_sources.max(SOURCES).min(system.rows() / 2);
    let set = Exchange::new(system).sets(&problem.forced, most).pop().unwrap_or_default();
    if set.is_empty() {
        return Ok(vec![0.0; problem.columns.len()]);
    }
    Ok(solve::scattered(problem.columns.len(), &set, &solve::coefficients(system, &set)?))
}
