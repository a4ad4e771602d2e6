//! What is looked at in the stage: order of the map, plot of the cell, card that is open, effect on trial.

use crate::diagnosis::Comparison;
use crate::effects::Source;
use crate::plots::error_map::Grid;
use std::sync::Arc;

/// A plot of the selected cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Tab {
    #[default]
    Frequency,
    Level,
    Time,
    Loop,
}

impl Tab {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Frequency, Self::Level, Self::Time, Self::Loop];

    /// Name on its tab.
    pub fn label(self) -> &'static str {
        match self {
            Self::Frequency => "Frequency",
            Self::Level => "Level",
            Self::Time => "Time",
            Self::Loop => "Loop",
        }
    }

    /// What it shows, in one sentence.
    pub fn tooltip(self) -> &'static str {
        match self {
            Self::Frequency => "Amplitude and phase along frequency near the selected run, with the model's curve.",
            Self::Level => "Amplitude and phase along the force level at the frequency of the selected run.",
            Self::Time => "One period, measured and modelled, and what is left over.",
            Self::Loop => "Force of the exciter over displacement, measured and modelled.",
        }
    }
}

/// A plot of a record that is not steady.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[expect(missing_docs, reason = "the names say it")]
pub enum RecordTab {
    #[default]
    Time,
    Spectrum,
    Spectrogram,
    Amplitude,
}

impl RecordTab {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Time, Self::Spectrum, Self::Spectrogram, Self::Amplitude];

    /// Name on its tab.
    pub fn label(self) -> &'static str {
        match self {
            Self::Time => "Time",
            Self::Spectrum => "Spectrum",
            Self::Spectrogram => "Spectrogram",
            Self::Amplitude => "Amplitude",
        }
    }

    /// What it shows, in one sentence.
    pub fn tooltip(self) -> &'static str {
        match self {
            Self::Time => "The record, measured and modelled, and what is left over below.",
            Self::Spectrum => "Amplitude spectra of the measured record, of the model's and of what is left over.",
            Self::Spectrogram => "What is left over, over time and frequency.",
            Self::Amplitude => "Damping ratio and frequency of a mode over its amplitude, measured and modelled.",
        }
    }

    /// The plot of that name, in any case.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|tab| tab.label().eq_ignore_ascii_case(name))
    }
}

/// State of the stage; neither saved nor undone.
#[derive(Debug, Clone)]
#[expect(clippy::struct_excessive_bools, reason = "each is a choice of the user that stands on its own")]
pub struct Look {
    /// Whether runs and channels stand in order of their error.
    pub worst_first: bool,
    /// Plot of the selected cell.
    pub tab: Tab,
    /// Plot of the selected record that is not steady.
    pub record_tab: RecordTab,
    /// Which of the modes that stand out of the selected record is shown over its amplitude, from 0.
    pub mode: usize,
    /// Whether the order of the map and the plots of the cell are chosen in the bars of their panes, which have room for it.
    pub in_bar: [bool; 2],
    /// Channel of the selected record that is not steady.
    pub record: Option<String>,
    /// Suggestion whose card is open; `None` opens the first.
    pub open: Option<Source>,
    /// Effect on trial.
    pub trial: Option<Source>,
    /// Whether the worst cell was chosen already; afterwards the user chooses.
    pub chosen: bool,
    /// Whether to search though the model is far from the data.
    pub anyway: bool,
    /// Whether corrections and scatter were shown in the last frame.
    pub scatter_shown: bool,
    /// Whether they are computed.
    pub scatter: bool,
    /// The map that was drawn last.
    pub(super) map: Option<DrawnMap>,
}

/// An error map with what it was made of, kept from frame to frame: of many runs it takes longer to make than to draw.
#[derive(Debug, Clone)]
pub(super) struct DrawnMap {
    comparison: Arc<Comparison>,
    worst_first: bool,
    grid: Arc<Grid>,
}

impl Look {
    /// The map of a comparison in the order that is chosen.
    pub(super) fn grid(&mut self, comparison: &Arc<Comparison>) -> Arc<Grid> {
        let same = |m: &&DrawnMap| Arc::ptr_eq(&m.comparison, comparison) && m.worst_first == self.worst_first;
        if let Some(kept) = self.map.as_ref().filter(same) {
            return Arc::clone(&kept.grid);
        }
        let grid = Arc::new(Grid::new(comparison, self.worst_first));
        let (comparison, worst_first) = (Arc::clone(comparison), self.worst_first);
        self.map = Some(DrawnMap { comparison, worst_first, grid: Arc::clone(&grid) });
        grid
    }
}

impl Default for Look {
    fn default() -> Self {
        Self {
            worst_first: true,
            tab: Tab::default(),
            record_tab: RecordTab::default(),
            mode: 0,
            in_bar: [false; 2],
            record: None,
            open: None,
            trial: None,
            chosen: false,
            anyway: false,
            scatter_shown: false,
            scatter: false,
            map: None,
        }
    }
}
