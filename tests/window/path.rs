//! The path of an engineer from a project to its result, by labels and by the pointer.

use crate::support::{beam, chain, document, drag, open, settle, start};
use dashpot::control::Control;
use dashpot::display::format;
use dashpot::effects::{Effect, Place, State};
use dashpot::window::app::view::Stage;
use egui::{Key, Modifiers, Theme};
use egui_kittest::kittest::Queryable;

#[test]
fn the_start_screen_offers_samples_and_a_file() {
    let harness = start();
    harness.get_by_label("Open a project…");
    harness.get_by_label("Cantilever, unequal dashpots");
    harness.get_by_label("Five points, no model");
    assert!(harness.query_by_label("Measure").is_none(), "there are no stages without a project");
}

#[test]
fn every_stage_opens_from_its_tab() {
    let sample = beam();
    let mut harness = open(&sample, Theme::Light);
    for stage in [Stage::Structure, Stage::Pattern, Stage::Select, Stage::Result, Stage::Measure] {
        harness.get_by_role_and_label(egui::accesskit::Role::Tab, stage.label()).click();
        settle(&mut harness);
        assert_eq!(harness.state().view.stage, stage);
    }
}

#[test]
fn sources_are_drawn_by_click_and_drag_and_taken_back() {
    let sample = beam();
    let mut harness = open(&sample, Theme::Light);
    harness.state_mut().view.stage = Stage::Pattern;
    harness.state_mut().view.law = Effect::Coulomb;
    harness.run_steps(3);
    let before = harness.state().document.as_ref().unwrap().project.sources.clone();
    let place_of_dof = |harness: &egui_kittest::Harness<'_, dashpot::window::App>, dof: &str| {
        harness.get_by_label_contains(&format!("DOF {dof}, translation")).rect().center()
    };

    harness.get_by_label_contains("DOF 7, translation").click();
    harness.run_steps(3);
    let drawn = |harness: &egui_kittest::Harness<'_, dashpot::window::App>| {
        harness.state().document.as_ref().unwrap().project.sources.clone()
    };
    assert_eq!(drawn(&harness).len(), before.len() + 1);
    assert!(drawn(&harness).iter().any(|s| s.effect == Effect::Coulomb && s.place == Place::Dofs(vec![6])));

    // The same again is refused with a reason, which stays in the status bar.
    harness.get_by_label_contains("DOF 7, translation").click();
    harness.run_steps(3);
    assert_eq!(drawn(&harness).len(), before.len() + 1);
    assert!(harness.query_all_by_label_contains("already drawn").count() > 0);

    let (from, to) = (place_of_dof(&harness, "1"), place_of_dof(&harness, "5"));
    drag(&mut harness, from, to);
    assert!(drawn(&harness).iter().any(|s| s.place == Place::Dofs(vec![0, 4])), "{:?}", drawn(&harness));

    let changes = drawn(&harness).len() - before.len();
    for _ in 0..changes {
        harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
        harness.run_steps(2);
    }
    assert_eq!(drawn(&harness), before);
}

#[test]
fn a_second_click_on_a_source_changes_its_state() {
    let sample = chain();
    let mut harness = open(&sample, Theme::Light);
    harness.state_mut().view.stage = Stage::Pattern;
    harness.run_steps(3);
    let label = "Source viscous dashpot between DOF 1 and 2";
    for _ in 0..2 {
        harness.get_by_label_contains(label).click();
        harness.run_steps(10);
    }
    let sources = &harness.state().document.as_ref().unwrap().project.sources;
    let state = sources.iter().find(|s| s.place == Place::Dofs(vec![0, 1])).unwrap().state;
    assert_eq!(state, State::Forced);
}

#[test]
fn the_result_shows_the_engine_s_values() {
    let sample = beam();
    let p = document(&sample.path).project;
    let outcome =
        dashpot::identify::identify(&p.structure, &p.sources, &p.runs, &p.settings, &Control::unattended()).unwrap();
    let mut harness = open(&sample, Theme::Light);
    harness.state_mut().view.stage = Stage::Result;
    settle(&mut harness);
    for estimate in &outcome.sources {
        let source = &p.sources[estimate.source];
        let value = format::with_deviation(estimate.coefficient, estimate.deviation, "N s/m");
        harness.get_by_label(&value);
        let Place::Dofs(dofs) = &source.place else { continue };
        let label = p.structure.label(dofs[0]);
        let share = format::percent(0.01 * estimate.energy_percent);
        harness.get_by_label(&format!("viscous dashpot {label}: {share}"));
        let entry = format::significant(estimate.coefficient, 3);
        harness.get_by_label_contains(&format!("; {label} {label} {entry}"));
    }
    // The answer itself is the truth that made the records.
    let found: Vec<usize> = outcome.sources.iter().map(|e| e.source).collect();
    let places: Vec<_> = found.iter().map(|&s| p.sources[s].place.clone()).collect();
    assert!(places.contains(&Place::Dofs(vec![2])) && places.contains(&Place::Dofs(vec![6])), "{places:?}");
}

#[test]
fn leaving_out_a_run_recomputes_what_is_downstream() {
    let sample = chain();
    let mut harness = open(&sample, Theme::Light);
    let first = harness.state().document.as_ref().unwrap().revision();
    harness.get_by_label("Use run 2").click();
    harness.run_steps(3);
    settle(&mut harness);
    let app = harness.state();
    let document = app.document.as_ref().unwrap();
    assert!(document.revision() > first);
    assert!(!document.project.runs[1].enabled);
    let outcome = app.derived.known_outcome(document).unwrap().unwrap();
    assert_eq!(outcome.runs.len(), document.project.runs.len() - 1);
}
