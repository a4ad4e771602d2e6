//! What is said beside the answer, against brute force: sources that could stand in one another's place by least squares on every
//! subset of every exchanged set, warnings by energies in closed form.
#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::common::models::{candidate, five_masses, oscillator, receptance, source};
use crate::common::runs::{displacements_run, with_noise};
use crate::effects::Effect;
use crate::measurement::Run;
use crate::response::dynamic_stiffness::DynamicStiffness;
use faer::c64;
use nalgebra::{DMatrix, DVector};

/// Growth of chi-square up to which two sets are not told apart: two deviations.
const ALIKE: f64 = 4.0;

/// Least squared residual of non-negative coefficients of some columns: the least over all subsets whose least squares solution is
/// not negative.
fn least_of_subsets(system: &System, set: &[usize]) -> f64 {
    let b = DVector::from_column_slice(&system.b);
    let mut least = b.norm_squared();
    for subset in 1..1_usize << set.len() {
        let columns: Vec<usize> = (0..set.len()).filter(|k| subset >> k & 1 == 1).map(|k| set[k]).collect();
        let a = DMatrix::from_fn(b.len(), columns.len(), |i, j| system.a[(i, columns[j])]);
        let x = a.clone().svd(true, true).solve(&b, 1e-12).unwrap();
        if x.iter().all(|c| *c >= 0.0) {
            least = least.min((a * x - &b).norm_squared());
        }
    }
    least
}

/// Runs of the five masses with dashpots, driven at the first, near all resonances; all displacements with noise.
fn runs(truth: &[Source]) -> Vec<Run> {
    let structure = five_masses();
    let stiffness = DynamicStiffness::new(&structure, truth).unwrap();
    let modes = structure.modes().unwrap();
    let run = |r: usize| {
        let omega = modes.omega[r % 5] * [1.004, 0.993][r / 5];
        let mut force = vec![c64::new(0.0, 0.0); 5];
        force[0] = c64::new(1.0, 0.0);
        displacements_run(omega, (0, 1.0), &stiffness.solve(omega, &force).unwrap(), 0.0)
    };
    with_noise(&(0..10).map(run).collect::<Vec<Run>>(), 0.05, 3)
}

#[test]
fn sources_that_are_not_told_apart_are_those_of_brute_force() {
    let (structure, control) = (five_masses(), Control::unattended());
    let runs = runs(&[source(Effect::Viscous, &[1, 2], &[3.0]), source(Effect::Viscous, &[4], &[2.0])]);
    let mut sources: Vec<Source> = (0..5).map(|i| candidate(Effect::Viscous, &[i])).collect();
    sources.extend((0..4).map(|i| candidate(Effect::Viscous, &[i, i + 1])));
    sources.extend([[1, 3], [2, 4]].map(|dofs| candidate(Effect::Viscous, &dofs)));
    let settings = Settings { keep: 0, max_sources: 3, ..Settings::default() };
    let measured = Measurements { runs: &runs, transient_runs: &[], ratios: &[] };
    let problem = Problem::new(&structure, &sources, measured, &settings, &control).unwrap();
    let start = balanced_start(&problem, IdentificationState::start(&problem).unwrap(), &control).unwrap();
    let state = response_start(&problem, &start, &control).unwrap().unwrap();
    let found = passes(&problem, state, Form::Response, &control).unwrap();
    let (system, set) = (&found.system, &found.rankings[found.decision.accepted].best().columns);
    let old = least_of_subsets(system, set);
    let scale = (old / (system.rows() - set.len()) as f64).max(1.0);
    let mut expected = Vec::new();
    for (place, &own) in set.iter().enumerate() {
        for other in (0..problem.columns.len()).filter(|j| !set.contains(j)) {
            let mut exchanged = set.clone();
            exchanged[place] = other;
            let growth = (least_of_subsets(system, &exchanged) - old) / scale;
            if growth < ALIKE {
                expected.push((problem.column_source[own], problem.column_source[other], growth));
            }
        }
    }
    assert!(!expected.is_empty() && set.len() > 1, "the test's own numbers: {set:?}");
    let groups = collinear::groups(&problem, &found);
    let mut told: Vec<(usize, usize, f64)> = Vec::new();
    for group in &groups {
        assert!(group.others.windows(2).all(|pair| pair[0].1 <= pair[1].1), "{group:?}");
        told.extend(group.others.iter().map(|&(other, growth)| (group.source, other, growth)));
    }
    let by_number = |a: &(usize, usize, f64), b: &(usize, usize, f64)| (a.0, a.1).cmp(&(b.0, b.1));
    told.sort_by(by_number);
    expected.sort_by(by_number);
    assert_eq!(told.len(), expected.len(), "{told:?} for {expected:?}");
    for (told, expected) in told.iter().zip(&expected) {
        assert_eq!((told.0, told.1), (expected.0, expected.1));
        assert!((told.2 - expected.2).abs() < 1e-6 * (1.0 + expected.2.abs()), "{told:?} for {expected:?}");
    }
}

