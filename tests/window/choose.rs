//! Files are chosen inside the window where the desktop has no dialogs.

use crate::support::{beam, settle, start};
use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;

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
