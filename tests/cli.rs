//! The program from outside: exit statuses, one line on standard error, nothing written where something is wrong.
#![allow(clippy::disallowed_methods, clippy::unwrap_used, reason = "tests")]

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
