//! The desk: panes that can be moved, split, closed and brought back; each stage has its own arrangement, remembered.

use super::desk::Desk;
use super::panes::Pane;
use super::tabs::Fit;
use crate::display::glossary;
use crate::window::app::ask::Ask;
use crate::window::app::opened::Opened;
use crate::window::appearance::theme::{self, Palette, size, space};
use crate::window::appearance::widgets::explained;
use crate::window::language::{t, tf, tr};
use crate::window::stages;
use crate::window::stages::explain::switches::in_bar;
use egui::{
    Color32, CornerRadius, Frame, Id, Margin, Rect, Response, Role, Sense, Stroke, Ui, WidgetInfo, WidgetText, vec2,
};
use egui_tiles::{Behavior, SimplificationOptions, TabState, Tabs, TileId, Tiles, UiResponse};

/// Least room behind a title for the cross that closes its pane, points.
const CROSS_ROOM: f32 = 11.0;

/// Shows the panes of the stage that is open.
pub(crate) fn show(ui: &mut Ui, desk: &mut Desk, opened: Opened<'_>, asks: &mut Vec<Ask>) {
    let tree = desk.tree(opened.view.stage);
    let mut panes = Panes { opened, asks, alone: true, fit: Fit::default(), closed: None, chosen: None };
    tree.ui(&mut panes, ui);
    let chosen = panes.chosen;
    // Closed panes keep their place, so that View > Panes can bring them back to it.
    if let Some(tile) = panes.closed {
        tree.set_visible(tile, false);
        ui.ctx().request_repaint();
    }
    if let Some(tile) = chosen {
        tree.make_active(|id, _| id == tile);
        ui.ctx().request_repaint();
    }
}

struct Panes<'a> {
    opened: Opened<'a>,
    asks: &'a mut Vec<Ask>,
    /// Whether the tab that is drawn is the only one of its bar.
    alone: bool,
    /// How the tabs of the bar that is drawn stand.
    fit: Fit,
    /// The pane that is to be closed after this frame.
    closed: Option<TileId>,
    /// The pane that was chosen in the list of those without a tab.
    chosen: Option<TileId>,
}

