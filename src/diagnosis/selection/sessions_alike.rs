//! The model with all sessions alike in place of one whose stiffness differs between them, where the data hardly tell the two apart:
//! levels of a stepped sine are sessions as long as nothing else is said, and a law whose stiffness goes with the amplitude can be
//! exchanged for a stiffness of each level. What is told is told of the structure, with all sessions alike: of two explanations as
//! likely, that which needs no other stiffness for each level is the one to tell.

use crate::diagnosis::residual::data::DiagnosisError;
use crate::diagnosis::residual::prediction::{FINAL, SEARCH};
use crate::diagnosis::selection::fits::STEPS;
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::diagnosis::selection::search_result::cost;
use crate::diagnosis::updating::scales::Scales;

/// Scale of the stiffness from session to session, relative, beside which all are alike.
const ALIKE: f64 = 1e-5;
/// Evidence that tells a stiffness of each session from none: a hundred to one.
const TOLD_APART: f64 = 9.2;
/// Share of its error from which on a model is the worse for the sessions it left out.
const LOWER: f64 = 0.1;
/// Rounds in which model and effects are settled.
const UPDATES: usize = 6;

/// The model and the effects of `fit`, or both with all sessions alike where that is hardly less likely and leaves less of the data
/// when all runs are.
pub(super) fn with_sessions_alike(
    reference: ReferenceModel<'_>,
    fit: FittedModel,
) -> Result<(ReferenceModel<'_>, FittedModel), DiagnosisError> {
    if reference.data.sessions.is_empty() || reference.control.is_late() {
        return Ok((reference, fit));
    }
    let (there, alike) = settled(&reference, &fit)?;
    if cost(&there, Some(&alike)) > cost(&reference, Some(&fit)) + TOLD_APART {
        return Ok((reference, fit));
    }
    let error = |reference: &ReferenceModel, fit: &FittedModel| reference.error_of_structure(&fit.effects, &fit.starts);
    let lower = error(&there, &alike)? < (1.0 - LOWER) * error(&reference, &fit)?;
    Ok(if lower { (there, alike) } else { (reference, fit) })
}

