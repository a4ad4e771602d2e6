//! The search with updating parameters free beside effects: corrections alone, one change in place of many corrections, laws.

use crate::diagnosis::residual::data::DiagnosisError;
use crate::diagnosis::selection::backward_elimination::{pruned, without_addition, without_needless_effects};
use crate::diagnosis::selection::competing_model::{CHOSEN, CompetingModel, FURTHER, RAISED};
use crate::diagnosis::selection::conclusion::{self, Outcome, TOLERATED};
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::diagnosis::selection::search_result::{DOUBTFUL, MOST_EFFECTS, SearchResult, agrees, explains_by_scatter};
use crate::diagnosis::selection::unreliable::Unreliable;
use crate::diagnosis::selection::weighing::weighed;
use crate::diagnosis::updating::detuning::is_likely;

/// Evidence that a single change is to bring as it is estimated, to be refined.
const CHANGE: f64 = 4.0;

/// The search with the updating parameters free: at each stage the candidates seen from the model as it was updated last,
/// then the model updated beside the best of them, and the candidates again.
pub(super) fn beside_updating(
    reference: ReferenceModel<'_>,
    before: f64,
) -> Result<Result<Outcome<'_>, Unreliable>, DiagnosisError> {
    let bare = reference.bare()?;
    match first_candidates(&reference, before, &bare)? {
        First::Fits(here, fits, corrected) => selected(&reference, &bare, before, here, fits, corrected).map(Ok),
        First::None(likely) => {
            let agrees = agrees(&likely, likely.misfit() * likely.count() as f64, 0);
            let found = SearchResult { agrees, ..SearchResult::beside(&bare, before) };
            Ok(Ok(Outcome { reference: likely, found }))
        }
        First::Unreliable(fault) => Ok(Err(fault)),
    }
}

/// The search with the updating parameters free from the candidates `first` on, beside corrections, which leave what `bare` does.
pub(super) fn selected<'a>(
    reference: &ReferenceModel<'a>,
    bare: &ReferenceModel<'a>,
    before: f64,
    mut here: ReferenceModel<'a>,
    first: Vec<(ReferenceModel<'a>, FittedModel)>,
    corrected: Option<(ReferenceModel<'a>, f64)>,
) -> Result<Outcome<'a>, DiagnosisError> {
    let stated = reference.estimator().error(&reference.predictions, &[]);
    let mut found = SearchResult::beside(bare, before);
    let (mut first, mut competing) = (Some(first), CompetingModel::new(bare, stated, corrected));
    while found.by_size.len() < MOST_EFFECTS && (found.by_size.is_empty() || !here.control.is_late()) {
        let from = found.by_size.last().map(|fitted_sets| fitted_sets.fits[0].clone());
        let fits = match (&from, first.take()) {
            (None, Some(fits)) => fits,
            (Some(from), _) => here.refined_beside(from, FURTHER)?,
            (None, None) => Vec::new(),
        };
        if found.by_size.is_empty() {
            let fits: Vec<FittedModel> = fits.iter().map(|(_, fit)| fit.clone()).collect();
            (here.early)(&conclusion::early(&here, &here.ranked(fits)));
        }
        if from.is_some() && here.control.is_late() {
            break;
        }
        if let Some(from) = &from
            && let Some(better) = without_addition(&fits, from, competing.least())?
        {
            found.by_size.pop();
            let (likely, least) = better.taken_into(&mut found);
            here = likely.with_scales(likely.linearisation.updating.scales);
            competing.replace(likely, least);
            continue;
        }
        let most = from.as_ref().map_or(f64::INFINITY, |from| RAISED * from.error);
        let Some(mut weighed) = weighed(fits, most)? else { break };
        if from.is_none()
            && let Some(two) = here.two_laws_for(&weighed)?
        {
            weighed = two;
        }
        if !competing.is_beaten_by(&weighed, from.as_ref())? {
            break;
        }
        if from.is_none() {
            let odds = competing.odds_of_change(&weighed);
            weighed.probabilities.iter_mut().for_each(|p| *p *= odds);
        }
        let (likely, least) = weighed.taken_into(&mut found);
        here = likely.clone();
        // Corrections beyond what models are wrong by may stand in for one effect more.
        let enough = found.agrees && is_likely(&likely);
        competing.replace(likely, least);
        if enough {
            break;
        }
    }
    let likely = competing.into_model()?;
    if found.by_size.is_empty() {
        found.agrees = agrees(&likely, likely.misfit() * likely.count() as f64, 0);
    }
    pruned(&likely, &mut found)?;
    let likely = without_needless_effects(likely, &mut found)?;
    Ok(Outcome { reference: likely, found })
}

