//! Which tabs of a bar have room: all of them, closer together where they must be, else the first ones and a list of the others.

use crate::window::appearance::theme::{self, size, space};
use crate::window::appearance::widgets::width;
use crate::window::language::{t, tf, tr};
use egui::Ui;
use egui_tiles::TileId;

/// Room at the right of a title for the cross that closes it, points.
const CROSS: f32 = 16.0;
/// Least of both.
const LEAST: [f32; 2] = [7.0, 7.0];
/// Room for the list of those that have none, points.
const LIST: f32 = 86.0;

/// How the tabs of a bar stand.
#[derive(Debug, Clone)]
pub(super) struct Fit {
    /// Room before and after each title, points.
    pub pads: [f32; 2],
    /// Tabs without room, with their titles.
    pub left_out: Vec<(TileId, &'static str)>,
}

impl Default for Fit {
    fn default() -> Self {
        Self { pads: [space::M, CROSS], left_out: Vec::new() }
    }
}

impl Fit {
    /// Of tabs with their titles in a bar of `room` points; the active one has room always.
    pub(super) fn new(ui: &Ui, tabs: &[(TileId, &'static str)], active: Option<TileId>, room: f32) -> Self {
        let wide = |title: &str| width(ui, title, theme::font(size::BODY));
        let titles: Vec<(TileId, &'static str, f32)> = tabs.iter().map(|&(t, title)| (t, title, wide(title))).collect();
        let words: f32 = titles.iter().map(|t| t.2).sum();
        let spare = (room - words) / titles.len().max(1) as f32;
        let [before, after] = [space::M, CROSS];
        if spare >= before + after {
            return Self::default();
        }
        if spare >= LEAST[0] + LEAST[1] {
            let share = (spare - LEAST[0] - LEAST[1]) / (before + after - LEAST[0] - LEAST[1]);
            let pads = [(LEAST[0], before), (LEAST[1], after)].map(|(least, most)| least + share * (most - least));
            return Self { pads, left_out: Vec::new() };
        }
        let taken = |own: f32| own + LEAST[0] + LEAST[1];
        let mut free = room - LIST - titles.iter().filter(|t| Some(t.0) == active).map(|t| taken(t.2)).sum::<f32>();
        let mut left_out = Vec::new();
        for &(tile, title, own) in titles.iter().filter(|t| Some(t.0) != active) {
            // Behind the first that has no room none is shown, so that they keep their order.
            if left_out.is_empty() && taken(own) <= free {
                free -= taken(own);
            } else {
                left_out.push((tile, title));
            }
        }
        Self { pads: LEAST, left_out }
    }

    /// Whether a tab stands in the list only.
    pub(super) fn is_left_out(&self, tile: TileId) -> bool {
        self.left_out.iter().any(|(other, _)| *other == tile)
    }

    /// The list of tabs without room; gives back the one that is chosen.
    pub(super) fn list(&self, ui: &mut Ui) -> Option<TileId> {
        if self.left_out.is_empty() {
            return None;
        }
        let mut chosen = None;
        ui.add_space(space::XS);
        ui.menu_button(tf!("{} more", self.left_out.len()), |ui| {
            for (tile, title) in &self.left_out {
                if ui.button(tr(*title)).clicked() {
                    chosen = Some(*tile);
                    ui.close();
                }
            }
        })
        .response
        .on_hover_text(t!("Panes whose tabs have no room here."));
        chosen
    }
}
