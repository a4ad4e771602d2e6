//! Sets of one layout become runs; units of set 164; what an import adds to a project that is there.

use super::{dashpot, imported, json};
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// Rows of a record of 2 kg on a spring at 21 Hz with a dashpot of 8 N s/m under 5 N at a frequency.
fn rows(frequency_hz: f64) -> String {
    let omega = TAU * frequency_hz;
    let (re, im) = (2.0 * (TAU * 21.0).powi(2) - 2.0 * omega * omega, 8.0 * omega);
    let size = re * re + im * im;
    (0..800).fold(String::new(), |mut text, i| {
        let t = f64::from(i) / 1000.0;
        let (cos, sin) = ((omega * t).cos(), (omega * t).sin());
        let acceleration = -omega * omega * 5.0 * (re * cos + im * sin) / size;
        writeln!(text, "{t:.4},{:.9},{acceleration:.9}", 5.0 * cos).unwrap();
        text
    })
}

#[test]
fn blocks_of_one_layout_are_runs_of_one_mapping() {
    let head = "Time [s],Force [N],Acc [m/s^2]";
    let text = format!("Run 1\n{head}\n{}\nRun 2\n{head}\n{}", rows(20.0), rows(22.5));
    let folder = tempfile::tempdir().unwrap();
    let (said, project) = imported(folder.path(), "two.csv", &text, &[]);
    assert!(said.contains("2 runs of 2 channels"), "{said}");
    assert_eq!((project.matches("[[run]]").count(), project.matches("\nset = ").count()), (2, 2), "{project}");
    assert_eq!(project.matches("[[channel]]").count(), 2, "{project}");
    let found = json(&["identify", "--json", &folder.path().join("project.toml").display().to_string()]);
    let c = found["sources"][0]["parameters"]["c"].as_f64().unwrap();
    assert!((c / 8.0 - 1.0).abs() < 1e-3, "{c}");
    assert_eq!(found["runs"].as_array().unwrap().len(), 2);
}

#[test]
fn a_record_without_units_has_those_of_the_file() {
    // A Universal File in millimetres: accelerations in mm/s^2, forces in N, no labels.
    let mut text = String::from(
        "    -1\n   164\n         5MM: mm (newton)             2\n  1.0000000000000000D+03  1.0000000000000000D+00  1.0000000000000000D+00\n  2.7314999999999998D+02\n    -1\n",
    );
    for (column, factor, quantity) in [(1, 1.0, 13), (2, 1e3, 12)] {
        text.push_str("    -1\n    58\nrecord\nNONE\nNONE\nNONE\nNONE\n");
        text.push_str("    1         0    0         0 NONE               1   3 NONE               0   0\n");
        text.push_str("         4       800         1  0.00000E+00  1.00000E-03  0.00000E+00\n");
        writeln!(text, "        17    0    0    0 NONE                 NONE").unwrap();
        writeln!(text, "{quantity:10}    0    0    0 NONE                 NONE").unwrap();
        text.push_str("         0    0    0    0 NONE                 NONE\n         0    0    0    0 NONE                 NONE\n");
        for row in rows(20.0).lines() {
            let value: f64 = row.split(',').nth(column).unwrap().parse().unwrap();
            writeln!(text, "{:20.12}", factor * value).unwrap();
        }
        text.push_str("    -1\n");
    }
    let folder = tempfile::tempdir().unwrap();
    imported(folder.path(), "mm.uff", &text, &[]);
    let found = json(&["identify", "--json", &folder.path().join("project.toml").display().to_string()]);
    let c = found["sources"][0]["parameters"]["c"].as_f64().unwrap();
    assert!((c / 8.0 - 1.0).abs() < 1e-3, "{c}");
}

#[test]
fn a_script_adds_measurements_to_a_project() {
    let folder = tempfile::tempdir().unwrap();
    let head = "Time [s],Force [N],Acc [m/s^2]";
    imported(folder.path(), "one.csv", &format!("{head}\n{}", rows(20.0)), &[]);
    std::fs::write(folder.path().join("other.csv"), format!("{head}\n{}", rows(22.5))).unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let play = |tables: &str| {
        let script = serde_json::json!([{ "import_tables": tables }]).to_string();
        std::fs::write(folder.path().join("script.json"), script).unwrap();
        dashpot(&["run", &path("script.json"), &path("project.toml"), "--out", &path("more.toml")])
    };
    play("[[run]]\nfile = \"other.csv\"\n").unwrap();
    let found = json(&["identify", "--json", &path("more.toml")]);
    assert_eq!(found["runs"].as_array().unwrap().len(), 2);
    let refused = play("[[run]]\nfile = \"one.csv\"\n").unwrap_err();
    assert!(refused.contains("in the project already"), "{refused}");
    let wrong = play("[[source]]\nlaw = \"viscous\"\n").unwrap_err();
    assert!(wrong.contains("source"), "{wrong}");
}
