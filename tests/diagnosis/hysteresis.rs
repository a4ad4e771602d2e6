//! Bouc-Wen hysteresis of exponent 1, as most of the literature has it (Wen 1976), which is the least exponent that the law has. Truth: the
//! program's own simulation.

use dashpot::cli::answer;
use serde_json::Value;
use std::path::Path;

fn run(words: &[&str], paths: &[&Path]) -> String {
    let words = ["dashpot"].iter().chain(words).map(Into::into);
    answer(words.chain(paths.iter().map(|path| (*path).into()))).unwrap()
}

#[test]
fn bouc_wen_hysteresis_of_exponent_1_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let chain = "[project]\nformat = 1\n[structure]\nkind = \"chain\"\nmasses = [2.0, 1.5]\nground_stiffness = [9000.0, 0.0]\n\
                 coupling_stiffness = [20000.0]\n[[source]]\nlaw = \"stiffness_proportional\"\nstate = \"known\"\nbeta = 1e-4\n";
    let hidden = "[[source]]\nlaw = \"bouc_wen\"\nstate = \"known\"\ndofs = [2]\nstiffness = 900.0\nforce = 0.6\nexponent = 1.0\n";
    let (mut measured, mut driven) = (String::new(), String::new());
    for (l, level) in [0.3, 1.0, 3.0].iter().enumerate() {
        for (i, frequency) in [7.2, 7.45, 7.6, 7.8].iter().enumerate() {
            let head = format!("[[run]]\nfile = \"{l}-{i}.csv\"\nfrequency = {frequency:?}\n");
            measured.push_str(&head);
            driven.push_str(&format!("{head}force_dof = 1\nforce_n = {level:?}\n"));
        }
    }
    let simulate = "[simulate]\nchannels = [\"force@1 [N]\", \"acc@1 [m/s^2]\", \"acc@2 [m/s^2]\"]\n";
    let (truth, project) = (folder.path().join("truth.toml"), folder.path().join("project.toml"));
    std::fs::write(&truth, [chain, hidden, &driven, simulate].concat()).unwrap();
    std::fs::write(&project, chain.to_owned() + &measured).unwrap();
    run(&["simulate", "--noise", "0.001", "--seed", "5", "--out"], &[folder.path(), &truth]);
    let said: Value = serde_json::from_str(&run(&["diagnose", "--json"], &[&project])).unwrap();
    let first = &said["suggestions"][0];
    assert!(said["verdict"] == "missing" && first["effect"] == "bouc_wen" && first["dofs"][0] == "2", "{said}");
    let parameter = |name: &str| first["parameters"][name].as_f64().unwrap();
    assert!(parameter("exponent") < 1.05, "{first}");
    assert!(
        (parameter("stiffness") / 900.0 - 1.0).abs() < 0.03 && (parameter("force") / 0.6 - 1.0).abs() < 0.03,
        "{first}"
    );
}
