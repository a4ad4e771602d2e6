//! A sensor that is loose, so that its gain is another in each run, or a run that is misread, on a chain whose model is off by some per cent
//! and lacks a law: the sensor or the run is named with its scatter or factor and the law is told all the same. Truth: the program's own
//! simulation, what the channels read changed in its files.

use super::quiet_sensors::{chain, run};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Gains of the loose sensor, run by run.
const GAINS: [f64; 10] = [1.06, 0.93, 1.01, 1.09, 0.95, 0.98, 1.07, 0.9, 1.03, 0.99];

/// Factors on the columns of a record, and of which run.
struct Misread {
    run: usize,
    /// Number of a column (0: time, 1: force, then the masses) and its factor.
    columns: Vec<(usize, f64)>,
}

/// A chain whose model is off and lacks a cubic spring between the masses 2 and 3, with records in which some columns are `misread`, as a
/// project in `folder`.
fn measured(folder: &Path, misread: &[Misread]) -> PathBuf {
    let damping = [0.8, 4e-5];
    let is = chain([&[1.02, 1.47, 0.99, 1.22], &[9200.0, 0.0, 0.0, 5150.0], &[20600.0, 24400.0, 30900.0]], damping);
    let stated = chain([&[1.0, 1.5, 1.0, 1.2], &[9000.0, 0.0, 0.0, 5000.0], &[20000.0, 25000.0, 30000.0]], damping);
    let (mut driven_runs, mut runs) = (String::new(), String::new());
    for k in 0..GAINS.len() {
        let head = format!("[[run]]\nfile = \"{k}.csv\"\nfrequency = {:?}\n", [7.6, 8.0, 8.4, 19.6, 20.4][k % 5]);
        runs.push_str(&head);
        driven_runs.push_str(&format!("{head}force_dof = 1\nforce_n = {:?}\n", if k < 5 { 4.0 } else { 16.0 }));
    }
    let hidden = "[[source]]\nlaw = \"cubic_stiffness\"\ndofs = [2, 3]\nstate = \"known\"\nstiffness = 4e8\n";
    let channels: String = (1..=4).map(|dof| format!(", \"acc@{dof} [m/s^2]\"")).collect();
    let simulate = format!("[simulate]\nchannels = [\"force@1 [N]\"{channels}]\n");
    let (truth, project) = (folder.join("truth.toml"), folder.join("project.toml"));
    std::fs::write(&truth, [&is, hidden, &driven_runs, &simulate].concat()).unwrap();
    std::fs::write(&project, stated + &runs).unwrap();
    run(&["simulate", "--noise", "0.002", "--seed", "7", "--out"], &[folder, &truth]);
    for Misread { run, columns } in misread {
        let path = folder.join(format!("{run}.csv"));
        let text = std::fs::read_to_string(&path).unwrap();
        let (header, rows) = text.split_once('\n').unwrap();
        let changed = |row: &str| {
            let mut cells: Vec<String> = row.split(',').map(str::to_owned).collect();
            for &(column, factor) in columns {
                cells[column] = (factor * cells[column].parse::<f64>().unwrap()).to_string();
            }
            cells.join(",") + "\n"
        };
        let rows: String = rows.lines().map(changed).collect();
        std::fs::write(&path, format!("{header}\n{rows}")).unwrap();
    }
    project
}

/// What `diagnose` says where records are `misread`.
fn diagnosed(misread: &[Misread]) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let project = measured(folder.path(), misread);
    serde_json::from_str(&run(&["diagnose", "--json"], &[&project])).unwrap()
}

fn assert_cubic(said: &Value) {
    let first = &said["suggestions"][0];
    assert_eq!(said["verdict"], "missing", "{said}");
    assert_eq!(
        (&first["effect"], &first["dofs"]),
        (&"cubic_stiffness".into(), &serde_json::json!(["2", "3"])),
        "{first}"
    );
    assert!(first["probability"].as_f64().unwrap() > 0.9, "{first}");
    let stiffness = first["parameters"]["stiffness"].as_f64().unwrap();
    assert!((stiffness / 4e8 - 1.0).abs() < 0.1, "{stiffness} N/m^3");
}

#[test]
fn a_loose_sensor_is_named_and_the_law_is_told_all_the_same() {
    let loose: Vec<Misread> =
        GAINS.iter().enumerate().map(|(run, &gain)| Misread { run, columns: vec![(4, gain)] }).collect();
    let said = diagnosed(&loose);
    let faults = said["channel_faults"].as_array().unwrap();
    assert_eq!(faults.len(), 1, "{faults:?}");
    assert!(faults[0]["fault"] == "unreliable" && faults[0]["channels"][0] == "acc@3", "{faults:?}");
    let scatter = faults[0]["scatter"].as_f64().unwrap();
    let truth = (GAINS.iter().map(|gain| (gain - 1.0).powi(2)).sum::<f64>() / GAINS.len() as f64).sqrt();
    assert!((scatter / truth).ln().abs() < 2.0_f64.ln(), "{scatter} {truth}");
    assert_cubic(&said);
}

#[test]
fn without_one_neither_a_sensor_nor_a_run_is_doubted() {
    let said = diagnosed(&[]);
    assert_eq!(said["channel_faults"].as_array().unwrap().len(), 0, "{said}");
    assert_eq!(said["run_faults"].as_array().unwrap().len(), 0, "{said}");
    assert_cubic(&said);
}

/// The only run that is left out, and by what factor what of it is misread.
fn assert_left_out(said: &Value, file: &str, fault: &str, channel: Option<&str>, factor: f64) {
    let faults = said["run_faults"].as_array().unwrap();
    assert_eq!(faults.len(), 1, "{faults:?}");
    assert_eq!((&faults[0]["file"], &faults[0]["fault"]), (&file.into(), &fault.into()), "{faults:?}");
    assert_eq!(faults[0]["channel"].as_str(), channel, "{faults:?}");
    let found = faults[0]["factor"].as_f64().unwrap();
    assert!((found / factor - 1.0).abs() < 0.1, "{found}");
    let [before, after] = ["error_before", "error_after"].map(|key| faults[0][key].as_f64().unwrap());
    assert!(after < 0.05 && before > 2.0 * after, "{before} {after}");
}

#[test]
fn a_channel_of_another_range_in_one_run_is_named_with_the_run() {
    let said = diagnosed(&[Misread { run: 3, columns: vec![(3, 1.4)] }]);
    assert_left_out(&said, "3.csv", "channel", Some("acc@2"), 1.4);
    assert_cubic(&said);
}

/// The force of one run is too small: its motions are 1 / 0.7 times what it gives. What is written does not use the run, and leaves what
/// was promised.
#[test]
fn a_run_of_another_force_is_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let project = measured(folder.path(), &[Misread { run: 1, columns: vec![(1, 0.7)] }]);
    let applied = folder.path().join("applied.toml");
    let said = run(&["diagnose", "--json", "--apply"], &[&applied, &project]);
    let said: Value = serde_json::from_str(&said).unwrap();
    assert_left_out(&said, "1.csv", "motions", None, 1.0 / 0.7);
    assert_cubic(&said);
    assert!(std::fs::read_to_string(&applied).unwrap().contains("use = false"));
    let compared: Value = serde_json::from_str(&run(&["compare", "--json"], &[&applied])).unwrap();
    let promised = said["suggestions"][0]["error_after"].as_f64().unwrap();
    assert!((compared["error"].as_f64().unwrap() / promised - 1.0).abs() < 0.02, "{compared} {promised}");
}
