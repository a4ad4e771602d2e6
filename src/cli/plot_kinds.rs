//! What plots show, and what they need of a project.

use super::arguments::PlotKind;

impl PlotKind {
    /// Whether it shows periodic motion, which records that are not steady do not hold.
    pub(super) fn is_of_runs(self) -> bool {
        use PlotKind::{Channel, Energy, Level, Loop, Nyquist, Overview, Period};
        matches!(self, Channel | Energy | Level | Loop | Nyquist | Overview | Period)
    }

    /// Whether it sets the model beside steady runs: one without its damping yet takes over what is identified, as `compare` does.
    pub(super) fn compares(self) -> bool {
        use PlotKind::{Channel, ErrorMap, Level, Loop, Period, RestoringForce};
        matches!(self, Channel | ErrorMap | Level | Loop | Period | RestoringForce)
    }
}
