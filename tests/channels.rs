//! Reversed, exchanged and misread channels are named before any law is looked for, and mended in the mapping.
#![allow(clippy::unwrap_used, clippy::disallowed_methods, missing_docs, reason = "tests")]

#[path = "channels/delays.rs"]
mod delays;
#[path = "channels/energies.rs"]
mod energies;
#[path = "channels/in_time.rs"]
mod in_time;

use dashpot::cli::answer;
use serde_json::Value;
use std::path::{Path, PathBuf};

const SENSORS: [usize; 5] = [3, 7, 11, 15, 19];
/// Time for a search: faults of channels come first, what laws there are is not asked here.
const SECONDS: &str = "5";

fn beam(youngs_modulus: f64) -> String {
    format!(
        "[project]\nformat = 1\ntitle = \"test\"\n[structure]\nkind = \"beam\"\nlength = 0.56\nbreadth = 0.04\ndepth = 0.004\n\
         youngs_modulus = {youngs_modulus:?}\ndensity = 2700.0\nelements = 10\nsupports = \"clamped-free\"\n\
         [[source]]\nlaw = \"viscous\"\ndofs = [19]\nstate = \"known\"\nc = 0.2\n"
    )
}

fn runs(exciting: bool) -> String {
    let run_table = |(i, f): (usize, &f64)| {
        let force = if exciting { "force_dof = 19\nforce_n = 1.0\n" } else { "" };
        format!("[[run]]\nfile = \"run-{i}.csv\"\nfrequency = {f:?}\n{force}")
    };
    [9.6, 11.2, 61.0, 66.0, 176.0, 186.0].iter().enumerate().map(run_table).collect()
}

/// Records of a beam, hidden friction and all, beside a project whose stiffness is 2 % too high.
fn recorded() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let channels: Vec<String> = SENSORS.iter().map(|dof| format!("\"acc@{dof} [m/s^2]\"")).collect();
    let simulate = format!("[simulate]\nchannels = [\"force@19 [N]\", {}]\n", channels.join(", "));
    let hidden = "[[source]]\nlaw = \"coulomb\"\ndofs = [9]\nstate = \"known\"\nforce = 0.05\n";
    let truth = folder.path().join("truth.toml");
    std::fs::write(&truth, [&beam(69e9), hidden, &runs(true), &simulate].concat()).unwrap();
    run(&["simulate", "--noise", "0.01", "--seed", "4", "--out"], &[folder.path(), &truth]);
    std::fs::write(folder.path().join("project.toml"), beam(70.4e9) + &runs(false)).unwrap();
    folder
}

fn run(words: &[&str], paths: &[&Path]) -> String {
    let words = ["dashpot"].iter().chain(words).map(Into::into);
    answer(words.chain(paths.iter().map(|path| (*path).into()))).unwrap()
}

/// Changes every record: its header, and the values of each row.
fn changed(folder: &Path, header: impl Fn(&str) -> String, values: impl Fn(&mut [f64])) {
    for i in 0..6 {
        let path = folder.join(format!("run-{i}.csv"));
        let text = std::fs::read_to_string(&path).unwrap();
        let mut lines = text.lines();
        let mut out = header(lines.next().unwrap()) + "\n";
        for line in lines {
            let mut row: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            values(&mut row);
            out.push_str(&row.iter().map(ToString::to_string).collect::<Vec<_>>().join(","));
            out.push('\n');
        }
        std::fs::write(&path, out).unwrap();
    }
}

/// What `diagnose` says of the channels, and the project with that mended.
fn diagnosed(folder: &Path) -> (Value, PathBuf) {
    let mended = folder.join("mended.toml");
    let text = run(&["diagnose", "--json", "--seconds", SECONDS, "--apply"], &[&mended, &folder.join("project.toml")]);
    (serde_json::from_str(&text).unwrap(), mended)
}

/// What `diagnose` says of the mended project.
fn diagnosed_again(mended: &Path) -> Value {
    serde_json::from_str(&run(&["diagnose", "--json", "--seconds", SECONDS], &[mended])).unwrap()
}

fn words(document: &Value) -> Vec<&str> {
    document["channel_faults"].as_array().unwrap().iter().map(|fault| fault["words"].as_str().unwrap()).collect()
}

#[test]
fn sound_channels_raise_no_alarm_beside_hidden_friction_and_a_detuned_model() {
    let folder = recorded();
    let (document, _) = diagnosed(folder.path());
    assert!(words(&document).is_empty(), "{:?}", words(&document));
    assert_eq!(document["not_looked_for"], Value::Null);
}

#[test]
fn a_reversed_channel_is_named_and_mended() {
    let folder = recorded();
    changed(folder.path(), str::to_owned, |row| row[3] = -row[3]);
    let (document, mended) = diagnosed(folder.path());
    assert_eq!(words(&document), ["acc@7 looks reversed"]);
    let fault = &document["channel_faults"][0];
    assert!(fault["error_after"].as_f64().unwrap() < 0.5 * fault["error_before"].as_f64().unwrap(), "{fault}");
    assert!(std::fs::read_to_string(&mended).unwrap().contains("sign = -1"));
    let again = diagnosed_again(&mended);
    assert!(words(&again).is_empty(), "{:?}", words(&again));
}

