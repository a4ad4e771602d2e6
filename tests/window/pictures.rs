//! Pictures of the stages, compared with those that were looked at and stored; `UPDATE_SNAPSHOTS=1` rewrites them.

use crate::support::{Sample, beam, chain, open, settle, start};
use dashpot::window::App;
use dashpot::window::app::view::Stage;
use dashpot::window::frame::panes::Pane;
use egui::Theme;
use egui_kittest::{Harness, SnapshotResults};

/// One window on a sample, pictured at one stage after the other.
struct Pictures {
    harness: Harness<'static, App>,
    results: SnapshotResults,
}

impl Pictures {
    fn of(sample: &Sample, theme: Theme) -> Self {
        Self { harness: open(sample, theme), results: SnapshotResults::new() }
    }

    fn take(&mut self, stage: Stage, pane: Pane, name: &str) {
        self.harness.state_mut().view.stage = stage;
        self.harness.state_mut().desk.set_open(stage, pane, true);
        settle(&mut self.harness);
        self.harness.remove_cursor();
        settle(&mut self.harness);
        self.results.add(self.harness.try_snapshot(name));
    }
}

#[test]
fn start_screen() {
    let mut harness = start();
    harness.remove_cursor();
    harness.run_steps(3);
    harness.snapshot("start");
}

#[test]
fn stages_of_a_beam() {
    let sample = beam();
    let mut pictures = Pictures::of(&sample, Theme::Light);
    for stage in Stage::ALL.into_iter().filter(|stage| *stage != Stage::Explain) {
        pictures.take(stage, Pane::Energy, &stage.label().to_lowercase());
    }
}

#[test]
fn panes_of_the_result() {
    let sample = beam();
    let mut pictures = Pictures::of(&sample, Theme::Light);
    for pane in [Pane::Damping, Pane::Bode, Pane::Nyquist, Pane::Hysteresis, Pane::Values] {
        pictures.take(Stage::Result, pane, &format!("result-{}", pane.title().to_lowercase()));
    }
}

#[test]
fn dark_theme() {
    let sample = beam();
    let mut pictures = Pictures::of(&sample, Theme::Dark);
    pictures.take(Stage::Select, Pane::Energy, "select-dark");
    pictures.take(Stage::Result, Pane::Bode, "result-bode-dark");
}

#[test]
fn chain_of_masses() {
    let sample = chain();
    let mut pictures = Pictures::of(&sample, Theme::Light);
    pictures.take(Stage::Structure, Pane::Energy, "chain-structure");
    pictures.take(Stage::Pattern, Pane::Energy, "chain-pattern");
    pictures.take(Stage::Result, Pane::Methods, "chain-methods");
    pictures.take(Stage::Result, Pane::Incompleteness, "chain-incompleteness");
}
