//! Records that are not steady against the model in the stage Explain: over time with what is left below, as spectra, what is left
//! over time and frequency, damping ratio and frequency over amplitude.

use crate::support::{Sample, open, open_sized, settle};
use dashpot::plots::record_residual::RecordResidual;
use dashpot::window::App;
use dashpot::window::app::view::Stage;
use dashpot::window::stages::explain::look::RecordTab;
use egui::{Theme, accesskit::Role};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::path::Path;

/// A copy of a sample of the program.
pub(crate) fn sample(name: &str) -> Sample {
    let folder = tempfile::tempdir().unwrap();
    for file in std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("sample-data").join(name)).unwrap() {
        let file = file.unwrap();
        std::fs::copy(file.path(), folder.path().join(file.file_name())).unwrap();
    }
    let path = folder.path().join("project.toml");
    Sample { _folder: folder, path }
}

fn explain(harness: &mut Harness<'_, App>) {
    harness.state_mut().view.stage = Stage::Explain;
    settle(harness);
}

/// Shows a plot of the record by a click on its name.
fn chosen(harness: &mut Harness<'_, App>, tab: RecordTab) {
    harness.get_by_role_and_label(Role::Button, tab.label()).click();
    settle(harness);
    assert_eq!(harness.state().view.explain.record_tab, tab);
}

/// The same, and pictures it.
fn picture(harness: &mut Harness<'_, App>, tab: RecordTab, name: &str) {
    chosen(harness, tab);
    harness.remove_cursor();
    settle(harness);
    harness.snapshot(format!("{name}-{}", tab.label().to_lowercase()));
}

/// A sample in the stage Explain whose search is ended at once: comparison and plots do not wait for it.
fn compared<'a>(sample: &Sample) -> Harness<'a, App> {
    let mut harness = open(sample, Theme::Light);
    harness.state_mut().view.limit_s = Some(1e-3);
    explain(&mut harness);
    harness
}

/// Loops of a component are no steady states, whatever they are called: they are searched as on the command line.
#[test]
fn loops_of_a_component_are_searched_as_loops() {
    let sample = sample("damper-loops");
    let mut harness = open(&sample, Theme::Light);
    let project = &harness.state().document.as_ref().unwrap().project;
    assert_eq!([project.runs.len(), project.transient_runs.len()], [0, 6]);
    assert!(project.transient_runs.iter().all(|run| run.findings.is_empty()));
    explain(&mut harness);
    assert!(harness.query_all_by_label_contains("Best guess: elastic slider at DOF 1").next().is_some());
}

#[test]
fn a_decay_is_drawn_as_it_was_compared() {
    let sample = sample("decay-friction");
    let mut harness = compared(&sample);
    chosen(&mut harness, RecordTab::Spectrogram);
    let app = harness.state();
    let (document, look) = (app.document.as_ref().unwrap(), &app.view.explain);
    let project = &document.project;
    let found = app.derived.explained.decays(document, None).unwrap().as_ref().unwrap();
    let record = found.iter().find(|record| record.index == app.view.run).unwrap();
    let run = &project.transient_runs[record.index];
    let direct = RecordResidual::new(&project.structure, run, record, look.record.as_deref()).unwrap();
    let shown = app.derived.explained.record(document, None, (record.index, look.record.clone())).unwrap();
    let shown = shown.as_ref().unwrap();
    assert_eq!(shown.title(), direct.title());
    assert_eq!(shown.spectrogram(), direct.spectrogram());
}

#[test]
#[ignore = "a minute: the pictures of the same beside all that the search finds"]
fn a_decay_is_seen_over_time_as_spectra_and_over_amplitude() {
    let sample = sample("decay-friction");
    let mut harness = open(&sample, Theme::Light);
    explain(&mut harness);
    for tab in RecordTab::ALL {
        picture(&mut harness, tab, "decay");
    }
}

/// Chooses the first cell of the second record.
fn second_record(harness: &mut Harness<'_, App>) {
    harness.get_by_role_and_label(Role::Button, "In order").click();
    harness.run_steps(3);
    harness.get_all_by_label_contains("Run 2, hammer-02.csv").next().unwrap().click();
    settle(harness);
}

#[test]
fn a_cell_of_the_map_chooses_record_and_channel() {
    let sample = sample("hammer-maxwell");
    let mut harness = compared(&sample);
    second_record(&mut harness);
    let app = harness.state();
    let shown = (1, app.view.explain.record.clone());
    let residual = app.derived.explained.record(app.document.as_ref().unwrap(), None, shown).unwrap().as_ref().unwrap();
    assert!(residual.title().ends_with("of hammer-02.csv"), "{}", residual.title());
    assert_eq!(Some(&residual.channel), app.view.explain.record.as_ref());
}

#[test]
#[ignore = "more than a minute: the picture of the same beside all that the search finds"]
fn a_hammer_is_seen_as_a_spectrum() {
    let sample = sample("hammer-maxwell");
    let mut harness = open(&sample, Theme::Light);
    explain(&mut harness);
    second_record(&mut harness);
    picture(&mut harness, RecordTab::Spectrum, "hammer");
}

#[test]
fn a_sweep_fits_into_a_small_window() {
    let sample = sample("sweep-cubic");
    let mut harness = open_sized(&sample, Theme::Dark, [1024.0, 700.0]);
    harness.state_mut().view.limit_s = Some(1e-3);
    explain(&mut harness);
    picture(&mut harness, RecordTab::Time, "sweep-1024");
    picture(&mut harness, RecordTab::Spectrogram, "sweep-1024");
}
