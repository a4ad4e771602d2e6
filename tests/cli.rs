//! The program from outside: exit statuses, one line on standard error, nothing written where something is wrong.
#![allow(clippy::disallowed_methods, clippy::unwrap_used, reason = "tests")]

#[path = "cli/records.rs"]
mod records;
#[path = "cli/unsettled.rs"]
mod unsettled;

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

const GOOD: &str = "[project]\nformat = 1\n[structure]\nkind = \"chain\"\nmasses = [1, 2]\nground_stiffness = [1e4, 0]\n\
    coupling_stiffness = [2e4]\n[[source]]\nlaw = \"viscous\"\ndofs = [1, 2]\nstate = \"known\"\nc = 3\n\
    [[run]]\nfile = \"run-01.csv\"\nfrequency = 12\nforce_dof = 2\nforce_n = 5\n\
    [simulate]\nchannels = [\"force@2 [N]\", \"acc@1 [m/s^2]\"]\nsamples = 200\nperiods = 8\n";

fn dashpot(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_dashpot"))
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::null())
        .output()
        .unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn bad_projects_end_with_status_1_one_line_and_nothing_written() {
    let cases = [
        ("", "p.toml:1: the project lacks `project`; add `[project]`"),
        ("[project\n", "p.toml:1: not valid TOML"),
        (&GOOD.replace("format = 1", "format = 9"), "p.toml:2: format 9 was written by a newer version"),
        (&GOOD.replace("dofs = [1, 2]", "dofs = [1, 7]"), "p.toml:10: there is no DOF \"7\""),
        (
            &GOOD.replace("state = \"known\"", "stat = \"known\""),
            "p.toml:11: [[source]] has no key `stat`; did you mean `state`?",
        ),
        (&GOOD.replace("c = 3", "c = nan"), "p.toml:12: `c = nan` is not a usable number"),
        (&GOOD.replace("masses = [1, 2]", "masses = [1, 0]"), "p.toml:5: mass 2 is 0 kg"),
        (&GOOD.replace("acc@1 [m/s^2]", "acc@1 [kg]"), "p.toml:19: "),
        (
            &GOOD.replace("frequency = 12\n", ""),
            "p.toml:14: run run-01.csv: the frequency is not given and there is no record to take it from; add `frequency",
        ),
        (
            &GOOD.replace("force_dof = 2\nforce_n = 5\n", ""),
            "p.toml:14: the record run-01.csv is not there; correct `file`, which is relative to the project",
        ),
        (
            &GOOD.replace("law = \"viscous\"", "law = \"coulomb\"").replace("c = 3", "c = 3\nforce = 1"),
            "p.toml:12: [[source]] has no key `c`; it takes",
        ),
        (&GOOD.replace("force_n = 5\n", ""), "p.toml:16: `force_dof` is there without `force_n`; give both or none"),
    ];
    for (project, expected) in cases {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("p.toml"), project).unwrap();
        let output = dashpot(&["simulate", "p.toml", "--out", "made"], folder.path());
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{message}");
        assert_eq!(message.lines().count(), 1, "{message}");
        assert!(message.starts_with(expected), "{message}\nis not\n{expected}");
        assert!(output.stdout.is_empty());
        assert_eq!(names(folder.path()), ["p.toml"], "nothing else is written");
    }
    let folder = tempfile::tempdir().unwrap();
    let output = dashpot(&["simulate", "none.toml", "--out", "made"], folder.path());
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).starts_with("none.toml: cannot be read: "));
    assert!(names(folder.path()).is_empty());
}

#[test]
fn good_projects_end_with_status_0_and_their_records() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("p.toml"), GOOD).unwrap();
    let output = dashpot(&["simulate", "p.toml", "--out", "made"], folder.path());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert_eq!(names(&folder.path().join("made")), ["run-01.csv"]);
    let record = fs::read_to_string(folder.path().join("made/run-01.csv")).unwrap();
    assert_eq!(record.lines().next(), Some("time [s],force@2 [N],acc@1 [m/s^2]"));
    assert_eq!(record.lines().count(), 201);
}

