//! What is drawn in space: pictured, pointed at, turned.

use crate::support::{beam, open, settle};
use crate::wing::wing;
use dashpot::window::App;
use dashpot::window::app::view::Stage;
use egui::{Event, Key, Theme};
use egui_kittest::kittest::Queryable;
use egui_kittest::{Harness, SnapshotResults};

fn result(theme: Theme) -> Harness<'static, App> {
    let sample = beam();
    let mut harness = open(&sample, theme);
    harness.state_mut().view.stage = Stage::Result;
    harness.state_mut().view.matrix_in_space = true;
    settle(&mut harness);
    harness
}

fn picture(harness: &mut Harness<'static, App>, results: &mut SnapshotResults, name: &str) {
    harness.remove_cursor();
    settle(harness);
    results.add(harness.try_snapshot(name));
}

#[test]
fn the_matrix_stands_in_space_and_can_be_turned_by_keys() {
    let mut results = SnapshotResults::new();
    let mut harness = result(Theme::Light);
    picture(&mut harness, &mut results, "matrix-in-space");
    harness.get_by_label_contains("Matrix in 3-D").focus();
    harness.run_steps(2);
    let run = harness.state().view.run;
    for _ in 0..6 {
        harness.key_press(Key::ArrowDown);
        harness.key_press(Key::ArrowRight);
        harness.run_steps(1);
    }
    assert_eq!(harness.state().view.run, run, "the arrows belong to what has the focus");
    picture(&mut harness, &mut results, "matrix-in-space-turned");
    harness.key_press(Key::Home);
    harness.run_steps(2);
    let mut dark = result(Theme::Dark);
    picture(&mut dark, &mut results, "matrix-in-space-dark");
}

#[test]
fn a_bar_under_the_pointer_says_its_dofs_and_its_value() {
    let mut harness = result(Theme::Light);
    let room = harness.get_by_label_contains("Matrix in 3-D").rect();
    let outcome = {
        let app = harness.state();
        app.derived.known_outcome(app.document.as_ref().unwrap()).unwrap().clone().unwrap()
    };
    let value = outcome.results.viscous[(6, 6)];
    let wanted = format!("Matrix in 3-D, N·s/m: (7, 7)  {}", dashpot::display::format::with_unit(value, "N s/m"));
    let said = (1..30).any(|k| {
        harness.hover_at(room.left_top() + room.size() * egui::vec2(k as f32 / 30.0, 0.55));
        harness.run_steps(2);
        harness.query_by_label_contains(&wanted).is_some()
    });
    assert!(said, "{wanted} is said nowhere across the picture");
}

#[test]
fn a_wing_is_drawn_in_space_and_turns_with_the_mouse() {
    let sample = wing();
    let mut results = SnapshotResults::new();
    for (theme, suffix) in [(Theme::Light, ""), (Theme::Dark, "-dark")] {
        let mut harness = open(&sample, theme);
        harness.state_mut().view.stage = Stage::Structure;
        harness.state_mut().view.mode = 2;
        settle(&mut harness);
        picture(&mut harness, &mut results, &format!("wing-structure{suffix}"));
        harness.state_mut().view.stage = Stage::Result;
        settle(&mut harness);
        picture(&mut harness, &mut results, &format!("wing-result{suffix}"));
    }
    let mut harness = open(&sample, Theme::Light);
    let before = harness.state().view.schematic.camera;
    let room = harness.get_by_role_and_label(egui::accesskit::Role::Image, "Schematic").rect();
    let corner = room.left_bottom() + egui::vec2(30.0, -30.0);
    harness.hover_at(corner);
    harness.run_steps(1);
    harness.drag_at(corner);
    harness.run_steps(1);
    harness.event(Event::PointerMoved(corner + egui::vec2(90.0, -40.0)));
    harness.run_steps(1);
    harness.drop_at(corner + egui::vec2(90.0, -40.0));
    harness.run_steps(2);
    let after = harness.state().view.schematic.camera;
    assert!(after.is_some() && after != before, "{before:?} {after:?}");
}
