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

/// What `compare` says of `r1.csv`: whether it is used, its channels, and the flags in words.
fn compared(project: &str) -> (bool, usize, String) {
    let found = json(&["compare", "--json", project]);
    let run = found["runs"].as_array().unwrap().iter().find(|run| run["file"] == "r1.csv").unwrap().clone();
    let said = dashpot(&["compare", project]).unwrap();
    (run["used"].as_bool().unwrap(), run["channels"].as_array().unwrap().len(), said)
}

#[test]
fn a_run_without_force_is_left_out_unless_it_is_insisted_on() {
    let folder = tempfile::tempdir().unwrap();
    let project = tested(folder.path());
    changed(folder.path(), |n, line| if n > 1 { with_cell(line, 1, "0") } else { format!("{line}\n") });
    let (used, _, said) = compared(&project);
    assert!(!used && said.contains("r1.csv: left out, dead-channel: force@10z does not move at all"), "{said}");
    let found = json(&["compare", "--json", &project]);
    assert!(found["error"].as_f64().unwrap() < 0.01, "{}", found["error"]);
    let identified = json(&["identify", "--json", &project]);
    assert!(
        identified["warnings"].to_string().contains("r1.csv: its force is zero, so it is left out"),
        "{identified}"
    );
    let text = fs::read_to_string(&project).unwrap();
    fs::write(&project, text.replace("file = \"r1.csv\"\n", "file = \"r1.csv\"\nuse = true\n")).unwrap();
    assert!(compared(&project).0);
}

#[test]
fn a_sensor_that_stands_still_is_left_out_of_its_run() {
    let folder = tempfile::tempdir().unwrap();
    let project = tested(folder.path());
    changed(folder.path(), |n, line| if n > 1 { with_cell(line, 3, "0.25") } else { format!("{line}\n") });
    let (used, channels, said) = compared(&project);
    assert_eq!((used, channels), (true, 2), "{said}");
    let expected =
        "r1.csv: dead-channel: acc@8z does not move at all: the channel is left out (`use = true` at the run keeps it)";
    assert!(said.contains(expected), "{said}");
    let found = json(&["compare", "--json", &project]);
    assert!(found["error"].as_f64().unwrap() < 0.01, "{}", found["error"]);
    let text = fs::read_to_string(&project).unwrap();
    fs::write(&project, text.replace("file = \"r1.csv\"\n", "file = \"r1.csv\"\nuse = true\n")).unwrap();
    assert_eq!(compared(&project).1, 3);
}

#[test]
fn rows_out_of_order_and_files_that_were_cut_off_are_told_by_their_line() {
    let folder = tempfile::tempdir().unwrap();
    let project = tested(folder.path());
    let path = folder.path().join("r1.csv");
    let good = fs::read_to_string(&path).unwrap();
    let mut lines: Vec<&str> = good.lines().collect();
    lines.swap(100, 101);
    fs::write(&path, lines.join("\n")).unwrap();
    let said = dashpot(&["compare", &project]).unwrap_err();
    assert!(
        said.contains("r1.csv: the time goes back in line 102: ") && said.contains("sort the rows by time"),
        "{said}"
    );
    let cut: Vec<&str> = good.lines().take(150).collect();
    let last: Vec<&str> = cut[149].split(',').take(3).collect();
    fs::write(&path, format!("{}\n{}", cut[..149].join("\n"), last.join(","))).unwrap();
    let said = dashpot(&["compare", &project]).unwrap_err();
    let expected = "r1.csv: the file ends in line 150, which has 3 of 5 cells: it was cut off; copy or export it again";
    assert!(said.contains(expected), "{said}");
}

#[test]
fn the_template_is_the_mapping_that_import_writes() {
    let folder = tempfile::tempdir().unwrap();
    tested(folder.path());
    let [file, map] = ["r0.csv", "model.toml"].map(|name| folder.path().join(name).display().to_string());
    let proposed = dashpot(&["import", &file, "--map", &map, "--propose"]).unwrap();
    let project = fs::read_to_string(folder.path().join("p.toml")).unwrap();
    for place in ["dof = \"4z\"", "dof = \"8z\"", "dof = \"10z\""] {
        assert!(proposed.contains(place) && project.contains(place), "{place}: {proposed}\n{project}");
    }
}

