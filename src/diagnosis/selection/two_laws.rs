//! Two laws at the place of one that leaves more than noise, in its stead: each step of a search adds one law, and of two that act
//! together neither need be the best alone. What one law of a joint misses passes for stiffness that scatters from run to run.

use super::weighing::{Weighed, weighed};
use crate::diagnosis::candidates::start::UnfittedSet;
use crate::diagnosis::candidates::two_laws::TwoLaws;
use crate::diagnosis::localisation::location::Spot;
use crate::diagnosis::residual::data::{DiagnosisError, if_possible};
use crate::diagnosis::residual::prediction::SEARCH;
use crate::diagnosis::selection::fits::STEPS;
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::selection::reference_model::{ReferenceModel, scale_of};
use crate::diagnosis::selection::search_result::{DOUBTFUL, EVIDENCE};
use crate::diagnosis::updating::scales::Scales;
use crate::diagnosis::updating::serial_correlation::evidence_against_scatter;
use crate::effects::{Kind, Place, Source};
use crate::math::statistics::bayesian_information;
use std::sync::Arc;

/// Pairs of laws that are refined.
const FOLLOWED: usize = 4;
/// Evidence that two laws must bring by their regression on the free force, in units of what they leave, to be refined.
const REGRESSED: f64 = 50.0;
/// Scatter of the stiffness and of the response from run to run, relative, that tests of one structure have: a single law that agrees
/// with the data beside no more than this needs no other.
const USUAL_SHIFT: f64 = 1.5e-3;
const USUAL_RESPONSE: f64 = 0.01;

/// Scales beside which all runs are alike, and the model as far off as it may be: a tenth of the scatter that tests of one structure have,
/// and a share of the response as good models of joints leave (set on a measured bolted beam).
const ALIKE: Scales = Scales {
    model: Scales::GREATEST.model,
    known: Scales::GREATEST.known,
    shift: 1e-4,
    session: 1e-4,
    response: 0.03,
    ..Scales::SEARCH
};
/// Rounds in which laws and model are settled there.
const UPDATES: usize = 6;

