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

/// A file of a laboratory is mapped as `import` maps it: units, times in ms, decimal commas, lines of a header, angles.
#[test]
fn files_of_laboratories_are_read_as_import_reads_them() {
    let folder = tempfile::tempdir().unwrap();
    let (from, to) = (folder.path().join("a.txt"), folder.path().join("b.csv"));
    let row = |n: i32| format!("{n};{:.1};1,5;180,0\r\n", 0.5 * f64::from(n)).replace('.', ",");
    let rows: String = (0..20).map(row).collect();
    fs::write(&from, format!("Rig 3\r\nOperator;Muster\r\nZeit [ms];Kraft [kN];Weg [mm];Winkel [deg]\r\n{rows}"))
        .unwrap();
    let output = convert(&from, &to, &[]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("assumed: disp@1: the file says no DOF: 1 is its number in order"), "{said}");
    let text = fs::read_to_string(&to).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "time [s],force@1 [N],disp@1 [m],disp@2 [rad]");
    assert_eq!((lines.len(), lines[3]), (21, "0.002,1e3,0.0015,3.141592653589793"));
}

#[test]
fn of_several_runs_one_is_named_or_all_become_harmonics() {
    let folder = tempfile::tempdir().unwrap();
    let (from, to) = (folder.path().join("a.csv"), folder.path().join("b.csv"));
    let block = |size: f64| {
        let row = |n: i32| {
            let angle = 31.0 * f64::from(n) * 0.005;
            format!("{},{},{}\n", f64::from(n) * 0.005, size * angle.cos(), size * angle.sin())
        };
        format!("Time [s],Force [N],Acc 1 [m/s^2]\n{}\n", (0..400).map(row).collect::<String>())
    };
    fs::write(&from, format!("{}{}", block(1.0), block(2.0))).unwrap();
    let refused = convert(&from, &to, &[]);
    let said = String::from_utf8(refused.stderr).unwrap();
    assert_eq!((refused.status.code(), said.lines().count()), (Some(1), 1), "{said}");
    assert!(
        said.contains("a.csv: holds 2 runs, and a table of samples one; name it by --set (\"1\", \"2\")"),
        "{said}"
    );
    assert_eq!(convert(&from, &to, &["--set", "2"]).status.code(), Some(0));
    assert!(fs::read_to_string(&to).unwrap().lines().nth(1).unwrap().starts_with("0,2,0"));
    assert_eq!(convert(&from, &to, &["--as", "harmonics", "--harmonics", "1"]).status.code(), Some(0));
    let text = fs::read_to_string(&to).unwrap();
    assert_eq!(text.lines().filter(|line| line.contains("force@1")).count(), 2, "{text}");
    let unknown = convert(&from, &to, &["--set", "7"]);
    assert!(String::from_utf8(unknown.stderr).unwrap().contains("the file has no set \"7\"; it has \"1\", \"2\""));
}

/// Files of every format that `import` reads: a CSV that is read again, or one line that says why not.
#[test]
fn every_format_is_converted_or_told_why_not() {
    let folder = tempfile::tempdir().unwrap();
    let to = folder.path().join("b.csv");
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("crates/datafiles/tests/corpus");
    let mut written = 0;
    for entry in fs::read_dir(corpus).unwrap() {
        let from = entry.unwrap().path();
        let output = convert(&from, &to, &[]);
        if output.status.code() == Some(0) {
            written += 1;
            let again = convert(&to, &folder.path().join("c.csv"), &[]);
            assert_eq!(again.status.code(), Some(0), "{}", from.display());
            fs::remove_file(&to).unwrap();
            continue;
        }
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!((output.status.code(), said.lines().count()), (Some(1), 1), "{}: {said}", from.display());
    }
    assert!(written > 15, "{written}");
}
