//! The report from the menu: what it is to be is asked, kept and written.

use crate::support::{beam, open, settle};
use dashpot::window::app::ask::Ask;
use dashpot::window::app::commands::Command;
use egui::Theme;
use egui::accesskit::Role;
use egui_kittest::kittest::{NodeT, Queryable};

#[test]
fn the_dialog_asks_what_the_command_line_asks() {
    let sample = beam();
    let mut harness = open(&sample, Theme::Light);
    harness.state_mut().own_dialogs = true;
    let ctx = harness.ctx.clone();
    harness.state_mut().answer(&ctx, Ask::Command(Command::Report));
    // The dialog has its size, and with it its place, after some frames.
    harness.run_steps(12);
    harness.get_by_role_and_label(Role::TextInput, "Tested by").click();
    harness.run_steps(2);
    harness.event(egui::Event::Text("C. Engineer".to_owned()));
    harness.run_steps(2);
    // Structure and settings only: the rest takes its time.
    harness.get_by_role_and_label(Role::Button, "None").click();
    harness.run_steps(2);
    assert!(harness.get_by_role_and_label(Role::Button, "Write…").accesskit_node().is_disabled(), "nothing is chosen");
    for section in ["Structure", "Settings"] {
        // The stage has a tab of that name as well.
        harness.get_by_role_and_label(Role::CheckBox, section).click();
        harness.run_steps(2);
    }
    harness.get_by_role_and_label(Role::Button, "Write…").click();
    harness.run_steps(4);
    let out = sample.path.with_file_name("r.html");
    let chosen = Ask::Picked(dashpot::window::files::Pick::Report, vec![out.clone()]);
    harness.state_mut().answer(&ctx, chosen);
    settle(&mut harness);
    let text = std::fs::read_to_string(&out).unwrap();
    assert!(text.contains("C. Engineer") && text.contains("<h2>Settings</h2>"));
    assert!(!text.contains("<h2>Ledger</h2>"));
    assert!(sample.path.with_file_name("r-tables.zip").is_file());
    let document = harness.state().document.as_ref().unwrap();
    let kept = document.session().document().file().report.tester.as_deref();
    assert_eq!(kept, Some("C. Engineer"), "kept in the project");
}
