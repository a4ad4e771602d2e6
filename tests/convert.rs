//! `dashpot convert` from outside: dialects and units into the plain file, records into harmonics, one line for what cannot be.
#![allow(clippy::disallowed_methods, clippy::unwrap_used, reason = "tests")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn convert(from: &Path, to: &Path, more: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_dashpot")).arg("convert").args([from, to]).args(more).output().unwrap()
}

#[test]
fn dialect_and_units_become_the_plain_file() {
    let folder = tempfile::tempdir().unwrap();
    let (from, to, again) = (folder.path().join("a.csv"), folder.path().join("b.csv"), folder.path().join("c.csv"));
    fs::write(&from, "time [s];acc@7 [g];force@19 [kN];disp@r [rad]\r\n0;1;2,5;0,1\r\n0,5;-1;0;0,2\r\n1;0;1;0\r\n1,5;0;1;0\r\n2;0;1;0\r\n").unwrap();
    let output = convert(&from, &to, &[]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let text = fs::read_to_string(&to).unwrap();
    assert_eq!(
        text,
        "time [s],acc@7 [m/s^2],force@19 [N],disp@r [rad]\n0,9.80665,2500,0.1\n0.5,-9.80665,0,0.2\n1,0,1e3,0\n1.5,0,1e3,0\n2,0,1e3,0\n"
    );
    convert(&to, &again, &[]);
    assert_eq!(fs::read_to_string(&again).unwrap(), text);
}

#[test]
fn a_record_becomes_its_harmonics_and_these_stay() {
    let folder = tempfile::tempdir().unwrap();
    let (from, to, again) = (folder.path().join("a.csv"), folder.path().join("b.csv"), folder.path().join("c.csv"));
    let mut text = String::from("time [s],disp@1 [mm]\n");
    for n in 0..400 {
        let t = f64::from(n) * 0.005;
        let phase = 31.0 * t;
        text += &format!("{t},{}\n", 3.0 * phase.cos() - 2.0 * phase.sin() + 0.5 * (3.0 * phase).cos());
    }
    fs::write(&from, text).unwrap();
    let output = convert(&from, &to, &["--as", "harmonics", "--harmonics", "3"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let text = fs::read_to_string(&to).unwrap();
    let rows: Vec<Vec<&str>> = text.lines().skip(1).map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 3);
    let number = |row: usize, column: usize| rows[row][column].parse::<f64>().unwrap();
    assert!((number(0, 1) - 31.0 / std::f64::consts::TAU).abs() < 1e-6, "{text}");
    for (row, cos, sin) in [(0, 3e-3, -2e-3), (2, 5e-4, 0.0)] {
        assert!((number(row, 4) - cos).abs() < 1e-8 && (number(row, 5) - sin).abs() < 1e-8, "{text}");
    }
    convert(&to, &again, &[]);
    assert_eq!(fs::read_to_string(&again).unwrap(), text);
    let refused = convert(&to, &again, &["--as", "time"]);
    assert_eq!(refused.status.code(), Some(1));
    assert!(String::from_utf8(refused.stderr).unwrap().contains("holds harmonics"));
}

#[test]
fn what_cannot_be_converted_is_one_line_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let (from, to) = (folder.path().join("a.csv"), folder.path().join("b.csv"));
    for (text, target) in [
        ("", &to),
        ("time [s],speed@1 [m/s]\n0,1\n", &to),
        ("time [s],acc@1 [m/s^2]\n0,one\n", &to),
        ("time [s],acc@1 [m/s^2]\n", &to),
        ("time [s],acc@1 [m/s^2]\n0,1\n", &folder.path().join("b.xlsx")),
    ] {
        fs::write(&from, text).unwrap();
        let output = convert(&from, target, &[]);
        assert_eq!(output.status.code(), Some(1), "{text}");
        assert_eq!(String::from_utf8(output.stderr).unwrap().lines().count(), 1, "{text}");
        assert!(!target.exists(), "{text}");
    }
    assert_eq!(convert(&folder.path().join("none.csv"), &to, &[]).status.code(), Some(1));
}
