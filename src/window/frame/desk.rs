//! Which panes are open and where they lie, stage by stage.

use super::panes::{Pane, arrangement};
use crate::window::app::view::Stage;
use egui::Rect;
use egui_tiles::{Tile, Tree};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Arrangements of the stages that were opened.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Desk {
    trees: BTreeMap<Stage, Tree<Pane>>,
}

impl Desk {
    /// The arrangement of a stage.
    pub(super) fn tree(&mut self, stage: Stage) -> &mut Tree<Pane> {
        self.trees.entry(stage).or_insert_with(|| arrangement(stage))
    }

    /// Back to the arrangement that the program starts with.
    pub fn reset(&mut self, stage: Stage) {
        self.trees.remove(&stage);
    }

    /// Panes of a stage and whether each is open.
    pub fn panes(&self, stage: Stage) -> Vec<(Pane, bool)> {
        let initial;
        let tiles = if let Some(tree) = self.trees.get(&stage) {
            &tree.tiles
        } else {
            initial = arrangement(stage);
            &initial.tiles
        };
        let mut panes: Vec<(Pane, bool)> = tiles
            .iter()
            .filter_map(|(id, tile)| match tile {
                Tile::Pane(pane) => Some((*pane, tiles.is_visible(*id))),
                Tile::Container(_) => None,
            })
            .collect();
        panes.sort_unstable();
        panes
    }

    /// Where a pane was drawn last; `None` where it is closed or behind another.
    pub fn rect(&self, stage: Stage, pane: Pane) -> Option<Rect> {
        let tiles = &self.trees.get(&stage)?.tiles;
        let parent = tiles.parent_of(tiles.find_pane(&pane)?)?;
        tiles.rect(tiles.find_pane(&pane)?).and(tiles.rect(parent))
    }

    /// Opens or closes a pane; one that is opened comes to the front of its tabs.
    pub fn set_open(&mut self, stage: Stage, pane: Pane, open: bool) {
        let tree = self.tree(stage);
        let Some(tile) = tree.tiles.find_pane(&pane) else { return };
        tree.set_visible(tile, open);
        if open {
            tree.make_active(|id, _| id == tile);
        }
    }
}
