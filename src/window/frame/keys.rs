//! The list of keys, from the table of commands.

use crate::window::commands::TABLE;
use crate::window::theme::space;
use crate::window::view::View;
use crate::window::widgets::UiExt;
use egui::{Context, Grid, Window};

/// Shows the list while it is open.
pub fn show(ctx: &Context, view: &mut View) {
    let mut open = view.keys;
    Window::new("Keys").open(&mut open).resizable(false).collapsible(false).show(ctx, |ui| {
        Grid::new("keys").num_columns(3).spacing([space::L, space::XS]).show(ui, |ui| {
            for entry in &TABLE {
                let Some(keys) = entry.keys else { continue };
                ui.label(ui.ctx().format_shortcut(&keys));
                ui.label(entry.label);
                ui.hint(entry.tooltip);
                ui.end_row();
            }
        });
        ui.add_space(space::S);
        ui.hint("On the schematic: Tab goes from DOF to DOF and from source to source, Enter is a click.");
    });
    view.keys = open;
}
