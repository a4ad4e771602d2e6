//! A base that moves in time, from outside: simulated, compared, explained.
#![allow(clippy::disallowed_methods, clippy::unwrap_used, reason = "tests")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

fn dashpot(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_dashpot"))
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::null())
        .output()
        .unwrap()
}

/// A base that moves as a record says: the model agrees with the record that was made of it, whether sensors show the base or not, and
/// the law that is taken out of the model is found again.
#[test]
fn a_base_moves_as_its_record_says() {
    let folder = tempfile::tempdir().unwrap();
    let chirp = |n: usize| {
        let t = n as f64 * 2e-3;
        let ramp = (t / 0.5).min(1.0);
        format!("{t:e},{:e}\n", ramp * 4.0 * (6.0 * t + 0.6 * t * t).sin())
    };
    let rows: String = (0..4500).map(chirp).collect();
    fs::write(folder.path().join("base.csv"), format!("time [s],base@x [m/s^2]\n{rows}")).unwrap();
    let project = |response: &str, hidden: &str| {
        format!(
            "[project]\nformat = 1\n[structure]\nkind = \"chain\"\nmasses = [2.0, 1.0]\nground_stiffness = [800.0, 0.0]\n\
             coupling_stiffness = [600.0]\n\
             [[source]]\nlaw = \"viscous\"\ndofs = [\"1\"]\nstate = \"known\"\nc = 0.8\n{hidden}\
             [[run]]\nfile = \"made.csv\"\nkind = \"transient\"\nresponse = \"{response}\"\n\
             excitation = {{ kind = \"base\", file = \"../base.csv\", duration_s = 9.0 }}\n[simulate]\nrate_hz = 100.0\n"
        )
    };
    let friction = "[[source]]\nlaw = \"coulomb\"\ndofs = [\"2\"]\nstate = \"known\"\nforce = 0.6\n";
    for response in ["absolute", "relative"] {
        let own = folder.path().join(response);
        fs::create_dir(&own).unwrap();
        fs::write(own.join("truth.toml"), project(response, friction)).unwrap();
        fs::write(own.join("model.toml"), project(response, "")).unwrap();
        let made = dashpot(&["simulate", "truth.toml", "--out", ".", "--noise", "0.002"], &own);
        assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
        let header = fs::read_to_string(own.join("made.csv")).unwrap();
        assert!(header.starts_with("time [s],base@x [m/s^2],acc@1 [m/s^2],acc@2 [m/s^2]\n"), "{}", &header[..80]);
        let error = |file: &str| {
            let output = dashpot(&["compare", file, "--json"], &own);
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
            let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
            document["error"].as_f64().unwrap()
        };
        let [with, without] = [error("truth.toml"), error("model.toml")];
        assert!(with < 0.01 && without > 0.05, "{response}: {with} {without}");
        let output = dashpot(&["diagnose", "model.toml", "--json"], &own);
        let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        let first = &document["suggestions"][0];
        assert_eq!(first["effect"], "coulomb", "{document}");
        assert_eq!(first["dofs"], serde_json::json!(["2"]), "{document}");
        assert!((first["parameters"]["force"].as_f64().unwrap() / 0.6 - 1.0).abs() < 0.05, "{first}");
    }
    // What is missing is one clear line.
    fs::write(folder.path().join("p.toml"), project("relative", "").replace("../base.csv", "none.csv")).unwrap();
    let output = dashpot(&["simulate", "p.toml", "--out", "made"], folder.path());
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!output.status.success() && error.contains("none.csv") && error.trim().lines().count() <= 2, "{error}");
}

/// One law at one place passes for two dashpots beside the damping of a mode times 17: both are told, and taken as known by what `identify`
/// finds nothing is missing.
#[test]
fn two_dashpots_on_a_shaker_table_are_both_told() {
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("sample-data/shaker-table");
    let document = |more: &[&str]| -> serde_json::Value {
        let said = dashpot(&[&["diagnose", "project.toml", "--json"], more].concat(), &sample);
        serde_json::from_slice(&said.stdout).unwrap()
    };
    let found = document(&[]);
    let told: Vec<_> =
        found["suggestions"].as_array().unwrap().iter().take(2).map(|s| (&s["effect"], &s["dofs"])).collect();
    let dashpots = ["9", "15"].map(|place| (serde_json::json!("viscous"), serde_json::json!([place])));
    assert_eq!(told, dashpots.iter().map(|(effect, place)| (effect, place)).collect::<Vec<_>>());
    let steps = found["steps"].as_array().unwrap();
    assert!(steps[steps.len() - 1]["error"].as_f64().unwrap() < 0.005, "{}", found["steps"]);
    let known = document(&["--identified"]);
    assert_eq!((known["verdict"].as_str(), &known["identify_explains"]), (Some("adequate"), &serde_json::Value::Null));
}
