//! Records with one fault each: refused with its place, or left out and said; never a result that looks like one.

use super::onto_model::{BEAM, onto, recorded};
use super::{dashpot, imported, json};
use std::fs;
use std::path::Path;

const HEADER: &str = "Time [s],Kraft P10 [N],Beschl. P4 [m/s²],Beschl. P8 [m/s²],Beschl. P10 [m/s²]";

/// Records of a beam and their project `p.toml`, which states the dashpot that made them.
fn tested(folder: &Path) -> String {
    let files = recorded(folder, HEADER);
    let (_, project) = onto(folder, &files, BEAM).unwrap();
    let path = folder.join("p.toml");
    let known = "[[source]]\nlaw = \"viscous\"\ndofs = [\"5z\"]\nstate = \"known\"\nc = 0.4\n";
    fs::write(&path, format!("{project}\n{known}")).unwrap();
    path.display().to_string()
}

/// Changes the lines of `r1.csv`.
fn changed(folder: &Path, change: impl Fn(usize, &str) -> String) {
    let path = folder.join("r1.csv");
    let text = fs::read_to_string(&path).unwrap();
    let lines: String = text.lines().enumerate().map(|(i, line)| change(i + 1, line)).collect();
    fs::write(path, lines).unwrap();
}

/// The line with the cell of a column, from 0, in place of its own.
fn with_cell(line: &str, column: usize, cell: &str) -> String {
    let mut cells: Vec<&str> = line.split(',').collect();
    cells[column] = cell;
    cells.join(",") + "\n"
}

#[test]
fn a_stray_text_between_rows_is_named_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let project = tested(folder.path());
    changed(folder.path(), |n, line| if n == 201 { format!("Overload,,,,\n{line}\n") } else { format!("{line}\n") });
    let file = folder.path().join("r1.csv").display().to_string();
    let expected = format!("{file}, line 201: \"Overload\" stands between rows of one table");
    for words in [&["compare", project.as_str()][..], &["import", &file], &["identify", &project]] {
        let said = dashpot(words).unwrap_err();
        assert!(said.contains(&expected), "{words:?}: {said}");
    }
    // Two tables that are truly there are two sets: the second begins anew.
    let rows = |from: f64| (0..40).map(|i| format!("{},{i},{i}\n", from + f64::from(i) / 64.0)).collect::<String>();
    fs::write(&file, format!("Time [s],Force 1 [N],Acc 1 [g]\n{}Second\n{}", rows(0.0), rows(0.0))).unwrap();
    assert!(dashpot(&["contents", &file]).unwrap().contains("2: time"));
}

#[test]
fn a_number_that_no_sensor_reads_is_refused_with_its_channel_and_sample() {
    let folder = tempfile::tempdir().unwrap();
    let project = tested(folder.path());
    changed(folder.path(), |n, line| if n == 52 { with_cell(line, 4, "1e300") } else { format!("{line}\n") });
    let said = dashpot(&["compare", &project]).unwrap_err();
    let expected =
        "channel acc@10z: sample 51 is 1e300 (SI units), more than any sensor reads; mend the number or remove the row";
    assert!(said.contains(&format!("r1.csv, {expected}")), "{said}");
}
