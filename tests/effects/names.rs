//! Names in files and the tables of parameters.

use dashpot::effects::{Effect, Kind};
use faer::c64;

#[test]
fn names_are_those_of_serde() {
    for effect in Effect::ALL {
        let text = serde_json::to_string(&effect).unwrap();
        assert_eq!(text, format!("\"{}\"", effect.name()));
        assert_eq!(serde_json::from_str::<Effect>(&text).unwrap(), effect);
        assert_eq!(Effect::from_name(effect.name()), Some(effect));
        assert_eq!(effect.to_string(), effect.name());
    }
    assert_eq!(Effect::from_name("duct_tape"), None);
}

#[test]
fn parameters_are_those_of_the_contract() {
    let names = |effect: Effect| effect.parameters().iter().map(|p| p.name).collect::<Vec<_>>().join(" ");
    let wanted = [
        "c",
        "force",
        "c",
        "c exponent",
        "loss_stiffness",
        "force static_force velocity",
        "stiffness force",
        "stiffness c",
        "stiffness force chi beta",
        "c order",
        "stiffness force exponent",
        "stiffness force loading",
        "stiffness force",
        "stiffness force backlash",
        "c_pull c_push",
        "force offset",
        "stiffness",
        "stiffness",
        "stiffness",
        "stiffness gap",
        "stiffness gap",
        "mass",
        "loss_factor",
        "beta",
        "alpha",
        "delay",
        "gain",
    ];
    for (effect, wanted) in Effect::ALL.into_iter().zip(wanted) {
        assert_eq!(names(effect), wanted, "{effect}");
        assert!(effect.parameters().iter().filter(|p| p.linear).count() <= 1);
        assert!(effect.parameters().iter().all(|p| p.allows(p.typical) && (!p.linear || p.typical == 1.0)), "{effect}");
    }
}

#[test]
fn linear_laws_and_lossless_laws_are_known() {
    let names = |keep: &dyn Fn(Effect) -> bool| {
        Effect::ALL.into_iter().filter(|&effect| keep(effect)).map(Effect::name).collect::<Vec<_>>().join(" ")
    };
    assert_eq!(
        names(&Effect::is_linear),
        "viscous hysteretic maxwell fractional stiffness mass loss_factor stiffness_proportional mass_proportional delay gain"
    );
    assert_eq!(
        names(&|effect| !effect.dissipates()),
        "stiffness cubic_stiffness quadratic_stiffness gap stop mass delay gain"
    );
    // In the tables every effect has its own title, formula and sentence.
    let formula = |effect: Effect| effect.description().formula;
    for text in [&Effect::noun as &dyn Fn(Effect) -> &'static str, &Effect::title, &formula, &Effect::sentence] {
        let all: std::collections::HashSet<_> = Effect::ALL.into_iter().map(text).collect();
        assert_eq!(all.len(), Effect::ALL.len());
    }
    assert_eq!([Effect::Viscous.noun(), Effect::Viscous.title()], ["viscous dashpot", "Viscous dashpot"]);
    assert_eq!([Effect::Iwan.noun(), Effect::Coulomb.title()], ["Iwan joint", "Coulomb friction"]);
}

/// Channel errors: the derivative is that of the transfer, and the neutral value changes nothing.
#[test]
fn channel_errors_have_their_derivative() {
    for effect in [Effect::Delay, Effect::Gain] {
        let Kind::Channel(law) = effect.kind() else { panic!("{effect} acts on a channel") };
        let (value, omega, step) = (1.3e-3, 400.0, 1e-7);
        let difference = (law.transfer(value + step, omega) - law.transfer(value - step, omega)) / (2.0 * step);
        assert!((difference - law.transfer_derivative(value, omega)).norm() < 1e-5, "{effect}");
        assert_eq!(law.transfer(law.neutral(), omega), c64::new(1.0, 0.0), "{effect}");
    }
    let Kind::Channel(delay) = Effect::Delay.kind() else { panic!("delay acts on a channel") };
    // Recorded 1 ms late: y(t) = cos(w (t - tau)) has the amplitude exp(-i w tau).
    assert!((delay.transfer(1e-3, 500.0) - c64::new(0.5_f64.cos(), -0.5_f64.sin())).norm() < 1e-15);
}

/// Whole-structure laws: which matrix, and the factor at 30 rad/s.
#[test]
fn whole_structure_laws_multiply_their_matrix() {
    use dashpot::effects::Basis;
    let wanted = [
        (Effect::LossFactor, Basis::Stiffness, 0.02),
        (Effect::StiffnessProportional, Basis::Stiffness, 0.6),
        (Effect::MassProportional, Basis::Mass, 0.6),
    ];
    for (effect, basis, imaginary) in wanted {
        let Kind::Whole(law) = effect.kind() else { panic!("{effect} acts on the whole structure") };
        assert_eq!(law.basis(), basis);
        assert!((law.factor(0.02, 30.0) - c64::new(0.0, imaginary)).norm() < 1e-15, "{effect}");
        assert_eq!(law.factor(0.02, 0.0), c64::new(0.0, 0.0), "{effect}");
    }
}
