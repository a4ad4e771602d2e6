//! The report: one file that holds everything, with the values of the command line.

use crate::support::beam;
use serde_json::Value;
use std::process::Command;

#[test]
fn a_report_holds_values_and_plots_in_one_file() {
    let sample = beam();
    let out = sample.path.with_file_name("report.html");
    let dashpot = || Command::new(env!("CARGO_BIN_EXE_dashpot"));
    let written = dashpot().arg("report").arg(&sample.path).arg("--out").arg(&out).output().unwrap();
    assert!(written.status.success(), "{}", String::from_utf8_lossy(&written.stderr));
    let text = std::fs::read_to_string(&out).unwrap();
    let identified = dashpot().arg("identify").arg(&sample.path).arg("--json").output().unwrap();
    let json: Value = serde_json::from_slice(&identified.stdout).unwrap();
    for source in json["sources"].as_array().unwrap() {
        let percent = source["energy_percent"].as_f64().unwrap();
        assert!(text.contains(&dashpot::display::format::percent(0.01 * percent)), "{source}");
    }
    assert!(text.contains("Test beam") && text.contains("run-01.csv") && text.contains("Damping ratios"));
    assert!(text.matches("data:image/svg+xml,").count() >= 5, "energies, angle, matrix, Bode, Nyquist");
    assert!(!text.contains("http://") || !text.contains("src=\"http"), "nothing outside the file");
}

#[test]
fn a_report_of_nothing_is_refused_in_one_line() {
    let failed = Command::new(env!("CARGO_BIN_EXE_dashpot")).args(["report", "no.toml", "--out", "r.html"]).output();
    let failed = failed.unwrap();
    assert_eq!(failed.status.code(), Some(1));
    let message = String::from_utf8(failed.stderr).unwrap();
    assert!(message.starts_with("no.toml") && message.trim().lines().count() == 1, "{message}");
}
