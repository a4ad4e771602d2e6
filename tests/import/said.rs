//! Odd files of laboratories, each with what is read of it or the line that says what is wrong.

use super::{dashpot, imported};
use std::fs;

const HEADER: &str = "Time [s],Force [N],Acc 1 [m/s^2]\n";

/// Rows of a steady test, with the text `cell` for the acceleration of row `at`, counted from 0.
fn rows(at: usize, cell: &str) -> String {
    let row = |n: usize| {
        let angle = 40.0 * n as f64 * 1e-3;
        let acceleration = if n == at { cell.to_owned() } else { format!("{:.5}", 3.0 * angle.cos()) };
        format!("{:.3},{:.5},{acceleration}\n", n as f64 * 1e-3, 10.0 * angle.sin())
    };
    (0..400).map(row).collect()
}

/// The line with which a file is refused.
fn refused(text: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.csv");
    fs::write(&file, text).unwrap();
    let out = folder.path().join("p.toml").display().to_string();
    let said = dashpot(&["import", &file.display().to_string(), "--out", &out]).unwrap_err();
    assert!(!said.contains('\n'), "{said}");
    said
}

#[test]
fn words_in_place_of_samples_are_named_with_their_line() {
    let overload = "says an overload, and no number was recorded; measure again in a larger range, or remove the row";
    for (cell, what) in [
        ("OVLD", overload),
        (">5.0", overload),
        ("*****", "is not a number; write one such as 1.25e-3, or remove the row"),
    ] {
        let said = refused(&format!("{HEADER}{}", rows(100, cell)));
        assert!(said.ends_with(&format!("a.csv, line 102: column 3: \"{cell}\" {what}")), "{said}");
    }
    let said = refused(&format!("{HEADER}{}", rows(100, "-9999")));
    assert!(said.contains("\"Acc 1\": sample 101 is -9999, which marks a value that is missing"), "{said}");
    let said = refused(&format!("{HEADER}{}", rows(100, "")));
    assert!(said.contains("sample 101 of acc@1 is NaN or left empty; remove the row or mend the number"), "{said}");
}

#[test]
fn what_ends_within_a_row_or_goes_back_in_time_is_said_to() {
    let good = format!("{HEADER}{}", rows(400, ""));
    let said = refused(good.trim_end().rsplit_once(',').unwrap().0);
    assert!(said.contains("a.csv: the file ends in line 401, which has 2 of 3 cells: it was cut off"), "{said}");
    let mut lines: Vec<&str> = good.lines().collect();
    lines.swap(100, 101);
    let said = refused(&lines.join("\n"));
    assert!(said.contains("the time goes back in line 102") && said.ends_with("; sort the rows by time"), "{said}");
}

#[test]
fn decimal_commas_between_commas_are_said() {
    let said = refused(&format!("{HEADER}{}", rows(400, "").replace(',', ";").replace(['.', ';'], ",")));
    assert!(said.contains("a.csv, line 2: the rows have 6 cells below 3 names"), "{said}");
}

#[test]
fn times_that_may_be_no_seconds_are_said() {
    let row = |n: usize| format!("{n},{:.5},{:.5}\n", (0.04 * n as f64).sin(), (0.04 * n as f64).cos());
    let rows: String = (0..400).map(row).collect();
    let folder = tempfile::tempdir().unwrap();
    let (said, project) = imported(folder.path(), "a.csv", &format!("Time,Force [N],Acc [m/s^2]\n{rows}"), &[]);
    let expected = "the times have no unit and rise by 1: they are taken in s, which is assumed";
    assert!(said.contains(expected) && project.contains("rise by 1"), "{said}");
    let (said, _) = imported(folder.path(), "a.csv", &format!("Time [ms],Force [N],Acc [m/s^2]\n{rows}"), &[]);
    assert!(!said.contains("rise by"), "{said}");
}

#[test]
fn a_nanometre_is_no_newton_metre() {
    let folder = tempfile::tempdir().unwrap();
    let of = |header: &str| {
        let text = format!("{header}\n{}", rows(400, ""));
        imported(folder.path(), "a.csv", &text, &[]).1
    };
    let project = of("Time [s],Force [N],Vibrometer [nm]");
    assert!(project.contains("quantity = \"disp\""), "{project}");
    let project = of("Time [s],Moment [nm],Angle [mrad]");
    assert!(project.contains("by its name a moment; the file says nm: N m is assumed"), "{project}");
    let project = of("Time [s],Moment [N mm],Angle [mrad]");
    assert!(!project.contains("factor"), "{project}");
}
