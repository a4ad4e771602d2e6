//! Files are chosen inside the window where the desktop has no dialogs.

use crate::support::{beam, open, settle, start};
use dashpot::window::files::Pick;
use dashpot::window::plots::export::{Kind, shown, want};
use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use std::time::{Duration, Instant};

#[test]
fn a_project_is_opened_and_saved_under_another_name_without_a_desktop() {
    let sample = beam();
    let folder = sample.path.parent().unwrap().to_owned();
    let mut harness = start();
    harness.state_mut().own_dialogs = true;
    harness.key_press_modifiers(Modifiers::COMMAND, Key::O);
    harness.run_steps(3);
    harness.get_by_label("Open a project or measurements");
    harness.get_by_role_and_label(Role::TextInput, "File name").click();
    harness.run_steps(2);
    harness.event(egui::Event::Text(folder.join("project.toml").display().to_string()));
    harness.run_steps(2);
    harness.get_by_role_and_label(Role::Button, "Choose").click();
    settle(&mut harness);
    assert_eq!(harness.state().document.as_ref().unwrap().project.title, "Test beam");
    harness.key_press_modifiers(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::S);
    harness.run_steps(3);
    // The folder of the project, with what may be meant in it.
    harness.get_by_label("Save the project as");
    harness.get_by_label("project.toml");
    harness.remove_cursor();
    harness.run_steps(3);
    harness.get_by_role_and_label(Role::Button, "Cancel").click();
    harness.run_steps(3);
    assert!(harness.state().choosing.is_none());
}

/// Asks for the plot on the screen as a table.
fn want_plot(harness: &mut egui_kittest::Harness<'_, dashpot::window::App>) {
    let title = shown(&harness.ctx).remove(0);
    want(&harness.ctx, &title, Kind::Csv);
    harness.run_steps(4);
}

/// Without a portal the dialog for a plot is one of the window, as for every other file.
#[test]
fn a_plot_is_written_where_the_dialog_of_the_window_says() {
    let sample = beam();
    let mut harness = open(&sample, egui::Theme::Light);
    harness.state_mut().own_dialogs = true;
    want_plot(&mut harness);
    harness.get_by_label("Export plot");
    assert!(harness.state().exports.busy(), "it waits for its file");
    harness.get_by_role_and_label(Role::Button, "Choose").click();
    // The file is written beside the window, by no job of its own.
    let start = Instant::now();
    while harness.state().message.is_none() && start.elapsed() < Duration::from_mins(1) {
        std::thread::sleep(Duration::from_millis(5));
        harness.run_steps(1);
    }
    let said = harness.state().message.clone().unwrap();
    assert!(!said.failed && said.text.starts_with("Written: "), "{said:?}");
    let written = std::path::PathBuf::from(said.text.trim_start_matches("Written: "));
    assert_eq!(written.parent(), sample.path.parent());
    assert!(std::fs::read_to_string(&written).unwrap().contains(','), "{}", written.display());
    // What is called off is written nowhere, and nothing waits for it.
    want_plot(&mut harness);
    harness.get_by_role_and_label(Role::Button, "Cancel").click();
    settle(&mut harness);
    assert!(!harness.state().exports.busy() && harness.state().choosing.is_none());
}

/// A session bus alone is no portal: a dialog of the desktop that ends before anybody could have seen it is made up for in the window.
#[test]
fn a_dialog_of_the_desktop_that_was_never_shown_is_made_up_for() {
    let sample = beam();
    let mut harness = open(&sample, egui::Theme::Light);
    let ctx = harness.ctx.clone();
    let wait = |millis| (Pick::SaveAs, "named.toml".to_owned(), Vec::new(), Duration::from_millis(millis));
    // Closed by the user: nothing follows.
    let (pick, name, paths, open) = wait(900);
    harness.state_mut().closed(&ctx, pick, name, paths, open);
    assert!(harness.state().choosing.is_none() && !harness.state().own_dialogs);
    let (pick, name, paths, open) = wait(3);
    harness.state_mut().closed(&ctx, pick, name, paths, open);
    harness.run_steps(3);
    assert!(harness.state().own_dialogs);
    harness.get_by_label("Save the project as");
    harness.get_by_role_and_label(Role::Button, "Choose").click();
    settle(&mut harness);
    assert!(sample.path.with_file_name("named.toml").is_file());
}
