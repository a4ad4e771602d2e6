//! The classical methods on whole frequency responses: a chain whose modes are known in closed form, with a damping of its own for
//! every mode, viscous or hysteretic, on a fine grid.

use dashpot::classical::FrequencyResponses;
use dashpot::classical::measured_ratios::{circle_ratios, half_power_ratios};
use dashpot::classical::poly_reference::extract;
use dashpot::cli::answer;
use dashpot::control::Control;
use dashpot::exchange::Project;
use dashpot::exchange::project::load;
use faer::c64;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use serde_json::Value;
use std::f64::consts::{PI, TAU};
use std::path::Path;
use uff::{Axis, Dof, Function, FunctionKind, Set, Values};

/// Masses of 1 kg between springs of `STIFFNESS`, both ends at a wall.
const MASSES: usize = 6;
const STIFFNESS: f64 = 1e5;
const RATIOS: [f64; MASSES] = [0.004, 0.006, 0.01, 0.008, 0.012, 0.009];
const DRIVES: [usize; 2] = [1, 3];
/// Lines from 5 Hz on, 1/40 Hz apart.
const LINES: usize = 4401;
const STEP_HZ: f64 = 0.025;

/// `w_j = 2 sqrt(k / m) sin(j pi / 2 (n + 1))`.
fn natural(j: usize) -> f64 {
    2.0 * STIFFNESS.sqrt() * (j as f64 * PI / (2.0 * (MASSES + 1) as f64)).sin()
}

/// `phi_ij = sqrt(2 / (n + 1)) sin(i j pi / (n + 1))`, modal masses 1.
fn shape(i: usize, j: usize) -> f64 {
    let n = (MASSES + 1) as f64;
    (2.0 / n).sqrt() * ((i * j) as f64 * PI / n).sin()
}

fn receptance(omega: f64, [i, k]: [usize; 2], hysteretic: bool) -> c64 {
    let term = |j: usize| {
        let (natural, ratio) = (natural(j), RATIOS[j - 1]);
        let loss = if hysteretic { natural * natural } else { natural * omega };
        c64::new(shape(i, j) * shape(k, j), 0.0) / c64::new(natural * natural - omega * omega, 2.0 * ratio * loss)
    };
    (1..=MASSES).map(term).sum()
}

/// A Universal File of all responses to the drives, with noise of this share of the largest value of each, and its project.
fn measured(folder: &Path, noise: f64, hysteretic: bool) -> Project {
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(3);
    let mut gauss = || -> f64 { StandardNormal.sample(&mut random) };
    let axis =
        |quantity: i64, unit: &str| Axis { quantity, exponents: [0; 3], label: String::new(), unit: unit.into() };
    let mut sets = Vec::new();
    for drive in DRIVES {
        for sensor in 1..=MASSES {
            let on_line = |k: usize| receptance(TAU * (5.0 + STEP_HZ * k as f64), [sensor, drive], hysteretic);
            let clean: Vec<c64> = (0..LINES).map(on_line).collect();
            let size = noise / 2f64.sqrt() * clean.iter().map(|h| h.norm()).fold(0.0, f64::max);
            let values = clean.iter().map(|h| [h.re + size * gauss(), h.im + size * gauss()]).collect();
            let dofs = [sensor, drive].map(|mass| Dof::new(mass as i64, 3));
            let [response, reference] = dofs;
            let kind = FunctionKind::FrequencyResponse;
            let mut one = Function::even(kind, response, reference, 5.0, STEP_HZ, Values::Complex(values));
            one.header.abscissa = axis(18, "Hz");
            one.header.ordinate = axis(8, "m");
            one.header.denominator = axis(13, "N");
            sets.push(Set::Function(one));
        }
    }
    std::fs::write(folder.join("test.uff"), uff::to_bytes(&sets).unwrap()).unwrap();
    let dofs: String = (1..=MASSES).map(|mass| format!("\"{mass}:+Z\" = {mass}\n")).collect();
    let ends: Vec<String> =
        (1..=MASSES).map(|mass| format!("{:?}", if [1, MASSES].contains(&mass) { STIFFNESS } else { 0.0 })).collect();
    let text = format!(
        "[project]\nformat = 1\ntitle = \"test\"\n[structure]\nkind = \"chain\"\nmasses = {:?}\nground_stiffness = [{}]\n\
         coupling_stiffness = {:?}\n[[candidates]]\nlaw = \"viscous\"\nwhere = \"each-translation\"\n\
         [[frf]]\nfile = \"test.uff\"\n[frf.dofs]\n{dofs}",
        [1.0; MASSES],
        ends.join(", "),
        [STIFFNESS; MASSES - 1]
    );
    std::fs::write(folder.join("project.toml"), text).unwrap();
    load(&folder.join("project.toml"), &Control::unattended()).unwrap()
}

