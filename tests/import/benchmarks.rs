//! Layouts of public benchmark data of nonlinear system identification, made here: no units, no times, a rate in a column of its own,
//! tests as the third extent of an array, names in a file beside. Each is 2 kg on a spring at 21 Hz with a dashpot of 8 N s/m.

use super::{dashpot, json};
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;

/// Force, displacement and acceleration of 800 samples at 1 kHz under 5 N at a frequency.
fn samples(frequency_hz: f64) -> Vec<[f64; 3]> {
    let omega = TAU * frequency_hz;
    let (re, im) = (2.0 * (TAU * 21.0).powi(2) - 2.0 * omega * omega, 8.0 * omega);
    let sample = |i: i32| {
        let (sin, cos) = (omega * f64::from(i) / 1000.0).sin_cos();
        let displacement = 5.0 * (re * cos + im * sin) / (re * re + im * im);
        [5.0 * cos, displacement, -omega * omega * displacement]
    };
    (0..800).map(sample).collect()
}

/// Imports files of a folder, opens the project and identifies: the summary, the project and the coefficient found.
fn found(folder: &Path, files: &[&str], more: &[&str]) -> (String, String, f64) {
    let project = folder.join("project.toml").display().to_string();
    let files: Vec<String> = files.iter().map(|file| folder.join(file).display().to_string()).collect();
    let mut words = vec!["import"];
    words.extend(files.iter().map(String::as_str));
    words.extend(["--out", project.as_str()]);
    words.extend(more);
    let said = dashpot(&words).unwrap();
    let result = json(&["identify", "--json", &project]);
    let c = result["sources"][0]["parameters"]["c"].as_f64().unwrap();
    (said, std::fs::read_to_string(&project).unwrap(), c)
}

#[test]
fn inputs_and_outputs_of_system_identification_without_units() {
    let mut text = String::from("u,y,\n");
    samples(20.0).iter().for_each(|[force, motion, _]| writeln!(text, "{force:.9},{motion:.12},").unwrap());
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("benchmark.csv"), text).unwrap();
    let (said, _, c) = found(folder.path(), &["benchmark.csv"], &["--sampling-hz", "1000"]);
    assert!(said.contains("as system identification calls inputs and outputs: a displacement is assumed"), "{said}");
    assert!((c / 8.0 - 1.0).abs() < 1e-3, "{c}");
}

#[test]
fn a_rate_in_a_column_of_its_own_and_indices_in_brackets() {
    let mut text = String::from("Force,Voltage,Acceleration[1],Acceleration[2],Fs\n");
    for (i, [force, _, a]) in samples(20.0).iter().enumerate() {
        let rate = if i == 0 { "1000" } else { "" };
        writeln!(text, "{force:.9},{:.9},{a:.9},{:.9},{rate}", force / 60.0, 0.5 * a).unwrap();
    }
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("ground.csv"), text).unwrap();
    let (said, project, _) = found(folder.path(), &["ground.csv"], &[]);
    assert!(said.contains("1 run of 3 channels"), "{said}");
    assert!(project.contains("name = \"Acceleration[2]\"\nquantity = \"acc\"\ndof = 2"), "{project}");
}

/// Rows without a header, the names of the columns in a file of their own.
#[test]
fn names_in_a_file_beside_the_table() {
    let mut text = String::new();
    samples(20.0).iter().for_each(|[force, _, a]| writeln!(text, "{force:.9};{:.9}", 1e3 * a).unwrap());
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("data.csv"), text).unwrap();
    std::fs::write(folder.path().join("channels.csv"), "channel\nForce [N]\nAcc 1z [mm/s^2]\n").unwrap();
    let (_, project, c) = found(folder.path(), &["channels.csv", "data.csv"], &["--sampling-hz", "1000"]);
    assert!(project.contains("name = \"column 2\"\nquantity = \"acc\"\ndof = \"1z\"\nunit = \"mm/s^2\""), "{project}");
    assert!((c / 8.0 - 1.0).abs() < 1e-3, "{c}");
}

/// Tests x channels x samples, as machine learning keeps them: each test is a run, named by its set.
#[test]
fn tests_of_an_array_are_runs() {
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 2, 800), }\n";
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    for frequency_hz in [20.0, 21.0, 22.5] {
        let made = samples(frequency_hz);
        for channel in [0, 2] {
            made.iter().for_each(|row| bytes.extend(row[channel].to_le_bytes()));
        }
    }
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("dataset.npy"), bytes).unwrap();
    std::fs::write(folder.path().join("names.txt"), "Force [N]\nAcc [m/s^2]\n").unwrap();
    let (said, project, c) = found(folder.path(), &["dataset.npy", "names.txt"], &["--sampling-hz", "1000"]);
    assert!(said.contains("3 runs of 2 channels"), "{said}");
    assert!(project.contains("set = \"test 3\"") && project.matches("[[channel]]").count() == 2, "{project}");
    assert!((c / 8.0 - 1.0).abs() < 1e-3, "{c}");
}
