//! Fits of one effect more: laws at places from which fits begin, followed from short parts to whole records.

use super::compare::short;
use super::data::{RecordError, Records};
use super::evidence::{evidence, scale};
use super::fit::{Fit, FittedRecords, Free};
use super::regression::Regression;
use super::starts::tuned;
use super::telling::{last_deviations, plainest};
use crate::control::Control;
use crate::diagnosis::candidates::special_cases::is_allowed;
use crate::effects::Source;

/// Fits that go on to longer parts and to whole records.
const LONGER: usize = 6;
const WHOLE: usize = 3;
/// Steps of the first fits.
const BEGINNING: usize = 5;
/// Ratio of the parts of a record on which a law is fitted one after the other.
const LADDER: f64 = 3.0;
/// Squared residual over the least one beyond which a fit is not followed further: on a short part, where a law still finds
/// its size, and on a longer one.
const HOPELESS: [f64; 2] = [12.0, 4.0];

/// The search for what is missing in some records.
pub(super) struct Search<'a> {
    pub records: &'a Records<'a>,
    /// The same with the noise of their channels only, as they are compared.
    pub plain: &'a Records<'a>,
    pub excluded: &'a [Source],
    pub control: &'a Control,
}

impl Search<'_> {
    pub fn fit(&self, start: &FittedRecords, share: f64, iterations: usize) -> Result<FittedRecords, RecordError> {
        self.fit_by(start, share, iterations, self.control)
    }

    fn fit_by(
        &self,
        start: &FittedRecords,
        share: f64,
        iterations: usize,
        control: &Control,
    ) -> Result<FittedRecords, RecordError> {
        Fit { records: self.records, free: Free::all(self.records), share, control }.improve(start, iterations)
    }

    /// Initial states and effects only, nothing corrected.
    pub fn quiet(&self, start: &FittedRecords, share: f64) -> Result<FittedRecords, RecordError> {
        Fit { records: self.records, free: Free::nothing(), share, control: self.control }.improve(start, 3)
    }

    /// The model corrected, on longer and longer parts, so that a frequency that is off does not lose the phase.
    pub fn corrected(&self, start: &FittedRecords) -> Result<FittedRecords, RecordError> {
        let first = short(self.records);
        let quiet = self.quiet(start, first)?;
        let mut fitted = self.fit(&quiet, first, 8)?;
        // The motion itself may know better how far the model is off.
        if let Some(regression) = Regression::new(self.records, &quiet, self.control)
            && let Ok(other) = self.fit(&tuned(&regression, &quiet, None), first, 8)
            && other.chi_square < fitted.chi_square
        {
            fitted = other;
        }
        let mut share = LADDER * first;
        while share < 1.0 {
            fitted = self.fit(&fitted, share, 8)?;
            share *= LADDER;
        }
        self.fit(&fitted, 1.0, 12)
    }

    /// Fits of `best` with one effect more, best first.
    pub fn extended(&self, best: &FittedRecords, bare: &FittedRecords) -> Result<Vec<FittedRecords>, RecordError> {
        let first = short(self.records);
        // Short parts are followed from the linear model, whose stiffness is not bent to what is missing.
        let base = if best.effects.is_empty() { bare } else { best };
        let base = self.quiet(base, first)?;
        let starts = self.begun(best, &base);
        let alone = self.control.alone();
        // A start that runs away, or a mass that takes away all there is, is no start.
        let begun = self.control.map(starts.len(), |k| self.fit_by(&starts[k], first, BEGINNING, &alone).ok());
        self.control.check()?;
        let mut found: Vec<FittedRecords> = Vec::new();
        for fitted in begun.into_iter().flatten() {
            let same =
                |o: &FittedRecords| o.effects.last().zip(fitted.effects.last()).is_some_and(|(a, b)| a.is_same(b));
            match found.iter_mut().find(|o| same(o)) {
                Some(own) if fitted.chi_square < own.chi_square => *own = fitted,
                Some(_) => {}
                None => found.push(fitted),
            }
        }
        let longer = 0.4_f64.max(first);
        let mut found = self.continued(found, (LONGER, HOPELESS[0]), [first, longer], 6);
        found = self.continued(found, (WHOLE, HOPELESS[1]), [longer, 1.0], 9);
        found.retain(|f| f.effects.last().is_some_and(|e| is_allowed(self.excluded, e, &last_deviations(f))));
        if let Some(least) = found.iter().map(|f| f.chi_square).min_by(f64::total_cmp) {
            let best = found.iter().find(|f| f.chi_square == least).map_or(1.0, scale);
            found.sort_by(|a, b| evidence(a, best).total_cmp(&evidence(b, best)));
            plainest(&mut found);
        }
        Ok(found)
    }

    /// The best `count` fitted on longer and longer parts, so that none loses the phase.
    fn continued(
        &self,
        mut found: Vec<FittedRecords>,
        (count, hopeless): (usize, f64),
        [from, to]: [f64; 2],
        iterations: usize,
    ) -> Vec<FittedRecords> {
        found.sort_by(|a, b| a.chi_square.total_cmp(&b.chi_square));
        found.truncate(count);
        let least = found.first().map_or(0.0, |f| f.chi_square);
        found.retain(|f| f.chi_square <= hopeless * least.max(f.count as f64));
        let alone = self.control.alone();
        let rising = |f: &FittedRecords| {
            let mut fitted = f.clone();
            let mut share = LADDER * from;
            while share < to {
                fitted = self.fit_by(&fitted, share, 4, &alone).ok()?;
                share *= LADDER;
            }
            self.fit_by(&fitted, to, iterations, &alone).ok()
        };
        self.control.map(found.len(), |k| rising(&found[k])).into_iter().flatten().collect()
    }
}
