//! Dry friction in chains that are off by some per cent, read by sensors so quiet that harmonics in resonances above the band weigh more
//! than all fundamentals do, or so that friction sticks at the lower of two levels. Truth: the program's own simulation.

use dashpot::cli::answer;
use serde_json::Value;
use std::path::Path;

pub(super) fn run(words: &[&str], paths: &[&Path]) -> String {
    let words = ["dashpot"].iter().chain(words).map(Into::into);
    answer(words.chain(paths.iter().map(|path| (*path).into()))).unwrap()
}

/// A chain of four masses with the damping of the whole structure.
pub(super) fn chain([masses, ground, coupling]: [&[f64]; 3], [alpha, beta]: [f64; 2]) -> String {
    format!(
        "[project]\nformat = 1\n[structure]\nkind = \"chain\"\nmasses = {masses:?}\nground_stiffness = {ground:?}\n\
         coupling_stiffness = {coupling:?}\n[[source]]\nlaw = \"mass_proportional\"\nstate = \"known\"\nalpha = {alpha:?}\n\
         [[source]]\nlaw = \"stiffness_proportional\"\nstate = \"known\"\nbeta = {beta:?}\n"
    )
}

/// What `diagnose` says of the chain `stated` where it is `is` with friction, N, at its last mass, driven at DOF `driven` with the forces
/// `levels`, N, at the frequencies, Hz.
fn diagnosed([stated, is]: [&str; 2], friction: f64, driven: usize, levels: &[f64], frequencies: &[f64]) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let masses = is.split("masses = ").nth(1).unwrap().lines().next().unwrap().split(',').count();
    let hidden = format!("[[source]]\nlaw = \"coulomb\"\ndofs = [{masses}]\nstate = \"known\"\nforce = {friction:?}\n");
    let (mut measured, mut driven_runs) = (String::new(), String::new());
    for (l, level) in levels.iter().enumerate() {
        for (i, frequency) in frequencies.iter().enumerate() {
            let head = format!("[[run]]\nfile = \"{l}-{i}.csv\"\nfrequency = {frequency:?}\n");
            measured.push_str(&head);
            driven_runs.push_str(&format!("{head}force_dof = {driven}\nforce_n = {level:?}\n"));
        }
    }
    let channels: String = (1..=masses).map(|dof| format!(", \"acc@{dof} [m/s^2]\"")).collect();
    let simulate = format!("[simulate]\nchannels = [\"force@{driven} [N]\"{channels}]\n");
    let (truth, project) = (folder.path().join("truth.toml"), folder.path().join("project.toml"));
    std::fs::write(&truth, [is, &hidden, &driven_runs, &simulate].concat()).unwrap();
    std::fs::write(&project, stated.to_owned() + &measured).unwrap();
    run(&["simulate", "--noise", "0.0002", "--seed", "20", "--out"], &[folder.path(), &truth]);
    serde_json::from_str(&run(&["diagnose", "--json"], &[&project])).unwrap()
}

/// That `said` tells this friction, N, within a relative `tolerance` at the DOF and little else.
fn assert_friction(said: &Value, dof: &str, friction: f64, tolerance: f64) {
    let first = &said["suggestions"][0];
    assert_eq!(said["verdict"], "missing", "{first}");
    assert!(first["effect"] == "coulomb" && first["dofs"][0] == dof, "{first}");
    assert!(first["probability"].as_f64().unwrap() > 0.9 && first["error_after"].as_f64().unwrap() < 0.03, "{first}");
    let force = first["parameters"]["force"].as_f64().unwrap();
    assert!((force / friction - 1.0).abs() < tolerance, "{force} N");
}

#[test]
fn friction_is_told_though_no_model_explains_harmonics_in_resonances_to_the_noise() {
    let is = chain(
        [&[1.2002, 1.6529, 0.8043, 1.8065], &[11138.0, 0.0, 0.0, 2573.1], &[14948.0, 59314.0, 44703.0]],
        [0.54061, 3.0935e-5],
    );
    let stated = chain(
        [&[1.2033, 1.6317, 0.7868, 1.7631], &[10950.0, 0.0, 0.0, 2549.6], &[14877.0, 57621.0, 45804.0]],
        [0.47009, 2.69e-5],
    );
    let said = diagnosed([&stated, &is], 0.3, 2, &[1.0], &[6.83761, 6.90668, 6.96193, 7.04481]);
    // Harmonics fall into three resonances, whose damping takes up a little of the friction.
    assert_friction(&said, "4", 0.3, 0.05);
}

/// At the lower level the last mass stands still, where the model without friction resonates.
#[test]
fn friction_that_sticks_at_one_of_two_levels_is_found_from_the_other() {
    let is = chain([&[1.154, 1.2462], &[17213.0, 2735.3], &[40005.0]], [0.91951, 3.7932e-5]);
    let stated = chain([&[1.1465, 1.2655], &[17310.0, 2705.0], &[40787.0]], [0.79957, 3.2984e-5]);
    let said = diagnosed([&stated, &is], 0.3637, 1, &[1.0, 0.35], &[13.8402, 13.98, 14.0919, 14.2596]);
    assert_friction(&said, "2", 0.3637, 0.02);
}
