//! Two laws at one place, of which neither is the one that explains most by itself: a joint that slips and stiffens, measured as
//! laboratories do it, re-seated between the levels, beside a model 2 % too stiff. Truth: the program's own simulation.

use dashpot::cli::answer;
use serde_json::Value;
use std::path::Path;

const STIFFNESS: f64 = 508_469.5;
/// Stiffness of each level beyond that, relative, and its force, N.
const LEVELS: [(f64, f64); 4] = [(0.0, 0.19), (0.0015, 0.5), (-0.001, 1.0), (0.0005, 1.45)];
const FREQUENCIES: [f64; 5] = [79.4, 79.9, 80.2, 80.5, 81.0];
const CUBIC: f64 = 2e11;

fn oscillator(stiffness: f64, dashpot: f64) -> String {
    format!(
        "[project]\nformat = 1\n[structure]\nkind = \"chain\"\nmasses = [1.99]\nground_stiffness = [{stiffness:?}]\n\
         coupling_stiffness = []\n[[source]]\nlaw = \"viscous\"\ndofs = [1]\nstate = \"known\"\nc = {dashpot:?}\n"
    )
}

fn run(words: &[&str], paths: &[&Path]) -> String {
    let words = ["dashpot"].iter().chain(words).map(Into::into);
    answer(words.chain(paths.iter().map(|path| (*path).into()))).unwrap()
}

/// Simulates a level at frequencies (Hz) into `folder`, with a dashpot (N s/m) beside the joint; gives back its runs as a project names
/// them.
fn level(folder: &Path, level: usize, frequencies: &[f64], dashpot: f64) -> String {
    let (shift, force) = LEVELS[level];
    let joint = format!(
        "[[source]]\nlaw = \"iwan\"\ndofs = [1]\nstate = \"known\"\nstiffness = 28000.0\nforce = 3.0\nchi = -0.4\nbeta = 0.1\n\
         [[source]]\nlaw = \"cubic_stiffness\"\ndofs = [1]\nstate = \"known\"\nstiffness = {CUBIC:?}\n"
    );
    let runs_with = |more: &str| {
        let run = |(i, f): (usize, &f64)| format!("[[run]]\nfile = \"l{level}-{i}.csv\"\nfrequency = {f:?}\n{more}");
        frequencies.iter().enumerate().map(run).collect::<String>()
    };
    let simulate = "[simulate]\nchannels = [\"force@1 [N]\", \"acc@1 [m/s^2]\"]\n";
    let runs = runs_with(&format!("force_dof = 1\nforce_n = {force:?}\n"));
    let truth = folder.join(format!("level-{level}.toml"));
    let text = [&oscillator(STIFFNESS * (1.0 + shift) - 26_000.0, dashpot), &joint, &runs, simulate].concat();
    std::fs::write(&truth, text).unwrap();
    run(&["simulate", "--noise", "0.01", "--seed", &level.to_string(), "--out"], &[folder, &truth]);
    runs_with(&format!("level = {}\n", level + 1))
}

/// The project of levels and frequencies in which a dashpot of the first size (N s/m) is and one of the second is stated is told both
/// laws, and the cubic stiffness within a share. Gives back the probability of the first.
fn are_both_told(levels: &[usize], frequencies: &[f64], [is, stated]: [f64; 2], within: f64) -> f64 {
    let folder = tempfile::tempdir().unwrap();
    let runs: String = levels.iter().map(|&k| level(folder.path(), k, frequencies, is)).collect();
    let project = folder.path().join("project.toml");
    std::fs::write(&project, oscillator(1.02 * STIFFNESS, stated) + &runs).unwrap();
    let said: Value = serde_json::from_str(&run(&["diagnose", "--json"], &[&project])).unwrap();
    let first: Vec<&Value> = said["suggestions"].as_array().unwrap().iter().take(2).collect();
    let laws: Vec<&str> = first.iter().map(|s| s["effect"].as_str().unwrap()).collect();
    assert!(laws.contains(&"iwan") && laws.contains(&"cubic_stiffness"), "{laws:?}");
    assert!(first[0]["error_after"].as_f64().unwrap() < 0.15, "{}", first[0]);
    let cubic = first.iter().find(|s| s["effect"] == "cubic_stiffness").unwrap();
    let value = cubic["parameters"]["stiffness"].as_f64().unwrap();
    assert!((value / CUBIC - 1.0).abs() < within, "{value}");
    first[0]["probability"].as_f64().unwrap()
}

#[test]
fn a_joint_that_slips_and_stiffens_is_told_as_both() {
    // Fewer runs leave the stiffness less certain.
    are_both_told(&[0, 2, 3], &[FREQUENCIES[0], FREQUENCIES[2], FREQUENCIES[4]], [2.0; 2], 0.08);
}

/// The damping of small amplitudes is all of the joint: no dashpot is there.
#[test]
fn a_joint_is_told_as_both_beside_its_own_damping_stated_as_a_dashpot() {
    let sure = are_both_told(&[0, 1, 2], &FREQUENCIES, [0.01, 3.2], 0.08);
    assert!(sure > 0.9, "{sure}");
}

#[test]
#[ignore = "half a minute without optimisation: all levels and frequencies; the test above has nine runs"]
fn a_joint_is_told_as_both_from_all_its_runs() {
    are_both_told(&[0, 1, 2, 3], &FREQUENCIES, [2.0; 2], 0.05);
}
