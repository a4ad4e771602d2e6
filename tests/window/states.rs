//! Pictures of what is not a stage at rest: a drag, a menu, running work, a refusal, empty panes, the tour.

use crate::support::{beam, drop_files, open, settle, start};
use dashpot::window::App;
use dashpot::window::app::Ask;
use dashpot::window::app::view::Stage;
use dashpot::window::frame::panes::Pane;
use egui::Theme;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

fn at(harness: &Harness<'_, App>, dof: &str) -> egui::Pos2 {
    harness.get_by_label_contains(&format!("DOF {dof}, translation")).rect().center()
}

fn picture(harness: &mut Harness<'static, App>, name: &str) {
    harness.remove_cursor();
    harness.run_steps(3);
    harness.snapshot(name);
}

#[test]
fn in_the_middle_of_a_drag() {
    let sample = beam();
    let mut harness = open(&sample, Theme::Light);
    harness.state_mut().view.stage = Stage::Pattern;
    settle(&mut harness);
    let (from, to) = (at(&harness, "3"), at(&harness, "7"));
    harness.hover_at(from);
    harness.run_steps(1);
    harness.drag_at(from);
    harness.run_steps(1);
    harness.hover_at(to + egui::vec2(2.0, 1.0));
    harness.run_steps(3);
    harness.snapshot("mid-drag");
}

#[test]
fn the_menu_of_a_degree_of_freedom() {
    let sample = beam();
    let mut harness = open(&sample, Theme::Light);
    harness.state_mut().view.stage = Stage::Pattern;
    settle(&mut harness);
    harness.get_by_label_contains("DOF 5, translation").click_secondary();
    harness.run_steps(4);
    harness.get_by_label("Candidate: Coulomb friction to the ground").click();
    harness.run_steps(4);
    assert_eq!(harness.state().document.as_ref().unwrap().project.sources.len(), 6);
    settle(&mut harness);
    harness.get_by_label_contains("DOF 7, translation").click_secondary();
    harness.run_steps(4);
    picture(&mut harness, "context-menu");
}

#[test]
fn running_work() {
    let sample = beam();
    let mut harness = open(&sample, Theme::Light);
    let ctx = harness.ctx.clone();
    harness.state_mut().run(&ctx, "Reading and fitting records", |control| {
        control.report(0.4);
        while control.check().is_ok() {
            std::thread::sleep(std::time::Duration::from_millis(2));
        }
        Err("cancelled".to_owned())
    });
    while harness.state().running().is_none_or(|(_, progress)| progress < 0.39) {
        harness.run_steps(1);
    }
    // What is drawn of the records is prepared in the background too, and cannot be waited for while this job runs.
    for _ in 0..100 {
        std::thread::sleep(std::time::Duration::from_millis(10));
        harness.run_steps(1);
    }
    picture(&mut harness, "running");
}

#[test]
fn a_refused_file() {
    let sample = beam();
    let bad = sample.path.with_file_name("bad.csv");
    std::fs::write(&bad, "time [s],force@9 [N],acc@5 [m/s^2]\n0,1,1\n0.1,1,oops\n").unwrap();
    let mut harness = open(&sample, Theme::Light);
    drop_files(&mut harness, &[bad]);
    settle(&mut harness);
    // The folder of the test has another name each time.
    let message = harness.state().message.clone().unwrap();
    let folder = sample.path.parent().unwrap().display().to_string();
    let text = message.text.replace(&format!("{folder}/"), "");
    harness.state_mut().messages.clear();
    harness.state_mut().fail(text);
    picture(&mut harness, "refused");
}

#[test]
fn empty_panes_say_what_to_do() {
    let mut harness = start();
    let ctx = harness.ctx.clone();
    harness.state_mut().answer(&ctx, Ask::New(0));
    for (stage, name) in [(Stage::Measure, "empty-measure"), (Stage::Select, "empty-select")] {
        harness.state_mut().view.stage = stage;
        settle(&mut harness);
        picture(&mut harness, name);
    }
}

#[test]
fn values_that_can_be_edited() {
    let sample = beam();
    let mut harness = open(&sample, Theme::Light);
    harness.state_mut().view.stage = Stage::Structure;
    harness.state_mut().desk.set_open(Stage::Structure, Pane::Parameters, true);
    harness.state_mut().desk.set_open(Stage::Structure, Pane::ModeShape, true);
    harness.state_mut().view.dof = Some(4);
    settle(&mut harness);
    picture(&mut harness, "parameters");
}

#[test]
fn the_tour_points_at_things() {
    let sample = beam();
    let mut harness = open(&sample, Theme::Light);
    harness.state_mut().view.tour = Some(5);
    settle(&mut harness);
    picture(&mut harness, "tour");
}
