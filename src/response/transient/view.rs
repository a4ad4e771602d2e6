//! What a march through a record shows to the derivatives that go along with it.

use super::hold::Polynomial;
use super::step::Step;
use super::system::Functional;

/// What an element sees, on flat states.
pub(super) struct View {
    pub displacement: Vec<f64>,
    pub velocity: Vec<f64>,
    pub acceleration: Functional,
}

/// A parameter on its way through the steps.
pub(super) struct Sensitivity {
    /// Derivative of the state at the start.
    pub state: Vec<f64>,
    /// Source and number of a parameter of a law.
    pub own: Option<(usize, usize)>,
    /// Whether it changes the linear part.
    pub changes_linear_part: bool,
}

/// Receptances between elements over a step, row by row.
pub(super) struct Receptance {
    pub displacement: Vec<f64>,
    pub velocity: Vec<f64>,
}

/// A piece of a step that is decided.
pub(super) struct Piece<'a> {
    pub step: &'a Step,
    /// Whether it is a step of full length.
    pub full: bool,
    /// Drives from its start on, N.
    pub drives: &'a [Polynomial],
    pub forces: &'a [f64],
    pub side: &'a [f64],
    /// States at both ends.
    pub states: [&'a [f64]; 2],
    /// Displacements of the elements at both ends, m.
    pub before: &'a [f64],
    pub after: &'a [f64],
}

impl Receptance {
    pub(super) fn new(views: &[View], step: &Step) -> Self {
        let count = views.len();
        let table = |functional: &dyn Fn(&View) -> &Vec<f64>| {
            views.iter().flat_map(|view| (0..count).map(|k| step.receptance(k, functional(view)))).collect()
        };
        Self { displacement: table(&|v| &v.displacement), velocity: table(&|v| &v.velocity) }
    }
}
