//! Multi-start: short fits of many starts with one law more each, which decide which starts are followed. Those at one place differ only
//! in the law, and share the derivatives by all other variables ([`super::chord_steps`]), taken at the first of them.

use super::chord_steps::ChordJacobian;
use super::fitted::FittedRecords;
use super::search::Search;

/// Rounds of a short fit, and steps in each.
const BEGINNING: [usize; 2] = [1, 3];

impl Search<'_> {
    /// Short fits on the segments of `level` of starts, the best start first; none of a start that diverges. `in_free_motion` each begins
    /// with a fit of the first periods: where the frequency depends on the amplitude the phase of a decay is lost within a segment.
    pub(super) fn multi_start_fits(
        &self,
        level: usize,
        starts: &[FittedRecords],
        in_free_motion: bool,
    ) -> Vec<Option<FittedRecords>> {
        let groups = by_place(starts);
        let problem = self.problem(level, 1.0);
        let fits = |group: &Vec<usize>| {
            let mut chord: Option<ChordJacobian> = None;
            let mut fit = |k: &usize| {
                let first =
                    if in_free_motion { self.fit_first_periods(level, &starts[*k], BEGINNING).ok() } else { None };
                problem.chord_fit_from(first.as_ref().unwrap_or(&starts[*k]), BEGINNING, &mut chord).ok()
            };
            group.iter().map(|k| (*k, fit(k))).collect::<Vec<_>>()
        };
        let mut found = vec![None; starts.len()];
        let done = self.control.map(groups.len(), |g| fits(&groups[g]));
        done.into_iter().flatten().for_each(|(k, fit)| found[k] = fit);
        found
    }
}

/// Numbers of the starts whose last law acts at one place, in their order.
fn by_place(starts: &[FittedRecords]) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    let place = |k: usize| starts[k].effects.last().map(|e| &e.place);
    for k in 0..starts.len() {
        let own = groups.iter_mut().find(|g| match (place(g[0]), place(k)) {
            (Some(a), Some(b)) => a.is_same(b),
            (a, b) => a == b,
        });
        match own {
            Some(group) => group.push(k),
            None => groups.push(vec![k]),
        }
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::by_place;
    use crate::diagnosis::records::fitted::FittedRecords;
    use crate::effects::{Effect, Place, Source};

    #[test]
    fn starts_at_one_place_stand_together() {
        let start = |effect: Effect, dofs: &[usize]| {
            let parameters = vec![1.0; effect.parameters().len()];
            FittedRecords::of_effects(vec![Source::known(effect, Place::Dofs(dofs.to_vec()), &parameters)], 1.0)
        };
        let starts = [
            (Effect::Viscous, &[0_usize, 1][..]),
            (Effect::Coulomb, &[2]),
            (Effect::Coulomb, &[1, 0]),
            (Effect::Mass, &[2]),
        ]
        .map(|(effect, dofs)| start(effect, dofs));
        assert_eq!(by_place(&starts), [vec![0, 2], vec![1, 3]]);
    }
}
