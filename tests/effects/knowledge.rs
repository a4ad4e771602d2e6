//! What laws say of themselves beside their force, against the force itself: odd or not, limits, exponents, start grids,
//! what solvers are told of friction and of infinite slopes.

use super::{cases, rich, sampled};
use dashpot::effects::{Constant, Effect, ForcePart, Kind, Manner, Motion, Place, Range, Source};
use faer::c64;

fn scale(force: &[f64]) -> f64 {
    force.iter().fold(1e-300, |most, f| f.abs().max(most))
}

/// The opposite motion is answered by the opposite force by odd laws, and only by them.
#[test]
fn odd_laws_answer_the_opposite_motion_by_the_opposite_force() {
    let (motion, harmonics) = (rich(300), rich(300).harmonics);
    let opposite: Vec<c64> = harmonics.iter().map(|d| -d).collect();
    let opposite = Motion::new(motion.omega, -motion.mean, &opposite, 300);
    for (effect, law, p) in cases() {
        let (there, back) = (sampled(law, &p, &motion), sampled(law, &p, &opposite));
        let most = there.iter().zip(&back).fold(0.0_f64, |most, (a, b)| most.max((a + b).abs()));
        assert_eq!(most < 1e-9 * scale(&there), law.description().odd, "{effect} {p:?}: {most}");
    }
}

/// `F(s p) = s F(p)` for the parameters that are said to share a factor.
#[test]
fn the_scaled_parameters_carry_a_common_factor() {
    let motion = rich(200);
    for (effect, law, p) in cases() {
        let mut doubled = p.clone();
        effect.scaled().iter().for_each(|&k| doubled[k] *= 2.0);
        let (once, twice) = (sampled(law, &p, &motion), sampled(law, &doubled, &motion));
        for (a, b) in once.iter().zip(&twice) {
            assert!((2.0 * a - b).abs() < 1e-9 * scale(&twice), "{effect} {p:?}");
        }
    }
}

fn range() -> Range {
    Range::of(&[Motion::cosine(60.0, 1e-3, 64), Motion::cosine(80.0, 4e-4, 64)])
}

