//! The law that fits best at the places next to its own: between sensors a free force of a model that is off is seen at the wrong one of
//! them.

use super::data::RecordDiagnosisError;
use super::equal_work::{least, with_equal_work};
use super::fitted::FittedRecords;
use super::pruning::is_same_set;
use super::score::ScoreTest;
use super::search::Search;
use crate::effects::Place;

/// Places next to that of the best at which its law is begun.
const BESIDE: usize = 2;
/// Most steps along the structure by which the law of the best fit is moved to where it leaves less.
const MOVED: usize = 3;

impl Search<'_> {
    /// Fits, best first, with the last law of the best moved along the structure from place to place as long as it leaves less there.
    pub(super) fn moved_along(
        &self,
        level: usize,
        mut found: Vec<FittedRecords>,
    ) -> Result<Vec<FittedRecords>, RecordDiagnosisError> {
        let place = |found: &[FittedRecords]| found.first().and_then(|f| f.effects.last()).map(|e| e.place.clone());
        for _ in 0..MOVED {
            let next_to = self.starts_at_neighbours(level, &found)?;
            let before = place(&found);
            if next_to.is_empty() {
                break;
            }
            found = self.with_begun(level, found, &next_to)?;
            if before == place(&found) {
                break;
            }
        }
        Ok(found)
    }

    /// The best of `found` with its last law moved to the places next to its own, the [`BESIDE`] that would leave least to first order.
    fn starts_at_neighbours(
        &self,
        level: usize,
        found: &[FittedRecords],
    ) -> Result<Vec<FittedRecords>, RecordDiagnosisError> {
        let Some((best, law)) = found.first().and_then(|f| Some((f, f.effects.last()?))) else { return Ok(Vec::new()) };
        let others = &best.effects[..best.effects.len() - 1];
        let mut places = next_to(&law.place, &self.records.structure.neighbours());
        places.retain(|place| !others.iter().any(|e| e.effect == law.effect && e.place.is_same(place)));
        if places.is_empty() || self.control.is_late() {
            return Ok(Vec::new());
        }
        let problem = self.problem(level, 1.0);
        let test = match ScoreTest::new(&problem, best).and_then(|test| test.without(law)) {
            Err(RecordDiagnosisError::Singular | RecordDiagnosisError::Model { .. }) => return Ok(Vec::new()),
            other => other?,
        };
        let begun = |k: usize| {
            let by_score = test.at(&places[k], &[law.effect]).into_iter().map(|scored| scored.source);
            let all = by_score.chain(with_equal_work(law, &places[k], test.motion()));
            let nearest = problem.nearest(best, all)?;
            let tried = found.iter().any(|f| is_same_set(&f.effects, &nearest.start.effects));
            (!tried && !self.pruned.holds(&nearest.start.effects, best)).then_some(nearest)
        };
        Ok(least(self.control.map(places.len(), begun), BESIDE))
    }
}

/// Places one step along the structure away from `place`, to the ground or between two DOFs; of one to the ground also those between its
/// DOF and the next, and of one between two DOFs those from each to the ground, which near a support are all but the same.
fn next_to(place: &Place, neighbours: &[[usize; 2]]) -> Vec<Place> {
    let Place::Dofs(own) = place else { return Vec::new() };
    let between = |pair: &[usize; 2]| Place::Dofs(pair.to_vec());
    match own[..] {
        [dof] => {
            let beside = || neighbours.iter().filter(move |pair| pair.contains(&dof));
            let other = |pair: &[usize; 2]| Place::Dofs(vec![pair[usize::from(pair[0] == dof)]]);
            beside().map(other).chain(beside().map(between)).collect()
        }
        [a, b] => {
            let shares_one = |pair: &&[usize; 2]| pair.contains(&a) != pair.contains(&b);
            let ends = [a, b].map(|dof| Place::Dofs(vec![dof]));
            neighbours.iter().filter(shares_one).map(between).chain(ends).collect()
        }
        _ => Vec::new(),
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
    use crate::effects::{Effect, Source};
    use crate::structure::Structure;

    fn three_masses() -> Structure {
        chain(&[2.0, 1.0, 1.5], &[800.0, 0.0, 0.0], &[1500.0, 900.0])
    }

    #[test]
    fn places_next_to_a_place_share_a_dof_with_it_or_are_beside_it() {
        let neighbours = three_masses().neighbours();
        let place = |dofs: &[usize]| Place::Dofs(dofs.to_vec());
        let of_mass = next_to(&place(&[1]), &neighbours);
        assert_eq!(of_mass, [&[0][..], &[2], &[0, 1], &[1, 2]].map(place));
        assert_eq!(next_to(&place(&[1, 0]), &neighbours), [&[1, 2][..], &[1], &[0]].map(place));
    }

    /// A dashpot that was fitted at the mass beside its own moves there.
    #[test]
    fn a_law_moves_along_the_structure_to_its_place() {
        let structure = three_masses();
        let modes = structure.modes().unwrap();
        let wave = |n: usize, dof: usize| -> f64 {
            let t = 5e-3 * n as f64;
            let mode = |r: usize| 2e-2 * modes.shapes[(dof, r)] * (-0.3 * t).exp() * (modes.omega[r] * t).cos();
            (0..3).map(mode).sum()
        };
        let dashpot = |dof: usize| Source::known(Effect::Viscous, Place::Dofs(vec![dof]), &[3.0]);
        let in_all_modes = decay(5e-3, (0..3).map(|dof| (0..2400).map(|n| wave(n, dof)).collect()).collect());
        let records = Records::new(&structure, &[dashpot(1)], std::slice::from_ref(&in_all_modes)).unwrap();
        let mut start = FittedRecords::start(&records, &[]);
        start.initial[0][..3].copy_from_slice(&[2e-2, 1e-2, 8e-3]);
        let truth = start.predict(&records, 0, in_all_modes.len(), &[]).unwrap().channels;
        let run = decay(5e-3, truth);
        let records = Records::new(&structure, &[], std::slice::from_ref(&run)).unwrap();
        let control = Control::unattended();
        let search = Search::new(&records, &records, &[], &structure, &[], &control);
        let whole = search.levels.len() - 1;
        start.known.clear();
        start.effects = vec![dashpot(0)];
        let wrong = search.fit(whole, &start, 1.0, [2, 3]).unwrap();
        let found = search.moved_along(whole, vec![wrong]).unwrap();
        let law = &found[0].effects[0];
        assert!(law.place == Place::Dofs(vec![1]) && (law.parameters[0] - 3.0).abs() < 0.15, "{law:?}");
    }
}
