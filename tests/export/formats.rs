//! One test a format.

use crate::{Sample, mat5};
use dashpot::exchange::export::{Format, write};
use faer::Mat;
use std::fs;
use std::path::PathBuf;

fn exported(format: Format, name: &str) -> (tempfile::TempDir, PathBuf, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    let sample = Sample::beam();
    let written = write(&sample.identified(), format, &path).unwrap();
    assert_eq!(written.paths[0], path);
    assert!(written.paths.iter().all(|p| p.is_file()));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), written.paths.len(), "only the files that are named");
    (folder, path, written.warnings)
}

fn text(path: &std::path::Path) -> String {
    fs::read_to_string(path).unwrap()
}

#[test]
fn csv_reads_back() {
    let (folder, path, warnings) = exported(Format::Csv, "c.csv");
    assert!(warnings.is_empty());
    let sample = Sample::beam();
    let read = |name: &str| {
        let rows: Vec<Vec<String>> = csv::Reader::from_path(folder.path().join(name))
            .unwrap()
            .records()
            .map(|r| r.unwrap().iter().map(str::to_owned).collect())
            .collect();
        rows
    };
    let number = |rows: &[Vec<String>], i: usize, j: usize| rows[i][j + 1].parse::<f64>().unwrap();
    let rows = read("c.csv");
    assert_eq!(Mat::from_fn(6, 6, |i, j| number(&rows, i, j)), sample.viscous);
    let coulomb = read("c-coulomb.csv");
    assert_eq!(Mat::from_fn(6, 6, |i, j| number(&coulomb, i, j)), sample.others[0].1);
    let sources = read("c-sources.csv");
    assert_eq!(sources.len(), 5);
    assert_eq!(sources[2][..4], ["viscous", "1-3-5", "identified", "c"]);
    assert_eq!(sources[1][4].parse::<f64>().unwrap(), 12_345.678_901_234_567);
    assert!(text(&path).starts_with("dof,1,2,3,4,5,6\n1,"));
}

#[test]
fn matrix_market_reads_back() {
    let (_folder, path, _) = exported(Format::Mtx, "c.mtx");
    let text = text(&path);
    assert!(text.starts_with("%%MatrixMarket matrix coordinate real symmetric\n"));
    let mut lines = text.lines().filter(|l| !l.starts_with('%'));
    let size: Vec<usize> = lines.next().unwrap().split(' ').map(|w| w.parse().unwrap()).collect();
    assert_eq!(size[..2], [6, 6]);
    let mut read = Mat::zeros(6, 6);
    let mut count = 0;
    for line in lines {
        let words: Vec<&str> = line.split(' ').collect();
        let (i, j): (usize, usize) = (words[0].parse().unwrap(), words[1].parse().unwrap());
        assert!(i >= j, "lower triangle");
        let value: f64 = words[2].parse().unwrap();
        read[(i - 1, j - 1)] = value;
        read[(j - 1, i - 1)] = value;
        count += 1;
    }
    assert_eq!(count, size[2]);
    assert_eq!(read, Sample::beam().viscous);
}

#[test]
fn matlab_reads_back() {
    let (_folder, path, _) = exported(Format::Mat, "c.mat");
    let sample = Sample::beam();
    let variables = mat5::read(&fs::read(path).unwrap());
    assert_eq!(variables["C"].numbers(), &sample.viscous);
    assert_eq!(variables["C_coulomb"].numbers(), &sample.others[0].1);
    assert_eq!(variables["energy_percent"].numbers()[(5, 0)], sample.energy[5]);
    assert_eq!(variables["damping_ratio"].numbers()[(0, 0)], 0.0141);
    let mat5::Value::Cells(labels) = &variables["dof_labels"] else { panic!("no cell array") };
    assert_eq!(labels.iter().map(mat5::Value::text).collect::<Vec<_>>(), ["1", "2", "3", "4", "5", "6"]);
    let mat5::Value::Structs(sources) = &variables["sources"] else { panic!("no struct array") };
    assert_eq!(sources.len(), 5);
    assert_eq!(sources[3]["law"].text(), "coulomb");
    assert_eq!(sources[1]["place"].text(), "3-5");
    assert_eq!(sources[1]["values"].numbers()[(0, 0)], 12_345.678_901_234_567);
}

#[test]
fn json_reads_back() {
    let (_folder, path, _) = exported(Format::Json, "c.json");
    let sample = Sample::beam();
    let document: serde_json::Value = serde_json::from_str(&text(&path)).unwrap();
    let entry = |name: &str, i: usize, j: usize| document["matrix"][name][i][j].as_f64().unwrap();
    assert_eq!(Mat::from_fn(6, 6, |i, j| entry("viscous", i, j)), sample.viscous);
    assert_eq!(Mat::from_fn(6, 6, |i, j| entry("hysteretic", i, j)), sample.others[1].1);
    assert_eq!(document["sources"][1]["dofs"], serde_json::json!(["3", "5"]));
    assert_eq!(document["sources"][0]["parameters"]["c"].as_f64(), Some(1.0 / 3.0));
}