#[test]
fn records_are_written_inside_their_folder_only() {
    let folder = tempfile::tempdir().unwrap();
    let absolute = folder.path().join("away.csv").display().to_string();
    for name in ["../away.csv", "deep/../../away.csv", &absolute] {
        fs::write(folder.path().join("p.toml"), GOOD.replace("run-01.csv", name)).unwrap();
        let output = dashpot(&["simulate", "p.toml", "--out", "made"], folder.path());
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{message}");
        assert_eq!(message.lines().count(), 1, "{message}");
        assert!(message.starts_with(&format!("p.toml:14: the record {name} would be written outside")), "{message}");
        assert_eq!(names(folder.path()), ["p.toml"], "nothing else is written");
    }
    fs::write(folder.path().join("p.toml"), GOOD.replace("run-01.csv", "deep/run-01.csv")).unwrap();
    let output = dashpot(&["simulate", "p.toml", "--out", "made"], folder.path());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert_eq!(names(&folder.path().join("made/deep")), ["run-01.csv"]);
}

#[test]
fn records_are_made_by_time_integration_on_request() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("p.toml"), GOOD).unwrap();
    let made = |out: &str, more: &[&str]| {
        let output = dashpot(&[&["simulate", "p.toml", "--out", out], more].concat(), folder.path());
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        let record = fs::read_to_string(folder.path().join(out).join("run-01.csv")).unwrap();
        let value = |line: &str| line.rsplit(',').next().unwrap().parse::<f64>().unwrap();
        record.lines().skip(1).map(value).collect::<Vec<f64>>()
    };
    let (balanced, timed) = (made("a", &[]), made("b", &["--by", "time"]));
    let largest = balanced.iter().fold(0.0_f64, |m, y| m.max(y.abs()));
    assert!(balanced.iter().zip(&timed).all(|(a, b)| (a - b).abs() < 1e-3 * largest));
    // The project may ask for it as well: it is one thing.
    fs::write(folder.path().join("p.toml"), GOOD.replace("[simulate]", "[simulate]\nintegrate = true")).unwrap();
    assert_eq!(made("e", &[]), timed);
    fs::write(folder.path().join("p.toml"), GOOD).unwrap();
    // From rest the motion is another at first and comes to the same.
    let rising = made("c", &["--transient", "1"]);
    let difference = |range: std::ops::Range<usize>| {
        range.map(|n| (balanced[n] - rising[n]).abs()).fold(0.0_f64, f64::max) / largest
    };
    assert!(difference(0..50) > 0.1 && difference(0..50) > difference(150..200), "{}", difference(0..50));
    fs::write(
        folder.path().join("p.toml"),
        GOOD.replace("viscous", "hysteretic").replace("c = 3", "loss_stiffness = 3"),
    )
    .unwrap();
    let output = dashpot(&["simulate", "p.toml", "--out", "d", "--by", "time"], folder.path());
    assert_eq!(output.status.code(), Some(1));
    let message = text(&output.stderr);
    assert!(message.starts_with("p.toml:14: run run-01.csv: law `hysteretic` is defined harmonic by"), "{message}");
}

