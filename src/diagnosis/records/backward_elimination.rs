//! Backward elimination: effects found early stood for others that were found later. Where the later ones are there, an earlier one may be
//! needless, or no more than a special case of itself.

use super::data::RecordError;
use super::evidence::{evidence, scale};
use super::fitted::FittedRecords;
use super::search::Search;
use crate::effects::Source;

/// Rounds and steps of a fit with one effect less, or a plainer one.
const PRUNING: [usize; 2] = [2, 3];

impl Search<'_> {
    /// A fit without those of its earlier effects that the last one has made needless, the others by the plainest law that does.
    pub(super) fn pruned(&self, level: usize, fit: &FittedRecords) -> Result<FittedRecords, RecordError> {
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

    /// The fit begun at `start` where it has more evidence than `best`.
    fn plainer(
        &self,
        level: usize,
        start: &FittedRecords,
        best: &FittedRecords,
    ) -> Result<Option<FittedRecords>, RecordError> {
        let allowed = |e: &Source| e.parameters.iter().zip(e.effect.parameters()).all(|(v, p)| p.allows(*v));
        if !start.effects.iter().all(allowed) {
            return Ok(None);
        }
        let refitted = match self.fit(level, start, 1.0, PRUNING) {
            Err(RecordError::Model { .. } | RecordError::Singular) => return Ok(None),
            other => other?,
        };
        let unit = scale(best);
        Ok((evidence(&refitted, unit) < evidence(best, unit)).then_some(refitted))
    }
}