/// Model and effects settled with all sessions alike, from all runs alike on.
fn settled<'a>(
    reference: &ReferenceModel<'a>,
    fit: &FittedModel,
) -> Result<(ReferenceModel<'a>, FittedModel), DiagnosisError> {
    let updating = &reference.linearisation.updating;
    // What differs between sessions is not to be told as what differs from run to run.
    let alike = |scales: Scales| Scales { session: ALIKE, shift: scales.shift.min(updating.scales.shift), ..scales };
    let begun = updating.without_force_gains_and_shifts().without_sessions().with_scales(alike(updating.scales));
    let there = reference.updated_as(&begun, &fit.effects, &fit.starts, &SEARCH)?;
    let begun = there.estimator().fit(&fit.effects, STEPS, &SEARCH, &fit.starts)?;
    let (there, begun) = there.converged(begun, &SEARCH, UPDATES)?;
    let (likely, again) = there.with_likely_scales(Some(&begun), &SEARCH)?;
    let scales = alike(likely.linearisation.updating.scales);
    likely.with_scales(scales).converged(again.unwrap_or(begun), &FINAL, UPDATES)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::{oscillator, source};
    use crate::common::runs::{displacements_run, with_noise};
    use crate::control::Control;
    use crate::diagnosis::Problem;
    use crate::diagnosis::residual::data::Data;
    use crate::diagnosis::residual::prediction::Predictor;
    use crate::diagnosis::result::Suggestion;
    use crate::diagnosis::updating::parameters::{Updating, UpdatingParameter};
    use crate::effects::{Effect, Source};
    use crate::measurement::Run;
    use crate::response::harmonic_balance::{Excitation, ForwardModel};
    use faer::c64;
    use std::sync::Arc;

    const STIFFNESS: f64 = 1e4;
    const CUBIC: f64 = 4e6;

    fn known() -> Source {
        source(Effect::Viscous, &[0], &[2.0])
    }

    fn cubic(stiffness: f64) -> Source {
        source(Effect::CubicStiffness, &[0], &[stiffness])
    }

    /// Two levels about the resonance of an oscillator with a cubic spring, whose stiffness is another by a share on the second, read
    /// with an error relative to the response.
    fn runs(shift: f64, noise: f64) -> Vec<Run> {
        let level_runs = |(force, stiffness): (f64, f64)| {
            let structure = oscillator(1.0, stiffness);
            let model = ForwardModel::new(&structure, &[known()]).unwrap();
            let run_at_frequency = |omega: f64| {
                let excitation = Excitation::sine(omega, 0, c64::new(force, 0.0));
                let (sources, control) = ([known(), cubic(CUBIC)], Control::unattended());
                let response = model.at(omega).respond(&sources, &excitation, &FINAL, None, &control).unwrap();
                displacements_run(omega, (0, force), &[response.amplitude(0, 1)], 0.0)
            };
            [97.0, 99.0, 100.0, 101.0, 102.0, 104.0].map(run_at_frequency)
        };
        let both = [(0.5, STIFFNESS), (2.0, STIFFNESS * (1.0 + shift))].map(level_runs);
        with_noise(&both.concat(), noise, 11)
    }

    /// The stiffness of both sessions, and the error with all runs alike, of what is told of `runs` where a search had taken a share of
    /// the cubic spring for a stiffness of each session.
    fn told(runs: &[Run], session: f64, share: f64) -> ([f64; 2], [f64; 2]) {
        let (stated, sources) = (oscillator(1.0, STIFFNESS), [known()]);
        let mut data = Data::new(&Problem { structure: &stated, sources: &sources, runs }).unwrap();
        data.sessions = (0..runs.len()).map(|r| usize::from(2 * r >= runs.len())).collect();
        let predictor = Arc::new(Predictor::new(&stated, sources.to_vec(), &data).unwrap());
        let (control, early) = (Control::unattended(), |_: &[Suggestion]| {});
        let model = ReferenceModel::new(predictor, &data, &control, &early).unwrap();
        let mut updating = Updating::all(&stated, &sources, &data);
        updating.scales.session = 2.0 * session;
        let own = |updating: &Updating, k: usize| {
            updating.parameters.iter().position(|p| *p == UpdatingParameter::Session(k)).map(|at| updating.values[at])
        };
        for k in 0..2 {
            let at = updating.parameters.iter().position(|p| *p == UpdatingParameter::Session(k)).unwrap();
            updating.values[at] = if k == 0 { -session } else { session };
        }
        let effects = [cubic(share * CUBIC)];
        let begun = model.updated_as(&updating, &effects, &Vec::new(), &SEARCH).unwrap();
        let fit = begun.estimator().fit(&effects, 0, &SEARCH, &Vec::new()).unwrap();
        let before = begun.error_of_structure(&fit.effects, &fit.starts).unwrap();
        let (there, fit) = with_sessions_alike(begun, fit).unwrap();
        let after = there.error_of_structure(&fit.effects, &fit.starts).unwrap();
        let updating = &there.linearisation.updating;
        ([own(updating, 0).unwrap(), own(updating, 1).unwrap()], [before, after])
    }

    #[test]
    fn a_stiffness_of_each_level_that_the_data_do_not_tell_is_left_to_the_law() {
        let (sessions, [before, after]) = told(&runs(0.0, 0.03), 3e-3, 0.8);
        assert!(sessions.iter().all(|s| s.abs() < 1e-4), "{sessions:?} {before} {after}");
        assert!(after < 0.07 && after < 0.9 * before, "{before} {after}");
    }

    #[test]
    fn a_level_that_was_re_seated_keeps_its_stiffness() {
        let (sessions, _) = told(&runs(0.02, 0.001), 0.01, 1.0);
        assert!((sessions[1] - sessions[0] - 0.02).abs() < 2e-3, "{sessions:?}");
    }
}
