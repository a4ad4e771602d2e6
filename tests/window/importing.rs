//! Laboratory files are looked into before they become runs: contents, proposals, mapping, and the project that comes of it.

use crate::support::{Sample, beam, drop_files, open_sized, settle, start_sized};
use dashpot::measurement::Quantity;
use dashpot::window::App;
use dashpot::window::importing::Importing;
use egui::Theme;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// A record as another program writes it: semicolons, names and units of its own.
fn foreign(frequency_hz: f64) -> String {
    let mut text = "Time (s);Kraft 9 (N);Beschl 5 (g);Temperature (degC)\n".to_owned();
    for k in 0..600 {
        let t = 12.0 / frequency_hz * f64::from(k) / 600.0;
        let wave = (TAU * frequency_hz * t).sin();
        writeln!(text, "{t:.9};{:.6};{:.6};21.5", wave, -2.0 * wave).unwrap();
    }
    text
}

fn written(sample: &Sample, name: &str, frequency_hz: f64) -> PathBuf {
    let file = sample.path.with_file_name(name);
    std::fs::write(&file, foreign(frequency_hz)).unwrap();
    file
}

/// Steps until the files were read and are shown.
pub(crate) fn shown(harness: &mut Harness<'_, App>) {
    settle(harness);
    assert!(matches!(harness.state().importing, Some(Importing::Ready(_))), "{:?}", harness.state().message);
    harness.remove_cursor();
    settle(harness);
}

/// Names another file for the project that is to be made; returns the one that was named.
pub(crate) fn target_named(harness: &mut Harness<'_, App>, target: String) -> String {
    match &mut harness.state_mut().importing {
        Some(Importing::Ready(draft)) => std::mem::replace(&mut draft.target, target),
        other => panic!("{other:?}"),
    }
}

/// A picture in which the folder of the test, another one every time, is not named.
fn picture(harness: &mut Harness<'_, App>, name: &str) {
    let target = target_named(harness, "measurements/project.toml".to_owned());
    settle(harness);
    harness.snapshot(name);
    target_named(harness, target);
    settle(harness);
}

pub(crate) fn press(harness: &mut Harness<'_, App>, label: &str) {
    let button = harness.get_by_role_and_label(Role::Button, label);
    assert!(!button.accesskit_node().is_disabled(), "{label} cannot be pressed");
    button.click();
    settle(harness);
    settle(harness);
}

#[test]
fn a_foreign_file_is_looked_into_mapped_and_becomes_a_run() {
    let sample = beam();
    let mut harness = open_sized(&sample, Theme::Light, [1280.0, 800.0]);
    drop_files(&mut harness, &[written(&sample, "shaker 17.csv", 13.07)]);
    shown(&mut harness);
    harness.get_by_role_and_label(Role::TextInput, "DOF of Kraft 9");
    harness.get_by_role_and_label(Role::ComboBox, "Quantity of Beschl 5");
    picture(&mut harness, "import-records");
    press(&mut harness, "Add to the project");
    let document = harness.state().document.as_ref().unwrap();
    assert_eq!(document.project.runs.len(), 5, "{:?}", harness.state().message);
    let run = &document.project.runs[4];
    assert!((run.frequency_hz() - 13.07).abs() < 0.01);
    let response = run.fit.channels.iter().find(|c| c.channel.quantity == Quantity::Acceleration).unwrap();
    assert_eq!(response.channel.label, "5");
    assert!((response.amplitudes[0].norm() / (2.0 * 9.80665) - 1.0).abs() < 1e-3, "in m/s^2, from g");
    assert!(harness.state().importing.is_none());
    // Further files of the layout are read by the mapping that is there, without a question.
    drop_files(&mut harness, &[written(&sample, "shaker 18.csv", 21.3), written(&sample, "shaker 19.csv", 33.1)]);
    settle(&mut harness);
    settle(&mut harness);
    assert!(harness.state().importing.is_none(), "{:?}", harness.state().importing);
    assert_eq!(harness.state().document.as_ref().unwrap().project.runs.len(), 7);
    // All of it can be taken back.
    harness.state_mut().document.as_mut().unwrap().undo();
    assert_eq!(harness.state().document.as_ref().unwrap().project.runs.len(), 5);
}

#[test]
fn what_cannot_be_imported_says_why_beside_the_button() {
    let sample = beam();
    let mut harness = open_sized(&sample, Theme::Light, [1280.0, 800.0]);
    let file = sample.path.with_file_name("other.csv");
    std::fs::write(&file, foreign(10.0).replace("Beschl 5", "Beschl 77")).unwrap();
    drop_files(&mut harness, &[file]);
    shown(&mut harness);
    // The beam has no DOF 77: a project of its own is offered in place of an addition.
    harness.get_by_role_and_label(Role::Button, "Make the project");
    harness.get_by_role_and_label(Role::RadioButton, "Into this project").click();
    harness.run_steps(3);
    let button = harness.get_by_role_and_label(Role::Button, "Add to the project");
    assert!(button.accesskit_node().is_disabled());
    assert!(harness.query_by_label_contains("no DOF \"77\"").is_some());
    harness.get_by_role_and_label(Role::Button, "Cancel").click();
    harness.run_steps(3);
    assert!(harness.state().importing.is_none());
    assert_eq!(harness.state().document.as_ref().unwrap().project.runs.len(), 4);
}

/// The hammer test of the samples in a folder of its own.
fn hammer(folder: &Path) -> PathBuf {
    let file = folder.join("hammer.uff");
    std::fs::copy(Path::new(env!("CARGO_MANIFEST_DIR")).join("sample-data/hammer-frf/hammer.uff"), &file).unwrap();
    file
}

#[test]
fn frequency_responses_become_a_project_that_identifies() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = start_sized([1024.0, 700.0]);
    drop_files(&mut harness, &[hammer(folder.path())]);
    shown(&mut harness);
    picture(&mut harness, "import-responses-small");
    press(&mut harness, "Make the project");
    let state = harness.state();
    let document = state.document.as_ref().unwrap_or_else(|| panic!("{:?}", state.message));
    assert!(document.project.runs.len() > 20);
    assert!(folder.path().join("hammer.toml").is_file(), "the project lies beside the measurement");
    // What the window wrote is what the command line writes.
    let told = folder.path().join("told.toml");
    let words = ["dashpot", "import", "--out"].map(Into::into);
    let all = words.into_iter().chain([told.clone().into(), folder.path().join("hammer.uff").into()]);
    dashpot::cli::answer(all).unwrap();
    let text = |path: &Path| std::fs::read_to_string(path).unwrap();
    assert_eq!(text(&folder.path().join("hammer.toml")), text(&told));
    let found = dashpot::identify::identify(
        &document.project.structure,
        &document.project.sources,
        &document.project.runs,
        &document.project.settings,
        &dashpot::control::Control::unattended(),
    )
    .unwrap();
    assert!(found.sources.iter().any(|found| found.coefficient > 0.0), "nothing was found");
}

#[test]
fn frequency_responses_are_shown_with_their_places() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = start_sized([1280.0, 800.0]);
    drop_files(&mut harness, &[hammer(folder.path())]);
    shown(&mut harness);
    picture(&mut harness, "import-responses");
}
