//! A sensor that is loose, so that its gain is another in each run, on a chain whose model is off by some per cent and lacks a law: the sensor
//! is named with its scatter and the law is told all the same. Truth: the program's own simulation, what the sensor reads changed in its files.

use super::quiet_sensors::{chain, run};
use serde_json::Value;

/// Gains of the loose sensor, run by run.
const GAINS: [f64; 10] = [1.06, 0.93, 1.01, 1.09, 0.95, 0.98, 1.07, 0.9, 1.03, 0.99];

/// What `diagnose` says where a cubic spring is hidden between the masses 2 and 3 and the sensor at mass `loose`, if any, is loose.
fn diagnosed(loose: Option<usize>) -> Value {
    let damping = [0.8, 4e-5];
    let is = chain([&[1.02, 1.47, 0.99, 1.22], &[9200.0, 0.0, 0.0, 5150.0], &[20600.0, 24400.0, 30900.0]], damping);
    let stated = chain([&[1.0, 1.5, 1.0, 1.2], &[9000.0, 0.0, 0.0, 5000.0], &[20000.0, 25000.0, 30000.0]], damping);
    let folder = tempfile::tempdir().unwrap();
    let (mut driven_runs, mut measured) = (String::new(), String::new());
    for k in 0..GAINS.len() {
        let head = format!("[[run]]\nfile = \"{k}.csv\"\nfrequency = {:?}\n", [7.6, 8.0, 8.4, 19.6, 20.4][k % 5]);
        measured.push_str(&head);
        driven_runs.push_str(&format!("{head}force_dof = 1\nforce_n = {:?}\n", if k < 5 { 4.0 } else { 16.0 }));
    }
    let hidden = "[[source]]\nlaw = \"cubic_stiffness\"\ndofs = [2, 3]\nstate = \"known\"\nstiffness = 4e8\n";
    let channels: String = (1..=4).map(|dof| format!(", \"acc@{dof} [m/s^2]\"")).collect();
    let simulate = format!("[simulate]\nchannels = [\"force@1 [N]\"{channels}]\n");
    let (truth, project) = (folder.path().join("truth.toml"), folder.path().join("project.toml"));
    std::fs::write(&truth, [&is, hidden, &driven_runs, &simulate].concat()).unwrap();
    std::fs::write(&project, stated + &measured).unwrap();
    run(&["simulate", "--noise", "0.002", "--seed", "7", "--out"], &[folder.path(), &truth]);
    for (k, gain) in GAINS.iter().enumerate() {
        let Some(column) = loose.map(|dof| dof + 1) else { continue };
        let path = folder.path().join(format!("{k}.csv"));
        let text = std::fs::read_to_string(&path).unwrap();
        let (header, rows) = text.split_once('\n').unwrap();
        let changed = |row: &str| {
            let mut cells: Vec<String> = row.split(',').map(str::to_owned).collect();
            cells[column] = (gain * cells[column].parse::<f64>().unwrap()).to_string();
            cells.join(",") + "\n"
        };
        let rows: String = rows.lines().map(changed).collect();
        std::fs::write(&path, format!("{header}\n{rows}")).unwrap();
    }
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
    let said = diagnosed(Some(3));
    let faults = said["channel_faults"].as_array().unwrap();
    assert_eq!(faults.len(), 1, "{faults:?}");
    assert!(faults[0]["fault"] == "unreliable" && faults[0]["channels"][0] == "acc@3", "{faults:?}");
    let scatter = faults[0]["scatter"].as_f64().unwrap();
    let truth = (GAINS.iter().map(|gain| (gain - 1.0).powi(2)).sum::<f64>() / GAINS.len() as f64).sqrt();
    assert!((scatter / truth).ln().abs() < 2.0_f64.ln(), "{scatter} {truth}");
    assert_cubic(&said);
}

#[test]
fn without_one_no_sensor_is_doubted() {
    let said = diagnosed(None);
    assert_eq!(said["channel_faults"].as_array().unwrap().len(), 0, "{said}");
    assert_cubic(&said);
}
