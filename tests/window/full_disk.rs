//! The window saves on a disk that takes no more. The shell's limit on the size of files stands for the disk, as in `tests/full_disk.rs`.
#![cfg(unix)]

use crate::support::{beam, start};
use dashpot::session::Command as Change;
use dashpot::window::app::ask::Ask;
use dashpot::window::app::commands::Command;
use dashpot::window::document::edits::Edit;
use std::path::{Path, PathBuf};

const PROJECT: &str = "DASHPOT_FULL_DISK_PROJECT";

/// Not a test of its own: the window on a full disk.
#[test]
#[ignore = "the program that has no room"]
fn cramped() {
    let Some(project) = std::env::var_os(PROJECT) else { return };
    let mut harness = start();
    let ctx = harness.ctx.clone();
    harness.state_mut().open(&ctx, PathBuf::from(project));
    harness.state_mut().settle(&ctx).unwrap();
    harness.state_mut().edit(&ctx, &Edit::Do(Change::SetTitle("Longer than the disk".repeat(40))));
    harness.state_mut().answer(&ctx, Ask::Command(Command::Save));
    let message = harness.state().message.clone().unwrap();
    println!("said: {}", message.text.replace('\n', "\\n"));
    let document = harness.state().document.as_ref().unwrap();
    assert!(message.failed && document.session().is_dirty(), "it stays unsaved");
}

#[test]
fn a_save_on_a_full_disk_is_told_and_loses_nothing() {
    let sample = beam();
    let before = std::fs::read(&sample.path).unwrap();
    let folder = |path: &Path| std::fs::read_dir(path.parent().unwrap()).unwrap().count();
    let count = folder(&sample.path);
    let script = "trap '' XFSZ; ulimit -f 1; exec \"$0\" --exact full_disk::cramped --ignored --nocapture";
    let done = std::process::Command::new("sh")
        .args(["-c", script])
        .arg(std::env::current_exe().unwrap())
        .env(PROJECT, &sample.path)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&done.stdout).into_owned();
    assert!(done.status.success(), "{said}{}", String::from_utf8_lossy(&done.stderr));
    let line = said.lines().find_map(|line| line.split_once("said: ")).map(|(_, line)| line).unwrap();
    assert!(line.contains("cannot save the project") && line.contains("free space") && !line.contains("\\n"), "{line}");
    assert_eq!(std::fs::read(&sample.path).unwrap(), before, "the file is as it was");
    assert_eq!(folder(&sample.path), count, "nothing is left beside it");
}