/// Frequencies (Hz) and ratios of a list of modes.
fn modes(list: &Value) -> Vec<(f64, f64)> {
    let number = |mode: &Value, key: &str| mode[key].as_f64().unwrap();
    list.as_array().unwrap().iter().map(|mode| (number(mode, "frequency_hz"), number(mode, "damping_ratio"))).collect()
}

#[test]
fn every_mode_is_right_to_one_per_cent_without_noise() {
    for hysteretic in [false, true] {
        let folder = tempfile::tempdir().unwrap();
        let project = measured(folder.path(), 0.0, hysteretic);
        assert!(project.runs.len() <= 96);
        let path = folder.path().join("project.toml").display().to_string();
        let text = answer(["dashpot", "methods", "--json", path.as_str()].map(Into::into)).unwrap();
        let found: Value = serde_json::from_str(&text).unwrap();
        let modes_by = |name: &str| {
            let methods = found["methods"].as_array().unwrap();
            methods.iter().find(|method| method["method"] == name).map(|method| modes(&method["modes"])).unwrap()
        };
        let lists = [
            modes(&found["complex_modes"]),
            modes_by("half-power"),
            modes_by("circle-fit"),
            modes_by("hysteresis-loop"),
            modes_by("ibrahim"),
        ];
        for (k, list) in lists.iter().enumerate() {
            assert_eq!(list.len(), MASSES, "{k}: {list:?}");
            for (j, (hz, ratio)) in list.iter().enumerate() {
                let [by_hz, by_ratio] = [TAU * hz / natural(j + 1) - 1.0, ratio / RATIOS[j] - 1.0];
                assert!(by_hz.abs() < 1e-3, "{k}, hysteretic {hysteretic}, mode {}: {by_hz:.1e}", j + 1);
                assert!(by_ratio.abs() < 0.01, "{k}, hysteretic {hysteretic}, mode {}: {by_ratio:.1e}", j + 1);
            }
        }
    }
}

#[test]
fn every_mode_is_right_to_three_deviations_with_noise() {
    for hysteretic in [false, true] {
        let folder = tempfile::tempdir().unwrap();
        let project = measured(folder.path(), 0.003, hysteretic);
        let responses = FrequencyResponses::from_runs(&project.runs).unwrap();
        assert_eq!((responses.omega.len(), responses.sensors.len(), responses.drives.len()), (LINES, MASSES, 2));
        let extraction = extract(&responses, &Control::unattended()).unwrap();
        assert_eq!(extraction.modes.len(), MASSES);
        for (j, mode) in extraction.modes.iter().enumerate() {
            let truth = RATIOS[j];
            let deviation = mode.deviation / mode.pole.norm();
            assert!((mode.damping_ratio() - truth).abs() < 3.0 * deviation, "mode {}: {mode:?}", j + 1);
            assert!(deviation < 0.05 * truth, "mode {}: {deviation:.1e}", j + 1);
        }
        let model = project.structure.modes().unwrap();
        let half_power = half_power_ratios(&model, &responses, &extraction.modes);
        let circle = circle_ratios(&model, &responses, &extraction.modes);
        for list in [half_power, circle] {
            assert_eq!(list.len(), MASSES, "{list:?}");
            for (j, ratio) in list.iter().enumerate() {
                let off = (ratio.ratio - RATIOS[j]).abs();
                assert!(off < 3.0 * ratio.deviation, "mode {}: {ratio:?}", j + 1);
                assert!(ratio.deviation < 0.1 * RATIOS[j], "mode {}: {ratio:?}", j + 1);
            }
        }
    }
}

/// Hits at every mass and one sensor: by reciprocity the shapes at all masses.
#[test]
fn a_roving_hammer_has_the_shapes_of_the_places_that_it_hits() {
    let folder = tempfile::tempdir().unwrap();
    let project = measured(folder.path(), 0.0, false);
    let mut runs = project.runs.clone();
    let functions = std::sync::Arc::make_mut(runs[0].functions.as_mut().unwrap());
    functions.functions.retain(|one| one.reference == 0);
    functions.functions.iter_mut().for_each(|one| std::mem::swap(&mut one.response, &mut one.reference));
    let responses = FrequencyResponses::from_runs(&runs[..1]).unwrap();
    assert_eq!((responses.sensors.len(), responses.drives), (MASSES, vec![0]));
}
