//! First fits of many starts with one law more each. Those at one place share what is held of all that is no law ([`super::held`]), taken
//! where the first of them begins: they differ in the law, and the fits only have to say which are followed.

use super::fitted::FittedRecords;
use super::held::Held;
use super::search::Search;

/// Rounds and steps in each of a first fit.
const BEGINNING: [usize; 2] = [1, 3];

impl Search<'_> {
    /// First fits on the parts of `level` of starts that are best first; none of a start that runs away. `in_free_motion` those of the
    /// first periods come before: where a frequency follows the amplitude the phase of a decay is lost within a part.
    pub(super) fn first_fits(
        &self,
        level: usize,
        starts: &[FittedRecords],
        in_free_motion: bool,
    ) -> Vec<Option<FittedRecords>> {
        let groups = by_place(starts);
        let problem = self.problem(level, 1.0);
        let fits = |group: &Vec<usize>| {
            let mut held: Option<Held> = None;
            let mut fit = |k: &usize| {
                let first =
                    if in_free_motion { self.fit_first_periods(level, &starts[*k], BEGINNING).ok() } else { None };
                problem.begin_beside(first.as_ref().unwrap_or(&starts[*k]), BEGINNING, &mut held).ok()
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
