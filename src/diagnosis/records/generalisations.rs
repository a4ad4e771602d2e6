//! Generalisations of the law that fits best, started where they exert the same force: the fit of a law of one parameter cannot find the
//! law of more parameters that it is a special case of (friction that falls with speed, a slider with a spring).

use super::data::RecordDiagnosisError;
use super::evidence::{AGREES, misfit};
use super::fit_motion::FitMotion;
use super::fitted::FittedRecords;
use super::pruning::is_same_set;
use super::score::{ScoreTest, Scored};
use super::search::Search;
use crate::effects::{Effect, Leg, Source};
use crate::response::transient::force_along;
use dashpot_numerics::dot;

/// Shapes of one generalisation from which fits start, and of all of them together.
const BEGUN: usize = 2;
const BEGUN_OF_ALL: usize = 8;
/// Places of candidates at which the law of the best is tried, and the squared residual over that of the best, or over the noise, up to which
/// they compete.
const ELSEWHERE: usize = 2;
const NEAR: f64 = 4.0;

impl Search<'_> {
    /// Special cases of the laws that were found, and generalisations of the best where it is not yet among those `generalised`.
    pub(super) fn neighbour_starts(
        &self,
        level: usize,
        found: &[FittedRecords],
        generalised: &mut Vec<Source>,
    ) -> Result<Vec<FittedRecords>, RecordDiagnosisError> {
        let mut starts = self.special_case_starts(level, found);
        if !Self::is_generalised(found, generalised)
            && let Some(best) = found.first().and_then(|f| f.effects.last())
        {
            let mut general = self.generalised_starts(level, found)?;
            let here = generalised.iter().any(|law| law.place.is_same(&best.place));
            general.retain(|s| !here || !found.iter().any(|f| is_same_set(&f.effects, &s.effects)));
            generalised.push(best.clone());
            starts.splice(0..0, general);
        }
        starts.retain(|s| found.first().is_none_or(|best| !self.pruned.holds(&s.effects, best)));
        Ok(starts)
    }

    /// Whether the last law of the best is among those `generalised`, at the same place.
    pub(super) fn is_generalised(found: &[FittedRecords], generalised: &[Source]) -> bool {
        let best = found.first().and_then(|f| f.effects.last());
        best.is_none_or(|best| generalised.iter().any(|law| law.is_same(best)))
    }

    /// The best of `found` with its last law replaced by generalisations, at the shapes that leave least; on segments of records none
    /// where the best leaves no more than noise.
    pub(super) fn generalised_starts(
        &self,
        level: usize,
        found: &[FittedRecords],
    ) -> Result<Vec<FittedRecords>, RecordDiagnosisError> {
        let Some((best, law)) = found.first().and_then(|f| Some((f, f.effects.last()?))) else { return Ok(Vec::new()) };
        let laws: Vec<Effect> =
            law.effect.generalisations().into_iter().filter(|e| self.laws.contains(e) && *e != law.effect).collect();
        let explained = misfit(best) < AGREES && level + 1 < self.levels.len();
        if explained || laws.is_empty() || self.control.is_late() {
            return Ok(Vec::new());
        }
        self.with_law_replaced(level, best, &laws)
    }

    /// The law of the best of `found` at the places of its nearest candidates, where it was not tried: law and place are decided together, and
    /// a law that was generalised at one place only would seem certain of that place.
    pub(super) fn starts_at_candidate_places(
        &self,
        level: usize,
        found: &[FittedRecords],
    ) -> Result<Vec<FittedRecords>, RecordDiagnosisError> {
        let Some((best, law)) = found.first().and_then(|f| Some((f, f.effects.last()?))) else { return Ok(Vec::new()) };
        let ends = level == 0 || level + 1 == self.levels.len();
        if !ends || self.control.is_late() {
            return Ok(Vec::new());
        }
        let mut places = vec![&law.place];
        let mut starts = Vec::new();
        for candidate in found.iter().skip(1).filter(|f| f.chi_square < NEAR * best.chi_square.max(f.count as f64)) {
            let Some(other) = candidate.effects.last() else { continue };
            let same_others =
                is_same_set(&candidate.effects[..candidate.effects.len() - 1], &best.effects[..best.effects.len() - 1]);
            let new = !places.iter().any(|p| p.is_same(&other.place));
            if places.len() > ELSEWHERE || !new || !same_others {
                continue;
            }
            places.push(&other.place);
            let tried = |f: &FittedRecords| {
                f.effects.last().is_some_and(|e| e.effect == law.effect && e.place.is_same(&other.place))
            };
            if !found.iter().any(tried) {
                starts.extend(self.with_law_replaced(level, candidate, &[law.effect])?);
            }
        }
        starts.retain(|s| !self.pruned.holds(&s.effects, best));
        Ok(starts)
    }

    /// `fit` with its last law replaced by others that exert an equal force along its motion: the [`BEGUN`] shapes of each, and
    /// [`BEGUN_OF_ALL`] of all, that would leave least in its place to first order.
    fn with_law_replaced(
        &self,
        level: usize,
        fit: &FittedRecords,
        laws: &[Effect],
    ) -> Result<Vec<FittedRecords>, RecordDiagnosisError> {
        let Some((law, leg)) = fit.effects.last().and_then(|e| Some((e, e.place.legs().first().copied()?))) else {
            return Ok(Vec::new());
        };
        let mut problem = self.problem(level, 1.0);
        problem.free.effects = false;
        let test = match ScoreTest::new(&problem, fit).and_then(|test| test.without(law)) {
            Err(RecordDiagnosisError::Singular | RecordDiagnosisError::Model { .. }) => return Ok(Vec::new()),
            other => other?,
        };
        let shapes = self.control.map(laws.len(), |k| test.shapes_at(&law.place, &laws[k..=k])).into_iter().flatten();
        let own = test.gain(law).unwrap_or(0.0);
        let most = (NEAR - 1.0) * fit.chi_square.max(fit.count as f64);
        let near = |s: &Scored| own - s.gain < most;
        // Where noise is low no shape of the grid is near; a law that contains the one that fits has it in reach all the same.
        let contains = |s: &Scored| s.source.effect.contains(law.effect);
        // The best shape of every law before the second of any: laws of one kin would leave no room for others.
        let ranked = shapes.flat_map(|list| {
            let numbered = list.into_iter().enumerate().take(BEGUN);
            numbered.filter(|(k, s)| near(s) || (*k == 0 && contains(s))).collect::<Vec<_>>()
        });
        let mut few: Vec<(usize, Scored)> = ranked.collect();
        few.sort_by(|a, b| a.0.cmp(&b.0).then(b.1.gain.total_cmp(&a.1.gain)));
        few.truncate(BEGUN_OF_ALL);
        let in_place = |scored: Scored| {
            let source = self.with_equal_force(law, scored.source, leg, test.motion(), level)?;
            let mut start = fit.clone();
            start.effects.pop();
            start.effects.push(source);
            Some(start)
        };
        Ok(few.into_iter().filter_map(|(_, scored)| in_place(scored)).collect())
    }

    /// `source` scaled so that its force along the motion equals that of `law` in the least-squares sense.
    pub(super) fn with_equal_force(
        &self,
        law: &Source,
        mut source: Source,
        leg: Leg,
        motion: &FitMotion,
        level: usize,
    ) -> Option<Source> {
        let (mut product, mut square) = (0.0, 0.0);
        for (r, record) in self.levels[level].list.iter().enumerate() {
            let [d, v, a] = motion.relative(leg, r)?;
            let along = [&d[..], &v, &a];
            let [own, wanted] = [&source, law].map(|s| force_along(s, along, record.force_step()));
            let (own, wanted) = (own?, wanted?);
            product += dot(&own, &wanted);
            square += dot(&own, &own);
        }
        let factor = product / square;
        source.effect.scaled().iter().for_each(|&k| source.parameters[k] *= factor);
        let allowed = source.parameters.iter().zip(source.effect.parameters()).all(|(v, p)| p.allows(*v));
        (factor.is_finite() && factor != 0.0 && allowed).then_some(source)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::control::Control;
    use crate::diagnosis::records::data::Records;
    use crate::diagnosis::records::fitted::FittedRecords;
    use crate::effects::Place;
    use crate::measurement::transient_run::TransientLabel;
    use crate::measurement::{Channel, Kind, Quantity, Record, TransientRun};
    use crate::structure::Structure;
    use crate::structure::chain::ChainParameters;
    use std::sync::Arc;

    fn chain() -> Structure {
        let (masses, ground_stiffness) = (vec![2.0, 1.0, 1.5], vec![800.0, 0.0, 0.0]);
        ChainParameters { masses, ground_stiffness, coupling_stiffness: vec![1500.0, 900.0] }.build(&[]).unwrap()
    }

    /// A decay in the first mode of the chain, all displacements.
    fn decay(structure: &Structure) -> TransientRun {
        let modes = structure.modes().unwrap();
        let wave = |n: usize, dof: usize| {
            let t = 5e-3 * n as f64;
            2e-2 * modes.shapes[(dof, 0)] * (-0.3 * t).exp() * (modes.omega[0] * t).cos()
        };
        let channel = |dof: usize| Channel { quantity: Quantity::Displacement, dof, label: (dof + 1).to_string() };
        let samples = (0..3).map(|dof| (0..2400).map(|n| wave(n, dof)).collect()).collect();
        let time = (0..2400).map(|n| 5e-3 * f64::from(n)).collect();
        let record = Record::new(time, (0..3).map(channel).collect(), samples).unwrap();
        let label = TransientLabel { file: "decay.csv".into(), kind: Kind::Decay, enabled: true, ..Default::default() };
        TransientRun::new(label, Arc::new(record), &[]).unwrap()
    }

    fn at(effect: Effect, dof: usize, parameters: &[f64]) -> Source {
        Source::known(effect, Place::Dofs(vec![dof]), parameters)
    }

    /// Does a test with a search, on the level of whole records, and fits, each of one effect with its squared residual.
    fn with_fits<T>(fits: &[(Source, f64)], test: impl FnOnce(&Search<'_>, usize, &[FittedRecords]) -> T) -> T {
        let structure = chain();
        let run = decay(&structure);
        let records = Records::new(&structure, &[], std::slice::from_ref(&run)).unwrap();
        let control = Control::unattended();
        let search = Search::new(&records, &records, &[], &structure, &[], &control);
        let whole = search.levels.len() - 1;
        let mut bare = FittedRecords::start(&search.levels[whole], &[]);
        bare.initial[0][0] = 2e-2;
        let fit = |(source, chi_square): &(Source, f64)| FittedRecords {
            effects: vec![source.clone()],
            chi_square: *chi_square,
            count: 7200,
            ..bare.clone()
        };
        test(&search, whole, &fits.iter().map(fit).collect::<Vec<_>>())
    }

    /// Starts beside some fits: special cases, and candidate places.
    fn starts(fits: &[(Source, f64)]) -> [Vec<Source>; 2] {
        let laws = |list: Vec<FittedRecords>| list.into_iter().filter_map(|mut f| f.effects.pop()).collect();
        with_fits(fits, |search, whole, found| {
            [
                laws(search.special_case_starts(whole, found)),
                laws(search.starts_at_candidate_places(whole, found).unwrap()),
            ]
        })
    }

    /// A power law of exponent 1 is a dashpot: where the fit of one was cut off it begins again, with the same force.
    #[test]
    fn a_simpler_law_that_was_cut_off_begins_again() {
        let power = (at(Effect::Power, 2, &[0.9, 1.0]), 7000.0);
        let [plainer, _] = starts(&[power.clone(), (at(Effect::Viscous, 2, &[9.0]), 1e30)]);
        let again = plainer.iter().find(|s| s.effect == Effect::Viscous).unwrap();
        assert!((again.parameters[0] - 0.9).abs() < 1e-9, "{again:?}");
        let [plainer, _] = starts(&[power, (at(Effect::Viscous, 2, &[0.9]), 7050.0)]);
        assert!(plainer.iter().all(|s| s.effect != Effect::Viscous), "{plainer:?}");
    }

    /// The best law begins at the place of a near candidate; not where it was tried, and not where little speaks for the place.
    #[test]
    fn the_best_law_is_tried_at_the_places_of_its_rivals() {
        let best = (at(Effect::Viscous, 2, &[0.9]), 7000.0);
        let [_, elsewhere] = starts(&[best.clone(), (at(Effect::Coulomb, 1, &[5e-3]), 14_000.0)]);
        assert!(elsewhere.iter().all(|s| s.effect == Effect::Viscous && s.place == Place::Dofs(vec![1])));
        assert_eq!(elsewhere.len(), 1, "{elsewhere:?}");
        assert!(elsewhere[0].parameters[0] > 0.0);
        let tried = (at(Effect::Viscous, 1, &[0.4]), 15_000.0);
        let far = (at(Effect::Coulomb, 0, &[5e-3]), 90_000.0);
        let [_, elsewhere] = starts(&[best, (at(Effect::Coulomb, 1, &[5e-3]), 14_000.0), tried, far]);
        assert!(elsewhere.is_empty(), "{elsewhere:?}");
    }

    /// A law that was generalised at one place is so at the next that it comes to, and there once.
    #[test]
    fn a_law_is_generalised_at_every_place_where_it_is_the_best() {
        with_fits(&[(at(Effect::Quadratic, 2, &[0.9]), 1e6)], |search, whole, found| {
            let mut generalised = vec![at(Effect::Quadratic, 1, &[0.9])];
            assert!(!Search::is_generalised(found, &generalised));
            for _ in 0..2 {
                search.neighbour_starts(whole, found, &mut generalised).unwrap();
                assert!(Search::is_generalised(found, &generalised));
                assert_eq!(generalised.len(), 2);
            }
        });
    }
}
