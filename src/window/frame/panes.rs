//! What can be shown side by side, and how each stage arranges it at first.

use crate::window::app::view::Stage;
use egui_tiles::{Container, Linear, LinearDir, TileId, Tiles, Tree};
use serde::{Deserialize, Serialize};

/// A pane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the titles below say what each shows")]
pub enum Pane {
    Schematic,
    Inspector,
    Runs,
    Record,
    Spectrum,
    Parameters,
    Modes,
    Frequencies,
    ModeShape,
    Expansion,
    Laws,
    Sources,
    Steps,
    Set,
    Angle,
    RunEnergy,
    Matrix,
    Energy,
    Damping,
    Bode,
    Nyquist,
    Hysteresis,
    Values,
    Methods,
    Incompleteness,
    ErrorMap,
    Cell,
    Missing,
    Ledger,
    Corrections,
    Overview,
    Change,
}

impl Pane {
    /// All panes.
    pub const ALL: [Self; 32] = [
        Self::Schematic,
        Self::Inspector,
        Self::Runs,
        Self::Record,
        Self::Spectrum,
        Self::Parameters,
        Self::Modes,
        Self::Frequencies,
        Self::ModeShape,
        Self::Expansion,
        Self::Laws,
        Self::Sources,
        Self::Steps,
        Self::Set,
        Self::Angle,
        Self::RunEnergy,
        Self::Matrix,
        Self::Energy,
        Self::Damping,
        Self::Bode,
        Self::Nyquist,
        Self::Hysteresis,
        Self::Values,
        Self::Methods,
        Self::Incompleteness,
        Self::ErrorMap,
        Self::Cell,
        Self::Missing,
        Self::Ledger,
        Self::Corrections,
        Self::Overview,
        Self::Change,
    ];

    /// Title on its tab.
    pub fn title(self) -> &'static str {
        match self {
            Self::Schematic => "Schematic",
            Self::Inspector => "Inspector",
            Self::Runs => "Runs",
            Self::Record => "Record",
            Self::Spectrum => "Spectrum",
            Self::Parameters => "Parameters",
            Self::Modes => "Modes",
            Self::Frequencies => "Frequencies",
            Self::ModeShape => "Mode shape",
            Self::Expansion => "Expansion",
            Self::Laws => "Laws",
            Self::Sources => "Sources",
            Self::Steps => "Steps",
            Self::Set => "Set and alternatives",
            Self::Angle => "Angle",
            Self::RunEnergy => "Energy per run",
            Self::Matrix => "Damping matrix",
            Self::Energy => "Energy",
            Self::Damping => "Damping",
            Self::Bode => "Bode",
            Self::Nyquist => "Nyquist",
            Self::Hysteresis => "Hysteresis",
            Self::Values => "Values",
            Self::Methods => "Methods",
            Self::Incompleteness => "Incompleteness",
            Self::ErrorMap => "Error map",
            Self::Cell => "Measured and modelled",
            Self::Missing => "What is missing?",
            Self::Ledger => "Ledger",
            Self::Corrections => "Corrections",
            Self::Overview => "Overview",
            Self::Change => "Change",
        }
    }

    /// The pane of that title, in any case, with or without spaces.
    ///
    /// # Errors
    /// One line with the names there are.
    pub fn from_name(name: &str) -> Result<Self, String> {
        let plain = |text: &str| text.to_lowercase().replace([' ', '-'], "");
        let names = Self::ALL.map(|p| p.title().to_lowercase().replace(' ', "-")).join(", ");
        Self::ALL
            .into_iter()
            .find(|p| plain(p.title()) == plain(name))
            .ok_or_else(|| format!("--pane {name}: there is no such pane; choose {names}"))
    }
}

/// Groups of panes side by side, each a row of tabs with its share of the width.
type Groups = &'static [(&'static [Pane], f32)];

