//! The program breaks down in a process of its own; the next start offers what was not saved.

use crate::support::{beam, settle, start};
use dashpot::control::Control;
use dashpot::session::Command as Change;
use dashpot::session::recent::Recent;
use dashpot::window::crash;
use dashpot::window::document::Document;
use dashpot::window::document::edits::Edit;
use egui::accesskit::Role;
use egui_kittest::kittest::Queryable;
use std::path::{Path, PathBuf};
use std::process::Command;

const PROJECT: &str = "DASHPOT_CRASH_PROJECT";
const FOLDER: &str = "DASHPOT_CRASH_FOLDER";

/// Not a test of its own: what the program does that breaks down. Its thread bears the name of the one that draws.
#[test]
#[ignore = "the program that breaks down"]
fn victim() {
    let (Some(project), Some(folder)) = (std::env::var_os(PROJECT), std::env::var_os(FOLDER)) else { return };
    crash::watch(PathBuf::from(folder));
    let work = move || {
        let (mut document, _) = Document::open(Path::new(&project), &Control::unattended()).unwrap();
        document.apply(&Edit::Do(Change::SetTitle("Not saved".to_owned()))).unwrap();
        document.autosave().unwrap();
        panic!("as if the window had broken down");
    };
    let thread = std::thread::Builder::new().name("main".to_owned()).spawn(work).unwrap();
    assert!(thread.join().is_err());
    std::process::exit(101);
}

#[test]
fn what_was_not_saved_comes_back_by_a_button_after_a_panic() {
    let (sample, folder) = (beam(), tempfile::tempdir().unwrap());
    let status = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "crash::victim", "--ignored", "--nocapture"])
        .env(PROJECT, &sample.path)
        .env(FOLDER, folder.path())
        .stderr(std::process::Stdio::null())
        .stdout(std::process::Stdio::null())
        .status()
        .unwrap();
    assert_eq!(status.code(), Some(101));
    let mut harness = start();
    let mut recent = Recent::load(&folder.path().join("recent.json"));
    recent.add(&sample.path).unwrap();
    harness.state_mut().recent = Some(recent);
    harness.state_mut().tell_of_crash(folder.path());
    harness.run_steps(3);
    let said = harness.state().message.clone().unwrap().text;
    assert!(said.contains("broke down") && said.contains("Unsaved changes were kept"), "{said}");
    let report = std::fs::read_to_string(folder.path().join("crash.txt")).unwrap();
    assert!(report.contains("as if the window had broken down") && !report.contains("Not saved"), "no data: {report}");
    harness.get_by_role_and_label(Role::Button, "Restore").click();
    settle(&mut harness);
    let document = harness.state().document.as_ref().unwrap();
    assert_eq!(document.project.title, "Not saved");
    assert!(document.session().is_dirty(), "on the disk is what was saved last");
    // Told once.
    harness.state_mut().tell_of_crash(folder.path());
    assert!(harness.state().message.as_ref().is_none_or(|m| !m.failed));
}

#[test]
fn nothing_is_offered_where_nothing_was_left_unsaved() {
    let (sample, folder) = (beam(), tempfile::tempdir().unwrap());
    std::fs::write(folder.path().join("crash-new.txt"), "x").unwrap();
    let mut harness = start();
    let mut recent = Recent::load(&folder.path().join("recent.json"));
    recent.add(&sample.path).unwrap();
    harness.state_mut().recent = Some(recent);
    harness.state_mut().tell_of_crash(folder.path());
    harness.run_steps(3);
    assert!(harness.state().message.as_ref().unwrap().text.contains("Nothing was left unsaved"));
    assert!(harness.query_by_label("Restore").is_none());
}
