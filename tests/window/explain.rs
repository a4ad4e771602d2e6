//! The walk through Explain: see where the model fails, learn what is missing, try it, add it, watch the error fall, undo.

use crate::friction::{FORCE, ROW, friction};
use crate::support::{beam, detuned, open, settle};
use dashpot::diagnosis::result::{Suggestion, Verdict};
use dashpot::effects::{Effect, Place, Source, State};
use dashpot::exchange::project::file::Shape;
use dashpot::window::App;
use dashpot::window::app::view::Stage;
use dashpot::window::explained::Standing;
use dashpot::window::stages::explain::look::Tab;
use egui::{Key, Modifiers, Theme, accesskit::Role};
use egui_kittest::kittest::{NodeT, Queryable};
use egui_kittest::{Harness, SnapshotOptions};
use std::time::Duration;

fn explain(theme: Theme) -> (crate::support::Sample, Harness<'static, App>) {
    let sample = friction();
    let mut harness = open(&sample, theme);
    harness.get_by_role_and_label(Role::Tab, "Explain").click();
    settle(&mut harness);
    (sample, harness)
}

fn press(harness: &mut Harness<'_, App>, label: &str) {
    harness.get_by_role_and_label(Role::Button, label).click();
    settle(harness);
}

fn picture(harness: &mut Harness<'_, App>, name: &str) {
    harness.remove_cursor();
    settle(harness);
    harness.snapshot(name);
}

/// A picture of `docs/explain-tour.md`.
fn picture_of_the_tour(harness: &mut Harness<'_, App>, name: &str) {
    harness.remove_cursor();
    settle(harness);
    let options = SnapshotOptions::new().output_path("docs/pictures/explain").threshold(0.6).max_failed_pixels(10);
    harness.snapshot_options(name, &options);
}

/// Error and noise floor of the model as it stands.
fn error(harness: &Harness<'_, App>) -> [f64; 2] {
    let app = harness.state();
    let comparison = app.derived.explained.comparison(app.document.as_ref().unwrap()).unwrap().as_ref().unwrap();
    [comparison.error, comparison.noise_floor]
}

fn verdict(harness: &Harness<'_, App>) -> Verdict {
    let app = harness.state();
    app.derived.explained.diagnosis(app.document.as_ref().unwrap()).unwrap().as_ref().unwrap().verdict
}

fn friction_of<'a>(harness: &'a Harness<'_, App>) -> Option<&'a Source> {
    let sources = &harness.state().document.as_ref().unwrap().project.sources;
    sources.iter().find(|s| s.effect == Effect::Coulomb && s.state == State::Known)
}

#[test]
fn the_hidden_friction_is_named_tried_added_and_taken_back() {
    let (_sample, mut harness) = explain(Theme::Light);
    let [before, floor] = error(&harness);
    assert!((0.10..0.60).contains(&before), "the model without friction is wrong by {before}");
    assert!(before > 10.0 * floor);
    assert_eq!(verdict(&harness), Verdict::Missing);
    harness.get_by_label_contains("Suggestion 1: Coulomb friction at DOF 7, probability");
    picture_of_the_tour(&mut harness, "before");

    press(&mut harness, "Try");
    let app = harness.state();
    let source = app.view.explain.trial.clone().unwrap();
    let tried = app.derived.explained.trial(app.document.as_ref().unwrap(), &source).unwrap().as_ref().unwrap().error;
    assert!(tried < 2.0 * floor, "with the friction the error would be {tried}");
    assert!(friction_of(&harness).is_none() && error(&harness)[0] == before, "a preview changes nothing");
    picture_of_the_tour(&mut harness, "try");

    press(&mut harness, "Add");
    let added = friction_of(&harness).unwrap();
    assert_eq!(added.place, Place::Dofs(vec![ROW]));
    assert!((added.parameters[0] / FORCE - 1.0).abs() < 0.02, "{added:?}");
    let [after, floor] = error(&harness);
    assert!(after < 1.2 * floor, "error {after}, noise floor {floor}");
    assert_eq!(verdict(&harness), Verdict::Adequate);
    harness.get_by_label_contains("The model now explains the data");
    picture_of_the_tour(&mut harness, "after");

    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    settle(&mut harness);
    assert!(friction_of(&harness).is_none());
    assert_eq!(error(&harness)[0], before);
    assert_eq!(verdict(&harness), Verdict::Missing);

    // All steps are kept: forward again by a click on the ledger, and back.
    harness.get_by_label_contains("Step 1: + Coulomb friction at DOF 7").click();
    settle(&mut harness);
    assert!(friction_of(&harness).is_some() && error(&harness)[0] == after);
    harness.get_by_label_contains("Step 0: Model as opened").click();
    settle(&mut harness);
    assert!(friction_of(&harness).is_none() && error(&harness)[0] == before);
    assert_eq!(harness.state().derived.explained.ledger.steps().len(), 2);
}

