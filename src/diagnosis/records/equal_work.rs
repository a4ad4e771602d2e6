//! The law that fits best at other places, where it does the same work: a fit that was begun there from a free force may have ended in another
//! local minimum, and the law would be sure of the place where it did not.

use super::evidence::scale;
use super::fit_motion::FitMotion;
use super::fitted::FittedRecords;
use super::problem::FitProblem;
use super::pruning::is_same_set;
use super::search::Search;
use crate::effects::{Place, Source};

/// Places at which the law of the best is begun, and the squared residual of a start over that of the best up to which: ten times its
/// residual, for phases that the corrections of the best keep are off elsewhere until they are fitted there (an elastic slider at its own
/// place began with 54 times that of the best; records of seeds 400 to 415).
const PLACES: usize = 5;
const NEAR: f64 = 100.0;
/// Squared residual of the fit of a law at a place over that of the best from which on it is begun again.
const MORE: f64 = 1.05;

/// A start with what it leaves before anything is fitted, priors included.
pub(super) struct Start {
    pub start: FittedRecords,
    pub left: f64,
}

impl FitProblem<'_> {
    /// Of `best` with its last law replaced by one of `sources` the start that leaves least; none where the model runs away.
    pub(super) fn nearest(&self, best: &FittedRecords, sources: impl IntoIterator<Item = Source>) -> Option<Start> {
        let start_with = |source: Source| {
            let mut start = best.clone();
            start.effects.pop();
            start.effects.push(source);
            Some(Start { left: self.left(&start).ok()?.total(scale(best)), start })
        };
        sources.into_iter().filter_map(start_with).min_by(|a, b| a.left.total_cmp(&b.left))
    }
}

/// The `count` starts that leave least.
pub(super) fn least(starts: Vec<Option<Start>>, count: usize) -> Vec<FittedRecords> {
    let mut starts: Vec<Start> = starts.into_iter().flatten().collect();
    starts.sort_by(|a, b| a.left.total_cmp(&b.left));
    starts.into_iter().take(count).map(|s| s.start).collect()
}

impl Search<'_> {
    /// The best of `found` with its last law at every other place, the [`PLACES`] that leave least; none where a fit of it leaves as little.
    pub(super) fn starts_of_equal_work(&self, level: usize, found: &[FittedRecords]) -> Vec<FittedRecords> {
        let Some((best, law)) = found.first().and_then(|f| Some((f, f.effects.last()?))) else { return Vec::new() };
        let Ok(motion) = FitMotion::new(&self.levels[level], best, self.control) else { return Vec::new() };
        let (problem, others) = (self.problem(level, 1.0), &best.effects[..best.effects.len() - 1]);
        let mut places = self.all_places();
        places.retain(|place| !place.is_same(&law.place) && !others.iter().any(|e| e.place.is_same(place)));
        let most = NEAR * (best.chi_square + scale(best) * best.prior);
        let start_at = |k: usize| {
            let nearest = problem.nearest(best, with_equal_work(law, &places[k], &motion))?;
            let fitted = found.iter().find(|f| is_same_set(&f.effects, &nearest.start.effects));
            let is_open = fitted.is_none_or(|own| own.chi_square > MORE * best.chi_square);
            (is_open && nearest.left < most).then_some(nearest)
        };
        least(self.control.map(places.len(), start_at), PLACES)
    }
}

/// `law` at another place, where it does the same work along a `motion`: with `r` the ratio of the motions at both places, lengths in
/// its parameters are divided and forces multiplied by it,
///
/// ```text
/// f'(d') = r f(r d')
/// ```
///
/// Once with the ratio of the displacements, once with that of the velocities: in several modes they differ. None where either place does
/// not move.
pub(super) fn with_equal_work(law: &Source, place: &Place, motion: &FitMotion) -> Vec<Source> {
    let sizes = |place: &Place| motion.sizes(*place.legs().first()?);
    let (Some(own), Some(other)) = (sizes(&law.place), sizes(place)) else { return Vec::new() };
    let ratios = own.into_iter().zip(other).filter(|(a, b)| *a > 0.0 && *b > 0.0).map(|(a, b)| a / b);
    ratios.filter_map(|ratio| scaled_by(law, place, ratio)).collect()
}

