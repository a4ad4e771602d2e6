//! A network drive that stalls, a file that vanishes, a project of a newer version, a disk that takes nothing: one clear line each, frames go on.
#![cfg(unix)]

use crate::support::{beam, open, settle, start};
use dashpot::session::Command as Change;
use dashpot::window::App;
use dashpot::window::app::commands::Command;
use dashpot::window::document::edits::Edit;
use egui::Theme;
use egui_kittest::Harness;
use std::path::Path;
use std::process::Command as Program;
use std::time::{Duration, Instant};

/// Longest time that a frame may take while a file is waited for; the tests share the machine.
const LONGEST: Duration = Duration::from_millis(if cfg!(debug_assertions) { 2000 } else { 200 });

/// A file that can be opened and gives nothing, as one on a drive that has stalled.
fn stalled(path: &Path) {
    assert!(Program::new("mkfifo").arg(path).status().unwrap().success());
}

fn said(harness: &Harness<'_, App>) -> String {
    harness.state().message.as_ref().map_or_else(String::new, |m| m.text.clone())
}

fn ask(harness: &mut Harness<'_, App>, command: Command) {
    let ctx = harness.ctx.clone();
    harness.state_mut().command(&ctx, command);
    harness.run_steps(3);
}

#[test]
fn a_drive_that_stalls_holds_no_frame_and_can_be_given_up() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("project.toml");
    stalled(&path);
    let mut harness = start();
    let ctx = harness.ctx.clone();
    harness.state_mut().open(&ctx, path.clone());
    for _ in 0..20 {
        let begin = Instant::now();
        harness.step();
        assert!(begin.elapsed() < LONGEST, "a frame waited for the file: {:?}", begin.elapsed());
    }
    assert!(harness.state().running().is_some(), "it is still waited for");
    ask(&mut harness, Command::Cancel);
    assert!(harness.state().running().is_none());
    assert_eq!(said(&harness), "Cancelled.");
    // The window is of use at once, and another project opens.
    let sample = beam();
    harness.state_mut().open(&ctx, sample.path.clone());
    settle(&mut harness);
    assert_eq!(harness.state().document.as_ref().unwrap().project.runs.len(), 4);
    // Who reads from a drive that is gone ends some time; here it is let go.
    drop(std::fs::OpenOptions::new().read(true).write(true).open(&path).unwrap());
}

#[test]
fn a_record_that_stalls_holds_no_frame_either() {
    let sample = beam();
    let record = sample.path.with_file_name("run-02.csv");
    std::fs::remove_file(&record).unwrap();
    stalled(&record);
    let mut harness = start();
    let ctx = harness.ctx.clone();
    harness.state_mut().open(&ctx, sample.path.clone());
    for _ in 0..10 {
        let begin = Instant::now();
        harness.step();
        assert!(begin.elapsed() < LONGEST, "{:?}", begin.elapsed());
    }
    ask(&mut harness, Command::Cancel);
    assert!(harness.state().document.is_none() && harness.state().running().is_none());
    drop(std::fs::OpenOptions::new().read(true).write(true).open(&record).unwrap());
}

#[test]
fn files_that_vanish_are_told_and_nothing_unsaved_is_lost() {
    let sample = beam();
    let mut harness = open(&sample, Theme::Light);
    let ctx = harness.ctx.clone();
    harness.state_mut().edit(&ctx, &Edit::Do(Change::SetTitle("Kept".to_owned())));
    let folder = sample.path.parent().unwrap();
    std::fs::remove_dir_all(folder).unwrap();
    ask(&mut harness, Command::Save);
    let text = said(&harness);
    assert!(text.contains("check the folder and its free space") && !text.contains('\n'), "{text}");
    assert!(harness.state().document.as_ref().unwrap().session().is_dirty());
    // Records stay in memory: all stages go on.
    settle(&mut harness);
    assert_eq!(harness.state().document.as_ref().unwrap().project.runs.len(), 4);
    std::fs::create_dir_all(folder).unwrap();
    ask(&mut harness, Command::Save);
    assert_eq!(said(&harness), "Saved.");
    assert!(std::fs::read_to_string(&sample.path).unwrap().contains("Kept"));
}

#[test]
fn a_project_of_a_newer_version_is_refused_in_one_line() {
    let sample = beam();
    let text = std::fs::read_to_string(&sample.path).unwrap().replace("format = 1", "format = 2\nnew_key = 3");
    std::fs::write(&sample.path, text).unwrap();
    let mut harness = start();
    let ctx = harness.ctx.clone();
    harness.state_mut().open(&ctx, sample.path.clone());
    settle(&mut harness);
    let text = said(&harness);
    assert!(text.contains("written by a newer version of dashpot") && text.contains("update dashpot"), "{text}");
    assert!(!text.contains('\n') && harness.state().document.is_none());
}

#[test]
fn two_windows_on_one_project_lose_nothing() {
    let sample = beam();
    let (mut one, mut other) = (open(&sample, Theme::Light), open(&sample, Theme::Light));
    for (harness, title) in [(&mut one, "Of the first"), (&mut other, "Of the second")] {
        let ctx = harness.ctx.clone();
        harness.state_mut().edit(&ctx, &Edit::Do(Change::SetTitle(title.to_owned())));
    }
    ask(&mut one, Command::Save);
    assert_eq!(said(&one), "Saved.");
    ask(&mut other, Command::Save);
    assert!(said(&other).contains("changed by another window or program"), "{}", said(&other));
    assert!(std::fs::read_to_string(&sample.path).unwrap().contains("Of the first"));
    assert!(
        other.state().document.as_ref().unwrap().session().is_dirty(),
        "it is kept here, to be saved under another name"
    );
    let ctx = other.ctx.clone();
    let own = sample.path.with_file_name("second.toml");
    other.state_mut().answer(&ctx, dashpot::window::app::ask::Ask::SaveAs(own.clone()));
    assert!(std::fs::read_to_string(&own).unwrap().contains("Of the second"));
}