#[test]
fn what_is_ruled_out_makes_room_for_the_next_and_can_be_taken_back() {
    let (_sample, mut harness) = explain(Theme::Light);
    let is_friction =
        |s: &Suggestion| s.added.source.effect == Effect::Coulomb && s.added.source.place == Place::Dofs(vec![ROW]);
    harness.get_by_role_and_label(Role::Button, "Not this").click();
    harness.run_steps(3);
    // The next best is there at once, while it is searched for what else it could be.
    assert!(harness.query_by_label_contains("Suggestion 1: Coulomb friction at DOF 7").is_none());
    harness.get_by_label_contains("Suggestion 1:");
    harness.get_by_label("Ruled out by you");
    harness.get_by_label("It is searched for what else it could be.");
    assert!(harness.state().running().is_some_and(|(name, _)| name.starts_with("Searching")));
    press(&mut harness, "Cancel");
    harness.get_by_label("The search was cancelled.");
    picture(&mut harness, "explain-not-this");
    press(&mut harness, "Search again");
    let app = harness.state();
    let (found, standing) = app.derived.explained.suggestions(app.document.as_ref().unwrap());
    assert!(standing == Standing::Final && !found.is_empty() && !found.iter().any(is_friction));
    assert!(error(&harness)[0] > 0.1, "the model is as it was");
    let next = found[0].clone();

    // It is a change like others: undone and repeated at once, without another search.
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(3);
    harness.get_by_label_contains("Suggestion 1: Coulomb friction at DOF 7");
    harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    harness.run_steps(3);
    let app = harness.state();
    assert_eq!(app.derived.explained.suggestions(app.document.as_ref().unwrap()).0[0], next);
    press(&mut harness, "Take back");
    harness.get_by_label_contains("Suggestion 1: Coulomb friction at DOF 7");
    assert_eq!(harness.state().derived.explained.ledger.steps().len(), 1, "the model was the same all the way");
}

/// Steps until the search has told its first suggestions; gives back what its bar showed on the way.
fn until_told(harness: &mut Harness<'_, App>) -> Vec<f64> {
    let mut bar = Vec::new();
    loop {
        harness.step();
        let app = harness.state();
        let document = app.document.as_ref().unwrap();
        assert!(app.derived.explained.diagnosis(document).is_none(), "the search ended before it was heard of");
        if let Some((_, progress)) = app.running().filter(|(name, _)| name.starts_with("Searching")) {
            bar.push(progress);
            let delay = harness.output().viewport_output[&egui::ViewportId::ROOT].repaint_delay;
            assert!(delay <= Duration::from_millis(100), "the next look at the progress is in {delay:?}");
        }
        if !app.derived.explained.suggestions(document).0.is_empty() {
            return bar;
        }
    }
}

