//! Pictures of the stages, compared with those that were looked at and stored; `UPDATE_SNAPSHOTS=1` rewrites them.

use crate::support::{Sample, beam, chain, open, settle, start};
use dashpot::window::view::{Pane, Stage};
use egui::Theme;

fn picture(sample: &Sample, theme: Theme, stage: Stage, pane: Pane, name: &str) {
    let mut harness = open(sample, theme);
    harness.state_mut().view.stage = stage;
    harness.state_mut().view.pane = pane;
    settle(&mut harness);
    harness.remove_cursor();
    settle(&mut harness);
    harness.snapshot(name);
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
    for stage in Stage::ALL {
        let name = stage.label().to_lowercase();
        picture(&sample, Theme::Light, stage, Pane::Energy, &name);
    }
}

#[test]
fn panes_of_the_result() {
    let sample = beam();
    for pane in [Pane::Damping, Pane::Bode, Pane::Nyquist, Pane::Hysteresis] {
        let name = format!("result-{}", pane.label().to_lowercase());
        picture(&sample, Theme::Light, Stage::Result, pane, &name);
    }
}

#[test]
fn dark_theme() {
    let sample = beam();
    picture(&sample, Theme::Dark, Stage::Select, Pane::Energy, "select-dark");
    picture(&sample, Theme::Dark, Stage::Result, Pane::Bode, "result-bode-dark");
}

#[test]
fn chain_of_masses() {
    let sample = chain();
    picture(&sample, Theme::Light, Stage::Structure, Pane::Energy, "chain-structure");
    picture(&sample, Theme::Light, Stage::Pattern, Pane::Energy, "chain-pattern");
}
