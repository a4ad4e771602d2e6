//! Three dampers hidden at once beside one that is known: told together by the model as it is, not as corrections of it.

use dashpot::cli::answer;
use serde_json::Value;
use std::path::Path;

const SENSORS: [usize; 6] = [3, 7, 9, 13, 15, 19];
/// Law, DOF, parameter and its value.
const HIDDEN: [(&str, &str, &str, f64); 3] =
    [("viscous", "5", "c", 0.3), ("coulomb", "11", "force", 0.05), ("viscous", "15", "c", 0.2)];

fn run(words: &[&str], paths: &[&Path]) -> String {
    let words = ["dashpot"].iter().chain(words).map(Into::into);
    answer(words.chain(paths.iter().map(|path| (*path).into()))).expect("a project")
}

fn beam() -> String {
    "[project]\nformat = 1\ntitle = \"three at once\"\n[structure]\nkind = \"beam\"\nlength = 0.56\nbreadth = 0.04\ndepth = 0.004\n\
     youngs_modulus = 69e9\ndensity = 2700.0\nelements = 10\nsupports = \"clamped-free\"\n\
     [[source]]\nlaw = \"stiffness_proportional\"\nstate = \"known\"\nbeta = 2e-5\n"
        .to_owned()
}

/// Runs about the first three modes at three levels; with their forces if they are to be simulated.
fn runs(exciting: bool) -> String {
    let mut text = String::new();
    for (m, mode) in [10.375, 65.0, 182.1].into_iter().enumerate() {
        for (l, force) in [0.5, 1.0, 2.0].into_iter().enumerate() {
            for (k, share) in [0.98, 1.003, 1.02].into_iter().enumerate() {
                let f = mode * share;
                text += &format!("[[run]]\nfile = \"run-{m}{l}{k}.csv\"\nfrequency = {f:.4}\nlevel = {}\n", l + 1);
                if exciting {
                    text += &format!("force_dof = 19\nforce_n = {force:?}\n");
                }
            }
        }
    }
    text
}

#[test]
fn two_dashpots_and_friction_hidden_at_once_are_told_together() {
    let folder = tempfile::tempdir().expect("a folder");
    let (truth, project) = (folder.path().join("truth.toml"), folder.path().join("project.toml"));
    let sources = HIDDEN.map(|(law, dof, parameter, value)| {
        format!("[[source]]\nlaw = \"{law}\"\ndofs = [{dof}]\nstate = \"known\"\n{parameter} = {value:?}\n")
    });
    let channels = SENSORS.map(|dof| format!("\"acc@{dof} [m/s^2]\"")).join(", ");
    let simulate = format!("[simulate]\nchannels = [\"force@19 [N]\", {channels}]\n");
    std::fs::write(&truth, [&beam(), &sources.concat(), &simulate, &runs(true)].map(String::as_str).concat())
        .expect("written");
    std::fs::write(&project, beam() + &runs(false)).expect("written");
    run(&["simulate", "--noise", "0.005", "--seed", "5", "--out"], &[folder.path(), &truth]);
    let found: Value = serde_json::from_str(&run(&["diagnose", "--json"], &[&project])).expect("a document");
    assert_eq!(found["verdict"], "missing");
    let added = found["steps"].as_array().expect("steps").last().expect("a step")["added"].as_array().expect("effects");
    assert_eq!(added.len(), HIDDEN.len(), "{added:?}");
    for (law, dof, parameter, value) in HIDDEN {
        let is = |effect: &&Value| effect["effect"] == law && effect["dofs"][0] == dof;
        let effect = added.iter().find(is).unwrap_or_else(|| panic!("{law} at {dof} among {added:?}"));
        let size = effect["parameters"][parameter].as_f64().expect("a number");
        assert!((size / value - 1.0).abs() < 0.02, "{law} at {dof}: {size}, in truth {value}");
    }
}