#[test]
fn the_first_suggestions_are_shown_before_the_search_has_ended() {
    let sample = friction();
    let mut harness = open(&sample, Theme::Light);
    harness.get_by_role_and_label(Role::Tab, "Explain").click();
    let bar = until_told(&mut harness);
    assert!(bar.is_sorted(), "the bar went back: {bar:?}");
    assert!(bar.last() > bar.first(), "the bar moves without any event: {bar:?}");
    // Held where it is.
    press(&mut harness, "Cancel");
    harness.get_by_label_contains("Provisional suggestion 1: Coulomb friction at DOF 7, probability about");
    assert!(harness.get_by_role_and_label(Role::Button, "Add").accesskit_node().is_disabled());
    picture(&mut harness, "explain-provisional");

    press(&mut harness, "Try");
    let early = harness.state().view.explain.trial.clone().unwrap();
    harness.get_by_role_and_label(Role::Button, "Search again").click();
    until_told(&mut harness);
    settle(&mut harness);
    assert!(harness.query_by_label_contains("Provisional").is_none());
    harness.get_by_label_contains("Suggestion 1: Coulomb friction at DOF 7, probability");
    assert!(!harness.get_by_role_and_label(Role::Button, "Add").accesskit_node().is_disabled());
    // What is on trial has the size that was found in the end.
    let app = harness.state();
    let (found, _) = app.derived.explained.suggestions(app.document.as_ref().unwrap());
    let trial = app.view.explain.trial.as_ref().unwrap();
    assert!(trial.is_same(&early) && *trial == found[0].added.source);
}

#[test]
fn a_click_on_the_map_chooses_run_and_channel_for_all_panes() {
    let (_sample, mut harness) = explain(Theme::Light);
    harness.get_by_label_contains("Run 8, 13.10 Hz, level 2, acc@5: error").click();
    settle(&mut harness);
    assert_eq!(harness.state().view.run, 7);
    harness.get_by_label_contains("run 8, 13.10 Hz, level 2");
    for tab in [Tab::Level, Tab::Time, Tab::Loop, Tab::Frequency] {
        harness.get_by_role_and_label(Role::Button, tab.label()).click();
        settle(&mut harness);
        assert_eq!(harness.state().view.explain.tab, tab);
        if tab != Tab::Frequency {
            picture(&mut harness, &format!("explain-{}", tab.label().to_lowercase()));
        }
    }
}

#[test]
fn what_was_identified_is_taken_over_into_the_model() {
    let sample = beam();
    let mut harness = open(&sample, Theme::Light);
    harness.state_mut().view.stage = Stage::Explain;
    settle(&mut harness);
    press(&mut harness, "Add the identified sources");
    let [after, floor] = error(&harness);
    assert!(after < 3.0 * floor, "error {after}, noise floor {floor}");
}

#[test]
fn the_walk_in_the_dark() {
    let (_sample, mut harness) = explain(Theme::Dark);
    press(&mut harness, "Try");
    picture(&mut harness, "explain-try-dark");
}

#[test]
fn a_detuned_model_is_corrected_and_lacks_nothing() {
    let sample = detuned();
    let mut harness = open(&sample, Theme::Light);
    harness.get_by_role_and_label(Role::Tab, "Explain").click();
    settle(&mut harness);
    let [before, floor] = error(&harness);
    assert!(before > 20.0 * floor, "the detuned model is wrong by {before}, noise {floor}");
    let app = harness.state();
    let found = app.derived.explained.diagnosis(app.document.as_ref().unwrap()).unwrap().as_ref().unwrap();
    assert_eq!(found.verdict, Verdict::Detuned, "no effect is missing: {:?}", found.suggestions);
    harness.get_by_label("The model is detuned");
    picture_of_the_tour(&mut harness, "detuned");
    press(&mut harness, "Correct the model");
    let [after, floor] = error(&harness);
    assert!(after < 1.2 * floor, "error {after}, noise floor {floor}");
    let modulus = harness.state().document.as_ref().unwrap().session().document().file().structure.clone();
    let Shape::Beam(corrected) = modulus.shape else { panic!("a beam") };
    let ratio = corrected.youngs_modulus / corrected.density / (70.4e9 / 2700.0);
    // The rest stands in corrections of groups of elements.
    assert!((ratio - 1.0).abs() < 5e-3, "stiffness over mass is off by {ratio}");
    picture(&mut harness, "explain-corrected");
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    settle(&mut harness);
    assert_eq!(error(&harness)[0], before);
}