impl Behavior<Pane> for Panes<'_> {
    fn pane_ui(&mut self, ui: &mut Ui, _tile: TileId, pane: &mut Pane) -> UiResponse {
        let palette = Palette::of(ui.visuals());
        let below = CornerRadius { nw: 0, ne: 0, sw: 6, se: 6 };
        let margin =
            if *pane == Pane::Schematic { Margin::ZERO } else { Margin { left: 12, right: 12, top: 8, bottom: 8 } };
        let rect = ui.max_rect();
        ui.painter().rect_filled(rect, below, palette.pane);
        Frame::new().inner_margin(margin).show(ui, |ui| {
            ui.set_min_size(ui.available_size());
            ui.push_id(*pane, |ui| stages::show(ui, *pane, &mut self.opened, self.asks));
        });
        UiResponse::None
    }

    fn tab_title_for_pane(&mut self, pane: &Pane) -> WidgetText {
        pane.title().into()
    }

    fn tab_ui(&mut self, tiles: &mut Tiles<Pane>, ui: &mut Ui, id: Id, tile: TileId, state: &TabState) -> Response {
        let palette = Palette::of(ui.visuals());
        let title = self.tab_title_for_tile(tiles, tile).text().to_owned();
        let galley = ui.painter().layout_no_wrap(tr(&title), theme::font(size::BODY), Color32::PLACEHOLDER);
        let [before, after] = if self.fit.is_left_out(tile) { [0.0; 2] } else { self.fit.pads };
        let wide = if self.fit.is_left_out(tile) { 0.0 } else { galley.size().x + before + after };
        let (_, rect) = ui.allocate_space(vec2(wide, ui.available_height()));
        if self.fit.is_left_out(tile) {
            return ui.interact(rect, id, Sense::hover());
        }
        let response = ui.interact(rect, id, Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::selected(Role::Tab, true, state.active, tr(&title)));
        if state.is_being_dragged {
            return response;
        }
        let hovered = ui.rect_contains_pointer(rect);
        let ink = match (state.active, self.alone) {
            (true, false) => palette.accent,
            (true, true) => palette.ink,
            _ if hovered => palette.ink,
            _ => palette.weak,
        };
        let at = rect.left_center() + vec2(before, -0.5 * galley.size().y);
        ui.painter().galley(at, galley, ink);
        if state.active && !self.alone {
            let line = Rect::from_min_max(
                rect.left_bottom() + vec2(before - 2.0, -2.0),
                rect.right_bottom() - vec2(after - 2.0, 0.0),
            );
            ui.painter().rect_filled(line, 1.0, palette.accent);
        }
        // Where tabs stand close together the menu closes panes: a cross would lie on the title.
        let response = explained(response, glossary::meaning(&title));
        if hovered && after >= CROSS_ROOM {
            self.close_button(ui, rect, tile, &title);
        }
        response
    }

    fn tab_bar_left_ui(&mut self, tiles: &Tiles<Pane>, _ui: &mut Ui, _tile: TileId, tabs: &Tabs) {
        self.alone = tabs.children.iter().filter(|child| tiles.is_visible_in_layout(**child)).count() < 2;
    }

    fn top_bar_right_ui(&mut self, tiles: &Tiles<Pane>, ui: &mut Ui, _tile: TileId, tabs: &Tabs, _offset: &mut f32) {
        match tabs.active.and_then(|tile| tiles.get_pane(&tile)) {
            Some(Pane::Schematic) => {
                ui.add_space(space::S);
                super::schematic::switches(ui, self.opened.view, self.asks);
            }
            Some(pane @ (Pane::ErrorMap | Pane::Cell)) => {
                let records = self.opened.document.project.runs.is_empty();
                let place = usize::from(*pane == Pane::Cell);
                in_bar(ui, place, pane.title(), &mut self.opened.view.explain, records);
            }
            _ => {}
        }
        let shown = tabs.children.iter().filter(|tile| tiles.is_visible_in_layout(**tile));
        let titles: Vec<_> = shown.filter_map(|tile| Some((*tile, tiles.get_pane(tile)?.title()))).collect();
        self.fit = Fit::new(ui, &titles, tabs.active, ui.available_width());
        self.chosen = self.fit.list(ui).or(self.chosen);
    }

    fn simplification_options(&self) -> SimplificationOptions {
        SimplificationOptions { all_panes_must_have_tabs: true, ..SimplificationOptions::default() }
    }

    fn gap_width(&self, _style: &egui::Style) -> f32 {
        space::GAP
    }

    fn min_size(&self) -> f32 {
        140.0
    }

    fn tab_bar_height(&self, _style: &egui::Style) -> f32 {
        30.0
    }

    fn tab_bar_color(&self, visuals: &egui::Visuals) -> Color32 {
        Palette::of(visuals).pane
    }

    fn tab_bar_hline_stroke(&self, visuals: &egui::Visuals) -> Stroke {
        theme::hair(Palette::of(visuals).line)
    }

    fn resize_stroke(&self, style: &egui::Style, state: egui_tiles::ResizeState) -> Stroke {
        let palette = Palette::of(&style.visuals);
        match state {
            egui_tiles::ResizeState::Idle => Stroke::NONE,
            egui_tiles::ResizeState::Hovering => theme::bold(palette.line),
            egui_tiles::ResizeState::Dragging => theme::bold(palette.accent),
        }
    }
}

impl Panes<'_> {
    fn close_button(&mut self, ui: &mut Ui, tab: Rect, tile: TileId, title: &str) {
        let palette = Palette::of(ui.visuals());
        let rect = Rect::from_center_size(tab.right_center() - vec2(7.0, 0.0), vec2(14.0, 14.0));
        let response = ui.interact(rect, ui.scope_id().with(("close", tile)), Sense::click());
        response.widget_info(|| WidgetInfo::labeled(Role::Button, true, tf!("Close {title}")));
        let ink = if response.hovered() { palette.error } else { palette.weak };
        let r = rect.shrink(3.5);
        ui.painter().line_segment([r.left_top(), r.right_bottom()], theme::pen(ink));
        ui.painter().line_segment([r.right_top(), r.left_bottom()], theme::pen(ink));
        if response.on_hover_text(t!("Closes the pane; View > Panes brings it back.")).clicked() {
            self.closed = Some(tile);
        }
    }
}
