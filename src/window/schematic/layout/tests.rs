//! Positions of the schematic, checked with numbers.

#![allow(clippy::unwrap_used, reason = "tests")]
use super::{Camera, Layout};
use crate::effects::{Effect, Place, Source};
use crate::window::schematic::{Scene, samples};
use egui::{Rect, pos2, vec2};

const AREA: Rect = Rect { min: pos2(0.0, 0.0), max: pos2(900.0, 360.0) };

fn candidates(places: &[&[usize]]) -> Vec<Source> {
    places.iter().map(|p| Source::candidate(Effect::Viscous, Place::Dofs(p.to_vec()))).collect()
}

fn placed(scene: &Scene) -> Layout {
    Layout::new(scene, AREA, Camera::default(), None)
}

#[test]
fn nodes_of_a_beam_are_equally_spaced_between_the_margins() {
    let layout = placed(&Scene::new(&samples::cantilever(4), &[], &[]));
    let x: Vec<f32> = [0, 2, 4, 6].map(|d| layout.handle(d).unwrap().pos.x).to_vec();
    let step = (900.0 - 54.0 - 40.0) / 4.0;
    for (k, x) in x.iter().enumerate() {
        assert!((x - (54.0 + step * (k + 1) as f32)).abs() < 1e-3, "node {k} at {x}");
    }
    assert!(layout.handle(1).unwrap().pos.y < layout.handle(0).unwrap().pos.y, "rotations stand above translations");
}

#[test]
fn a_bent_beam_passes_through_its_nodes_and_leaves_the_clamp_level() {
    let structure = samples::cantilever(3);
    let shape = structure.modes().unwrap().shape(1);
    let scene = Scene::new(&structure, &[], &[]);
    let layout = Layout::new(&scene, AREA, Camera::default(), Some(&shape));
    let largest = [0, 2, 4].map(|d: usize| shape[d].abs()).into_iter().fold(0.0, f64::max);
    for (k, dof) in [0, 2, 4].into_iter().enumerate() {
        let end = *layout.body[k].last().unwrap();
        assert!((end - layout.handle(dof).unwrap().pos).length() < 1e-3);
        let up = layout.rest[k][1].y - end.y;
        assert!((f64::from(up) - 46.0 * shape[dof] / largest).abs() < 1e-3);
    }
    let clamp = &layout.body[0];
    let slope = (clamp[1].y - clamp[0].y) / (clamp[1].x - clamp[0].x);
    assert!(slope.abs() < 0.2, "slope at the clamp {slope}");
    // The cubic's derivative is continuous at a node: compare the last and first short chords.
    let chord = |a: egui::Pos2, b: egui::Pos2| (b.y - a.y) / (b.x - a.x);
    let (left, right) = (&layout.body[0], &layout.body[1]);
    assert!((chord(left[7], left[8]) - chord(right[0], right[1])).abs() < 0.15);
}

#[test]
fn sources_between_dofs_take_separate_lanes_where_they_overlap() {
    let sources = candidates(&[&[0, 4], &[2, 6], &[0], &[0]]);
    let layout = placed(&Scene::new(&samples::cantilever(4), &sources, &[]));
    let lane = |k: usize| layout.sources[k].parts[0].glyph[0].y;
    assert!((lane(0) - lane(1)).abs() > 20.0);
    let foot = |k: usize| layout.sources[k].parts[0].ground.unwrap().pos;
    assert!(foot(2).x < foot(3).x, "two sources on one DOF stand side by side");
    assert_eq!(foot(2).y, foot(3).y);
}

#[test]
fn a_chain_source_has_one_leg_a_pair() {
    let sources = candidates(&[&[0, 1, 2]]);
    let layout = placed(&Scene::new(&samples::chain(), &sources, &[]));
    assert_eq!(layout.sources[0].parts.len(), 2);
    assert_eq!(layout.springs.len(), 3);
    let wall = layout.springs[0].ground.unwrap();
    assert!(wall.pos.x < layout.masses[0].rect.left(), "the first ground spring ends at the wall on the left");
    for part in &layout.sources[0].parts {
        assert!(part.glyph[0].x < part.glyph[1].x);
    }
}

#[test]
fn everything_stays_inside_the_pane() {
    let sources = candidates(&[&[0], &[2], &[0, 6], &[2, 4], &[1]]);
    let shape: Vec<f64> = (0..8).map(|k| (f64::from(k) * 1.7).sin()).collect();
    let scene = Scene::new(&samples::cantilever(4), &sources, &[]);
    for size in [vec2(500.0, 300.0), vec2(1600.0, 600.0)] {
        let area = Rect::from_min_size(pos2(10.0, 20.0), size);
        let layout = Layout::new(&scene, area, Camera::default(), Some(&shape));
        let points = layout.sources.iter().flat_map(|s| s.parts.iter().flat_map(|p| p.glyph));
        for p in points.chain(layout.handles.iter().map(|h| h.pos)).chain(layout.body.concat()) {
            assert!(area.expand(1.0).contains(p), "{p:?} outside {area:?}");
        }
    }
}

/// The least pane of the window, and one as low as beside the error map on a small screen.
#[test]
fn the_ground_stays_inside_a_low_pane() {
    let sources = candidates(&[&[0], &[2], &[6]]);
    let shape = [0.1, 0.0, 0.3, 0.0, 0.6, 0.0, -1.0, 0.0];
    let mut scene = Scene::new(&samples::cantilever(4), &sources, &[]);
    scene.dofs[6].exciter = true;
    for height in [112.0, 125.0, 150.0] {
        let area = Rect::from_min_size(pos2(10.0, 20.0), vec2(430.0, height));
        let layout = Layout::new(&scene, area, Camera::default(), Some(&shape));
        let feet = layout.sources.iter().filter_map(|s| s.parts[0].ground);
        for foot in feet {
            assert!(foot.pos.y + 8.0 <= area.bottom(), "the hatching under {:?} is cut off by {area:?}", foot.pos);
        }
        for source in &layout.sources {
            let [start, end] = source.parts[0].glyph;
            assert!(end.y - start.y > 10.0, "a symbol of {} points at {height}", end.y - start.y);
        }
    }
}

#[test]
fn a_wire_model_seen_from_above_keeps_its_proportions() {
    let scene = Scene::new(&samples::points(), &[], &[]);
    assert!(Layout::turns(&scene));
    let above = Camera { yaw: 0.0, pitch: std::f32::consts::FRAC_PI_2, zoom: 1.0 };
    let layout = Layout::new(&scene, AREA, above, None);
    let position = |d: usize| layout.handle(d).unwrap().pos;
    let (x, y) = (position(1) - position(0), position(2) - position(0));
    assert!(x.x > 0.0 && x.y.abs() < 1e-3, "x to the right: {x:?}");
    assert!(y.y < 0.0 && y.x.abs() < 1e-3, "y upwards: {y:?}");
    assert!((x.length() - y.length()).abs() < 1e-2);
    assert!((position(3) - position(0)).length() < 1e-2, "z points at the eye");
}
