//! The whole way of an engineer who has never seen the program, by labels and by the pointer alone.

use crate::support::{beam, document, drag, drop_files, open, settle, start};
use dashpot::effects::{Place, State};
use dashpot::window::App;
use dashpot::window::app::Ask;
use dashpot::window::app::view::Stage;
use dashpot::window::document::edits::Edit;
use egui::accesskit::Role;
use egui::{Key, Modifiers, Theme};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

fn click(harness: &mut Harness<'_, App>, label: &str) {
    harness.get_by_label(label).click();
    harness.run_steps(3);
}

fn tab(harness: &mut Harness<'_, App>, label: &str) {
    harness.get_by_role_and_label(Role::Tab, label).click();
    settle(harness);
}

fn places(harness: &Harness<'_, App>) -> Vec<(Place, State)> {
    let sources = &harness.state().document.as_ref().unwrap().project.sources;
    sources.iter().map(|s| (s.place.clone(), s.state)).collect()
}

#[test]
fn from_the_start_screen_to_exported_matrices() {
    let mut harness = start();
    click(&mut harness, "Five masses");
    settle(&mut harness);
    assert_eq!(harness.state().document.as_ref().unwrap().project.title, "Five masses with two dashpots");
    // A run is looked at: the inspector follows.
    click(&mut harness, "run-03.csv");
    harness.get_by_label("Run 3");
    // A source is drawn between masses 1 and 3, and made forced, known, off, candidate by clicks.
    tab(&mut harness, "Pattern");
    let place_of_dof =
        |h: &Harness<'_, App>, dof: &str| h.get_by_label_contains(&format!("DOF {dof}, translation")).rect().center();
    let (one, three) = (place_of_dof(&harness, "1"), place_of_dof(&harness, "3"));
    let before = places(&harness);
    drag(&mut harness, one, three);
    assert!(places(&harness).contains(&(Place::Dofs(vec![0, 2]), State::Candidate)));
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(2);
    assert_eq!(places(&harness), before, "undo takes the source away again");
    // The selection is stepped through.
    tab(&mut harness, "Select");
    let accepted = harness.state().derived.known_outcome(harness.state().document.as_ref().unwrap()).unwrap().clone();
    let accepted = accepted.unwrap().accepted;
    click(&mut harness, "Step back");
    assert_eq!(harness.state().view.step, Some(accepted - 1));
    click(&mut harness, "To the best set");
    assert_eq!(harness.state().view.step, None);
    // What was identified is read.
    tab(&mut harness, "Result");
    harness.get_by_label_contains("Matrix; ");
    for pane in ["Damping", "Bode", "Nyquist", "Hysteresis", "Values"] {
        tab(&mut harness, pane);
    }
    harness.get_by_label("Copy table");
    // And exported.
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("damping.bdf");
    let ctx = harness.ctx.clone();
    harness.state_mut().answer(&ctx, Ask::Export(dashpot::exchange::export::Format::Nastran, path.clone()));
    settle(&mut harness);
    assert!(std::fs::read_to_string(&path).unwrap().contains("CDAMP2"));
    harness.get_by_label_contains("Written:");
    // A slow machine kept the source between drawing it and taking it back; the sample stays as it was.
    let sample = harness.state().document.as_ref().unwrap().session().path().unwrap().to_path_buf();
    dashpot::session::save::forget_autosave(&sample).unwrap();
}

#[test]
fn records_are_dropped_on_the_window_appended_or_refused_with_the_reason() {
    let sample = beam();
    let folder = sample.path.parent().unwrap();
    let mut harness = open(&sample, Theme::Light);
    let good = folder.join("again.csv");
    std::fs::copy(folder.join("run-01.csv"), &good).unwrap();
    drop_files(&mut harness, &[good]);
    settle(&mut harness);
    let runs = |h: &Harness<'_, App>| h.state().document.as_ref().unwrap().project.runs.len();
    assert_eq!(runs(&harness), 5, "appended, never replaced");
    let bad = folder.join("bad.csv");
    std::fs::write(&bad, "time [s],force@9 [N],acc@5 [m/s^2]\n0,1,1\n0.1,1,oops\n").unwrap();
    drop_files(&mut harness, std::slice::from_ref(&bad));
    settle(&mut harness);
    assert_eq!(runs(&harness), 5);
    let message = harness.state().message.clone().unwrap();
    assert!(message.failed && message.text.contains("bad.csv, line 3"), "{message:?}");
    // The reason stays until it is closed.
    harness.run_steps(40);
    harness.get_by_label("Close").click();
    harness.run_steps(3);
    assert!(harness.state().message.is_none());
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(2);
    assert_eq!(runs(&harness), 4);
}

#[test]
fn what_runs_shows_its_progress_and_can_be_cancelled() {
    let sample = beam();
    let mut harness = open(&sample, Theme::Light);
    let ctx = harness.ctx.clone();
    harness.state_mut().run(&ctx, "Waiting for the test", |control| {
        control.report(0.4);
        while control.check().is_ok() {
            std::thread::sleep(std::time::Duration::from_millis(2));
        }
        Err("cancelled".to_owned())
    });
    harness.run_steps(2);
    harness.get_by_label("Waiting for the test");
    click(&mut harness, "Cancel");
    assert!(harness.state().running().is_none());
    harness.get_by_label("Cancelled.");
}