/// What a search beside corrections begins with.
enum First<'a> {
    /// The model from which candidates were seen, these fitted, and corrections alone, where they were looked at, with their evidence.
    Fits(ReferenceModel<'a>, Vec<(ReferenceModel<'a>, FittedModel)>, Option<(ReferenceModel<'a>, f64)>),
    /// Nothing: corrections alone, as likely as they make the model.
    None(ReferenceModel<'a>),
    /// A run or channel that is not to be relied on.
    Unreliable(Unreliable),
}

/// The first candidates beside the corrections of `bare`. Where corrections alone agree with the data and no law would bring its
/// evidence beside them, none is refined but what one change explains instead of them.
fn first_candidates<'a>(
    reference: &ReferenceModel<'a>,
    before: f64,
    bare: &ReferenceModel<'a>,
) -> Result<First<'a>, DiagnosisError> {
    let changes = if bare.misfit() < TOLERATED { bare.single_changes(CHANGE)? } else { Vec::new() };
    let (mut expected, mut corrected) = (bare.misfit() >= DOUBTFUL || bare.is_law_expected(CHOSEN)?, None);
    if !expected {
        // What differs from run to run may be more than tests usually differ by.
        let likely = bare.likely(f64::INFINITY)?;
        expected = likely.0.is_scatter()?;
        if !expected && changes.is_empty() {
            if !likely.0.is_law_expected(CHOSEN)? {
                return Ok(First::None(likely.0));
            }
            expected = true;
        }
        corrected = Some(likely);
    }
    let (mut here, mut fits) = (bare.with_scales(bare.linearisation.updating.scales), Vec::new());
    if expected {
        let (localised, unfitted) = match reference.localised()? {
            Ok(localised) => localised,
            Err(fault) => return Ok(First::Unreliable(fault)),
        };
        fits = localised.refined(unfitted)?;
        let whole = reference.refined_whole(before, &fits)?;
        fits.extend(whole);
        here = localised;
    }
    let refine = |k: usize| bare.refined_change(&changes[k]);
    fits.extend(bare.control.map(changes.len(), refine).into_iter().collect::<Result<Vec<_>, _>>()?);
    Ok(First::Fits(here, fits, corrected))
}

impl ReferenceModel<'_> {
    /// Whether this model, corrected and without any effect, explains the runs by what is free from run to run alone.
    fn is_scatter(&self) -> Result<bool, DiagnosisError> {
        let errors = [self.error_of_structure(&[], &Vec::new())?, self.floor()];
        self.leaves(explains_by_scatter, errors, &[], &Vec::new())
    }

    pub(super) fn floor(&self) -> f64 {
        self.noise_floor(&[], &self.predictions)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use crate::common::models::three_masses;
    use crate::common::runs::{channel, run};
    use crate::control::Control;
    use crate::diagnosis::residual::prediction::FINAL as EXACT;
    use crate::diagnosis::result::Verdict;
    use crate::diagnosis::{Problem, diagnose};
    use crate::effects::{Effect, Place, Source};
    use crate::measurement::{Quantity, Run};
    use crate::response::harmonic_balance::{Excitation, ForwardModel};
    use crate::structure::Part;
    use faer::c64;

    /// Modes that are damped a little unlike the stated law, on a model that is 5 % too soft, lack no other law of the whole structure.
    #[test]
    fn modes_that_are_damped_unlike_the_stated_law_are_a_correction() {
        let stated = three_masses([1.0; 3]);
        let parts = [(Part::Stiffness, 1.05), (Part::ModeDamping(1), 1.4), (Part::ModeDamping(2), 0.8)];
        let truth = stated.with_factors(&parts);
        let sources = [Source::known(Effect::LossFactor, Place::Whole(None), &[0.01])];
        let model = ForwardModel::new(&truth, &sources).unwrap();
        let measured = |omega: f64| -> Run {
            let (zero, control) = (c64::new(0.0, 0.0), Control::unattended());
            let excitation = Excitation::sine(omega, 2, c64::new(1.0, 0.0));
            let response = model.at(omega).respond(&sources, &excitation, &EXACT, None, &control).unwrap();
            let motion = |dof: usize| {
                let x = response.amplitude(dof, 1);
                channel(Quantity::Displacement, dof, vec![x, zero, zero], 1e-3 * x.norm())
            };
            let force = channel(Quantity::Force, 2, vec![c64::new(1.0, 0.0), zero, zero], 1e-3);
            run(format!("{omega}"), omega, std::iter::once(force).chain((0..3).map(motion)).collect())
        };
        let omegas = truth.modes().unwrap().omega.clone();
        let runs: Vec<Run> =
            omegas.iter().flat_map(|w| [0.985, 0.995, 1.0, 1.005, 1.02].map(|r| measured(r * w))).collect();
        let problem = Problem { structure: &stated, sources: &sources, runs: &runs };
        let found = diagnose(&problem, &Control::unattended()).unwrap();
        assert_eq!(found.verdict, Verdict::Detuned, "{:?}", found.suggestions);
    }
}
