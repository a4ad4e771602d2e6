//! Where the menus are: a key moves the focus there, and the keys that walk through them do nothing else meanwhile.

use egui::{Context, Id, Popup};

fn id() -> Id {
    Id::NULL.with("menu bar")
}

/// Notes the buttons of the menus, the first one first.
pub(crate) fn note(ctx: &Context, buttons: Vec<Id>) {
    ctx.data_mut(|d| d.insert_temp(id(), buttons));
}

fn buttons(ctx: &Context) -> Vec<Id> {
    ctx.data(|d| d.get_temp(id())).unwrap_or_default()
}

/// Moves the focus to the first menu.
pub(crate) fn focus(ctx: &Context) {
    if let Some(first) = buttons(ctx).first() {
        ctx.memory_mut(|m| m.request_focus(*first));
    }
}

/// Whether plain keys belong to the menus: one has the focus, or something that opened over the window is shown.
pub(crate) fn has_keys(ctx: &Context) -> bool {
    let focused = ctx.memory(egui::Memory::focused);
    Popup::is_any_open(ctx) || focused.is_some_and(|id| buttons(ctx).contains(&id))
}
