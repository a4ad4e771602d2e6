//! Channels of a structure of points, of which only energies are compared.

use super::run;
use serde_json::Value;
use std::path::Path;

/// Five masses whose sensor at the drive point is stated with 1.4 times its sensitivity: its gain is told, and the project with it
/// added shows the error that was promised, relative to the energy that the corrected sensor puts in.
#[test]
fn a_gain_at_the_drive_point_leaves_what_is_promised() {
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("sample-data/five-masses-points");
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    for number in 1..=10 {
        let name = format!("run-{number:02}.csv");
        std::fs::copy(sample.join(&name), at(&name)).unwrap();
    }
    let stated = std::fs::read_to_string(sample.join("project.toml")).unwrap();
    let stated = stated.replace("state = \"reference\"", "state = \"known\"");
    std::fs::write(at("project.toml"), stated + "\n[[sensor]]\nchannel = \"acc@5\"\ngain = 1.4\n").unwrap();
    let told = run(&["diagnose", "--json", "--apply"], &[&at("applied.toml"), &at("project.toml")]);
    let told: Value = serde_json::from_str(&told).unwrap();
    let compared: Value = serde_json::from_str(&run(&["compare", "--json"], &[&at("applied.toml")])).unwrap();
    let found = &told["suggestions"][0];
    assert!(found["effect"] == "gain" && found["channel"] == "acc@5", "{found}");
    assert!((found["parameters"]["gain"].as_f64().unwrap() * 1.4 - 1.0).abs() < 0.01, "{found}");
    let (promised, shown) = (found["error_after"].as_f64().unwrap(), compared["error"].as_f64().unwrap());
    assert!((shown / promised - 1.0).abs() < 0.01 && shown < 0.01, "{promised} and {shown}");
}
