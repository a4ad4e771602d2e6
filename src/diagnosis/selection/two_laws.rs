//! Two laws at the place of one that leaves more than noise, in its stead: each step of a search adds one law, and of two that act
//! together neither need be the best alone. What one law of a joint misses passes for stiffness that scatters from run to run.

use super::weighing::{Weighed, weighed};
use crate::diagnosis::residual::data::DiagnosisError;
use crate::diagnosis::selection::found::EVIDENCE;
use crate::diagnosis::selection::reference_model::{ReferenceModel, scale_of};
use crate::effects::Kind;

/// Pairs of laws that are followed.
const FOLLOWED: usize = 4;
/// Share of the evidence that two laws must bring in the end which they must bring by their regression.
const BROUGHT: f64 = 0.5;
/// Share of the error that the best law leaves with all runs alike which two may leave that are no likelier than it.
const LESS: f64 = 0.67;

impl<'a> ReferenceModel<'a> {
    /// Two laws at the place of the only effect of `best`, with the single laws behind them; `None` where none bring `evidence` beyond
    /// the best single law, nor, with about its evidence, leave much less than it once all runs are alike.
    pub(super) fn two_laws_for(
        &self,
        best: &Weighed<'a>,
        evidence: f64,
    ) -> Result<Option<Weighed<'a>>, DiagnosisError> {
        let [source] = best.fits[0].effects.as_slice() else { return Ok(None) };
        if !matches!(source.effect.kind(), Kind::Relative(_)) || self.control.is_late() {
            return Ok(None);
        }
        let mut unfitted = self.two_laws(source, BROUGHT * evidence)?;
        unfitted.truncate(FOLLOWED);
        if unfitted.is_empty() {
            return Ok(None);
        }
        let Some(two) = weighed(self.followed(unfitted)?)? else { return Ok(None) };
        let gain = (best.least - two.least) / scale_of(&two.fits, two.reference.count());
        let leaves_less = two.fits[0].error < LESS * best.fits[0].error && gain > -EVIDENCE;
        let better = two.fits[0].effects.len() > 1 && (gain > evidence || leaves_less);
        Ok(better.then(|| beside(two, best, gain)))
    }
}

/// Two laws with the single ones behind them. Where the evidence speaks for the single law, what both leave with all runs alike speaks
/// for the two: neither is then the likelier.
fn beside<'a>(mut two: Weighed<'a>, single: &Weighed<'a>, gain: f64) -> Weighed<'a> {
    let share = 1.0 / (1.0 + (-0.5 * gain.max(0.0)).exp());
    two.probabilities.iter_mut().for_each(|p| *p *= share);
    two.probabilities.extend(single.probabilities.iter().map(|p| p * (1.0 - share)));
    two.fits.extend(single.fits.iter().cloned());
    two
}
