//! Finite-element models in, dashpots out, and structures on a moving base, from files to results.
#![allow(clippy::disallowed_methods, clippy::unwrap_used, missing_docs, reason = "tests")]

mod base;
mod calculix;
#[path = "../common/mod.rs"]
mod common;
mod formats;
mod reduced;

use std::path::Path;
use std::process::{Command, Output, Stdio};

/// Runs the program in a folder.
fn dashpot(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_dashpot"))
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::null())
        .output()
        .unwrap()
}

/// Its standard output as text; it must have ended well.
fn said(arguments: &[&str], folder: &Path) -> String {
    let output = dashpot(arguments, folder);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// Its standard output as JSON.
fn json(arguments: &[&str], folder: &Path) -> serde_json::Value {
    serde_json::from_str(&said(arguments, folder)).unwrap()
}

/// What it says on standard error when it refuses.
fn refused(arguments: &[&str], folder: &Path) -> String {
    let output = dashpot(arguments, folder);
    assert_eq!(output.status.code(), Some(1), "{arguments:?}");
    String::from_utf8(output.stderr).unwrap().trim().to_owned()
}
