//! The samples with a hidden effect: what is named is what their truth holds.

use dashpot::control::Control;
use dashpot::diagnosis::Problem;
use dashpot::diagnosis::diagnose::diagnose;
use dashpot::diagnosis::result::{Diagnosis, Verdict};
use dashpot::effects::{Effect, Place};
use dashpot::exchange::project::load;
use std::path::Path;

fn diagnosis(name: &str) -> Diagnosis {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("sample-data").join(name).join("project.toml");
    let control = Control::unattended();
    let project = load(&path, &control).unwrap();
    let problem = Problem { structure: &project.structure, sources: &project.sources, runs: &project.runs };
    diagnose(&problem, &control).unwrap()
}

fn is_named(name: &str, effect: Effect, place: &Place, value: f64) {
    let diagnosis = diagnosis(name);
    let first = &diagnosis.suggestions[0].added;
    assert_eq!((first.source.effect, &first.source.place), (effect, place), "{name}");
    assert!((first.source.parameters[0] / value - 1.0).abs() < 0.01, "{name}: {:?}", first.source.parameters);
    assert_eq!(diagnosis.verdict, Verdict::Missing);
    let last = &diagnosis.steps[diagnosis.steps.len() - 1];
    assert!(last.error < 1.2 * diagnosis.noise_floor, "{name}: {} above {}", last.error, diagnosis.noise_floor);
}

#[test]
fn friction_of_the_cantilever() {
    is_named("cantilever-friction", Effect::Coulomb, &Place::Dofs(vec![12]), 0.15);
    let found = diagnosis("cantilever-friction");
    assert!((0.1..0.6).contains(&found.error_before), "{}", found.error_before);
    // With an offset that the data do not know it is the same.
    let wider = found.suggestions.iter().find(|s| s.added.source.effect == Effect::AsymmetricCoulomb);
    assert!(wider.is_none(), "{wider:?}");
}

#[test]
fn hardening_spring_of_the_five_masses() {
    is_named("five-masses-cubic", Effect::CubicStiffness, &Place::Dofs(vec![1]), 3e9);
}

#[test]
fn late_accelerometer() {
    is_named("cantilever-late-sensor", Effect::Delay, &Place::Channel("acc@9".into()), 1.2e-4);
}

#[test]
fn friction_and_a_wrong_mass_of_the_five_masses() {
    let diagnosis = diagnosis("five-masses-friction");
    let last = &diagnosis.steps[diagnosis.steps.len() - 1];
    let effects: Vec<Effect> = last.added.iter().map(|a| a.source.effect).collect();
    assert!(effects.contains(&Effect::Coulomb) && effects.contains(&Effect::Mass) && effects.len() == 2, "{effects:?}");
    assert!(last.error < 1.2 * diagnosis.noise_floor, "{} above {}", last.error, diagnosis.noise_floor);
    // The two masses stick to each other in most runs: friction is known from the few in which they slide.
    for added in &last.added {
        let (place, value) = if added.source.effect == Effect::Mass { (vec![1], 0.15) } else { (vec![3, 4], 2.0) };
        let (found, deviation) = (added.source.parameters[0], added.deviations[0]);
        assert_eq!(added.source.place, Place::Dofs(place));
        assert!((found - value).abs() < 3.0 * deviation && deviation < 0.01 * value, "{found} +- {deviation}");
    }
}
