//! A mass that a chain lacks, among springs and masses that are all a few per cent off: corrections of the model can stand for it, one of them
//! far beyond what is believed. Truth: the program's own simulation.

use dashpot::cli::answer;
use serde_json::Value;
use std::path::Path;

const MASSES: [f64; 5] = [1.75, 1.62, 6.07, 1.59, 3.71];
const COUPLING: [f64; 4] = [67_900.0, 107_400.0, 101_300.0, 80_600.0];
const GROUND: f64 = 90_000.0;
/// What is true over what is stated.
const TRUE_MASSES: [f64; 5] = [0.995, 1.002, 1.011, 0.966, 0.996];
const TRUE_COUPLING: [f64; 4] = [1.001, 1.029, 0.994, 0.94];
const TRUE_GROUND: f64 = 0.969;
/// Force, N, and band, Hz, of two sweeps.
const SWEEPS: [[f64; 3]; 2] = [[4.0, 4.0, 22.0], [8.0, 22.0, 60.0]];

fn run(words: &[&str], paths: &[&Path]) -> String {
    let words = ["dashpot"].iter().chain(words).map(Into::into);
    answer(words.chain(paths.iter().map(|path| (*path).into()))).unwrap()
}

fn product<const N: usize>(a: [f64; N], b: [f64; N]) -> [f64; N] {
    std::array::from_fn(|k| a[k] * b[k])
}

fn chain(masses: [f64; 5], ground: f64, coupling: [f64; 4]) -> String {
    let damping = [(1, 3.0), (3, 9.6), (5, 1.9)]
        .map(|(dof, c)| format!("[[source]]\nlaw = \"viscous\"\nstate = \"known\"\ndofs = [{dof}]\nc = {c:?}\n"));
    format!(
        "[project]\nformat = 1\n[structure]\nkind = \"chain\"\nmasses = {masses:?}\nground_stiffness = [{ground:?}, 0.0, 0.0, 0.0, \
         0.0]\ncoupling_stiffness = {coupling:?}\n{}",
        damping.concat()
    )
}

/// What is said where this mass, kg, is missing at the first DOF.
fn diagnosed(mass: f64) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let hidden = format!("[[source]]\nlaw = \"mass\"\nstate = \"known\"\ndofs = [1]\nmass = {mass:?}\n");
    let (mut measured, mut swept) = (String::new(), String::new());
    for (k, [force, from, to]) in SWEEPS.iter().enumerate() {
        let head = format!("[[run]]\nfile = \"{k}.csv\"\nkind = \"transient\"\n");
        measured.push_str(&head);
        swept.push_str(&format!(
            "{head}excitation = {{ kind = \"sweep\", dof = 5, force_n = {force:?}, from_hz = {from:?}, to_hz = {to:?}, duration_s = 4.0 }}\n"
        ));
    }
    let channels: String = (1..=5).map(|dof| format!(", \"acc@{dof} [m/s^2]\"")).collect();
    let simulate = format!("[simulate]\nchannels = [\"force@5 [N]\"{channels}]\nrate_hz = 300.0\n");
    let (truth, project) = (folder.path().join("truth.toml"), folder.path().join("project.toml"));
    let is = chain(product(MASSES, TRUE_MASSES), GROUND * TRUE_GROUND, product(COUPLING, TRUE_COUPLING));
    let hidden = if mass > 0.0 { hidden } else { String::new() };
    std::fs::write(&truth, [is, hidden, swept, simulate].concat()).unwrap();
    std::fs::write(&project, chain(MASSES, GROUND, COUPLING) + &measured).unwrap();
    run(&["simulate", "--noise", "0.003", "--seed", "3", "--out"], &[folder.path(), &truth]);
    serde_json::from_str(&run(&["diagnose", "--json"], &[&project])).unwrap()
}

#[test]
fn a_mass_that_corrections_could_stand_for_is_told() {
    let said = diagnosed(0.5);
    let first = &said["suggestions"][0];
    assert_eq!(said["verdict"], "missing", "{said}");
    assert!(first["effect"] == "mass" && first["dofs"][0] == "1", "{first}");
    let mass = first["parameters"]["mass"].as_f64().unwrap();
    assert!((0.3..0.6).contains(&mass), "{mass} kg");
}

#[test]
fn errors_of_all_springs_and_masses_are_no_mass() {
    let said = diagnosed(0.0);
    assert_eq!(said["verdict"], "detuned", "{said}");
}