impl<'a> ReferenceModel<'a> {
    /// Two laws at the place of the only effect of `best`, with the single laws behind them; `None` where none bring their evidence.
    pub(super) fn two_laws_for(&self, best: &Weighed<'a>) -> Result<Option<Weighed<'a>>, DiagnosisError> {
        let [source] = best.fits[0].effects.as_slice() else { return Ok(None) };
        if matches!(source.effect.kind(), Kind::Channel(_)) || self.control.is_late() || suffices(best) {
            return Ok(None);
        }
        let mut unfitted = self.regressed_pairs(source, REGRESSED)?;
        unfitted.truncate(FOLLOWED);
        if unfitted.is_empty() {
            return Ok(None);
        }
        let mut refined = self.refined(unfitted)?;
        let alike = self.control.map(refined.len(), |k| if_possible(with_runs_alike(&refined[k].0, &refined[k].1)));
        for alike in alike {
            refined.extend(alike?);
        }
        let Some(two) = weighed(refined, f64::INFINITY)? else { return Ok(None) };
        let effects = &two.fits[0].effects;
        let both = effects.len() > 1 && !effects.iter().any(|e| e.effect.is_mass_or_spring());
        let gains = gains(&two, best);
        Ok((both && 0.5 * (gains[0] + gains[1]) > EVIDENCE).then(|| beside(two, best, gains[0])))
    }

    /// Sets of two laws at the place of `source`, or at the one that explains most where that is the whole structure, regressed on the
    /// free force there beside this model, best first, that explain it by more than `evidence` better than the best law alone does, in
    /// units of what they leave beyond the noise.
    fn regressed_pairs(&self, source: &Source, evidence: f64) -> Result<Vec<UnfittedSet>, DiagnosisError> {
        let mut view = self.view(None)?;
        let at = match source.place {
            Place::Whole(_) => {
                let mut spots = view.screen.singles().into_iter().map(|placing| placing.spots[0]);
                spots.find(|&spot| matches!(view.screen.spots[spot], Spot::Leg(_)))
            }
            _ => view.screen.spots.iter().position(|spot| spot.place().is_same(&source.place)),
        };
        let Some(at) = at else { return Ok(Vec::new()) };
        self.need(&mut view, &[at])?;
        let (forces, fields) = self.free(&view, &[at]);
        let (data, fields) = (self.at_place(&view, at, &forces[0], &fields), Arc::new(fields));
        let count = data.count();
        let alone = data.all_fits(data.simple_fits()).into_iter();
        let alone = alone.map(|fit| bayesian_information(fit.misfit, fit.source.parameters.len(), count));
        let alone = alone.fold(f64::INFINITY, f64::min);
        let pairs = data.two_laws(|source| self.data.allows(source) && !source.effect.is_mass_or_spring());
        let scale = pairs.first().map_or(1.0, |best| best.misfit / count.max(1) as f64).max(1.0);
        let enough = |score: &f64| alone - score > evidence * scale;
        let set = |pair: TwoLaws| UnfittedSet {
            score: pair.score(count),
            effects: pair.sources.to_vec(),
            fields: fields.clone(),
        };
        Ok(pairs.into_iter().map(set).filter(|set| enough(&set.score)).collect())
    }
}

/// A candidate with its model settled anew where runs hardly differ but by a share of their response: what differs from run to run takes
/// over so much of what laws do that a descent beside it may have ended far from where all runs are explained alike.
fn with_runs_alike<'a>(
    reference: &ReferenceModel<'a>,
    fit: &FittedModel,
) -> Result<(ReferenceModel<'a>, FittedModel), DiagnosisError> {
    let updating = reference.linearisation.updating.without_force_gains_and_shifts().with_scales(ALIKE);
    let there = reference.updated_as(&updating, &fit.effects, &fit.starts, &SEARCH)?;
    let fit = there.estimator().fit(&fit.effects, STEPS, &SEARCH, &fit.starts)?;
    there.converged(fit, &SEARCH, UPDATES)
}

/// Evidence that two laws bring beyond a single one: beside what differs from run to run, so far as that is by chance, and with all runs
/// alike, where the response is off in proportion to itself, `2 n ln(error / error)` of `n` data.
fn gains(two: &Weighed, single: &Weighed) -> [f64; 2] {
    let count = two.reference.count();
    let by_chance = |of: &Weighed| evidence_against_scatter(&of.reference.linearisation.updating, of.reference.data);
    let follows = by_chance(single) - by_chance(two);
    let beside_scatter = (single.least - two.least) / scale_of(&two.fits, count) + follows;
    [beside_scatter, 2.0 * count as f64 * (single.fits[0].error / two.fits[0].error).ln()]
}

/// Whether the best single law agrees with the data, or leaves little of them, beside scatter that is usual: what little it leaves is
/// looked for as a further effect.
fn suffices(best: &Weighed) -> bool {
    let (fit, scales) = (&best.fits[0], best.reference.linearisation.updating.scales);
    let usual = scales.shift < USUAL_SHIFT && scales.response < USUAL_RESPONSE;
    usual && fit.chi_square < DOUBTFUL * best.reference.count().saturating_sub(fit.parameters) as f64
}

/// Two laws with the single ones behind them. Where the evidence beside the scatter speaks for the single law, that with all runs alike
/// speaks for the two: neither is then the likelier.
fn beside<'a>(mut two: Weighed<'a>, single: &Weighed<'a>, gain: f64) -> Weighed<'a> {
    let share = 1.0 / (1.0 + (-0.5 * gain.max(0.0)).exp());
    two.probabilities.iter_mut().for_each(|p| *p *= share);
    two.probabilities.extend(single.probabilities.iter().map(|p| p * (1.0 - share)));
    two.fits.extend(single.fits.iter().cloned());
    two
}