#[test]
fn the_table_under_a_chain_moves_along_its_axis() {
    let folder = tempfile::tempdir().unwrap();
    let wave = |t: f64, size: f64, phase: f64| size * (40.0 * t + phase).sin();
    let row = |i: i32| {
        let t = f64::from(i) / 500.0;
        format!("{t},{},{},{}\n", wave(t, 1.0, 0.0), wave(t, 1.4, 0.1), wave(t, 1.7, 0.2))
    };
    let rows: String = (0..1500).map(row).collect();
    let file = folder.path().join("quake.csv");
    fs::write(&file, format!("Time [s],Table acc [m/s^2],Floor 1 acc [m/s^2],Floor 2 acc [m/s^2]\n{rows}")).unwrap();
    let chain = "[base]\nresponse = \"absolute\"\n[structure]\nkind = \"chain\"\nmasses = [2.0, 2.0]\n\
                 ground_stiffness = [9e4, 0.0]\ncoupling_stiffness = [9e4]\n";
    let (said, project) = onto(folder.path(), &[file.display().to_string()], chain).unwrap();
    assert!(project.contains("quantity = \"base\"\ndof = \"x\""), "{project}");
    assert!(said.contains("base@x: the model moves along x only: so does its base"), "{said}");
}

#[test]
fn levels_of_a_table_of_amplitudes_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let row = |(i, level): (i32, i32)| format!("{level};{};{level};{};{}\n", 20 + i, 3 + i, 100 - i);
    let rows: String = [1, 3].into_iter().flat_map(|level| (0..6).map(move |i| (i, level))).map(row).collect();
    let table = format!("Level;Frequency [Hz];Force N4 [N];Acc N4 [m/s^2];Phase Acc N4 [deg]\n{rows}");
    let (said, project) = imported(folder.path(), "steps.csv", &table, &[]);
    assert!(said.contains("12 runs in 1 table at 2 levels") && !said.contains("not mapped"), "{said}");
    assert!(!project.contains("Not mapped"), "{project}");
    let path = folder.path().join("project.toml");
    let loaded = dashpot::exchange::project::load(&path, &dashpot::control::Control::unattended()).unwrap();
    let levels: Vec<_> = loaded.runs.iter().map(|run| run.level).collect();
    assert_eq!((levels[0], levels[5], levels[6], levels.len()), (Some(1), Some(1), Some(3), 12));
    let broken = table.replace("\n3;21;", "\n2.5;21;");
    fs::write(folder.path().join("steps.csv"), broken).unwrap();
    let said = dashpot(&["identify", &path.display().to_string()]).unwrap_err();
    assert!(said.contains("channel \"Level\": row 8 is 2.5, and levels are whole numbers"), "{said}");
}

#[test]
fn a_force_and_a_motion_of_two_rates_are_no_project_of_a_force_alone() {
    let folder = tempfile::tempdir().unwrap();
    let rows = |count: i32, rate: f64| -> String {
        (0..count).map(|i| format!("{};{}\n", f64::from(i) / rate, (f64::from(i) / rate * 60.0).sin())).collect()
    };
    let text = format!("Time [s];Force 5 [N]\n{}\nTime [s];Acc 5 [g]\n{}", rows(2000, 500.0), rows(400, 100.0));
    let file = folder.path().join("rates.csv").display().to_string();
    fs::write(&file, text).unwrap();
    let out = folder.path().join("p.toml");
    let said = dashpot(&["import", &file, "--out", &out.display().to_string()]).unwrap_err();
    assert!(said.contains("\"Acc 5\" and the force \"Force 5\" are not recorded together"), "{said}");
    assert!(said.contains("export all channels at one rate") && !out.exists(), "{said}");
}
