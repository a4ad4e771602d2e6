//! Which candidates are fitted, and which fits are kept.

use crate::diagnosis::candidates::friction::friction;
use crate::diagnosis::candidates::law_force::GAINS;
use crate::diagnosis::candidates::special_cases::is_limit;
use crate::diagnosis::candidates::start::UnfittedSet;
use crate::diagnosis::localisation::free_force::Placing;
use crate::effects::{Kind, SetValued, Source};

/// What every parameter of a law beyond its first costs in evidence besides its information criterion: where one law
/// contains another as a limit, the simpler wins unless the data demand the other.
pub(super) const EXTRA: f64 = 8.0;
/// Most laws of one place that are fitted on the response.
const LAWS_AT_ONE_PLACE: usize = 4;
/// Sets whose score is this many times that of the best are not fitted.
const SCORE_RATIO: f64 = 5.0;
/// Places by either order at which laws of many parameters are regressed.
const PRESELECTED: usize = 3;
/// Score, in units of that of a set, below which a simpler one is as good for a start.
const CLEARLY: f64 = 1.2;
/// Relative deviation of the size of an effect from which on there may as well be none.
pub(super) const VOID: f64 = 0.5;

/// Whether an effect with the standard deviations of its parameters is one: of a size that the data know, within bounds.
pub(super) fn is_real(source: &Source, deviations: &[f64]) -> bool {
    let value = source.parameters[0];
    match source.effect.kind() {
        Kind::Channel(law) => {
            let bounded = law.neutral() == 0.0 || (GAINS[0]..=GAINS[1]).contains(&value);
            bounded && (value - law.neutral()).abs() * VOID > deviations[0]
        }
        Kind::Relative(_) | Kind::Whole(_) => {
            let known = |(p, d): (&f64, &f64)| p.abs() * VOID > *d;
            source.parameters.iter().zip(deviations).any(known)
        }
    }
}

/// Score beyond which sets are not fitted where the best has the score `best`.
pub(super) fn score_bound(best: f64) -> f64 {
    SCORE_RATIO * best.abs() + 300.0
}

/// Which laws are regressed at a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Breadth {
    /// Those of one or two parameters, at the few places that leave least.
    Near,
    /// Those of one or two parameters.
    Simple,
    /// Those of more, too.
    All,
}

/// The places whose laws of many parameters are regressed: those that leave least to a free force, and those that leave least
/// to a law of few.
pub(super) fn preselected_places(placings: &[Placing], laws: &[Vec<Vec<UnfittedSet>>]) -> Vec<usize> {
    let score = |k: usize| {
        let best = laws[k].iter().flatten().map(|d| d.score).fold(f64::INFINITY, f64::min);
        placings[k].chi_square + best
    };
    let sorted = |key: &dyn Fn(usize) -> f64| {
        let mut order: Vec<usize> = (0..placings.len()).collect();
        order.sort_by(|&a, &b| key(a).total_cmp(&key(b)));
        order.truncate(PRESELECTED);
        order
    };
    let mut chosen = sorted(&|k| placings[k].chi_square);
    let by_law = sorted(&score).into_iter().filter(|k| !chosen.contains(k)).collect::<Vec<_>>();
    chosen.extend(by_law);
    chosen
}

/// Whether an effect is friction with a smooth part that changes with velocity.
fn is_falling_friction(source: &Source) -> bool {
    friction(source.effect).is_some_and(SetValued::has_smooth_part)
}

/// Sets without falling friction where plain friction explains the free forces as well: its responses take longest, and it
/// is fitted where plain friction leaves something.
pub(super) fn without_falling_friction(unfitted: Vec<UnfittedSet>) -> Vec<UnfittedSet> {
    let falling = |d: &UnfittedSet| d.effects.iter().filter(|e| is_falling_friction(e)).count();
    let plainer = |a: &UnfittedSet, b: &UnfittedSet| falling(a) < falling(b) && is_limit(&a.effects, &b.effects);
    let needless = |d: &UnfittedSet| unfitted.iter().any(|s| s.score < CLEARLY * d.score.abs() && plainer(s, d));
    unfitted.iter().filter(|d| !needless(d)).cloned().collect()
}

/// Whether the last of `set` is friction that falls where the last of `plain` is friction that does not, and all else is the same.
pub(super) fn is_plain_friction_of(plain: &[Source], set: &[Source]) -> bool {
    let falls = |sources: &[Source]| sources.last().is_some_and(is_falling_friction);
    falls(set) && !falls(plain) && is_limit(plain, set)
}