/// Where a limit is said to hold, the force on motions of the range is that of the simpler law there.
#[test]
fn limits_are_the_simpler_law_where_they_hold() {
    // (law, parameters at its limit, the simpler law, relative difference of the forces that the closeness allows)
    let table: &[(Effect, &[f64], Effect, f64)] = &[
        (Effect::Power, &[2.0, 0.01], Effect::Coulomb, 0.06),
        (Effect::Power, &[2.0, 0.98], Effect::Viscous, 0.1),
        (Effect::Power, &[2.0, 2.01], Effect::Quadratic, 0.1),
        (Effect::Fractional, &[3.0, 0.99], Effect::Viscous, 0.06),
        (Effect::Fractional, &[3.0, 0.004], Effect::Stiffness, 0.05),
        (Effect::Stribeck, &[2.0, 2.04, 0.02], Effect::Coulomb, 0.03),
        (Effect::Maxwell, &[1e5, 10.0], Effect::Viscous, 0.03),
        (Effect::Maxwell, &[10.0, 100.0], Effect::Stiffness, 0.03),
        (Effect::Gap, &[500.0, 1e-5], Effect::Stiffness, 0.03),
        (Effect::ElasticSlider, &[1e3, 2.0], Effect::Stiffness, 1e-12),
        (Effect::ElasticSlider, &[1e8, 2.0], Effect::Coulomb, 0.08),
        (Effect::Iwan, &[1e3, 1e3, -0.5, 1.0], Effect::Stiffness, 0.05),
        (Effect::Iwan, &[1e9, 2.0, -0.5, 1.0], Effect::Coulomb, 0.08),
        (Effect::Iwan, &[1e4, 2.0, -0.5, 99.0], Effect::ElasticSlider, 0.03),
        (Effect::BoucWen, &[1e3, 10.0, 2.0], Effect::Stiffness, 0.03),
        (Effect::BoucWen, &[1e9, 2.0, 2.0], Effect::Coulomb, 0.08),
        (Effect::BoucWen, &[1e4, 2.0, 40.0], Effect::ElasticSlider, 0.03),
        (Effect::StiffeningBoucWen, &[1e3, 50.0, 0.5], Effect::Stiffness, 0.03),
        (Effect::Dahl, &[1e3, 50.0], Effect::Stiffness, 0.03),
        (Effect::Dahl, &[1e9, 2.0], Effect::Coulomb, 0.08),
        (Effect::ElasticSliderBacklash, &[1e4, 2.0, 2e-5], Effect::ElasticSlider, 0.05),
        (Effect::ElasticSliderBacklash, &[1e3, 2.0, 4e-4], Effect::Gap, 1e-9),
        (Effect::AsymmetricViscous, &[2.0, 2.03], Effect::Viscous, 0.02),
        (Effect::AsymmetricCoulomb, &[2.0, 0.04], Effect::Coulomb, 0.03),
    ];
    for &(effect, p, simple, tolerance) in table {
        let source = Source::known(effect, Place::Dofs(vec![0]), p);
        let found = source.simpler(&range()).unwrap_or_else(|| panic!("{effect} {p:?} is no {simple}"));
        assert_eq!((found.effect, &found.place), (simple, &source.place), "{effect} {p:?}");
        for motion in [Motion::cosine(60.0, 1e-3, 400), Motion::cosine(80.0, 4e-4, 400)] {
            let a = sampled(effect.law().unwrap(), p, &motion);
            let b = sampled(simple.law().unwrap(), &found.parameters, &motion);
            let mean = a.iter().zip(&b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
            let size = b.iter().map(|b| b * b).sum::<f64>().sqrt();
            assert!(mean < tolerance * size.max(1e-300) * 2.0, "{effect} {p:?}: {} of {simple}", mean / size);
        }
    }
    let listed = |effect: Effect, limit: Effect| table.iter().any(|row| row.0 == effect && row.2 == limit);
    for (effect, limit) in Effect::ALL.into_iter().flat_map(|e| e.limits().map(move |l| (e, l))) {
        let never = (effect, limit) == (Effect::Fractional, Effect::Hysteretic);
        assert!(never || listed(effect, limit), "the limit of {effect} that is {limit} is not tested");
    }
    // Values away from every limit are no simpler law, and of motions that nobody knows only pure numbers tell.
    for (effect, _, p) in cases().into_iter().filter(|case| case.0 == Effect::Maxwell || case.0 == Effect::Gap) {
        assert!(Source::known(effect, Place::Dofs(vec![0]), &p).simpler(&Range::UNKNOWN).is_none());
    }
}

#[test]
fn nested_laws_are_known() {
    assert_eq!(Effect::Quadratic.generalisations(), [Effect::Power]);
    assert!(
        Effect::Coulomb.generalisations().contains(&Effect::Stribeck)
            && Effect::Stribeck.generalisations().contains(&Effect::Iwan)
    );
    assert!(Effect::Mass.generalisations().is_empty());
    assert!(Effect::Iwan.contains(Effect::ElasticSlider) && !Effect::ElasticSlider.contains(Effect::Iwan));
    for effect in Effect::ALL {
        assert!(!effect.contains(effect), "{effect}");
        let fewer = |limit: Effect| limit.parameters().len() < effect.parameters().len();
        assert!(effect.limits().all(fewer), "{effect}: a limit is plainer");
    }
    let named = |effect, p: &[f64]| Source::known(effect, Place::Dofs(vec![0]), p).is_disguised();
    assert!(named(Effect::Power, &[1.0, 0.01]) && !named(Effect::Power, &[1.0, 0.5]));
    assert!(named(Effect::Stribeck, &[1.0, 0.9, 0.1]) && !named(Effect::Stribeck, &[1.0, 1.5, 0.1]));
}

/// The powers that a law states are those of its force on one harmonic.
#[test]
fn exponents_are_those_of_the_force() {
    for (effect, law, p) in cases() {
        let Some(stated) = effect.exponents(&p) else { continue };
        let equivalent = |amplitude: f64, omega: f64| {
            let motion = Motion::cosine(omega, amplitude, 4096);
            let force = sampled(law, &p, &motion);
            let mut first = [c64::new(0.0, 0.0)];
            dashpot::effects::Sampling::new(4096).analyse(&force, &mut first);
            let ratio = first[0] / amplitude;
            let value = if stated.part == ForcePart::Damping { ratio.im / omega } else { ratio.re };
            value.abs().ln()
        };
        let (x, w) = (5e-4, 60.0);
        let by_amplitude = (equivalent(1.1 * x, w) - equivalent(x, w)) / 1.1_f64.ln();
        let by_frequency = (equivalent(x, 1.1 * w) - equivalent(x, w)) / 1.1_f64.ln();
        assert!((by_amplitude - stated.amplitude).abs() < 1e-3, "{effect} {p:?}: {by_amplitude}");
        assert!((by_frequency - stated.frequency).abs() < 1e-3, "{effect} {p:?}: {by_frequency}");
    }
}

/// Fits start from parameters that the law allows, of unit scale, and more than one where shapes differ.
#[test]
fn start_grids_lie_within_the_limits() {
    for (effect, _) in Effect::relative() {
        let grid = effect.shapes(&range());
        let shaping = effect.parameters().len() > effect.scaled().len();
        assert!(!grid.is_empty() && (!shaping || grid.len() > 3), "{effect}: {} shapes", grid.len());
        for p in grid {
            assert_eq!((p.len(), p[effect.scaled()[0]]), (effect.parameters().len(), 1.0), "{effect}");
            assert!(effect.parameters().iter().zip(&p).all(|(q, &v)| q.allows(v)), "{effect} {p:?}");
        }
    }
}

/// Friction holds its own force, and a stuck joint agrees with every bound above its force.
#[test]
fn friction_holds_its_own_force() {
    let motion = rich(240);
    let mut tried = 0;
    for (effect, law, p) in cases().into_iter().filter(|case| case.1.manner(&case.2) == Manner::SetValued) {
        let friction = law.set_valued().unwrap();
        for (f, v) in sampled(law, &p, &motion).iter().zip(&motion.velocity) {
            assert!((friction.held(&p, *f, *v, 40.0) - f).abs() < 1e-9, "{effect} {p:?} at {v} m/s");
        }
        let [low, high] = friction.bounds(&p);
        for share in [0.1, 0.5, 0.9] {
            let force = low + share * (high - low);
            assert!((friction.held(&p, force, 0.0, 40.0) - force).abs() < 1e-12, "{effect} {p:?}");
        }
        let step = 1e-6;
        for k in 0..p.len() {
            let moved = |change: f64| {
                let mut p = p.clone();
                p[k] += change;
                p
            };
            for v in [-0.03, 0.07] {
                let slope =
                    (friction.smooth_part(&p, v + step)[0] - friction.smooth_part(&p, v - step)[0]) / (2.0 * step);
                assert!((slope - friction.smooth_part(&p, v)[1]).abs() < 1e-5 * (1.0 + slope.abs()), "{effect} {p:?}");
                let smooth_force = |change: f64| friction.smooth_part(&moved(change), v)[0];
                let by = (smooth_force(step) - smooth_force(-step)) / (2.0 * step);
                assert!((by - friction.smooth_part_by(&p, k, v)).abs() < 1e-5 * (1.0 + by.abs()), "{effect} {p:?} {k}");
            }
            for side in 0..2 {
                let by = (friction.bounds(&moved(step))[side] - friction.bounds(&moved(-step))[side]) / (2.0 * step);
                assert!((by - friction.bounds_by(&p, k)[side]).abs() < 1e-6, "{effect} {p:?} {k}");
            }
        }
        tried += 1;
    }
    assert!(tried >= 6);
}

/// The speed at which a steep law meets a line of slope `-r`, its slope and its derivative by the parameters.
#[test]
fn steep_laws_are_met_by_lines() {
    for (effect, law, p) in cases().into_iter().filter(|case| case.1.manner(&case.2) == Manner::Steep) {
        let steep = law.steep().unwrap();
        for (r, s) in [(3.0, 0.4), (40.0, 2.0), (0.1, 5.0)] {
            let v = steep.speed(&p, r, s);
            let point = law.point(&p, 0.0, v).unwrap();
            assert!((point.force + r * v - s).abs() < 1e-10 * s, "{effect} {p:?}");
            assert!((point.by_velocity - steep.slope(&p, v)).abs() < 1e-9 * point.by_velocity, "{effect} {p:?}");
        }
        assert!(steep.slope(&p, 0.0).is_infinite() && steep.speed(&p, 2.0, 0.0) == 0.0);
    }
}

/// Roles: the matrix to which a law adds is the one that its dynamic stiffness shows.
#[test]
fn constant_laws_are_their_matrix() {
    for (effect, law) in Effect::relative() {
        let Some(constant) = effect.constant() else { continue };
        for omega in [3.0, 50.0] {
            let wanted = match constant {
                Constant::Mass => c64::new(-omega * omega, 0.0),
                Constant::Viscous => c64::new(0.0, omega),
                Constant::Stiffness => c64::new(1.0, 0.0),
                Constant::Hysteretic => c64::new(0.0, 1.0),
            };
            assert_eq!(law.dynamic_stiffness(&[1.0], omega), Some(wanted), "{effect}");
        }
    }
    let held = |effect: Effect| effect.element();
    assert_eq!([Effect::Viscous, Effect::Stiffness].map(held), [Some(Constant::Viscous), Some(Constant::Stiffness)]);
    assert_eq!([Effect::Coulomb, Effect::LossFactor, Effect::MassProportional].map(held), [None; 3]);
    let place = Place::Dofs(vec![1, 2]);
    assert_eq!(Source::known(Effect::Iwan, place.clone(), &[1.0; 4]).unit_dashpot(), Source::dashpot(vec![1, 2], 1.0));
    let whole = Source::known(Effect::LossFactor, Place::Whole(None), &[0.1]);
    assert_eq!(whole.unit_dashpot().effect, Effect::StiffnessProportional);
}

/// Every law has a symbol, and an example that it allows.
#[test]
fn every_law_has_a_symbol_and_an_example() {
    for effect in Effect::ALL {
        assert!(!effect.description().symbol.is_empty(), "{effect}");
    }
    for (effect, _) in Effect::relative() {
        let example = effect.description().example;
        assert_eq!(example.len(), effect.parameters().len(), "{effect}");
        assert!(effect.parameters().iter().zip(example).all(|(q, &v)| q.allows(v)), "{effect}");
    }
    for effect in Effect::ALL {
        let Kind::Channel(law) = effect.kind() else { continue };
        let joined = law.joined(1.25, law.neutral());
        assert_eq!(joined, 1.25, "{effect}");
        let (a, b) = (law.transfer(1.25, 3.0) * law.transfer(0.5, 3.0), law.transfer(law.joined(1.25, 0.5), 3.0));
        assert!((a - b).norm() < 1e-14, "{effect}");
        assert_eq!((law.transfer(1.01, 3.0).norm() - 1.0).abs() < 1e-12, law.turns_phase(), "{effect}");
    }
}

/// Measured powers of the amplitude are compared with the plainest law of each.
#[test]
fn each_power_of_the_amplitude_has_its_plainest_law() {
    let damping = [(Effect::Coulomb, -1.0), (Effect::Viscous, 0.0), (Effect::Quadratic, 1.0)];
    assert_eq!(Effect::amplitude_powers(ForcePart::Damping), damping);
    let stiffness = [(Effect::Stiffness, 0.0), (Effect::CubicStiffness, 2.0)];
    assert_eq!(Effect::amplitude_powers(ForcePart::Stiffness), stiffness);
}