#[test]
fn a_shift_of_all_frequencies_is_a_change_of_all_stiffness() {
    let folder = tempfile::tempdir().unwrap();
    let made = |project: &str| {
        fs::write(folder.path().join("p.toml"), project).unwrap();
        let output = dashpot(&["simulate", "p.toml", "--out", "made"], folder.path());
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        fs::read_to_string(folder.path().join("made/run-01.csv")).unwrap()
    };
    let shifted = made(&GOOD.replace("force_n = 5", "force_n = 5\nfrequency_shift = 0.02"));
    let stiffer = made(&GOOD.replace("[1e4, 0]", "[1.0404e4, 0]").replace("[2e4]", "[2.0808e4]"));
    assert_ne!(shifted, made(GOOD));
    let numbers = |text: &str| -> Vec<f64> {
        text.lines().skip(1).flat_map(|l| l.split(',').map(|v| v.parse().unwrap()).collect::<Vec<f64>>()).collect()
    };
    assert!(numbers(&shifted).iter().zip(numbers(&stiffer)).all(|(a, b)| (a - b).abs() < 1e-9 * (1.0 + b.abs())));
    fs::write(folder.path().join("p.toml"), GOOD.replace("force_n = 5", "force_n = 5\nfrequency_shift = 5")).unwrap();
    let output = dashpot(&["simulate", "p.toml", "--out", "made"], folder.path());
    assert!(text(&output.stderr).contains("frequency_shift"), "{}", text(&output.stderr));
}

#[test]
fn wrong_usage_ends_with_status_2() {
    let folder = tempfile::tempdir().unwrap();
    for arguments in [&["simulate"] as &[&str], &["fly", "p.toml"], &["simulate", "p.toml", "--out"], &["--wings"]] {
        let output = dashpot(arguments, folder.path());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(output.stdout.is_empty() && !output.stderr.is_empty());
    }
}

#[test]
fn help_goes_to_standard_output() {
    let output = dashpot(&["--help"], Path::new("."));
    assert_eq!(output.status.code(), Some(0));
    assert!(text(&output.stdout).contains("simulate") && output.stderr.is_empty());
}

#[test]
fn a_reader_that_leaves_early_is_no_failure() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_dashpot"))
        .arg("--help")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(!text(&output.stderr).contains("panicked"), "{}", text(&output.stderr));
    assert_eq!(output.status.code(), Some(0));
}

const SOUGHT: &str = "[project]\nformat = 1\ntitle = \"Two masses\"\n[structure]\nkind = \"chain\"\nmasses = [1, 2]\n\
    ground_stiffness = [1e4, 0]\ncoupling_stiffness = [2e4]\n[[candidates]]\nlaw = \"viscous\"\nwhere = \"each-pair\"\n\
    [[run]]\nfile = \"made/run-01.csv\"\nfrequency = 12\n";

/// Folder with simulated records in `made` and a project that seeks the dashpot of 3 N s/m between the masses.
fn measured() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let recipe = GOOD.replace("\"acc@1 [m/s^2]\"", "\"acc@1 [m/s^2]\", \"acc@2 [m/s^2]\"");
    fs::write(folder.path().join("recipe.toml"), recipe).unwrap();
    fs::write(folder.path().join("p.toml"), SOUGHT).unwrap();
    let made = dashpot(&["simulate", "recipe.toml", "--out", "made", "--noise", "0.001"], folder.path());
    assert_eq!(made.status.code(), Some(0), "{}", text(&made.stderr));
    folder
}

fn json(arguments: &[&str], folder: &Path) -> serde_json::Value {
    let output = dashpot(arguments, folder);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn identify_prints_a_table_or_one_document() {
    let folder = measured();
    let found = json(&["identify", "p.toml", "--json"], folder.path());
    assert_eq!(found["title"], "Two masses");
    assert_eq!(found["sources"][0]["dofs"], serde_json::json!(["1", "2"]));
    let c = found["sources"][0]["parameters"]["c"].as_f64().unwrap();
    assert!((c / 3.0 - 1.0).abs() < 0.01, "{c}");
    assert_eq!(found["matrix"]["viscous"][0][1].as_f64().unwrap(), -c);
    let table = dashpot(&["identify", "p.toml"], folder.path());
    assert!(
        text(&table.stdout).contains("Two masses")
            && serde_json::from_slice::<serde_json::Value>(&table.stdout).is_err()
    );
}

#[test]
fn export_writes_the_matrix_and_names_what_it_wrote() {
    let folder = measured();
    let output = dashpot(&["export", "p.toml", "--to", "mtx", "--out", "c.mtx"], folder.path());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("c.mtx"));
    assert!(fs::read_to_string(folder.path().join("c.mtx")).unwrap().starts_with("%%MatrixMarket matrix"));
    let refused = dashpot(&["export", "p.toml", "--to", "word", "--out", "c.doc"], folder.path());
    assert_eq!(refused.status.code(), Some(2));
}