/// Once it is decided, sets of every larger size leave the accepted one as it is; and two sizes beyond it are looked at before.
#[test]
fn larger_sets_change_nothing_once_it_is_decided() {
    let (structure, control) = (five_masses(), Control::unattended());
    let runs = runs(&[source(Effect::Viscous, &[1, 2], &[3.0]), source(Effect::Viscous, &[4], &[2.0])]);
    let mut sources: Vec<Source> = (0..5).map(|i| candidate(Effect::Viscous, &[i])).collect();
    sources.extend((0..4).map(|i| candidate(Effect::Viscous, &[i, i + 1])));
    let settings = Settings { keep: 0, max_sources: 8, ..Settings::default() };
    let measured = Measurements { runs: &runs, transient_runs: &[], ratios: &[] };
    let problem = Problem::new(&structure, &sources, measured, &settings, &control).unwrap();
    let start = balanced_start(&problem, IdentificationState::start(&problem).unwrap(), &control).unwrap();
    let state = response_start(&problem, &start, &control).unwrap().unwrap();
    let found = passes(&problem, state, Form::Response, &control).unwrap();
    let all = &found.rankings;
    let pass = Pass { problem: &problem, state: &found.state, system: &found.system, form: Form::Response };
    let accepted = |n: usize| pass.decide(&all[..n]).accepted;
    let decided = |n: usize| pass.is_decided(&all[..n]);
    let first = (0..=all.len()).find(|&n| decided(n)).unwrap();
    assert!(first >= accepted(all.len()) + 3 && first < all.len(), "{first} of {}", all.len());
    assert!((first..=all.len()).all(|n| accepted(n) == accepted(all.len())));
}

/// A dashpot and drag at one place take out `pi c w a^2` and `8/3 c w^2 a^3` a cycle: the angle between the two columns of runs of
/// different force says whether they can be told apart.
#[test]
fn laws_are_said_to_be_alike_by_the_angle_of_their_energies() {
    let (mass, stiffness, dashpot, omega) = (2.0, 800.0, 4.0, 19.0);
    let sources = [candidate(Effect::Viscous, &[0]), candidate(Effect::Quadratic, &[0])];
    for louder in [1.001, 1.002, 1.005, 1.01, 1.3] {
        let forces = [1.0, louder, 1.0];
        let amplitudes = forces.map(|f| f * receptance(mass, stiffness, dashpot, omega).norm());
        let [linear, square] =
            [2, 3].map(|power| DVector::from_iterator(3, amplitudes.iter().map(|a: &f64| a.powi(power))));
        let angle = (linear.dot(&square) / (linear.norm() * square.norm())).min(1.0).acos().to_degrees();
        let runs =
            forces.map(|f| displacements_run(omega, (0, f), &[receptance(mass, stiffness, dashpot, omega) * f], 1e-6));
        let settings = Settings { max_sources: 1, ..Settings::default() };
        let outcome =
            identify(&oscillator(mass, stiffness), &sources, &runs, &settings, &Control::unattended()).unwrap();
        let warned = outcome.warnings.iter().any(|w| w.contains("cannot be told apart"));
        assert_eq!(warned, angle < 0.1, "{louder}: {angle} degrees, {:?}", outcome.warnings);
    }
}

/// A coefficient whose deviation is more than half of it is named with that share.
#[test]
fn uncertain_coefficients_are_those_whose_deviation_is_half_of_them() {
    let structure = five_masses();
    for value in [0.02, 0.2, 2.0] {
        let runs = runs(&[source(Effect::Viscous, &[1, 2], &[3.0]), source(Effect::Viscous, &[4], &[value])]);
        let forced =
            |dofs: &[usize]| Source { state: crate::effects::State::Forced, ..candidate(Effect::Viscous, dofs) };
        let sources = [forced(&[1, 2]), forced(&[4])];
        let outcome = identify(&structure, &sources, &runs, &Settings::default(), &Control::unattended()).unwrap();
        let expected: Vec<String> = (outcome.sources.iter())
            .filter(|e| e.coefficient > 0.0 && e.deviation > 0.5 * e.coefficient)
            .map(|e| format!("its standard deviation is {:.0} % of its value", 100.0 * e.deviation / e.coefficient))
            .collect();
        let told: Vec<&String> = outcome.warnings.iter().filter(|w| w.contains("its standard deviation is")).collect();
        assert_eq!(told.len(), expected.len(), "{told:?} for {expected:?}");
        assert!(told.iter().zip(&expected).all(|(told, expected)| told.ends_with(expected.as_str())), "{told:?}");
    }
}
