//! Two states of one structure: what changed is found and shown, and another project than one of the structure is refused.

use crate::support::{beam, beam_with, chain, open, settle};
use dashpot::session::states::Against;
use dashpot::window::App;
use dashpot::window::app::view::Stage;
use dashpot::window::frame::panes::Pane;
use egui::Theme;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

fn at_change(harness: &mut Harness<'_, App>) {
    harness.state_mut().view.stage = Stage::Result;
    harness.state_mut().desk.set_open(Stage::Result, Pane::Change, true);
    settle(harness);
}

#[test]
fn the_dashpot_that_changed_is_named() {
    let (before, after) = (beam(), beam_with(1.0));
    let mut harness = open(&after, Theme::Light);
    at_change(&mut harness);
    harness.get_by_label("What changed?");
    harness.get_by_role_and_label(Role::Button, "Choose the earlier state…");
    harness.state_mut().view.against = Some(Against::Project(before.path.clone()));
    settle(&mut harness);
    harness.get_by_label_contains("Changed: Viscous dashpot at DOF 7: +0.");
    assert!(harness.query_by_label_contains("Viscous dashpot at DOF 3: ").is_none(), "the other one stayed as it was");
    harness.remove_cursor();
    settle(&mut harness);
    harness.snapshot("change");
    harness.get_by_role_and_label(Role::Button, "End comparison").click();
    settle(&mut harness);
    harness.get_by_label("What changed?");
}

#[test]
fn a_project_of_something_else_is_refused_with_a_reason() {
    let (other, this) = (chain(), beam());
    let mut harness = open(&this, Theme::Light);
    harness.state_mut().view.against = Some(Against::Project(other.path.clone()));
    at_change(&mut harness);
    harness.get_by_label_contains("give both structures the same DOFs and labels");
    harness.state_mut().view.against = Some(Against::Project(other.path.with_file_name("gone.toml")));
    settle(&mut harness);
    harness.get_by_label_contains("gone.toml");
}
