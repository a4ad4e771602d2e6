//! What turns all motions together against the force: an AC-coupled measuring chain, and a force that is recorded late. The truth is in closed
//! form: `(K (1 + i eta) - w^2 M) X = F` solved by elimination, the high-pass as its circuit of a resistor and a capacitor.

use crate::common::models::{three_masses, whole};
use crate::common::runs::{displacements_run, with_noise};
use dashpot::control::Control;
use dashpot::diagnosis::result::Verdict;
use dashpot::diagnosis::{Diagnosis, Problem, diagnose};
use dashpot::effects::{Effect, Place};
use dashpot::measurement::Run;
use faer::c64;
use std::f64::consts::TAU;

const LOSS: f64 = 0.02;
const FORCE: f64 = 2.0;
const NOISE: f64 = 3e-4;
/// Springs of `three_masses` (N/m): to the ground, and between neighbours; masses are 1 kg.
const SPRINGS: [f64; 3] = [2e4, 1e4, 1.5e4];

/// Displacements under a force on the last mass (tridiagonal elimination from the first).
fn motion(omega: f64) -> [c64; 3] {
    let k = SPRINGS.map(|k| c64::new(k, LOSS * k));
    let inertia = c64::new(omega * omega, 0.0);
    let first = k[0] + k[1] - inertia;
    let second = k[1] + k[2] - inertia - k[1] * k[1] / first;
    let third = k[2] - inertia - k[2] * k[2] / second;
    let last = c64::new(FORCE, 0.0) / third;
    let middle = k[2] * last / second;
    [k[1] * middle / first, middle, last]
}

/// Five runs about each of the three modes, what is recorded being `chain` times what was there.
fn runs(chain: impl Fn(f64) -> c64) -> Vec<Run> {
    let structure = three_masses([1.0; 3]);
    let modes = structure.modes().unwrap();
    let about = |omega: &f64| [0.97, 0.99, 1.0, 1.01, 1.03].map(|share| share * omega);
    let frequencies: Vec<f64> = modes.omega.iter().flat_map(about).collect();
    let recorded = |omega: &f64| displacements_run(*omega, (2, FORCE), &motion(*omega).map(|x| x * chain(*omega)), 0.0);
    with_noise(&frequencies.iter().map(recorded).collect::<Vec<_>>(), NOISE, 5)
}

fn diagnosed(runs: &[Run]) -> Diagnosis {
    let (structure, sources) = (three_masses([1.01, 0.99, 1.0]), [whole(Effect::LossFactor, LOSS)]);
    diagnose(&Problem { structure: &structure, sources: &sources, runs }, &Control::unattended()).unwrap()
}

/// An AC-coupled chain is no model out of tune, and no law of the structure gives it: what is told is that all motions are turned together,
/// or the delay that comes next to it.
#[test]
fn an_ac_coupled_chain_is_no_model_out_of_tune() {
    let corner = 1.5;
    let circuit = |omega: f64| c64::new(0.0, omega) / c64::new(TAU * corner, omega);
    let diagnosis = diagnosed(&runs(circuit));
    assert!(!matches!(diagnosis.verdict, Verdict::Detuned | Verdict::Adequate), "{:?}", diagnosis.verdict);
    let likely = diagnosis.suggestions.iter().filter(|s| s.probability > 0.5);
    let of_structure: Vec<_> = likely.filter(|s| !matches!(s.added.source.place, Place::Channel(_))).collect();
    assert!(of_structure.is_empty(), "{of_structure:?}");
}

#[test]
fn a_force_that_is_recorded_late_is_told_with_its_delay() {
    let delay = 1.2e-3;
    let diagnosis = diagnosed(&runs(|omega| c64::from_polar(1.0, delay * omega)));
    assert_eq!(diagnosis.verdict, Verdict::Missing);
    let first = &diagnosis.suggestions[0].added.source;
    assert_eq!((first.effect, &first.place), (Effect::Delay, &Place::Channel("force@3".into())));
    assert!((first.parameters[0] / delay - 1.0).abs() < 0.02, "{first:?}");
}

/// Motions that are turned together in one band are no model out of tune; a chain as it should be turns nothing.
#[test]
fn motions_turned_together_are_not_told_as_a_model_out_of_tune() {
    let turned = |omega: f64| c64::from_polar(1.0, if omega > 120.0 { 0.15 } else { 0.0 });
    let diagnosis = diagnosed(&runs(turned));
    assert!(!matches!(diagnosis.verdict, Verdict::Detuned | Verdict::Adequate), "{:?}", diagnosis.verdict);
    let sound = diagnosed(&runs(|_| c64::new(1.0, 0.0)));
    assert!(sound.common_factors.is_empty(), "{:?}", sound.common_factors);
}
