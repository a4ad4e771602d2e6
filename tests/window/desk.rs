//! Panes are closed, brought back, moved, remembered.

use crate::support::{beam, open, settle};
use dashpot::window::App;
use dashpot::window::app::commands::Command;
use dashpot::window::app::view::Stage;
use dashpot::window::frame::desk::Desk;
use dashpot::window::frame::panes::Pane;
use egui::Theme;
use egui::accesskit::Role;
use egui_kittest::kittest::Queryable;
use std::collections::HashMap;

#[derive(Default)]
struct Store(HashMap<String, String>);

impl eframe::Storage for Store {
    fn get_string(&self, key: &str) -> Option<String> {
        self.0.get(key).cloned()
    }

    fn set_string(&mut self, key: &str, value: String) {
        self.0.insert(key.to_owned(), value);
    }

    fn remove_string(&mut self, key: &str) {
        self.0.remove(key);
    }

    fn flush(&mut self) {}
}

#[test]
fn a_pane_is_closed_brought_back_and_remembered() {
    let sample = beam();
    let mut harness = open(&sample, Theme::Light);
    harness.get_by_role_and_label(Role::Tab, "Spectrum").hover();
    harness.run_steps(2);
    harness.get_by_label("Close Spectrum").click();
    harness.run_steps(3);
    assert!(harness.query_by_role_and_label(Role::Tab, "Spectrum").is_none());
    let mut store = Store::default();
    eframe::App::save(harness.state_mut(), &mut store);
    let desk: Desk = eframe::get_value(&store, "desk").unwrap();
    assert!(desk.panes(Stage::Measure).contains(&(Pane::Spectrum, false)));
    let sample = beam();
    let mut again = open(&sample, Theme::Light);
    again.state_mut().desk = desk;
    settle(&mut again);
    assert!(again.query_by_role_and_label(Role::Tab, "Spectrum").is_none());
    let ctx = again.ctx.clone();
    again.state_mut().command(&ctx, Command::ResetLayout);
    settle(&mut again);
    again.get_by_role_and_label(Role::Tab, "Spectrum");
}

#[test]
fn a_pane_is_dragged_by_its_title_into_another_group() {
    let sample = beam();
    let mut harness = open(&sample, Theme::Light);
    let rect = |h: &egui_kittest::Harness<'_, App>, name: &str| h.get_by_role_and_label(Role::Tab, name).rect();
    let (from, to) = (rect(&harness, "Spectrum").center(), rect(&harness, "Runs").center());
    harness.hover_at(from);
    harness.run_steps(1);
    harness.drag_at(from);
    harness.run_steps(1);
    for k in 1..=6 {
        harness.hover_at(from + (to - from) * (k as f32 / 6.0));
        harness.run_steps(2);
    }
    harness.drop_at(to);
    harness.run_steps(4);
    let (spectrum, runs) = (rect(&harness, "Spectrum"), rect(&harness, "Runs"));
    assert!((spectrum.top() - runs.top()).abs() < 1.0 && spectrum.left() < from.x - 300.0, "{spectrum:?} {runs:?}");
}
