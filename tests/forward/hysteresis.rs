//! Hysteresis with one internal force and laws that resist one direction more than the other: harmonic balance against
//! time stepping from rest, with the zeroth harmonic; stability; what the table of laws promises of each.

use super::support::{balanced, difference, five_masses, source, stepped, whole};
use dashpot::control::Control;
use dashpot::effects::{Effect, Source};
use dashpot::response::harmonic_balance::{Excitation, ForwardModel, Settings};
use dashpot::response::time_integration::TimeModel;
use faer::c64;
use std::f64::consts::TAU;

fn excitation() -> Excitation {
    Excitation::sine(TAU * 21.0, 4, c64::new(20.0, 0.0))
}

fn with(extra: Source) -> Vec<Source> {
    vec![whole(Effect::MassProportional, 1.0), whole(Effect::StiffnessProportional, 1e-5), extra]
}

/// Fundamental, another harmonic and the static offset of every mass, against stepping from rest.
fn agrees(name: &str, extra: Source, steps: usize, harmonic: usize) {
    let (structure, sources) = (five_masses(), with(extra));
    let response = balanced(&structure, &sources, &excitation(), &Settings::default());
    let reference = stepped(&structure, &sources, &excitation(), steps);
    let first = difference(&response, &reference, 1);
    assert!(first < 1e-3, "{name}: fundamental off by {first:.2e}");
    let other = difference(&response, &reference, harmonic);
    assert!(other < 1e-2, "{name}: harmonic {harmonic} off by {other:.2e}");
}

#[test]
fn smooth_hysteresis_on_the_five_masses() {
    agrees("bouc-wen", source(Effect::BoucWen, &[2], &[2e4, 5.0, 2.0]), 2000, 3);
    agrees("bouc-wen between two masses", source(Effect::BoucWen, &[1, 2], &[5e4, 4.0, 1.0]), 2000, 3);
    agrees("stiffening", source(Effect::StiffeningBoucWen, &[2], &[2e4, 5.0, 0.3]), 2000, 3);
    agrees("dahl", source(Effect::Dahl, &[2], &[2e4, 5.0]), 2000, 3);
    agrees("backlash", source(Effect::ElasticSliderBacklash, &[2], &[4e4, 5.0, 1e-4]), 4000, 3);
}

#[test]
fn asymmetric_laws_on_the_five_masses() {
    agrees("dashpot", source(Effect::AsymmetricViscous, &[2], &[60.0, 10.0]), 4000, 2);
    agrees("dashpot between two masses", source(Effect::AsymmetricViscous, &[1, 2], &[10.0, 90.0]), 4000, 2);
    agrees("friction", source(Effect::AsymmetricCoulomb, &[2], &[5.0, 2.0]), 4000, 3);
    agrees("half stuck", source(Effect::AsymmetricCoulomb, &[2], &[14.0, -3.0]), 8000, 3);
}

/// The mean of the motion over a period that time stepping has settled to is the zeroth harmonic, and the mean force of
/// the law carried by the static stiffness.
#[test]
fn mean_forces_shift_the_structure() {
    let structure = five_masses();
    let stiffness = structure.matrices().unwrap().stiffness.clone();
    for (extra, steps) in [
        (source(Effect::AsymmetricViscous, &[2], &[60.0, 10.0]), 2000),
        (source(Effect::AsymmetricCoulomb, &[2], &[5.0, 2.0]), 4000),
    ] {
        let (name, sources) = (extra.effect, with(extra));
        let response = balanced(&structure, &sources, &excitation(), &Settings::default());
        let force = response.forces.iter().find(|f| f.leg.first == 2).unwrap().mean;
        assert!(force.abs() > 0.1, "{name}: {force} N");
        for i in 0..5 {
            let carried: f64 = (0..5).map(|j| stiffness[(i, j)] * response.mean[j]).sum();
            let wanted = if i == 2 { -force } else { 0.0 };
            assert!((carried - wanted).abs() < 1e-8 * force.abs(), "{name}: {carried} N instead of {wanted}");
        }
        let mut model = TimeModel::new(&structure, &sources, &excitation(), steps).unwrap();
        model.start_from(&response);
        let mut mean = [0.0; 5];
        let settled = 40;
        for step in 0..(settled + 4) * steps {
            model.advance().unwrap();
            if step >= settled * steps {
                (0..5).for_each(|i| mean[i] += model.displacement(i) / (4 * steps) as f64);
            }
        }
        for i in 0..5 {
            let error = (mean[i] - response.mean[i]).abs();
            assert!(error < 5e-3 * response.mean[2].abs(), "{name}, mass {i}: {} and {}", mean[i], response.mean[i]);
        }
    }
}

/// Laws that are not odd put even harmonics into the motion; those that are do not.
#[test]
fn only_laws_that_are_not_odd_make_even_harmonics() {
    let structure = five_masses();
    for (effect, _) in Effect::relative() {
        let example: Vec<f64> = match effect {
            // At the size of these masses' forces and motions.
            Effect::AsymmetricViscous => vec![60.0, 10.0],
            Effect::QuadraticStiffness => vec![1e7],
            Effect::BoucWen => vec![2e4, 5.0, 3.0],
            Effect::StiffeningBoucWen => vec![2e4, 5.0, 0.3],
            Effect::Dahl => vec![2e4, 5.0],
            Effect::ElasticSliderBacklash => vec![4e4, 5.0, 1e-4],
            Effect::Stop => vec![3e4, 2e-4],
            _ => continue,
        };
        let sources = with(Source::known(effect, dashpot::effects::Place::Dofs(vec![2]), &example));
        let response = balanced(&structure, &sources, &excitation(), &Settings::default());
        let even = response.amplitude(2, 2).norm() > 1e-6 * response.amplitude(2, 1).norm();
        assert_eq!(even, !effect.description().odd, "{effect}");
    }
}

/// A response to a law with one internal force is stable, as time stepping from beside it shows.
#[test]
fn smooth_hysteresis_is_stable() {
    let (structure, sources) = (five_masses(), with(source(Effect::BoucWen, &[2], &[2e4, 5.0, 2.0])));
    let model = ForwardModel::new(&structure, &sources).unwrap();
    let run = model.at(excitation().omega);
    let branches = run.branches(&sources, &excitation(), &Settings::default(), &Control::unattended()).unwrap();
    assert!(branches.len() == 1 && branches[0].1);
}
