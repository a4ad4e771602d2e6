//! Two effects at once: laws regressed at the pairs of places that two free forces explain best.

use super::search::joined;
use super::short_list::{Breadth, score_bound, without_falling_friction};
use super::singles::FITS;
use crate::diagnosis::candidates::start::UnfittedSet;
use crate::diagnosis::residual::data::DiagnosisError;
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::selection::reference_model::ReferenceModel;

/// Pairs of places whose laws are looked at.
const PAIRS: usize = 48;
/// Of these, pairs of which laws of many parameters are looked at too.
const PAIRS_OF_ALL_LAWS: usize = 6;

impl ReferenceModel<'_> {
    /// Sets of two new effects at the pairs of places that explain most.
    pub(crate) fn pairs(&self) -> Result<Vec<FittedModel>, DiagnosisError> {
        let mut view = self.view(None)?;
        let mut unfitted = Vec::new();
        let placings = view.screen.pairs(PAIRS);
        let (first, others) = placings.split_at(placings.len().min(PAIRS_OF_ALL_LAWS));
        let mut laws = self.all_laws(&mut view, first, &[], Breadth::All)?;
        laws.extend(self.all_laws(&mut view, others, &[], Breadth::Simple)?);
        for (placing, options) in placings.iter().zip(laws) {
            let [first, second] = &options[..] else { continue };
            for a in first.iter().take(3) {
                for b in second.iter().take(3) {
                    let score = placing.chi_square + a.score + b.score;
                    unfitted.push(UnfittedSet {
                        effects: joined(&a.effects, &b.effects),
                        score,
                        fields: a.fields.clone(),
                    });
                }
            }
        }
        unfitted.sort_by(|a, b| a.score.total_cmp(&b.score));
        unfitted = without_falling_friction(unfitted);
        unfitted.truncate(FITS);
        let bound = score_bound(unfitted.first().map_or(f64::INFINITY, |best| best.score));
        unfitted.retain(|d| d.score < bound);
        Ok(self.ranked(self.fit_all(&unfitted)?))
    }
}
