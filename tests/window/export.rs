//! Plots leave the window: as SVG, as PNG, and as a table on the clipboard.

use crate::support::{beam, open, settle};
use dashpot::window::App;
use dashpot::window::app::view::Stage;
use dashpot::window::frame::panes::Pane;
use dashpot::window::plots::export::{Kind, shown, want};
use egui::{OutputCommand, PointerButton, Theme};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::path::Path;
use std::time::{Duration, Instant};

/// Writes every plot on the screen into a folder; gives back their number.
fn export_all(harness: &mut Harness<'_, App>, folder: &Path) -> usize {
    harness.state_mut().exports.folder = Some(folder.to_owned());
    let titles = shown(&harness.ctx);
    for title in &titles {
        want(&harness.ctx, title, Kind::Svg);
        want(&harness.ctx, title, Kind::Png);
        want(&harness.ctx, title, Kind::Csv);
    }
    harness.run_steps(2);
    let start = Instant::now();
    while harness.state().exports.busy() {
        assert!(start.elapsed() < Duration::from_mins(2), "exports have not ended");
        std::thread::sleep(Duration::from_millis(20));
        harness.run_steps(1);
    }
    titles.len()
}

#[test]
fn every_plot_is_written_as_svg_and_as_png() {
    let sample = beam();
    let mut harness = open(&sample, Theme::Light);
    let folder = tempfile::tempdir().unwrap();
    let mut count = 0;
    for (stage, pane, in_space) in [
        (Stage::Measure, Pane::Record, false),
        (Stage::Measure, Pane::Spectrum, false),
        (Stage::Select, Pane::RunEnergy, false),
        (Stage::Result, Pane::Energy, true),
        (Stage::Result, Pane::Bode, false),
        (Stage::Result, Pane::Nyquist, false),
        (Stage::Result, Pane::Hysteresis, false),
    ] {
        let app = harness.state_mut();
        (app.view.stage, app.view.matrix_in_space) = (stage, in_space);
        app.desk.set_open(stage, pane, true);
        settle(&mut harness);
        count += export_all(&mut harness, folder.path());
        assert!(harness.state().message.as_ref().is_none_or(|m| !m.failed), "{:?}", harness.state().message);
    }
    assert!(count >= 10, "{count} plots were on the screen");
    let files: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|f| f.unwrap().path()).collect();
    let ends = |e: &str| files.iter().filter(|f| f.extension().is_some_and(|x| x == e)).collect::<Vec<_>>();
    assert_eq!(ends("svg").len(), ends("png").len());
    for word in ["bode", "nyquist", "hysteresis", "record", "spectrum", "damping-matrix-in-space", "energy-by-source"] {
        assert!(files.iter().any(|f| f.to_string_lossy().contains(word)), "{word} in {files:?}");
    }
    for svg in ends("svg") {
        let text = std::fs::read_to_string(svg).unwrap();
        let mut reader = quick_xml::Reader::from_str(&text);
        while reader.read_event().unwrap() != quick_xml::events::Event::Eof {}
        assert!(text.contains("<text"), "{}", svg.display());
    }
    for png in ends("png") {
        let picture = image::open(png).unwrap().to_rgb8();
        let ground = *picture.get_pixel(0, 0);
        let inked = picture.pixels().filter(|p| **p != ground).count();
        assert!(picture.width() >= 1400 && inked > 2000, "{}: {inked} pixels", png.display());
    }
}

/// Clicks with a button of the pointer, so many times at once.
fn click(harness: &mut Harness<'_, App>, pos: egui::Pos2, button: PointerButton, times: usize) {
    for pressed in [true, false].into_iter().cycle().take(2 * times) {
        let event = egui::Event::PointerButton { pos, button, pressed, modifiers: egui::Modifiers::NONE };
        // All in one frame: frames of a harness are too far apart for a double click.
        harness.input_mut().events.push(event);
    }
    harness.run_steps(1);
}