#[test]
fn compare_and_diagnose_speak_of_what_is_missing() {
    let folder = measured();
    let compared = json(&["compare", "p.toml", "--json"], folder.path());
    assert_eq!(compared["runs"][0]["channels"].as_array().unwrap().len(), 2);
    assert!(compared["error"].as_f64() > compared["noise_floor"].as_f64());
    let diagnosed = json(&["diagnose", "p.toml", "--json", "--apply", "better.toml"], folder.path());
    assert!(diagnosed["verdict"].is_string() && diagnosed["steps"].is_array());
    assert!(folder.path().join("better.toml").exists() && diagnosed["error_applied"].is_null());
}

#[test]
fn a_script_is_played_on_a_project_that_stays_as_it_is() {
    let folder = measured();
    let script = r#"[{"add_source": {"law": "coulomb", "dofs": ["1"]}}, {"set_title": "Played"}, "undo"]"#;
    fs::write(folder.path().join("s.json"), script).unwrap();
    let output = dashpot(&["run", "s.json", "p.toml", "--out", "q.toml"], folder.path());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert_eq!(text(&output.stderr), "1 add Coulomb friction\n2 change title\n3 undo change title\n");
    assert_eq!(fs::read_to_string(folder.path().join("p.toml")).unwrap(), SOUGHT);
    let played = fs::read_to_string(folder.path().join("q.toml")).unwrap();
    assert!(played.contains("coulomb") && played.contains("Two masses"));
    let printed = dashpot(&["run", "s.json", "p.toml"], folder.path());
    assert_eq!(text(&printed.stdout), played);

    fs::write(folder.path().join("s.json"), r#"[{"remove_source": {"law": "coulomb", "dofs": ["2"]}}]"#).unwrap();
    let refused = dashpot(&["run", "s.json", "p.toml"], folder.path());
    assert_eq!(refused.status.code(), Some(1));
    assert!(text(&refused.stderr).starts_with("s.json: step 1 of the script"), "{}", text(&refused.stderr));
}

/// A mass without any spring, with a dashpot: the model predicts it, and what is missing is found.
#[test]
fn a_mass_without_a_spring_is_compared_and_diagnosed() {
    let folder = tempfile::tempdir().unwrap();
    let run =
        |k: usize| format!("[[run]]\nfile = \"run-{k}.csv\"\nfrequency = {}\nforce_dof = 1\nforce_n = 10\n", 2 * k);
    let head = "[project]\nformat = 1\n[structure]\nkind = \"chain\"\nmasses = [2]\nground_stiffness = [0]\ncoupling_stiffness = []\n";
    let dashpots = "[[source]]\nlaw = \"viscous\"\ndofs = [1]\nstate = \"known\"\nc = 20\n";
    let runs: String = (1..4).map(run).collect();
    fs::write(folder.path().join("p.toml"), format!("{head}{dashpots}{runs}")).unwrap();
    let made = dashpot(&["simulate", "p.toml", "--out", ".", "--noise", "0.002"], folder.path());
    assert_eq!(made.status.code(), Some(0), "{}", text(&made.stderr));
    let whole = json(&["compare", "p.toml", "--json"], folder.path());
    assert!(whole["error"].as_f64().unwrap() < 0.002, "{}", whole["error"]);
    fs::write(folder.path().join("p.toml"), format!("{head}{runs}")).unwrap();
    let found = json(&["diagnose", "p.toml", "--json"], folder.path());
    // Alone on its mass, a dashpot to the ground is damping in proportion to the mass.
    let alike = ["viscous", "mass_proportional"];
    assert!(alike.contains(&found["suggestions"][0]["effect"].as_str().unwrap()), "{}", found["suggestions"][0]);
    assert!(found["suggestions"][0]["error_after"].as_f64().unwrap() < 0.002);
}

/// An undamped model at resonance says nothing but that its damping is still to be found.
#[test]
fn damping_that_identify_finds_is_taken_over_before_the_model_is_compared() {
    let folder = tempfile::tempdir().unwrap();
    let recipe = "[project]\nformat = 1\n[structure]\nkind = \"chain\"\nmasses = [1]\nground_stiffness = [1e4]\ncoupling_stiffness = []\n\
        [[source]]\nlaw = \"viscous\"\ndofs = [1]\nstate = \"known\"\nc = 0.2\n\
        [[run]]\nfile = \"a.csv\"\nfrequency = 15.91549430918953\nforce_dof = 1\nforce_n = 1\n\
        [[run]]\nfile = \"b.csv\"\nfrequency = 15.8\nforce_dof = 1\nforce_n = 1\n";
    fs::write(folder.path().join("p.toml"), recipe).unwrap();
    dashpot(&["simulate", "p.toml", "--out", ".", "--noise", "0.001"], folder.path());
    let sought = recipe.replace("state = \"known\"\nc = 0.2", "state = \"candidate\" # the damper of the door");
    fs::write(folder.path().join("p.toml"), sought).unwrap();
    let output = dashpot(&["compare", "p.toml", "--json"], folder.path());
    assert!(text(&output.stderr).contains("the model has no damping yet"), "{}", text(&output.stderr));
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(document["error"].as_f64().unwrap() < 0.01, "{}", document["error"]);
    let c = document["identified"][0]["parameters"]["c"].as_f64().unwrap();
    assert!((c / 0.2 - 1.0).abs() < 0.01, "{c}");
    let found = json(&["diagnose", "p.toml", "--json", "--identified", "--apply", "q.toml"], folder.path());
    assert_eq!(found["identified"][0]["effect"], "viscous");
    let again = json(&["compare", "q.toml", "--json"], folder.path());
    assert!(again["error"].as_f64().unwrap() < 0.01 && again.get("identified").is_none(), "{}", again["error"]);
    let written = fs::read_to_string(folder.path().join("q.toml")).unwrap();
    assert!(written.contains("state = \"known\" # the damper of the door\n"), "{written}");
    assert_eq!(written.matches("[[source]]").count(), 1, "{written}");
}

/// Two of the samples are the same cantilever with other dashpots.
#[test]
fn what_changed_between_two_states_is_told_as_table_and_as_json() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let state = |name: &str| format!("sample-data/{name}/project.toml");
    let (before, after) = (state("cantilever-case-1"), state("cantilever-case-2"));
    let done = dashpot(&["change", &before, &after], root);
    assert!(done.status.success(), "{}", text(&done.stderr));
    let said = text(&done.stdout);
    assert!(
        said.contains("damping ratios, per cent") && said.contains("changed") && said.contains("Changed: "),
        "{said}"
    );
    let json: serde_json::Value =
        serde_json::from_slice(&dashpot(&["change", &before, &after, "--json"], root).stdout).unwrap();
    let sources = json["sources"].as_array().unwrap();
    assert!(sources.len() >= 4 && json["chance"].as_f64().unwrap() < 1e-6, "{json:#}");
    assert!(sources.iter().any(|s| s["coefficient"]["changed"] == true && s["unit"] == "N s/m"));
    // A state against itself: nothing changed.
    let same: serde_json::Value =
        serde_json::from_slice(&dashpot(&["change", &before, &before, "--json"], root).stdout).unwrap();
    assert!(same["sources"].as_array().unwrap().iter().all(|s| s["coefficient"]["changed"] == false), "{same:#}");
    let none = dashpot(&["change", &before, "--sessions", "monday,tuesday"], root);
    assert_eq!(none.status.code(), Some(1));
    assert!(
        text(&none.stderr).contains("no run is of session \"monday\"; the project has none"),
        "{}",
        text(&none.stderr)
    );
}
