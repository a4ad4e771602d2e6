//! Runs that are not steady: told, left out, or used all the same.

use super::{SOUGHT, dashpot, json, measured, text};
use std::fs;
use std::path::Path;

/// Writes `made/run-01.csv` anew: force and accelerations at 12 Hz, each times `shape(t)`.
fn reshape(folder: &Path, shape: impl Fn(f64) -> f64) {
    reshape_columns(folder, |_, t| shape(t));
}

/// The same, each column by its number from 0, the force, times `shape(column, t)`.
fn reshape_columns(folder: &Path, shape: impl Fn(usize, f64) -> f64) {
    let path = folder.join("made/run-01.csv");
    let text = fs::read_to_string(&path).unwrap();
    let mut lines = text.lines();
    let mut made = format!("{}\n", lines.next().unwrap());
    for line in lines {
        let numbers: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        let columns = numbers[1..].iter().enumerate();
        let rest: String = columns.map(|(c, y)| format!(",{}", y * shape(c, numbers[0]))).collect();
        made.push_str(&format!("{}{rest}\n", numbers[0]));
    }
    fs::write(path, made).unwrap();
}

/// A lightly damped structure whose records all hold the end of a transient: they tell more than nothing.
#[test]
fn where_no_run_has_settled_those_that_hardly_change_are_used() {
    let folder = measured();
    reshape_columns(folder.path(), |column, t| if column == 0 { 1.0 } else { 1.0 + 0.02 * t });
    let used = dashpot(&["compare", "p.toml", "--json"], folder.path());
    let said = text(&used.stderr);
    assert_eq!(used.status.code(), Some(0), "{said}");
    assert!(said.contains("note: no run has settled: amplitudes change by up to 1.0 %"), "{said}");
    let document: serde_json::Value = serde_json::from_slice(&used.stdout).unwrap();
    assert_eq!(document["runs"][0]["findings"][0]["flag"], "not-settled");
    let left_out = SOUGHT.replace("frequency = 12\n", "frequency = 12\nuse = false\n");
    fs::write(folder.path().join("p.toml"), left_out).unwrap();
    assert_eq!(dashpot(&["compare", "p.toml"], folder.path()).status.code(), Some(1));

    fs::write(folder.path().join("p.toml"), SOUGHT).unwrap();
    reshape_columns(folder.path(), |column, t| if column == 0 { 1.0 } else { 1.0 + 0.5 * t });
    let refused = dashpot(&["compare", "p.toml"], folder.path());
    assert!(text(&refused.stderr).contains("no run can be compared"), "{}", text(&refused.stderr));
}

#[test]
fn runs_that_are_not_steady_are_told_and_used_where_the_user_insists() {
    let folder = measured();
    reshape(folder.path(), |t| (t / 0.3).min(1.0));
    let refused = dashpot(&["compare", "p.toml"], folder.path());
    assert_eq!(refused.status.code(), Some(1));
    let said = text(&refused.stderr);
    assert!(said.contains("no run can be compared") && said.contains("is run up until"), "{said}");
    let insisting = SOUGHT.replace("frequency = 12\n", "frequency = 12\nuse = true\n");
    fs::write(folder.path().join("p.toml"), insisting).unwrap();
    let printed = dashpot(&["compare", "p.toml"], folder.path());
    let table = text(&printed.stdout);
    assert!(table.contains("not-settled") && table.contains("is run up until"), "{table}");
    assert!(!table.contains("left out"), "{table}");
    let document = json(&["compare", "p.toml", "--json"], folder.path());
    assert_eq!(document["runs"][0]["used"], true);
    assert_eq!(document["runs"][0]["findings"][0]["flag"], "not-settled");

    reshape(folder.path(), |t| (-8.0 * t).exp());
    let decaying = fs::read_to_string(folder.path().join("made/run-01.csv")).unwrap();
    let forceless: String = decaying
        .lines()
        .map(|l| format!("{},{}\n", l.split(',').next().unwrap(), l.split(',').nth(2).unwrap()))
        .collect();
    fs::write(folder.path().join("made/run-01.csv"), forceless).unwrap();
    fs::write(folder.path().join("p.toml"), SOUGHT).unwrap();
    let refused = dashpot(&["compare", "p.toml"], folder.path());
    assert!(text(&refused.stderr).contains("is a free decay, no steady sine"), "{}", text(&refused.stderr));
}
