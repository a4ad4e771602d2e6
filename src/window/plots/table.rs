//! Tables of panes leave the window: copied with one key or by a context menu, written as CSV by that menu or by the menu
//! File. A table is asked for its text only when somebody wants it.

use super::export::{self, COPY, Kind};
use crate::window::language::{t, tf};
use egui::containers::menu::menu_style;
use egui::{Align, Context, Id, Layout, Popup, PopupAnchor, PopupKind, Rect, SetOpenCommand, Ui};

/// Where a table goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TableAction {
    /// On the clipboard, with tabs.
    Copy,
    /// In a file.
    Csv,
}

fn shown_id() -> Id {
    Id::NULL.with("shown tables")
}

/// Titles of the tables on the screen, in the order in which they were drawn.
pub(crate) fn shown(ctx: &Context) -> Vec<String> {
    export::recent(ctx, shown_id())
}

/// Offers the table of that title in the pane `area`; gives back what is wanted of it in this frame.
pub(crate) fn offer(ui: &Ui, area: Rect, title: &str) -> Option<TableAction> {
    let ctx = ui.ctx();
    export::register(ctx, shown_id(), title);
    // A plot in the pane has keys and a menu of its own.
    let over = ui.rect_contains_pointer(area) && !export::over_plot(ctx);
    if over {
        export::point(ctx);
    }
    let focused = export::is_focused(ctx, area) && !export::plot_has_focus(ctx);
    let opened = over && ctx.input(|i| i.pointer.secondary_clicked());
    let chosen = menu(ui, title, opened);
    if !export::take_requests(ctx, title).is_empty() {
        return Some(TableAction::Csv);
    }
    chosen.or(((over || focused) && export::copied(ctx)).then_some(TableAction::Copy))
}

/// Does what is wanted with the text of the table, columns separated by tabs.
pub(crate) fn give(ctx: &Context, title: &str, action: TableAction, text: String) {
    match action {
        TableAction::Copy => export::copy(ctx, title, text),
        TableAction::Csv => export::write_table(ctx, title, text),
    }
}

fn menu(ui: &Ui, title: &str, opened: bool) -> Option<TableAction> {
    let (ctx, id) = (ui.ctx().clone(), ui.scope_id().with("table menu"));
    let entries = |ui: &mut Ui| {
        let mut action = None;
        let copy = egui::Button::new(t!("Copy table")).shortcut_text(ui.ctx().format_shortcut(&COPY));
        let copy = ui.add(copy).on_hover_text(t!("With tabs, for a spreadsheet: SI units, all digits."));
        copy.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, t!("Copy table")));
        if copy.clicked() {
            action = Some(TableAction::Copy);
        }
        if ui.button(t!("Export table as CSV…")).clicked() {
            action = Some(TableAction::Csv);
        }
        action
    };
    Popup::new(id, ctx, PopupAnchor::PointerFixed, ui.layer_id())
        .kind(PopupKind::Menu)
        .layout(Layout::top_down_justified(Align::Min))
        .style(menu_style)
        .open_memory(opened.then_some(SetOpenCommand::Bool(true)))
        .accessible_name(tf!("Menu of the table {title}"))
        .show(entries)?
        .inner
}

/// Asks the table of that title for its text, to be written to a file.
pub(crate) fn want(ctx: &Context, title: &str) {
    export::want(ctx, title, Kind::Csv);
}