/// Chooses "Copy values" in the context menu of the plot at a point; gives back what was copied.
fn copy_values(harness: &mut Harness<'_, App>, plot: egui::Pos2) -> String {
    harness.hover_at(plot);
    harness.run_steps(1);
    click(harness, plot, PointerButton::Secondary, 1);
    harness.run_steps(2);
    harness.get_by_label("Copy values").click();
    let mut copied = None;
    for _ in 0..4 {
        harness.step();
        let commands = &harness.output().platform_output.commands;
        copied = copied.or(commands.iter().find_map(|c| match c {
            OutputCommand::CopyText(text) => Some(text.clone()),
            _ => None,
        }));
    }
    copied.expect("something was copied")
}

#[test]
fn a_double_click_shows_all_of_a_record_and_another_its_start() {
    let sample = beam();
    let mut harness = open(&sample, Theme::Light);
    harness.state_mut().view.stage = Stage::Measure;
    settle(&mut harness);
    let plot = harness.get_by_label("residual").rect().center() + egui::vec2(0.0, 120.0);
    // Last time of the first block that is in sight, s.
    let last = |text: &str| -> f64 {
        let row = text.lines().take_while(|l| !l.is_empty()).last().unwrap();
        row.split('\t').next().unwrap().parse().unwrap()
    };
    let start = last(&copy_values(&mut harness, plot));
    let span = harness.state().document.as_ref().unwrap().project.runs[0]
        .record
        .as_ref()
        .unwrap()
        .time()
        .last()
        .copied()
        .unwrap();
    assert!(start < 0.7 * span, "the first periods: {start} of {span}");
    for expected in [span, start] {
        click(&mut harness, plot, PointerButton::Primary, 2);
        settle(&mut harness);
        let shown = last(&copy_values(&mut harness, plot));
        assert!((shown - expected).abs() < 0.05 * span, "{shown} after a double click, {expected} expected");
    }
}

#[test]
fn the_context_menu_of_a_plot_copies_its_values() {
    let sample = beam();
    let mut harness = open(&sample, Theme::Light);
    harness.state_mut().view.stage = Stage::Result;
    settle(&mut harness);
    let plot = harness.get_by_label_contains("Matrix;").rect().center();
    let copied = copy_values(&mut harness, plot);
    let rows: Vec<Vec<&str>> = copied.lines().map(|l| l.split('\t').collect()).collect();
    assert_eq!(rows[0], ["N s/m", "3", "7"]);
    let value: f64 = rows[1][1].parse().unwrap();
    assert!((value - 0.3).abs() < 0.01, "{copied}");
}

/// Presses the keys to copy; gives back what is on the clipboard then.
fn press_copy(harness: &mut Harness<'_, App>) -> Option<String> {
    harness.input_mut().events.push(egui::Event::Copy);
    harness.step();
    harness.output().platform_output.commands.iter().find_map(|c| match c {
        OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    })
}

/// Whoever works with the keyboard alone copies the table of the pane that has the focus.
#[test]
fn the_keys_to_copy_take_the_pane_with_the_focus() {
    let sample = beam();
    let mut harness = open(&sample, Theme::Light);
    harness.remove_cursor();
    harness.run_steps(3);
    assert_eq!(press_copy(&mut harness), None, "nothing has the focus");
    harness.get_by_label("Use run 1").focus();
    harness.run_steps(3);
    let table = press_copy(&mut harness).expect("the table of runs");
    assert!(table.starts_with("file\tfrequency (Hz)") && table.lines().count() == 5, "{table}");
    // The structure's numbers are a table as well.
    harness.state_mut().view.stage = Stage::Structure;
    harness.state_mut().desk.set_open(Stage::Structure, Pane::Parameters, true);
    settle(&mut harness);
    let place = harness.get_by_label("Ends, left and right").rect().center();
    harness.hover_at(place);
    harness.run_steps(3);
    let table = press_copy(&mut harness).expect("the table of parameters");
    assert!(table.contains("length\t") && table.contains("supports\t"), "{table}");
}
