//! Sources: checks and their messages.

use dashpot::effects::{Effect, Place, Source, State};

fn dofs(rows: &[usize]) -> Place {
    Place::Dofs(rows.to_vec())
}

fn message(effect: Effect, place: Place, state: State, values: &[(&str, f64)]) -> String {
    Source::named(effect, place, state, values).unwrap_err().to_string()
}

#[test]
fn parameters_are_taken_by_name() {
    let given = [("force", 2.0), ("stiffness", 1e5)];
    let known = Source::named(Effect::ElasticSlider, dofs(&[1]), State::Known, &given).unwrap();
    assert_eq!(known, Source::known(Effect::ElasticSlider, dofs(&[1]), &[1e5, 2.0]));
    let candidate = Source::named(Effect::Gap, dofs(&[1, 2]), State::Candidate, &[("gap", 2e-3), ("stiffness", 7.0)]);
    assert_eq!(candidate.unwrap().parameters, [1.0, 2e-3]);
    let off = Source::named(Effect::Viscous, dofs(&[1, 2]), State::Off, &[("c", 7.0)]).unwrap();
    assert_eq!(off.coefficient(), 7.0);
}

#[test]
fn messages_say_what_is_wrong_and_how_to_mend_it() {
    let cases = [
        (
            message(Effect::Gap, dofs(&[0]), State::Known, &[("stifness", 1.0)]),
            "law `gap` has no parameter `stifness`: it takes `stiffness`, `gap`",
        ),
        (
            message(Effect::Gap, dofs(&[0]), State::Known, &[("stiffness", 1.0)]),
            "law `gap` needs a value for `gap` [m] where it is known: add `gap = ...`",
        ),
        (
            message(Effect::Gap, dofs(&[0]), State::Known, &[("gap", 1.0), ("gap", 2.0)]),
            "parameter `gap` of law `gap` is given twice: leave one out",
        ),
        (
            message(Effect::Viscous, dofs(&[0]), State::Known, &[("c", -1.0)]),
            "`c = -1` of law `viscous` is out of range: it must be at least 0 N s/m",
        ),
        (
            message(Effect::Fractional, dofs(&[0]), State::Candidate, &[("order", 1.0)]),
            "`order = 1` of law `fractional` is out of range: it must be above 0 and below 1",
        ),
        (
            message(Effect::Iwan, dofs(&[0]), State::Candidate, &[("chi", -1.0)]),
            "`chi = -1` of law `iwan` is out of range: it must be above -1 and at most 0",
        ),
        (
            message(Effect::Mass, dofs(&[0]), State::Known, &[("mass", f64::NAN)]),
            "`mass = NaN` of law `mass` is out of range: it must be a finite number kg",
        ),
        (
            message(Effect::Viscous, dofs(&[3, 4, 4]), State::Candidate, &[]),
            "entries 2 and 3 of `dofs` of law `viscous` are the same DOF: name two different ones",
        ),
        (
            message(Effect::Viscous, Place::Whole(None), State::Candidate, &[]),
            "law `viscous` acts on a relative motion: give `dofs`, one for the ground, two for a pair, more for a chain",
        ),
        (
            message(Effect::LossFactor, dofs(&[1]), State::Candidate, &[]),
            "law `loss_factor` acts on the whole structure: leave `dofs` out (`elements = [first, last]` restricts it)",
        ),
        (
            message(Effect::Delay, dofs(&[1]), State::Candidate, &[]),
            "`delay` is an error of a measuring channel: write it under [[sensor]] with `channel`",
        ),
    ];
    for (found, wanted) in cases {
        assert_eq!(found, wanted);
    }
    assert!(Source::named(Effect::Viscous, dofs(&[]), State::Candidate, &[]).is_err());
    assert!(Source::named(Effect::Delay, Place::Channel("acc@7".into()), State::Known, &[("delay", 1e-4)]).is_ok());
    assert!(Source::known(Effect::Gap, dofs(&[1]), &[1.0]).check().is_err());
}