#[test]
fn exchanged_channels_are_named_and_mended() {
    let folder = recorded();
    let swap = |header: &str| header.replace("acc@7", "acc@x").replace("acc@15", "acc@7").replace("acc@x", "acc@15");
    changed(folder.path(), swap, |_| {});
    let (document, mended) = diagnosed(folder.path());
    assert_eq!(words(&document), ["acc@15 and acc@7 look exchanged"]);
    let again = diagnosed_again(&mended);
    assert!(words(&again).is_empty(), "{:?}", words(&again));
}

#[test]
fn a_wrong_unit_is_named_and_mended() {
    let folder = recorded();
    // The file gives g and its header says m/s^2.
    changed(folder.path(), str::to_owned, |row| row[4] /= 9.806_65);
    let (document, mended) = diagnosed(folder.path());
    assert_eq!(words(&document), ["acc@11 reads 9.81 times too small: g read as m/s^2?"]);
    assert_eq!(document["suggestions"][0]["effect"], "gain");
    assert_eq!(document["suggestions"][0]["channel"], "acc@11");
    let again = diagnosed_again(&mended);
    assert!(words(&again).is_empty(), "{:?}", words(&again));
}

#[test]
fn a_unit_that_all_motions_share_is_named_once_and_mended() {
    let folder = recorded();
    changed(folder.path(), str::to_owned, |row| row[2..].iter_mut().for_each(|acc| *acc /= 9.806_65));
    let (document, mended) = diagnosed(folder.path());
    assert_eq!(words(&document), ["all 5 acc channels read 9.81 times too small: g read as m/s^2?"]);
    let fault = &document["channel_faults"][0];
    assert!(fault["error_after"].as_f64().unwrap() < 0.35 * fault["error_before"].as_f64().unwrap(), "{fault}");
    assert_eq!(std::fs::read_to_string(&mended).unwrap().matches("factor = 9.80665").count(), 5);
    let again = diagnosed_again(&mended);
    assert!(words(&again).is_empty(), "{:?}", words(&again));
}

#[test]
fn a_reversed_force_is_named_and_mended_beside_a_reversed_sensor() {
    let folder = recorded();
    changed(folder.path(), str::to_owned, |row| (row[1], row[3]) = (-row[1], -row[3]));
    let (document, mended) = diagnosed(folder.path());
    let mut said = words(&document);
    said.sort_unstable();
    assert_eq!(said, ["acc@7 looks reversed", "force@19 looks reversed against the motions"]);
    assert_eq!(std::fs::read_to_string(&mended).unwrap().matches("sign = -1").count(), 2);
    let again = diagnosed_again(&mended);
    assert!(words(&again).is_empty(), "{:?}", words(&again));
}

/// Nothing can be identified under a reversed force, so that it is looked for before.
#[test]
fn a_reversed_force_and_sensors_in_g_are_named_where_no_damping_is_known_yet() {
    let folder = recorded();
    let path = folder.path().join("project.toml");
    let text = beam(69e9).replace("state = \"known\"\nc = 0.2", "state = \"candidate\"") + &runs(false);
    std::fs::write(&path, text).unwrap();
    changed(folder.path(), str::to_owned, |row| {
        row[1] = -row[1];
        row[2..].iter_mut().for_each(|acc| *acc /= 9.806_65);
    });
    let said = run(&["diagnose", "--identified", "--json"], &[&path]);
    let document: Value = serde_json::from_str(&said).unwrap();
    assert_eq!(words(&document), ["all 5 acc channels look reversed and read 9.81 times too small: g read as m/s^2?"]);
    let c = document["identified"][0]["parameters"]["c"].as_f64().unwrap();
    // Friction that is hidden beside it takes its share.
    assert!((0.2..0.4).contains(&c), "{c}");
}

#[test]
fn a_model_without_its_damping_is_no_misread_channel() {
    let folder = recorded();
    let undamped = beam(69e9).replace("c = 0.2", "c = 0.0005") + &runs(false);
    std::fs::write(folder.path().join("project.toml"), undamped).unwrap();
    let (document, _) = diagnosed(folder.path());
    assert!(words(&document).is_empty(), "{:?}", words(&document));
}