#[test]
fn a_long_record_is_read_with_progress_and_can_be_given_up() {
    let sample = beam();
    let mut text = "time [s],force@9 [N],acc@5 [m/s^2],acc@9 [m/s^2]\n".to_owned();
    for k in 0..400_000 {
        let (s, c) = (1e-3 * f64::from(k)).sin_cos();
        text += &format!("{:.6},{c:.8},{s:.8},{c:.8}\n", 1e-4 * f64::from(k));
    }
    let long = sample.path.with_file_name("long.csv");
    std::fs::write(&long, text).unwrap();
    let mut harness = open(&sample, Theme::Light);
    drop_files(&mut harness, &[long]);
    let start = std::time::Instant::now();
    let progress = |h: &Harness<'_, App>| h.state().running().map(|(_, progress)| progress);
    let mut seen = vec![0.0];
    while *seen.last().unwrap() < 0.3 {
        seen.push(progress(&harness).expect("the record is being read"));
        harness.run_steps(1);
        assert!(start.elapsed() < std::time::Duration::from_mins(1));
    }
    assert!(seen.is_sorted(), "progress goes forwards: {seen:?}");
    click(&mut harness, "Cancel");
    settle(&mut harness);
    harness.get_by_label("Cancelled.");
    assert_eq!(harness.state().document.as_ref().unwrap().project.runs.len(), 4, "nothing was added");
}

#[test]
fn a_source_is_drawn_with_the_keyboard_alone() {
    let sample = beam();
    let mut harness = open(&sample, Theme::Light);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Num3);
    harness.run_steps(3);
    assert_eq!(harness.state().view.stage, Stage::Pattern);
    harness.state_mut().view.law = dashpot::effects::Effect::Coulomb;
    harness.get_by_label_contains("DOF 3, translation").focus();
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    harness.run_steps(3);
    assert!(places(&harness).iter().filter(|(place, _)| *place == Place::Dofs(vec![2])).count() == 2);
}

#[test]
fn a_parameter_of_the_structure_is_edited_and_taken_back() {
    let sample = beam();
    let mut harness = open(&sample, Theme::Light);
    harness.state_mut().view.stage = Stage::Structure;
    harness.run_steps(2);
    tab(&mut harness, "Parameters");
    let length = |h: &Harness<'_, App>| h.state().document.as_ref().unwrap().project.structure.nodes()[5].position[0];
    assert!((length(&harness) - 0.5).abs() < 1e-12);
    harness.get_by_role_and_label(Role::SpinButton, "Length").click();
    harness.run_steps(2);
    harness.get_by_role_and_label(Role::SpinButton, "Length").type_text("0.6");
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    harness.run_steps(2);
    settle(&mut harness);
    assert!((length(&harness) - 0.6).abs() < 1e-12, "{}", length(&harness));
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(2);
    assert!((length(&harness) - 0.5).abs() < 1e-12);
}

#[test]
fn a_new_project_is_made_from_a_template_and_saved_under_a_name() {
    let mut harness = start();
    let ctx = harness.ctx.clone();
    harness.state_mut().answer(&ctx, Ask::New(1));
    settle(&mut harness);
    harness.get_by_label_contains("A new project");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    harness.state_mut().answer(&ctx, Ask::SaveAs(path.clone()));
    settle(&mut harness);
    assert_eq!(document(&path).project.structure.len(), 5);
    assert!(!harness.state().document.as_ref().unwrap().session().is_dirty());
}

#[test]
fn the_tour_leads_through_all_stages_and_ends() {
    let mut harness = start();
    click(&mut harness, "Take the tour");
    settle(&mut harness);
    let mut stages = vec![harness.state().view.stage];
    for step in 1..=9 {
        harness.get_by_label_contains(&format!("{step} of 10"));
        click(&mut harness, "Next");
        settle(&mut harness);
        stages.push(harness.state().view.stage);
    }
    click(&mut harness, "Finish");
    assert!(harness.state().view.tour.is_none());
    stages.dedup();
    assert_eq!(stages, [Stage::Measure, Stage::Structure, Stage::Pattern, Stage::Select, Stage::Result]);
}
#[test]
fn unsaved_changes_are_asked_about_before_they_are_left_behind() {
    let sample = beam();
    let mut harness = open(&sample, Theme::Light);
    let ctx = harness.ctx.clone();
    harness.state_mut().answer(&ctx, Ask::Edit(Edit::Cycle(0)));
    settle(&mut harness);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::W);
    harness.run_steps(3);
    click(&mut harness, "Stay");
    assert!(harness.state().document.is_some());
    harness.key_press_modifiers(Modifiers::COMMAND, Key::W);
    harness.run_steps(3);
    harness.remove_cursor();
    harness.run_steps(3);
    harness.snapshot("leave");
    click(&mut harness, "Save");
    assert!(harness.state().document.is_none());
    assert_eq!(document(&sample.path).project.sources[0].state, State::Forced);
    // Nothing is unsaved: nothing is asked.
    harness.state_mut().answer(&ctx, Ask::Open(sample.path.clone()));
    settle(&mut harness);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::W);
    harness.run_steps(3);
    assert!(harness.state().document.is_none() && harness.state().leaving.is_none());
}
