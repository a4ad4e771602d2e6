//! `dashpot methods` from outside, on the samples: every method that the data allow, and for each other one line why.
#![allow(clippy::disallowed_methods, clippy::unwrap_used, reason = "tests")]

use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output, Stdio};

fn methods(sample: &str, more: &[&str]) -> Output {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("sample-data").join(sample).join("project.toml");
    Command::new(env!("CARGO_BIN_EXE_dashpot"))
        .arg("methods")
        .arg(file)
        .args(more)
        .stdin(Stdio::null())
        .output()
        .unwrap()
}

fn json(sample: &str) -> Value {
    let output = methods(sample, &["--json"]);
    assert_eq!(output.status.code(), Some(0), "{sample}: {}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn method<'a>(found: &'a Value, name: &str) -> &'a Value {
    found["methods"].as_array().unwrap().iter().find(|m| m["method"] == name).unwrap()
}

fn ratios(of: &Value) -> Vec<f64> {
    of.as_array().unwrap().iter().map(|m| m["damping_ratio"].as_f64().unwrap()).collect()
}

#[test]
fn every_sample_has_every_method_or_one_line_why() {
    let samples = [
        "cantilever-case-1",
        "cantilever-case-1a",
        "cantilever-case-2",
        "cantilever-case-2-rounded",
        "cantilever-friction",
        "cantilever-harmonics",
        "cantilever-late-sensor",
        "five-masses",
        "five-masses-cubic",
        "five-masses-friction",
    ];
    for sample in samples {
        let found = json(sample);
        let all = found["methods"].as_array().unwrap();
        assert_eq!(all.len(), 20, "{sample}");
        let size = found["dofs"].as_array().unwrap().len();
        for one in all {
            if one["ran"] == false {
                let reason = one["reason"].as_str().unwrap();
                assert!(reason.len() > 10 && reason.len() < 160 && reason.lines().count() == 1, "{sample}: {reason}");
                continue;
            }
            if let Some(rows) = one["viscous"].as_array() {
                assert_eq!(rows.len(), size, "{sample} {}", one["name"]);
                let finite = |row: &Value| row.as_array().unwrap().iter().all(Value::is_f64);
                assert!(rows.iter().all(finite), "{sample} {}", one["name"]);
                let known = !found["reference"].is_null();
                assert_eq!(one["eps_c_percent"].is_f64(), known, "{sample} {}", one["name"]);
            } else {
                assert!(ratios(&one["modes"]).iter().all(|z| *z > 0.0 && *z < 0.3), "{sample} {one}");
            }
        }
    }
}

/// Four equal dashpots, eight resonances, 5 % noise: the complex modes that three sensors show have the reference's ratios; the
/// methods that keep to the measured modes return them.
#[test]
fn cantilever_at_its_resonances() {
    let found = json("cantilever-case-1");
    assert_eq!(found["modes_from"], "8 modes from runs near the resonances, with the model's help");
    assert_eq!(found["measured_modes"], 8);
    let known = ratios(&found["reference_modes"]);
    let by = ratios(&found["complex_modes"]);
    let kept = ratios(&method(&found, "ibrahim")["modes"]);
    for mode in 0..8 {
        // Mode 8 is so lightly damped (0.006 %) that noise in the shapes of the others carries damping over to it.
        let kept = if mode < 7 { kept[mode] } else { known[mode] };
        for (name, value) in [("measured", by[mode]), ("Ibrahim", kept)] {
            assert!((value / known[mode] - 1.0).abs() < 0.05, "{name}, mode {}: {value} {}", mode + 1, known[mode]);
        }
    }
    assert_eq!(
        method(&found, "chen")["reason"],
        "needs the full receptance matrix: 1 of 20 DOFs are driven, 3 measured"
    );
    assert_eq!(method(&found, "log-decrement")["reason"], "needs a free decay; the runs are steady states");
}

#[test]
fn five_masses_with_all_sensors() {
    let found = json("five-masses");
    let known = ratios(&found["reference_modes"]);
    let by = ratios(&found["complex_modes"]);
    assert_eq!(by.len(), 5);
    for mode in 0..5 {
        assert!((by[mode] / known[mode] - 1.0).abs() < 0.25, "mode {}: {} {}", mode + 1, by[mode], known[mode]);
    }
    // Needs no model, only the motion of every mass: half a per cent beside the resonances it is the best.
    assert!(method(&found, "fritzen")["eps_c_percent"].as_f64().unwrap() < 5.0);
    assert!(method(&found, "half-power")["ran"] == false && method(&found, "energy-single")["ran"] == false);
}

#[test]
fn text_has_a_row_a_method_and_the_reference() {
    let output = methods("five-masses", &[]);
    let text = String::from_utf8(output.stdout).unwrap();
    for words in [
        "eps_C %",
        "zeta 5 %",
        "Lancaster",
        "spread of the methods, %",
        "reference",
        "Cannot run",
        "  Chen et al.: needs",
    ] {
        assert!(text.contains(words), "{words} is not in\n{text}");
    }
    let points = methods("five-masses-points", &[]);
    assert_eq!(points.status.code(), Some(1));
    let message = String::from_utf8(points.stderr).unwrap();
    assert!(message.contains("needs mass and stiffness matrices") && message.lines().count() == 1, "{message}");
}

#[test]
fn incompleteness_has_a_row_a_case_and_says_which_damping() {
    let output = methods("five-masses", &["--incompleteness", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(found["damping"], "known");
    let cases = found["cases"].as_array().unwrap();
    let whole: Vec<&Value> = cases.iter().filter(|c| c["sensors"].as_array().unwrap().len() == 5).collect();
    assert_eq!(whole.iter().map(|c| c["modes"].as_u64().unwrap()).collect::<Vec<_>>(), [1, 2, 3, 4, 5]);
    let last = whole[4]["methods"].as_array().unwrap();
    let lancaster = last.iter().find(|m| m["method"] == "lancaster").unwrap();
    assert!(lancaster["eps_c_percent"].as_f64().unwrap() < 1e-4, "{lancaster}");
    assert!(whole[4]["eps_p_percent"].as_f64().unwrap() < 1e-6);
    let text = String::from_utf8(methods("five-masses", &["--incompleteness"]).stdout).unwrap();
    assert!(text.contains("5 of 5 DOFs measured: 1 2 3 4 5") && text.contains("eps_p %"), "{text}");
    assert!(text.contains("where the damping is the known one"), "{text}");
    let points = methods("five-masses-points", &["--incompleteness"]);
    assert_eq!(points.status.code(), Some(1));
    assert_eq!(String::from_utf8(points.stderr).unwrap().lines().count(), 1);
}

/// Without a known damping that of the energy balance takes its place.
#[test]
fn incompleteness_without_a_known_damping() {
    let folder = tempfile::tempdir().unwrap();
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("sample-data/five-masses");
    for file in std::fs::read_dir(&sample).unwrap() {
        let path = file.unwrap().path();
        std::fs::copy(&path, folder.path().join(path.file_name().unwrap())).unwrap();
    }
    let file = folder.path().join("project.toml");
    let text = std::fs::read_to_string(&file).unwrap();
    let without =
        text.replace("state = \"reference\"", "state = \"off\"").replace("state = \"known\"", "state = \"candidate\"");
    assert_ne!(text, without);
    std::fs::write(&file, without).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_dashpot")).arg("methods").arg(&file).arg("--incompleteness").output();
    let output = output.unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        text.contains("where the damping is the identified one"),
        "{text}{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

/// 48 lines of a hammer test: too few for an estimator but around the third mode, and each of the others has lines near it.
#[test]
fn modes_of_too_few_lines_for_the_estimator_come_from_the_lines_beside_them() {
    let found = json("hammer-frf");
    let how = found["modes_from"].as_str().unwrap();
    assert!(
        how.starts_with("1 mode by the poly-reference estimator, ") && how.contains("with the model's help"),
        "{how}"
    );
    let modes = ratios(&found["complex_modes"]);
    for (mode, reference) in [0.0100, 0.0032, 0.00268].into_iter().enumerate() {
        assert!((modes[mode] / reference - 1.0).abs() < 0.03, "mode {mode}: {modes:?}");
    }
}