/// Where the damping itself is still to be found, it is found anew once the channels are mended.
#[test]
fn what_was_identified_from_faulty_channels_is_identified_again() {
    let folder = recorded();
    let path = folder.path().join("project.toml");
    let text = beam(69e9).replace("state = \"known\"\nc = 0.2", "state = \"candidate\"")
        + "[[source]]\nlaw = \"viscous\"\ndofs = [9]\nstate = \"candidate\"\n"
        + &runs(false);
    std::fs::write(&path, text).unwrap();
    changed(folder.path(), ToOwned::to_owned, |row| row[3] = -row[3]);
    let mended = folder.path().join("mended.toml");
    let said = run(&["diagnose", "--identified", "--json", "--apply"], &[&mended, &path]);
    let document: Value = serde_json::from_str(&said).unwrap();
    assert_eq!(words(&document), ["acc@7 looks reversed"]);
    let written = std::fs::read_to_string(&mended).unwrap();
    assert_eq!(written.matches("sign = -1").count(), 1, "{written}");
    let found = document["identified"].as_array().unwrap();
    let tip = found.iter().find(|source| source["dofs"][0] == "19").unwrap();
    assert!((tip["parameters"]["c"].as_f64().unwrap() / 0.2 - 1.0).abs() < 0.1, "{found:?}");
    // The error of the model as it is goes before that with the sensor turned.
    let steps = document["steps"].as_array().unwrap();
    assert_eq!(steps[0]["error"], document["error_before"]);
    assert!(steps[1]["error"].as_f64().unwrap() < 0.5 * steps[0]["error"].as_f64().unwrap(), "{steps:?}");
}

/// Frequency responses of the beam, hit at some nodes, with noise and coherences; and what a project says of their DOFs.
fn hit(forces: &[usize], said: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let forces = forces.iter().map(|dof| format!("\"force@{dof} [N]\""));
    let channels: Vec<String> = forces.chain(SENSORS.iter().map(|dof| format!("\"acc@{dof} [m/s^2]\""))).collect();
    let simulate = format!("[simulate]\nsamples = 801\nchannels = [{}]\n", channels.join(", "));
    let frf = "[[frf]]\nfile = \"hammer.uff\"\naverages = 8\n";
    let truth = folder.path().join("truth.toml");
    std::fs::write(&truth, [&beam(69e9), frf, "band = [0, 400]\n", &simulate].concat()).unwrap();
    run(&["simulate", "--noise", "0.01", "--seed", "4", "--as", "frf", "--out"], &[folder.path(), &truth]);
    let known = beam(70e9).replace("\"known\"\nc = 0.2", "\"candidate\"");
    std::fs::write(folder.path().join("project.toml"), [&known, frf, said].concat()).unwrap();
    folder
}

#[test]
fn a_hammer_that_hit_at_another_node_is_put_there_and_the_sensor_of_that_name_stays() {
    let sound = hit(&[17, 7], "");
    assert!(words(&diagnosed(sound.path()).0).is_empty());
    // Node 9, DOF 17, is taken for the free end.
    let folder = hit(&[17, 7], "[frf.reference_dofs]\n\"9:+Z\" = 19\n");
    let (document, mended) = diagnosed(folder.path());
    assert_eq!(words(&document), ["force@19 fits the motion of the model at DOF 17: was the force there?"]);
    let fault = &document["channel_faults"][0];
    assert_eq!((fault["fault"].as_str(), fault["channels"][1].as_str()), (Some("elsewhere"), Some("force@17")));
    assert!(fault["error_before"].as_f64().unwrap() > 0.3 && fault["error_after"].as_f64().unwrap() < 0.1, "{fault}");
    assert!(words(&diagnosed_again(&mended)).is_empty());
    assert!(std::fs::read_to_string(&mended).unwrap().contains("\"9:+Z\" = 17"));
}

#[test]
fn a_sensor_at_another_node_is_put_there_and_exchanged_points_take_their_force_along() {
    // Node 6 is DOF 11.
    let folder = hit(&[19], "[frf.dofs]\n\"6:+Z\" = 13\n");
    let (document, mended) = diagnosed(folder.path());
    assert_eq!(words(&document), ["acc@13 fits the motion of the model at DOF 11: is the sensor there?"]);
    assert!(std::fs::read_to_string(&mended).unwrap().contains("\"6:+Z\" = 11"));
    assert!(words(&diagnosed_again(&mended)).is_empty());
    // Nodes 4 and 6 are DOFs 7 and 11; the one is also hit.
    let folder = hit(&[7, 19], "[frf.dofs]\n\"4:+Z\" = 11\n\"6:+Z\" = 7\n");
    let (document, mended) = diagnosed(folder.path());
    let said = words(&document);
    assert!(said.iter().any(|words| words.contains("look exchanged")), "{said:?}");
    assert!(said.contains(&"force@11 fits the motion of the model at DOF 7: was the force there?"), "{said:?}");
    let text = std::fs::read_to_string(&mended).unwrap();
    assert!(!text.contains("reference_dofs") && text.contains("\"4:+Z\" = 7"), "{text}");
    assert!(words(&diagnosed_again(&mended)).is_empty());
}

/// One hammer at three points, its cable turned: one parameter, not as many as there are sensors.
#[test]
fn a_reversed_hammer_that_roves_is_named_and_not_all_sensors() {
    let folder = hit(&[7, 13, 19], "scale = -1.0\n");
    let (document, mended) = diagnosed(folder.path());
    assert_eq!(words(&document), ["all 3 force channels look reversed against the motions"]);
    assert!(words(&diagnosed_again(&mended)).is_empty());
}