fn work(stage: Stage) -> Groups {
    match stage {
        Stage::Measure => &[(&[Pane::Runs], 0.40), (&[Pane::Record, Pane::Overview], 0.35), (&[Pane::Spectrum], 0.25)],
        Stage::Structure => {
            &[(&[Pane::Modes, Pane::Parameters, Pane::Expansion], 0.44), (&[Pane::Frequencies, Pane::ModeShape], 0.56)]
        }
        Stage::Pattern => &[(&[Pane::Laws], 0.48), (&[Pane::Sources], 0.52)],
        Stage::Select => &[(&[Pane::Steps], 0.46), (&[Pane::Set], 0.30), (&[Pane::Angle, Pane::RunEnergy], 0.24)],
        Stage::Result => &[
            (&[Pane::Matrix, Pane::Values], 0.42),
            (
                &[
                    Pane::Energy,
                    Pane::Damping,
                    Pane::Bode,
                    Pane::Nyquist,
                    Pane::Hysteresis,
                    Pane::Methods,
                    Pane::Incompleteness,
                    Pane::Change,
                ],
                0.58,
            ),
        ],
        // Arranged on its own below: the map and the cards need the height.
        Stage::Explain => &[],
    }
}

/// The arrangement that a stage starts with: schematic over the panes of the stage, inspector at the right.
pub fn arrangement(stage: Stage) -> Tree<Pane> {
    if stage == Stage::Explain {
        return explain();
    }
    let mut tiles = Tiles::default();
    let groups: Vec<(TileId, f32)> =
        work(stage).iter().map(|(panes, share)| (tabs(&mut tiles, panes), *share)).collect();
    let row = shared(&mut tiles, LinearDir::Horizontal, &groups);
    let schematic = tabs(&mut tiles, &[Pane::Schematic]);
    let left =
        tiles.insert_container(Container::Linear(Linear::new_binary(LinearDir::Vertical, [schematic, row], 0.45)));
    let inspector = tabs(&mut tiles, &[Pane::Inspector]);
    let whole = Linear::new_binary(LinearDir::Horizontal, [left, inspector], 0.79);
    let root = tiles.insert_container(Container::Linear(whole));
    Tree::new(egui::Id::unique(("panes of", stage)), root, tiles)
}

/// Schematic, error map and its cell above each other; the suggestions in full height; ledger and inspector at the right.
fn explain() -> Tree<Pane> {
    let mut tiles = Tiles::default();
    let rows = [(Pane::Schematic, 0.27), (Pane::ErrorMap, 0.30), (Pane::Cell, 0.43)];
    let rows = rows.map(|(pane, share)| (tabs(&mut tiles, &[pane]), share));
    let left = shared(&mut tiles, LinearDir::Vertical, &rows);
    let columns = [
        (left, 0.43),
        (tabs(&mut tiles, &[Pane::Missing, Pane::Corrections]), 0.35),
        (tabs(&mut tiles, &[Pane::Ledger, Pane::Inspector]), 0.22),
    ];
    let root = shared(&mut tiles, LinearDir::Horizontal, &columns);
    Tree::new(egui::Id::unique(("panes of", Stage::Explain)), root, tiles)
}

/// Tiles side by side or above each other, each with its share.
fn shared(tiles: &mut Tiles<Pane>, direction: LinearDir, parts: &[(TileId, f32)]) -> TileId {
    let mut line = Linear::new(direction, parts.iter().map(|p| p.0).collect());
    for &(tile, share) in parts {
        line.shares.set_share(tile, share);
    }
    tiles.insert_container(Container::Linear(line))
}

fn tabs(tiles: &mut Tiles<Pane>, panes: &[Pane]) -> TileId {
    let children = panes.iter().map(|&pane| tiles.insert_pane(pane)).collect();
    tiles.insert_tab_tile(children)
}

#[cfg(test)]
mod tests {
    use super::{Pane, arrangement};
    use crate::window::app::view::Stage;

    #[test]
    fn every_stage_shows_the_schematic_and_the_inspector_and_every_pane_is_somewhere() {
        let mut seen = std::collections::BTreeSet::new();
        for stage in Stage::ALL {
            let tree = arrangement(stage);
            for pane in [Pane::Schematic, Pane::Inspector] {
                assert!(tree.tiles.find_pane(&pane).is_some(), "{stage:?}");
            }
            seen.extend(Pane::ALL.into_iter().filter(|p| tree.tiles.find_pane(p).is_some()));
        }
        assert_eq!(seen.len(), Pane::ALL.len());
    }

    #[test]
    fn panes_are_found_by_their_titles() {
        assert_eq!(Pane::from_name("mode-shape"), Ok(Pane::ModeShape));
        assert_eq!(Pane::from_name("Bode"), Ok(Pane::Bode));
        assert!(Pane::from_name("waterfall").is_err_and(|e| e.contains("hysteresis")));
    }
}
