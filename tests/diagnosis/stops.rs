//! A contact on one side only is told from one on both sides and from a quadratic spring, and these from it; a slider with play
//! from one without. Truth: the program's own simulation of three masses.

use dashpot::cli::answer;
use serde_json::Value;
use std::path::Path;

const FREQUENCIES: [f64; 3] = [20.3, 37.8, 52.0];
const FORCES: [f64; 3] = [5.0, 15.0, 30.0];

fn run(words: &[&str], paths: &[&Path]) -> String {
    let words = ["dashpot"].iter().chain(words).map(Into::into);
    answer(words.chain(paths.iter().map(|path| (*path).into()))).unwrap()
}

/// Three masses on springs and dashpots.
fn chain() -> String {
    let dashpot = |dof: u8| format!("[[source]]\nlaw = \"viscous\"\ndofs = [{dof}]\nstate = \"known\"\nc = 12.0\n");
    let head = "[project]\nformat = 1\n[structure]\nkind = \"chain\"\nmasses = [2.0, 1.5, 1.0]\n\
                ground_stiffness = [4e4, 2e4, 2e4]\ncoupling_stiffness = [3e4, 3e4]\n";
    [head.to_string(), dashpot(1), dashpot(2), dashpot(3)].concat()
}

/// What is told first of runs, with 0.5 % noise, in which a law acts beside what is known: its name, DOFs and parameters.
fn told(law: &str, dofs: &[u8], parameters: &[(&str, f64)]) -> (String, Vec<String>, Value) {
    let folder = tempfile::tempdir().unwrap();
    let values: String = parameters.iter().map(|(name, value)| format!("{name} = {value:?}\n")).collect();
    let hidden = format!("[[source]]\nlaw = \"{law}\"\ndofs = {dofs:?}\nstate = \"known\"\n{values}");
    let (mut known, mut driven) = (String::new(), String::new());
    for (i, frequency) in FREQUENCIES.iter().enumerate() {
        for (level, force) in FORCES.iter().enumerate() {
            let head =
                format!("[[run]]\nfile = \"{i}-{level}.csv\"\nfrequency = {frequency:?}\nlevel = {}\n", level + 1);
            known.push_str(&head);
            driven.push_str(&format!("{head}force_dof = 2\nforce_n = {force:?}\n"));
        }
    }
    let simulate =
        "[simulate]\nchannels = [\"force@2 [N]\", \"acc@1 [m/s^2]\", \"acc@2 [m/s^2]\", \"acc@3 [m/s^2]\"]\n";
    let (truth, project) = (folder.path().join("truth.toml"), folder.path().join("project.toml"));
    std::fs::write(&truth, [&chain(), &hidden, &driven, simulate].concat()).unwrap();
    std::fs::write(&project, chain() + &known).unwrap();
    run(&["simulate", "--noise", "0.005", "--seed", "5", "--out"], &[folder.path(), &truth]);
    let said: Value = serde_json::from_str(&run(&["diagnose", "--json"], &[&project])).unwrap();
    let first = &said["suggestions"][0];
    assert!(first["error_after"].as_f64().unwrap() < 0.01, "{first}");
    let dofs = first["dofs"].as_array().unwrap().iter().map(|dof| dof.as_str().unwrap().to_string()).collect();
    (first["effect"].as_str().unwrap().to_string(), dofs, first["parameters"].clone())
}

/// The law is told at its place with its parameters.
fn is_told(law: &str, dofs: &[u8], parameters: &[(&str, f64)]) {
    let (effect, places, found) = told(law, dofs, parameters);
    assert_eq!((effect.as_str(), places), (law, dofs.iter().map(u8::to_string).collect()), "{found}");
    for (name, value) in parameters {
        let found = found[name].as_f64().unwrap();
        assert!((found - value).abs() < 0.02 * value.abs() + 1e-6, "{law}: {name} {found} instead of {value}");
    }
}

#[test]
fn a_stop_is_told_on_either_side() {
    is_told("stop", &[2], &[("stiffness", 2e4), ("gap", 1e-4)]);
    is_told("stop", &[3], &[("stiffness", 2e4), ("gap", -2e-4)]);
}

#[test]
fn a_stop_between_two_masses_is_told() {
    is_told("stop", &[1, 2], &[("stiffness", 3e4), ("gap", -5e-5)]);
    // A crack that opens and closes.
    is_told("stop", &[2, 3], &[("stiffness", 1e4), ("gap", 0.0)]);
}

#[test]
fn a_slider_with_backlash_is_told() {
    is_told("elastic_slider_backlash", &[2], &[("stiffness", 2e4), ("force", 2.0), ("backlash", 1e-4)]);
    is_told("elastic_slider", &[2], &[("stiffness", 2e4), ("force", 2.0)]);
}

#[test]
fn a_stop_is_not_told_where_both_sides_touch_or_none() {
    is_told("gap", &[2], &[("stiffness", 2e4), ("gap", 1e-4)]);
    is_told("quadratic_stiffness", &[2], &[("stiffness", 5e6)]);
}
