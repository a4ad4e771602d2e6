//! Backward elimination: effects found early stood for others that were found later. Where the later ones are there, an earlier one may be
//! needless, or no more than a special case of itself.

use super::data::RecordDiagnosisError;
use super::evidence::{AGREES, evidence, misfit, scale};
use super::fitted::FittedRecords;
use super::search::{Search, SetsBySize};
use crate::effects::Source;

/// Rounds and steps of a fit with one effect less, or a plainer one.
const PRUNING: [usize; 2] = [2, 3];
/// The same of one on whole records without its last effect, or without any.
pub(super) const WITHOUT: [usize; 2] = [4, 4];

impl Search<'_> {
    /// A fit without those of its earlier effects that the last one has made needless, the others by the plainest law that does.
    pub(super) fn pruned(&self, level: usize, fit: &FittedRecords) -> Result<FittedRecords, RecordDiagnosisError> {
        let mut best = fit.clone();
        for k in (0..fit.effects.len().saturating_sub(1)).rev() {
            let mut fewer = best.clone();
            fewer.effects.remove(k);
            if let Some(plainer) = self.plainer(level, &fewer, &best)? {
                best = plainer;
                continue;
            }
            let law = best.effects[k].clone();
            for limit in law.limits().filter(|limit| self.laws.contains(&limit.effect)) {
                let mut simpler = best.clone();
                simpler.effects[k] = limit;
                if let Some(plainer) = self.plainer(level, &simpler, &best)? {
                    best = plainer;
                }
            }
        }
        Ok(best)
    }

    /// The effects before a mass or spring that was found last, on whole records, where they leave no more than noise there: what it explains
    /// beside them is an error of the masses and springs of the model. `None` where it is no such effect, or they leave more.
    pub(super) fn without_constant(&self, by_size: &SetsBySize) -> Result<Option<SetsBySize>, RecordDiagnosisError> {
        let last = by_size.last.first().filter(|best| best.effects.len() > 1 && best.adds_constant());
        let Some(((level, before), earlier)) = last.and_then(|_| by_size.earlier.split_last()) else { return Ok(None) };
        if before.effects.is_empty() || self.control.is_late() {
            return Ok(None);
        }
        let whole = self.levels.len() - 1;
        let without = self.fit(whole, &self.carried(before, *level, whole)?, 1.0, WITHOUT)?;
        let noise = misfit(&without) < AGREES;
        Ok(noise.then(|| SetsBySize { earlier: earlier.to_vec(), last: vec![without] }))
    }

    /// The fit begun at `start` where it has more evidence than `best`.
    fn plainer(
        &self,
        level: usize,
        start: &FittedRecords,
        best: &FittedRecords,
    ) -> Result<Option<FittedRecords>, RecordDiagnosisError> {
        let allowed = |e: &Source| e.parameters.iter().zip(e.effect.parameters()).all(|(v, p)| p.allows(*v));
        if !start.effects.iter().all(allowed) {
            return Ok(None);
        }
        let refitted = match self.fit(level, start, 1.0, PRUNING) {
            Err(RecordDiagnosisError::Model { .. } | RecordDiagnosisError::Singular) => return Ok(None),
            other => other?,
        };
        let unit = scale(best);
        Ok((evidence(&refitted, unit) < evidence(best, unit)).then_some(refitted))
    }
}