/// A bulk-data number: exponent after `E` or `D`.
fn real(field: &str) -> f64 {
    field.trim().replace('D', "E").parse().unwrap()
}

fn field(line: &str, start: usize, width: usize) -> &str {
    line.get(start..(start + width).min(line.len())).unwrap_or("").trim()
}

/// Grid and component in the program's own numbering: clamped node 1, free nodes 2 to 4; deflection 3, rotation 5.
fn dof_of(grid: usize, component: usize) -> usize {
    2 * (grid - 2) + usize::from(component == 5)
}

#[test]
fn nastran_dashpots_read_back() {
    let (_folder, path, warnings) = exported(Format::Nastran, "c.bdf");
    assert_eq!(warnings.len(), 2, "Coulomb and hysteretic are no dashpots: {warnings:?}");
    let text = text(&path);
    assert!(warnings.iter().all(|w| text.contains(w)));
    let mut read = Mat::<f64>::zeros(6, 6);
    let lines: Vec<&str> = text.lines().collect();
    for (at, line) in lines.iter().enumerate().filter(|(_, l)| l.starts_with("CDAMP2*")) {
        // Element, coefficient, grid, component; grid and component of the second end in the line below.
        assert!(line.len() == 8 + 4 * 16 && lines[at + 1].starts_with('*'));
        let c = real(field(line, 24, 16));
        let i = dof_of(field(line, 40, 16).parse().unwrap(), field(line, 56, 16).parse().unwrap());
        read[(i, i)] += c;
        let (grid, component) = (field(lines[at + 1], 8, 16), field(lines[at + 1], 24, 16));
        if !grid.is_empty() {
            let j = dof_of(grid.parse().unwrap(), component.parse().unwrap());
            read[(j, j)] += c;
            read[(i, j)] -= c;
            read[(j, i)] -= c;
        }
    }
    assert_near(&read, &Sample::beam().viscous);
}

/// Ten digits are the least that a large field holds.
fn assert_near(read: &Mat<f64>, expected: &Mat<f64>) {
    for i in 0..6 {
        for j in 0..6 {
            let (a, b) = (read[(i, j)], expected[(i, j)]);
            assert!((a - b).abs() <= 1e-10 * b.abs(), "({i},{j}) {a} {b}");
        }
    }
}

#[test]
fn nastran_matrix_reads_back() {
    let (folder, _, _) = exported(Format::Nastran, "c.bdf");
    let text = text(&folder.path().join("c-dmig.bdf"));
    let mut read = Mat::<f64>::zeros(6, 6);
    let mut column = 0;
    for line in text.lines().filter(|l| !l.starts_with('$')) {
        assert!(line.len() <= 72, "{line}");
        let card_field = |k: usize| field(line, 8 + 16 * k, 16);
        if line.starts_with("DMIG*") {
            assert_eq!(card_field(0), "CDAMP");
            column = dof_of(card_field(1).parse().unwrap(), card_field(2).parse().unwrap());
        } else if line.starts_with('*') {
            let row = dof_of(card_field(0).parse().unwrap(), card_field(1).parse().unwrap());
            read[(row, column)] = real(card_field(2));
            read[(column, row)] = real(card_field(2));
        } else {
            assert_eq!(line.split_whitespace().collect::<Vec<_>>(), ["DMIG", "CDAMP", "0", "6", "2", "0"]);
        }
    }
    assert_near(&read, &Sample::beam().viscous);
}

#[test]
fn abaqus_reads_back() {
    let (_folder, path, warnings) = exported(Format::Abaqus, "c.inp");
    assert_eq!(warnings.len(), 2);
    let text = text(&path);
    let lines: Vec<&str> = text.lines().filter(|l| !l.starts_with("**")).collect();
    let mut read = Mat::<f64>::zeros(6, 6);
    for block in lines.chunks(5) {
        let numbers = |k: usize| block[k].split(',').map(|w| w.trim().parse::<usize>().unwrap()).collect::<Vec<_>>();
        let nodes = numbers(1)[1..].to_vec();
        let directions = numbers(3);
        let c: f64 = block[4].parse().unwrap();
        let i = dof_of(nodes[0], directions[0]);
        read[(i, i)] += c;
        if block[0].contains("DASHPOT2") {
            let j = dof_of(nodes[1], directions[1]);
            read[(j, j)] += c;
            read[(i, j)] -= c;
            read[(j, i)] -= c;
        } else {
            assert!(block[0].contains("DASHPOT1"));
        }
    }
    assert_eq!(read, Sample::beam().viscous);
}

#[test]
fn a_folder_that_is_not_there_is_said_in_one_line_and_nothing_is_left() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("missing").join("c.csv");
    let error = write(&Sample::beam().identified(), Format::Csv, &path).unwrap_err().to_string();
    assert!(error.contains("c.csv") && error.contains("choose a folder") && !error.contains('\n'), "{error}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn an_old_file_is_replaced_whole() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("c.json");
    fs::write(&path, "x".repeat(1_000_000)).unwrap();
    write(&Sample::beam().identified(), Format::Json, &path).unwrap();
    assert!(serde_json::from_str::<serde_json::Value>(&text(&path)).is_ok());
}
