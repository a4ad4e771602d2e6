//! Gestures turned into intents, without a window: what a click or a finished drag asks for.

use super::hit::{self, Target};
use super::{Layout, Scene};
use crate::window::document::edits::Edit;
use egui::{Pos2, Rect};

/// What the user asked for on the schematic; DOFs are matrix rows, sources are indices in the project.
#[derive(Debug, Clone, PartialEq)]
pub enum Intent {
    /// Look at a DOF.
    SelectDof(usize),
    /// Look at a source.
    SelectSource(usize),
    /// Look at nothing.
    ClearSelection,
    /// Draw a source: one DOF to the ground, two between them, more a chain.
    Draw(Vec<usize>),
    /// Candidate, forced, known, off, candidate.
    CycleSource(usize),
    /// Take a source away.
    RemoveSource(usize),
    /// Another change of the document.
    Edit(Edit),
}

/// A drag in progress.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drag {
    /// DOF it began on; `None` sweeps a span.
    pub from: Option<usize>,
    /// Where it began.
    pub start: Pos2,
    /// Where the pointer is.
    pub now: Pos2,
}

impl Drag {
    /// A drag that begins at `start`.
    pub fn begin(layout: &Layout, start: Pos2) -> Self {
        Self { from: hit::dof(layout, start), start, now: start }
    }

    /// The rectangle swept, for a drag that did not begin on a DOF.
    pub fn span(&self) -> Option<Rect> {
        self.from.is_none().then(|| Rect::from_two_pos(self.start, self.now))
    }

    /// DOFs of the source that would be drawn if the drag ended now.
    pub fn dofs(&self, layout: &Layout) -> Option<Vec<usize>> {
        let dofs = match self.from {
            Some(from) => match hit::dof(layout, self.now) {
                Some(to) if to != from => vec![from, to],
                _ => return None,
            },
            None => hit::in_span(layout, Rect::from_two_pos(self.start, self.now)),
        };
        (dofs.len() >= 2).then_some(dofs)
    }
}

/// What a click asks for. Where the pattern is edited, a click on a DOF draws and a second click on a source cycles its
/// state; elsewhere clicks only select.
pub(crate) fn click(scene: &Scene, target: Option<Target>, selected: Option<Target>, editing: bool) -> Intent {
    match target {
        Some(Target::Dof(dof)) if editing => Intent::Draw(vec![dof]),
        Some(Target::Dof(dof)) => Intent::SelectDof(dof),
        Some(Target::Source(slot)) if editing && selected == target => Intent::CycleSource(scene.sources[slot].index),
        Some(Target::Source(slot)) => Intent::SelectSource(scene.sources[slot].index),
        None => Intent::ClearSelection,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::{Drag, Intent, Target, click};
    use crate::effects::{Effect, Place, Source};
    use crate::window::schematic::{Camera, Layout, Scene, samples};
    use egui::{Rect, pos2, vec2};

    fn scene() -> (Scene, Layout) {
        let spring = Source::candidate(Effect::Viscous, Place::Dofs(vec![0]));
        let scene = Scene::new(&samples::cantilever(4), &[spring], &[]);
        let area = Rect::from_min_size(pos2(0.0, 0.0), vec2(800.0, 320.0));
        let layout = Layout::new(&scene, area, Camera::default(), None);
        (scene, layout)
    }

    #[test]
    fn a_click_draws_only_where_the_pattern_is_edited() {
        let (scene, _) = scene();
        assert_eq!(click(&scene, Some(Target::Dof(4)), None, true), Intent::Draw(vec![4]));
        assert_eq!(click(&scene, Some(Target::Dof(4)), None, false), Intent::SelectDof(4));
        assert_eq!(click(&scene, None, None, true), Intent::ClearSelection);
    }

    #[test]
    fn the_second_click_on_a_source_cycles_it() {
        let (scene, _) = scene();
        let source = Some(Target::Source(0));
        assert_eq!(click(&scene, source, None, true), Intent::SelectSource(0));
        assert_eq!(click(&scene, source, source, true), Intent::CycleSource(0));
        assert_eq!(click(&scene, source, source, false), Intent::SelectSource(0));
    }

    #[test]
    fn a_drag_joins_two_dofs_or_sweeps_a_chain() {
        let (_, layout) = scene();
        let position = |d: usize| layout.handle(d).unwrap().pos;
        let mut drag = Drag::begin(&layout, position(2) + vec2(1.0, 0.0));
        assert_eq!(drag.dofs(&layout), None, "a drag that has not left its DOF draws nothing");
        drag.now = position(6);
        assert_eq!(drag.dofs(&layout), Some(vec![2, 6]));
        let mut sweep = Drag::begin(&layout, position(0) - vec2(40.0, 60.0));
        sweep.now = position(4) + vec2(20.0, 40.0);
        assert_eq!(sweep.dofs(&layout), Some(vec![0, 2, 4]));
        assert!(sweep.span().is_some());
    }
}
