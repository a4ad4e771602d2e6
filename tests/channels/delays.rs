//! Channels of records that are late against the others: of all motions, and of one sensor.

use super::{run, words};
use serde_json::Value;
use std::path::Path;

/// Samples a second.
const RATE: f64 = 256.0;

/// A chain of three masses whose stiffness is wrong by a factor.
fn head(factor: f64) -> String {
    let k = 2e4 * factor;
    format!(
        "[project]\nformat = 1\n[structure]\nkind = \"chain\"\nmasses = [2.0, 1.5, 1.0]\nground_stiffness = [{k:?}, 0.0, 0.0]\n\
         coupling_stiffness = [{:?}, {k:?}]\n[[source]]\nlaw = \"viscous\"\ndofs = [1]\nstate = \"known\"\nc = 6.0\n",
        1.3 * k
    )
}

/// Records of random force on that chain with a spring that stiffens, channels late by so many samples; `diagnose` of a project that
/// knows of neither, and of the same with what that found applied.
fn told(late: &[(&str, f64)], stiffness: &str) -> [Value; 3] {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let sensors: String = late
        .iter()
        .map(|(channel, samples)| format!("[[sensor]]\nchannel = \"{channel}\"\ndelay = {:?}\n", samples / RATE))
        .collect();
    let run_table = "[[run]]\nfile = \"noise.csv\"\nkind = \"transient\"\n";
    let excitation =
        "excitation = { kind = \"random\", dof = 3, rms_n = 40.0, from_hz = 4.0, to_hz = 50.0, duration_s = 8.0 }\n";
    let hidden =
        format!("[[source]]\nlaw = \"cubic_stiffness\"\ndofs = [2]\nstate = \"known\"\nstiffness = {stiffness}\n");
    let simulate = format!(
        "[simulate]\nrate_hz = {RATE:?}\nchannels = [\"force@3 [N]\", \"acc@1 [m/s^2]\", \"acc@2 [m/s^2]\", \"acc@3 [m/s^2]\"]\n"
    );
    let truth = [&head(1.0), &hidden, &sensors, run_table, excitation, &simulate].map(str::to_owned).concat();
    std::fs::write(at("truth.toml"), truth).unwrap();
    run(&["simulate", "--noise", "0.003", "--seed", "7", "--out"], &[folder.path(), &at("truth.toml")]);
    std::fs::write(at("project.toml"), head(1.015) + run_table).unwrap();
    let json = |more: &[&str], paths: &[&Path]| -> Value {
        serde_json::from_str(&run(&[&["diagnose", "--json", "--seconds", "100"], more].concat(), paths)).unwrap()
    };
    let first = json(&["--apply"], &[&at("applied.toml"), &at("project.toml")]);
    let compared = serde_json::from_str(&run(&["compare", "--json"], &[&at("applied.toml")])).unwrap();
    [first, compared, json(&[], &[&at("applied.toml")])]
}

/// Checks what is said of channels that are late by so many samples beside a spring that stiffens, and that what was found leaves what
/// was promised.
#[track_caller]
fn checked(late: &[(&str, f64)], stiffness: &str) {
    let [first, compared, again] = told(late, stiffness);
    let faults = first["channel_faults"].as_array().unwrap();
    assert_eq!(faults.len(), late.len(), "{faults:?}");
    for (channel, samples) in late {
        let fault = faults.iter().find(|f| f["channels"][0] == *channel).unwrap();
        let delay = fault["delay_s"].as_f64().unwrap();
        assert!((delay * RATE - samples).abs() < 0.05, "{fault}");
        assert_eq!(fault["fault"], "late");
    }
    let found = first["suggestions"].as_array().unwrap().iter().find(|s| s["effect"] != "delay").unwrap();
    assert!(found["effect"] == "cubic_stiffness" && found["dofs"] == serde_json::json!(["2"]), "{found}");
    let size = found["parameters"]["stiffness"].as_f64().unwrap() / stiffness.parse::<f64>().unwrap();
    assert!((size - 1.0).abs() < 0.02, "{found}");
    let (promised, shown) = (found["error_after"].as_f64().unwrap(), compared["error"].as_f64().unwrap());
    assert!((shown / promised - 1.0).abs() < 0.02 && shown < 0.02, "{promised} and {shown}");
    assert!(words(&again).is_empty(), "{again}");
}

/// A generator that holds each value, or a vibrometer: all motions lag behind the force.
#[test]
fn a_force_that_is_early() {
    checked(&[("force@3", -0.6)], "2e6");
}

#[test]
fn a_sensor_that_is_late() {
    checked(&[("acc@2", 0.8)], "2e6");
}

/// A spring that moves the frequencies by a tenth over records of two hundred periods: a fit that is carried on before it has ended loses
/// the phase, and the law is one among many.
#[test]
fn channels_in_time_are_not_called_late() {
    checked(&[], "2e7");
}
