//! What is looked at: stage, selection, shape. Neither saved with the project nor undone.

use crate::classical::method::Method;
use crate::effects::Effect;
use crate::response::frequency_response::ResponseForm;
use crate::session::states::Against;
use crate::window::schematic::view::ViewState;
use crate::window::stages::explain::look::Look;
use crate::window::stages::incompleteness::choice::Choice;
use crate::window::stages::run_table::Order;
use serde::{Deserialize, Serialize};

/// A stage of the work.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default, Hash, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Stage {
    #[default]
    Measure,
    Structure,
    Pattern,
    Select,
    Result,
    Explain,
}

impl Stage {
    /// All stages, in the order of the work.
    pub const ALL: [Self; 6] =
        [Self::Measure, Self::Structure, Self::Pattern, Self::Select, Self::Result, Self::Explain];

    /// Name on its tab.
    pub fn label(self) -> &'static str {
        match self {
            Self::Measure => "Measure",
            Self::Structure => "Structure",
            Self::Pattern => "Pattern",
            Self::Select => "Select",
            Self::Result => "Result",
            Self::Explain => "Explain",
        }
    }

    /// The stage of that name, in any case.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|s| s.label().eq_ignore_ascii_case(name))
    }
}

/// What is looked at.
#[derive(Debug, Clone)]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of its own on the screen")]
pub struct View {
    /// Stage that is open.
    pub stage: Stage,
    /// Selected run.
    pub run: usize,
    /// Order and filter of the table of runs.
    pub runs: Order,
    /// Selected channel of the run.
    pub channel: usize,
    /// Whether the records of all channels are shown under each other.
    pub every_channel: bool,
    /// Selected mode.
    pub mode: usize,
    /// Step of the selection that is looked at; `None` is the accepted one.
    pub step: Option<usize>,
    /// Whether the matrix shows DOFs without damping too.
    pub whole_matrix: bool,
    /// Whether the matrix is shown as bars in space.
    pub matrix_in_space: bool,
    /// What is divided by the force in frequency responses.
    pub quantity: ResponseForm,
    /// Classical method whose matrix is shown; `None` is the first that gives one.
    pub method: Option<Method>,
    /// Of the study of incompleteness.
    pub incompleteness: Choice,
    /// Earlier state that the project is held against.
    pub against: Option<Against>,
    /// Selected DOF.
    pub dof: Option<usize>,
    /// Selected source, index in the project.
    pub source: Option<usize>,
    /// Law that is drawn.
    pub law: Effect,
    /// Whether the schematic is deflected.
    pub shape: bool,
    /// Whether it moves.
    pub animate: bool,
    /// Whether the keyboard moved the focus last.
    pub by_keyboard: bool,
    /// Whether transitions are left out; it is kept from project to project.
    pub less_motion: bool,
    /// Phase of the motion, rad.
    pub phase: f64,
    /// Of the schematic.
    pub schematic: ViewState,
    /// Whether the list of keys is open.
    pub keys: bool,
    /// Whether the list of messages is open.
    pub messages: bool,
    /// Whether it is said what the program is.
    pub about: bool,
    /// Step of the tour.
    pub tour: Option<usize>,
    /// Step of the tour whose stage and pane have been opened.
    pub tour_shown: Option<usize>,
    /// Of the stage Explain.
    pub explain: Look,
    /// Time after which a search for what is missing answers with the best so far, s; it is kept from project to project.
    pub limit_s: Option<f64>,
}

impl Default for View {
    fn default() -> Self {
        Self {
            stage: Stage::Measure,
            run: 0,
            runs: Order::default(),
            channel: 0,
            every_channel: false,
            mode: 0,
            step: None,
            whole_matrix: false,
            matrix_in_space: false,
            quantity: ResponseForm::Receptance,
            method: None,
            incompleteness: Choice::default(),
            against: None,
            dof: None,
            source: None,
            law: Effect::DASHPOT,
            shape: true,
            animate: false,
            by_keyboard: false,
            less_motion: false,
            phase: 0.0,
            schematic: ViewState::default(),
            keys: false,
            messages: false,
            about: false,
            tour: None,
            tour_shown: None,
            explain: Look::default(),
            limit_s: None,
        }
    }
}
