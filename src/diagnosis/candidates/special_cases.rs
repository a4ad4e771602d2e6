//! Laws that contain simpler ones as limits of their parameters.

use crate::effects::{Effect, Source};

/// Distance of an exponent or an order from that of a simpler law within which they are taken for the same.
const CLOSE: f64 = 0.03;

/// Simpler laws that a law becomes at the ends of its parameters.
pub(crate) fn limits(effect: Effect) -> &'static [Effect] {
    match effect {
        Effect::ElasticSlider => &[Effect::Stiffness, Effect::Coulomb],
        Effect::Iwan => &[Effect::ElasticSlider, Effect::Stiffness, Effect::Coulomb],
        Effect::Maxwell => &[Effect::Viscous, Effect::Stiffness],
        Effect::Fractional => &[Effect::Viscous, Effect::Stiffness, Effect::Hysteretic],
        Effect::Power => &[Effect::Viscous, Effect::Quadratic, Effect::Coulomb],
        Effect::Stribeck => &[Effect::Coulomb],
        Effect::Gap => &[Effect::Stiffness],
        _ => &[],
    }
}

/// Laws of several parameters that a law may have been taken for: those that contain it or one of its limits, and itself.
pub(crate) fn wider(effect: Effect) -> Vec<Effect> {
    let common = |other: Effect| limits(other).iter().any(|&l| l == effect || limits(effect).contains(&l));
    Effect::ALL
        .into_iter()
        .filter(|&other| other.parameters().len() > 1 && (other == effect || common(other)))
        .collect()
}

/// The simpler law whose parameters those of `source` all but are; none if it is no such.
pub(crate) fn simpler(source: &Source) -> Option<Source> {
    let p = &source.parameters;
    let near = |value: f64, limit: f64| (value - limit).abs() < CLOSE;
    let effect = match source.effect {
        Effect::Power if near(p[1], 0.0) => Effect::Coulomb,
        Effect::Power | Effect::Fractional if near(p[1], 1.0) => Effect::Viscous,
        Effect::Power if near(p[1], 2.0) => Effect::Quadratic,
        Effect::Fractional if near(p[1], 0.0) => Effect::Stiffness,
        Effect::Stribeck if near(p[1] / p[0], 1.0) => Effect::Coulomb,
        _ => return None,
    };
    Some(Source { effect, parameters: vec![p[0]], ..source.clone() })
}

/// Whether `source` is Coulomb friction by another name, which is always looked at beside it: a force that knows no speed,
/// or friction that does not fall from rest to sliding, as what a series of few harmonics leaves of a jump.
pub(crate) fn disguised(source: &Source) -> bool {
    let p = &source.parameters;
    match source.effect {
        Effect::Power => p[1] < CLOSE,
        Effect::Stribeck => p[1] <= p[0],
        _ => false,
    }
}

/// Whether an effect with these standard deviations of its parameters may be suggested where those of `excluded` may not: it
/// is none of them, nor a law that has one of them as a limit and a parameter that the data do not determine, which may be
/// the same by another name.
pub fn is_allowed(excluded: &[Source], source: &Source, deviations: &[f64]) -> bool {
    let out = |law: Effect| excluded.iter().any(|other| other.effect == law && other.place.is_same(&source.place));
    let undetermined = |(d, p): (&f64, &f64)| d.is_nan() || *d >= p.abs();
    let open = deviations.iter().zip(&source.parameters).any(undetermined);
    let disguise = open && limits(source.effect).iter().any(|&law| out(law));
    !(disguise || out(source.effect))
}

/// Whether the set `simple` differs from `set` in no more than laws that are limits of those in `set`, at the same places.
pub(crate) fn is_limit(simple: &[Source], set: &[Source]) -> bool {
    let stands = |a: &Source, b: &Source| {
        a.place.is_same(&b.place) && (a.effect == b.effect || limits(b.effect).contains(&a.effect))
    };
    simple.len() == set.len() && simple.iter().zip(set).all(|(a, b)| stands(a, b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::Place;

    #[test]
    fn what_may_hide_behind_a_law_contains_it_or_shares_a_limit() {
        assert_eq!(wider(Effect::Quadratic), [Effect::Power]);
        assert!(wider(Effect::Coulomb).contains(&Effect::Stribeck) && wider(Effect::Stribeck).contains(&Effect::Iwan));
        assert!(wider(Effect::Mass).is_empty());
    }

    #[test]
    fn what_is_excluded_does_not_come_back_by_another_name() {
        let at = |dof, effect, parameters: &[f64]| Source::known(effect, Place::Dofs(vec![dof]), parameters);
        let excluded = [at(6, Effect::Coulomb, &[1.0])];
        let falls = [0.2, 0.3, 0.05];
        assert!(!is_allowed(&excluded, &at(6, Effect::Coulomb, &[0.2]), &[0.01]));
        assert!(!is_allowed(&excluded, &at(6, Effect::Stribeck, &falls), &[0.01, 0.4, 0.01]));
        assert!(is_allowed(&excluded, &at(6, Effect::Stribeck, &falls), &[0.01, 0.02, 0.01]));
        assert!(is_allowed(&excluded, &at(4, Effect::Stribeck, &falls), &[0.01, 0.4, 0.01]));
        assert!(is_allowed(&excluded, &at(6, Effect::Viscous, &[0.2]), &[0.3]));
    }

    #[test]
    fn powers_next_to_whole_numbers_pose_as_other_laws() {
        let power = |e: f64| Source::known(Effect::Power, Place::Dofs(vec![0]), &[1.0, e]);
        let limit = |e: f64| simpler(&power(e)).map(|s| s.effect);
        assert_eq!([0.002, 0.99, 1.98].map(limit), [Effect::Coulomb, Effect::Viscous, Effect::Quadratic].map(Some));
        assert!([0.5, 1.5, 2.5].iter().all(|&e| limit(e).is_none()));
        assert!(!limits(Effect::Power).is_empty());
    }
}