/// `law` at another place, which moves by `ratio` times less; none where its parameters are then not allowed.
fn scaled_by(law: &Source, place: &Place, ratio: f64) -> Option<Source> {
    let list = law.effect.parameters();
    let exponent = list.iter().position(|p| p.name == "exponent").map_or(1.0, |k| law.parameters[k]);
    let mut source = Source { place: place.clone(), ..law.clone() };
    for (value, parameter) in source.parameters.iter_mut().zip(list) {
        let powers = parameter.powers_of_scale(exponent);
        // A length becomes shorter where the motion is less.
        *value *= ratio.powf(if matches!(parameter.unit, "m" | "m/s") { -powers } else { powers });
    }
    let allowed = source.parameters.iter().zip(list).all(|(v, p)| p.allows(*v));
    allowed.then_some(source)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::chain;
    use crate::common::runs::decay;
    use crate::control::Control;
    use crate::diagnosis::records::data::Records;
    use crate::effects::Effect;
    use crate::measurement::TransientRun;
    use crate::response::transient::force_along;
    use crate::structure::Structure;

    fn three_masses() -> Structure {
        chain(&[2.0, 1.0, 1.5], &[800.0, 0.0, 0.0], &[1500.0, 900.0])
    }

    /// Free motion in the first mode, all displacements.
    fn in_first_mode(structure: &Structure) -> TransientRun {
        let modes = structure.modes().unwrap();
        let wave = |n: usize, dof: usize| {
            let t = 5e-3 * n as f64;
            2e-2 * modes.shapes[(dof, 0)] * (-0.1 * t).exp() * (modes.omega[0] * t).cos()
        };
        decay(5e-3, (0..3).map(|dof| (0..2400).map(|n| wave(n, dof)).collect()).collect())
    }

    /// In one mode a law carried to another mass takes the same power at every instant, whatever lengths, speeds and powers it has.
    #[test]
    fn a_law_carried_to_another_place_does_the_same_work() {
        let structure = three_masses();
        let run = in_first_mode(&structure);
        let records = Records::new(&structure, &[], std::slice::from_ref(&run)).unwrap();
        let mut fit = FittedRecords::start(&records, &[]);
        fit.initial[0][0] = 2e-2;
        let motion = FitMotion::new(&records, &fit, &Control::unattended()).unwrap();
        let laws: [(Effect, &[f64]); 6] = [
            (Effect::CubicStiffness, &[4e5]),
            (Effect::Quadratic, &[3.0]),
            (Effect::Power, &[2.0, 1.6]),
            (Effect::Gap, &[500.0, 4e-3]),
            (Effect::ElasticSlider, &[900.0, 2.0]),
            (Effect::Stribeck, &[1.0, 2.0, 0.05]),
        ];
        let power = |law: &Source| -> Vec<f64> {
            let [d, v, a] = motion.relative(law.place.legs()[0], 0).unwrap();
            let force = force_along(law, [&d, &v, &a], records.list[0].force_step()).unwrap();
            force.iter().zip(&v).map(|(f, v)| f * v).collect()
        };
        for (effect, parameters) in laws {
            let law = Source::known(effect, Place::Dofs(vec![2]), parameters);
            let own = power(&law);
            let most = own.iter().fold(0.0_f64, |m, p| m.max(p.abs()));
            let there = with_equal_work(&law, &Place::Dofs(vec![0]), &motion);
            assert_eq!(there.len(), 2);
            for other in there {
                assert_eq!(other.place, Place::Dofs(vec![0]));
                let off = own.iter().zip(power(&other)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(most > 0.0 && off < 1e-6 * most, "{effect:?}: {off} of {most}");
            }
        }
    }

    /// In one mode a dashpot does the same work at any mass: it begins there, but not where it was fitted as well.
    #[test]
    fn a_law_begins_where_it_does_the_same_work() {
        let structure = three_masses();
        let (modes, run) = (structure.modes().unwrap(), in_first_mode(&structure));
        let records = Records::new(&structure, &[], std::slice::from_ref(&run)).unwrap();
        let control = Control::unattended();
        let search = Search::new(&records, &records, &[], &structure, &[], &control);
        let whole = search.levels.len() - 1;
        let mut start = FittedRecords::start(&search.levels[whole], &[]);
        start.initial[0][0] = 2e-2;
        start.effects = vec![Source::known(Effect::Viscous, Place::Dofs(vec![2]), &[0.4])];
        let best = search.quiet(whole, &start).unwrap();
        let begun = search.starts_of_equal_work(whole, std::slice::from_ref(&best));
        let mass = |dof: usize| begun.iter().find(|f| f.effects[0].place == Place::Dofs(vec![dof]));
        let (there, c) = (&mass(1).unwrap().effects[0], best.effects[0].parameters[0]);
        let as_much_work = c * (modes.shapes[(2, 0)] / modes.shapes[(1, 0)]).powi(2);
        assert!((there.parameters[0] / as_much_work - 1.0).abs() < 0.01, "{there:?} {as_much_work}");
        assert!(mass(2).is_none() && begun.len() <= PLACES);
        let fitted: Vec<FittedRecords> = std::iter::once(&best)
            .chain(&begun)
            .map(|f| FittedRecords { chi_square: best.chi_square, ..f.clone() })
            .collect();
        let again = search.starts_of_equal_work(whole, &fitted);
        assert!(begun.iter().all(|f| !again.iter().any(|g| is_same_set(&f.effects, &g.effects))));
    }
}