/// The same sets, the plain friction that the first contains before it.
pub(super) fn plain_friction_first(mut sets: Vec<UnfittedSet>) -> Vec<UnfittedSet> {
    let plain = |first: &UnfittedSet| sets.iter().position(|set| is_plain_friction_of(&set.effects, &first.effects));
    if let Some(plain) = sets.first().and_then(plain) {
        let plain = sets.remove(plain);
        sets.insert(0, plain);
    }
    sets
}

/// Sets without those that leave no less than one of simpler laws which they contain as limits: a parameter beyond must bring its
/// evidence. Laws that the best of the simpler ones may have been taken for are fitted beside it in the end.
pub(super) fn without_idle_parameters(unfitted: Vec<UnfittedSet>, count: usize) -> Vec<UnfittedSet> {
    let best = unfitted.iter().map(|d| d.score).fold(f64::INFINITY, f64::min);
    let evidence = EXTRA * (best / count.max(1) as f64).max(1.0);
    let parameters = |d: &UnfittedSet| d.effects.iter().map(|e| e.parameters.len()).sum::<usize>();
    let simpler = |a: &UnfittedSet, b: &UnfittedSet| {
        let fewer = parameters(a) < parameters(b) && is_limit(&a.effects, &b.effects);
        fewer && a.score < b.score + evidence
    };
    let idle = |d: &UnfittedSet| unfitted.iter().any(|s| simpler(s, d));
    unfitted.iter().filter(|d| !idle(d)).cloned().collect()
}

/// The best sets, no more than a few at one place, each with the simpler laws that it contains as limits.
pub(super) fn short_list(mut unfitted: Vec<UnfittedSet>, most: usize) -> Vec<UnfittedSet> {
    unfitted.sort_by(|a, b| a.score.total_cmp(&b.score));
    let bound = score_bound(unfitted.first().map_or(f64::INFINITY, |best| best.score));
    let mut kept: Vec<UnfittedSet> = Vec::new();
    for unfitted in unfitted.iter().filter(|d| d.score < bound) {
        let here = kept.iter().filter(|k| k.effects[0].place == unfitted.effects[0].place).count();
        if here < LAWS_AT_ONE_PLACE {
            kept.push(unfitted.clone());
        }
        if kept.len() == most {
            break;
        }
    }
    for set in kept.clone().iter().take(LAWS_AT_ONE_PLACE) {
        let (effect, place) = (set.effects[0].effect, &set.effects[0].place);
        for simpler in effect.limits() {
            let is = |d: &&UnfittedSet| d.effects[0].effect == simpler && d.effects[0].place == *place;
            if kept.iter().any(|d| is(&d)) {
                continue;
            }
            kept.extend(unfitted.iter().find(is).cloned());
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::{UnfittedSet, plain_friction_first, without_idle_parameters};
    use crate::effects::{Effect, Place, Source};
    use std::sync::Arc;

    fn set(effect: Effect, dof: usize, parameters: &[f64], score: f64) -> UnfittedSet {
        let effects = vec![Source::known(effect, Place::Dofs(vec![dof]), parameters)];
        UnfittedSet { effects, score, fields: Arc::default() }
    }

    fn laws(sets: &[UnfittedSet]) -> Vec<Effect> {
        sets.iter().map(|set| set.effects[0].effect).collect()
    }

    /// A power of velocity that leaves no less than a dashpot at its place is one; elsewhere, or where it leaves less, it is not.
    #[test]
    fn a_parameter_that_brings_nothing_is_not_refined() {
        let power = |dof: usize, score: f64| set(Effect::Power, dof, &[7.0, 1.0], score);
        let dashpot = set(Effect::Viscous, 0, &[7.0], 90.0);
        let kept = |power: UnfittedSet| laws(&without_idle_parameters(vec![dashpot.clone(), power], 100));
        assert_eq!(kept(power(0, 88.0)), [Effect::Viscous]);
        assert_eq!(kept(power(0, 60.0)), [Effect::Viscous, Effect::Power]);
        assert_eq!(kept(power(1, 88.0)), [Effect::Viscous, Effect::Power]);
    }

    #[test]
    fn plain_friction_comes_before_the_friction_that_contains_it() {
        let falling = set(Effect::Stribeck, 0, &[1.0, 2.0, 0.1], 50.0);
        let (dashpot, plain) = (set(Effect::Viscous, 0, &[1.0], 60.0), set(Effect::Coulomb, 0, &[1.5], 200.0));
        let ordered = plain_friction_first(vec![falling.clone(), dashpot.clone(), plain]);
        assert_eq!(laws(&ordered), [Effect::Coulomb, Effect::Stribeck, Effect::Viscous]);
        let elsewhere = plain_friction_first(vec![falling, dashpot, set(Effect::Coulomb, 1, &[1.5], 200.0)]);
        assert_eq!(laws(&elsewhere), [Effect::Stribeck, Effect::Viscous, Effect::Coulomb]);
    }
}
