//! What is under the pointer: a DOF before a source before nothing; among equals the nearest.

use super::layout::{Layout, Part};
use egui::{Pos2, Rect};

/// Something that can be pointed at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// Row of a DOF.
    Dof(usize),
    /// Slot of a source, index into [`super::Scene::sources`].
    Source(usize),
}

/// How far from a handle a click still counts, points.
const DOF_REACH: f32 = 7.0;
/// How far from a symbol a click still counts, points.
const SOURCE_REACH: f32 = 9.0;

/// The nearest target within reach of `at`.
pub(crate) fn at(layout: &Layout, at: Pos2) -> Option<Target> {
    dof(layout, at).map(Target::Dof).or_else(|| source(layout, at).map(Target::Source))
}

/// The nearest DOF within reach.
pub(crate) fn dof(layout: &Layout, at: Pos2) -> Option<usize> {
    let handle = layout
        .handles
        .iter()
        .map(|h| (h.dof, h.pos.distance(at), h.radius + DOF_REACH))
        .filter(|(_, distance, reach)| distance <= reach)
        .min_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(handle.0)
}

fn source(layout: &Layout, at: Pos2) -> Option<usize> {
    let distance = |parts: &[Part]| parts.iter().map(|p| to_segment(at, p.glyph)).fold(f32::INFINITY, f32::min);
    layout
        .sources
        .iter()
        .map(|s| (s.slot, distance(&s.parts)))
        .filter(|(_, d)| *d <= SOURCE_REACH)
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(slot, _)| slot)
}

/// Distance from a point to a segment.
fn to_segment(p: Pos2, [a, b]: [Pos2; 2]) -> f32 {
    let (ab, ap) = (b - a, p - a);
    let t = if ab.length_sq() > 0.0 { (ap.dot(ab) / ab.length_sq()).clamp(0.0, 1.0) } else { 0.0 };
    (ap - ab * t).length()
}

/// Translations whose handles lie in `span`, from left to right; rotations never belong to a span.
pub(crate) fn in_span(layout: &Layout, span: Rect) -> Vec<usize> {
    let mut inside: Vec<_> = layout.handles.iter().filter(|h| !h.rotation && span.contains(h.pos)).collect();
    inside.sort_by(|a, b| a.pos.x.total_cmp(&b.pos.x).then(a.pos.y.total_cmp(&b.pos.y)));
    inside.iter().map(|h| h.dof).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::{Target, at, in_span, to_segment};
    use crate::effects::{Effect, Place, Source};
    use crate::window::schematic::{Camera, Layout, Scene, samples};
    use egui::{Rect, pos2, vec2};

    fn layout() -> Layout {
        let dashpot = Source::candidate(Effect::Viscous, Place::Dofs(vec![2]));
        let scene = Scene::new(&samples::cantilever(4), &[dashpot], &[]);
        Layout::new(&scene, Rect::from_min_size(pos2(0.0, 0.0), vec2(800.0, 320.0)), Camera::default(), None)
    }

    #[test]
    fn a_dof_wins_over_the_source_that_hangs_on_it() {
        let layout = layout();
        let node = layout.handle(2).unwrap().pos;
        assert_eq!(at(&layout, node + vec2(2.0, 3.0)), Some(Target::Dof(2)));
        assert_eq!(at(&layout, node + vec2(3.0, 50.0)), Some(Target::Source(0)));
        assert_eq!(at(&layout, node + vec2(60.0, 50.0)), None);
    }

    #[test]
    fn a_span_takes_translations_only() {
        assert_eq!(in_span(&layout(), Rect::from_min_max(pos2(0.0, 0.0), pos2(500.0, 320.0))), [0, 2]);
    }

    #[test]
    fn distance_to_a_segment_ends_at_its_ends() {
        let s = [pos2(0.0, 0.0), pos2(10.0, 0.0)];
        assert_eq!(to_segment(pos2(5.0, 3.0), s), 3.0);
        assert_eq!(to_segment(pos2(13.0, 4.0), s), 5.0);
        assert_eq!(to_segment(pos2(3.0, 4.0), [pos2(0.0, 0.0); 2]), 5.0);
    }
}
