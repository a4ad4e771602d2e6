//! Sets with one effect more, of laws that were regressed on free forces.

use super::fits::FIRST_STEPS;
use super::search::joined;
use super::short_list::{Breadth, short_list};
use crate::diagnosis::candidates::start::UnfittedSet;
use crate::diagnosis::residual::data::DiagnosisError;
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::selection::reference_model::ReferenceModel;

/// Sets that are fitted on the response.
pub(super) const FITS: usize = 10;
/// Share of the squared residual of the model as it is up to which a regressed law may still agree with the data.
const WORTH: f64 = 0.05;

impl ReferenceModel<'_> {
    /// Sets of the effects of `from` and one more, fitted on the response, best first by evidence.
    pub(crate) fn singles(&self, from: Option<&FittedModel>) -> Result<Vec<FittedModel>, DiagnosisError> {
        let effects = from.map_or(&[][..], |fit| &fit.effects);
        let unfitted = self.unfitted(&mut self.view(from)?, effects, Breadth::All)?;
        self.fitted_singles(unfitted, from)
    }

    /// The laws regressed on the free forces of this model if the best of them leaves at most `least`, or a twentieth of the
    /// squared residual `before`: else free forces that explain everything (of one sensor they always do) are those of no law.
    pub(super) fn regressed_within(&self, least: f64, before: f64) -> Result<Option<Vec<UnfittedSet>>, DiagnosisError> {
        let unfitted = self.unfitted(&mut self.view(None)?, &[], Breadth::All)?;
        let left = unfitted.iter().map(|set| set.score).fold(f64::INFINITY, f64::min);
        Ok((left <= least.max(WORTH * before)).then_some(unfitted))
    }

    /// Sets of the effects of `from` and one of `unfitted`, fitted on the response, best first by evidence.
    pub(super) fn fitted_singles(
        &self,
        unfitted: Vec<UnfittedSet>,
        from: Option<&FittedModel>,
    ) -> Result<Vec<FittedModel>, DiagnosisError> {
        let effects = from.map_or(&[][..], |fit| &fit.effects);
        let mut unfitted = short_list(unfitted, FITS);
        unfitted.iter_mut().for_each(|d| d.effects = joined(effects, &d.effects));
        let mut begun = self.begun(&unfitted)?;
        begun.extend(self.whole(from, FIRST_STEPS)?);
        Ok(self.ranked(self.finished(begun)?))
    }
}
