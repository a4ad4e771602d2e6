//! Dry friction in a chain that is off by 2 %, read by sensors so quiet that harmonics in resonances above the band weigh more than all
//! fundamentals do, and that what the fit leaves of them is beyond the noise. Truth: the program's own simulation.

use dashpot::cli::answer;
use serde_json::Value;
use std::path::Path;

const FREQUENCIES: [f64; 4] = [6.83761, 6.90668, 6.96193, 7.04481];
const FRICTION: f64 = 0.3;

fn run(words: &[&str], paths: &[&Path]) -> String {
    let words = ["dashpot"].iter().chain(words).map(Into::into);
    answer(words.chain(paths.iter().map(|path| (*path).into()))).unwrap()
}

/// A chain of four masses with the damping of the whole structure.
fn chain([masses, ground, coupling]: [&[f64]; 3], [alpha, beta]: [f64; 2]) -> String {
    format!(
        "[project]\nformat = 1\n[structure]\nkind = \"chain\"\nmasses = {masses:?}\nground_stiffness = {ground:?}\n\
         coupling_stiffness = {coupling:?}\n[[source]]\nlaw = \"mass_proportional\"\nstate = \"known\"\nalpha = {alpha:?}\n\
         [[source]]\nlaw = \"stiffness_proportional\"\nstate = \"known\"\nbeta = {beta:?}\n"
    )
}

#[test]
fn friction_is_told_though_no_model_explains_harmonics_in_resonances_to_the_noise() {
    let folder = tempfile::tempdir().unwrap();
    let is = chain(
        [&[1.2002, 1.6529, 0.8043, 1.8065], &[11138.0, 0.0, 0.0, 2573.1], &[14948.0, 59314.0, 44703.0]],
        [0.54061, 3.0935e-5],
    );
    let stated = chain(
        [&[1.2033, 1.6317, 0.7868, 1.7631], &[10950.0, 0.0, 0.0, 2549.6], &[14877.0, 57621.0, 45804.0]],
        [0.47009, 2.69e-5],
    );
    let hidden = format!("[[source]]\nlaw = \"coulomb\"\ndofs = [4]\nstate = \"known\"\nforce = {FRICTION:?}\n");
    let (mut measured, mut driven) = (String::new(), String::new());
    for (i, frequency) in FREQUENCIES.iter().enumerate() {
        let head = format!("[[run]]\nfile = \"{i}.csv\"\nfrequency = {frequency:?}\n");
        measured.push_str(&head);
        driven.push_str(&format!("{head}force_dof = 2\nforce_n = 1.0\n"));
    }
    let channels: String = (1..=4).map(|dof| format!(", \"acc@{dof} [m/s^2]\"")).collect();
    let simulate = format!("[simulate]\nchannels = [\"force@2 [N]\"{channels}]\n");
    let (truth, project) = (folder.path().join("truth.toml"), folder.path().join("project.toml"));
    std::fs::write(&truth, [&is, &hidden, &driven, &simulate].map(String::as_str).concat()).unwrap();
    std::fs::write(&project, stated + &measured).unwrap();
    run(&["simulate", "--noise", "0.0002", "--seed", "20", "--out"], &[folder.path(), &truth]);
    let said: Value = serde_json::from_str(&run(&["diagnose", "--json"], &[&project])).unwrap();
    let first = &said["suggestions"][0];
    assert_eq!(said["verdict"], "missing", "{first}");
    assert!(first["effect"] == "coulomb" && first["dofs"][0] == "4", "{first}");
    assert!(first["probability"].as_f64().unwrap() > 0.9 && first["error_after"].as_f64().unwrap() < 0.03, "{first}");
    let force = first["parameters"]["force"].as_f64().unwrap();
    assert!((force / FRICTION - 1.0).abs() < 0.02, "{force} N");
}
