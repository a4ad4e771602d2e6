//! Fits carried on from short segments of the records to longer ones, at last to the whole records: at once where they keep the phase.

use super::data::RecordDiagnosisError;
use super::evidence::{evidence, misfit, scale};
use super::fitted::FittedRecords;
use super::pruning::{diverse, without_needless_generalisations};
use super::search::{MOST_LEFT, Search, keep};

/// Fits that are carried on to longer parts, and the rounds and steps there of all and of those that are followed.
const CANDIDATES: usize = 4;
/// Misfit on longer parts over that on shorter ones from which on the phase is lost there: residuals are twice what they were, which
/// corrections that drift do not make.
const LOST: f64 = 4.0;
/// Evidence by which a fit may be behind the best to be carried on, and fits that are carried on all the same.
const BEHIND: f64 = 80.0;
const LEAST_RIVALS: usize = 2;
const CARRYING: [[usize; 2]; 2] = [[1, 4], [2, 4]];

impl Search<'_> {
    /// The level on which what was found at `level` goes on: the whole records where the best of `candidates` keeps the phase over them.
    pub(super) fn next_level(&self, level: usize, candidates: &[FittedRecords]) -> usize {
        let whole = self.levels.len() - 1;
        let keeps_phase = |best: &FittedRecords| {
            let start = self.carried(best, level, whole).ok()?;
            let left = self.problem(whole, 1.0).left(&start).ok()?;
            Some(left.chi_square < self.most_in_phase(best, whole))
        };
        let found = candidates.first().filter(|best| level + 1 < whole && !best.effects.is_empty());
        if found.and_then(keeps_phase) == Some(true) { whole } else { level + 1 }
    }

    /// Squared residual on a level beyond which a fit of another one has lost the phase there.
    fn most_in_phase(&self, fit: &FittedRecords, level: usize) -> f64 {
        LOST * misfit(fit) * self.levels[level].samples() as f64
    }

    /// The best of `candidates` of the level `from` fitted on the parts of the level `to`, best first.
    pub(super) fn lengthened(
        &self,
        candidates: &[FittedRecords],
        from: usize,
        to: usize,
    ) -> Result<Vec<FittedRecords>, RecordDiagnosisError> {
        let mut few = diverse(&without_needless_generalisations(candidates), CANDIDATES);
        if let Some(best) = candidates.first() {
            let unit = scale(best);
            let near = few.iter().filter(|f| evidence(f, unit) < evidence(best, unit) + BEHIND).count();
            few.truncate(near.max(LEAST_RIVALS));
        }
        let carry = |k: usize| {
            let start = self.carried(&few[k], from, to).ok()?;
            self.in_phase(to, start, self.most_in_phase(&few[k], to)).ok()
        };
        let starts: Vec<FittedRecords> = self.control.map(few.len(), carry).into_iter().flatten().collect();
        let longer = |list: &[FittedRecords], rounds| -> Vec<FittedRecords> {
            let fit = |k: usize| self.fit(to, &list[k], 1.0, rounds).ok();
            self.control.map(list.len(), fit).into_iter().flatten().collect()
        };
        // What leaves far too much after the first rounds is not followed further.
        let mut found = longer(&starts, CARRYING[0]);
        keep(&mut found, CANDIDATES, MOST_LEFT[0]);
        let mut found = longer(&found, CARRYING[1]);
        self.control.check()?;
        keep(&mut found, CANDIDATES, MOST_LEFT[1]);
        self.beside_neighbours(to, self.sorted(to, found))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::chain;
    use crate::common::runs::decay;
    use crate::control::Control;
    use crate::diagnosis::records::data::Records;
    use crate::effects::{Effect, Place, Source};

    /// The level that follows the second one for a model whose stiffness is off, of a motion that rings on for some hundred periods.
    fn level_after(stiffness: f64) -> (usize, usize) {
        let structure = chain(&[2.0, 1.0], &[800.0, 0.0], &[1500.0]);
        let modes = structure.modes().unwrap();
        let noise = |n: usize, dof: usize| {
            1e-4 * (12.9898 * n as f64 + 78.233 * dof as f64).sin().mul_add(43758.5453, 0.0).fract()
        };
        let wave = |n: usize, dof: usize| {
            0.02 * modes.shapes[(dof, 0)] * (1e-2 * modes.omega[0] * n as f64).cos() + noise(n, dof)
        };
        let run = decay(1e-2, (0..2).map(|dof| (0..12_000).map(|n| wave(n, dof)).collect()).collect());
        let records = Records::new(&structure, &[], std::slice::from_ref(&run)).unwrap();
        let control = Control::unattended();
        let search = Search::new(&records, &records, &[], &structure, &[], &control);
        let whole = search.levels.len() - 1;
        let mut start = FittedRecords { stiffness, ..FittedRecords::start(&search.levels[whole], &[]) };
        start.effects = vec![Source::known(Effect::Viscous, Place::Dofs(vec![1]), &[1e-9])];
        let fit = search.quiet(1, &search.carried(&start, whole, 1).unwrap()).unwrap();
        (search.next_level(1, &[fit]), whole)
    }

    #[test]
    fn a_fit_that_keeps_the_phase_goes_on_with_the_whole_records() {
        let (next, whole) = level_after(0.0);
        assert!(whole > 2 && next == whole, "{next} of {whole}");
        assert_eq!(level_after(3e-3).0, 2);
    }
}
