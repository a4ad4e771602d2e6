//! Two effects at once, or three: laws regressed at the sets of places that as many free forces explain best.

use super::search::{View, joined};
use super::short_list::{Breadth, hopeless, needed};
use super::singles::FITS;
use crate::diagnosis::candidates::start::UnfittedSet;
use crate::diagnosis::localisation::free_force::Placing;
use crate::diagnosis::residual::data::DiagnosisError;
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::effects::{Kind, Source};

/// Sets of places whose laws are looked at.
const PLACINGS: usize = 48;
/// Of these, sets of which laws of many parameters are looked at too.
const OF_ALL_LAWS: usize = 6;
/// Laws of each place that are looked at.
const LAWS: usize = 3;

impl ReferenceModel<'_> {
    /// Sets of two new effects at the pairs of places that explain most.
    pub(crate) fn pairs(&self) -> Result<Vec<FittedModel>, DiagnosisError> {
        let mut view = self.view(None)?;
        let placings = view.screen.pairs(PLACINGS);
        self.at_once(&mut view, &placings, |_| true)
    }

    /// Sets of three new effects at the triples of places that explain most. Springs, masses and errors of channels are not among
    /// them: what takes three of those is a model to be corrected.
    pub(super) fn triples(&self) -> Result<Vec<FittedModel>, DiagnosisError> {
        let mut view = self.view(None)?;
        let placings = view.screen.triples(PLACINGS);
        let dissipates =
            |source: &Source| matches!(source.effect.kind(), Kind::Relative(_)) && !source.effect.is_mass_or_spring();
        self.at_once(&mut view, &placings, dissipates)
    }

    /// One new effect at every place of a placing, of those that `may` be, fitted on the response.
    fn at_once(
        &self,
        view: &mut View,
        placings: &[Placing],
        may: impl Fn(&Source) -> bool,
    ) -> Result<Vec<FittedModel>, DiagnosisError> {
        let (first, others) = placings.split_at(placings.len().min(OF_ALL_LAWS));
        let mut laws = self.all_laws(view, first, &[], Breadth::All)?;
        laws.extend(self.all_laws(view, others, &[], Breadth::Simple)?);
        let mut unfitted = Vec::new();
        for (placing, mut options) in placings.iter().zip(laws) {
            for option in &mut options {
                option.retain(|set| may(&set.effects[0]));
                option.truncate(LAWS);
            }
            unfitted.extend(combined(placing, &options));
        }
        unfitted.sort_by(|a, b| a.score.total_cmp(&b.score));
        unfitted = needed(unfitted);
        unfitted.truncate(FITS);
        let bound = hopeless(unfitted.first().map_or(f64::INFINITY, |best| best.score));
        unfitted.retain(|d| d.score < bound);
        Ok(self.ranked(self.fit_all(&unfitted)?))
    }
}

/// Every choice of one law of each place.
fn combined(placing: &Placing, options: &[Vec<UnfittedSet>]) -> Vec<UnfittedSet> {
    let Some((first, others)) = options.split_first() else { return Vec::new() };
    let begun = first.iter().map(|set| UnfittedSet { score: placing.chi_square + set.score, ..set.clone() }).collect();
    others.iter().fold(begun, |sets: Vec<UnfittedSet>, laws| {
        let with = |set: &UnfittedSet, law: &UnfittedSet| UnfittedSet {
            effects: joined(&set.effects, &law.effects),
            score: set.score + law.score,
            fields: set.fields.clone(),
        };
        sets.iter().flat_map(|set| laws.iter().map(move |law| with(set, law))).collect()
    })
}
