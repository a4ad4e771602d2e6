//! What is drawn of an element: its edges, of solids those of the faces that belong to one element only.

use std::collections::{HashMap, HashSet};

/// Corner nodes of the faces of a hexahedron, a wedge and a tetrahedron.
const HEXAHEDRON: [&[usize]; 6] =
    [&[0, 1, 2, 3], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]];
const WEDGE: [&[usize]; 5] = [&[0, 1, 2], &[3, 4, 5], &[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]];
const TETRAHEDRON: [&[usize]; 4] = [&[0, 1, 2], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]];

/// Shape of an element as far as drawing needs it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shape {
    /// A line through all its nodes.
    Line,
    /// A polygon of that many corners, which come first.
    Polygon(usize),
    Tetrahedron,
    Wedge,
    Hexahedron,
}

/// Collects elements, gives lines.
#[derive(Debug, Default)]
pub(crate) struct Edges {
    lines: Vec<[i64; 2]>,
    seen: HashSet<[i64; 2]>,
    /// Each face of a solid by its sorted corners, with its corners in order; `None` once a second element has it.
    faces: HashMap<Vec<i64>, Option<Vec<i64>>>,
    order: Vec<Vec<i64>>,
}

impl Edges {
    /// Adds an element; too few nodes draw nothing.
    pub(crate) fn add(&mut self, shape: Shape, nodes: &[i64]) {
        let corners = |count: usize| nodes.get(..count);
        match shape {
            Shape::Line => nodes.windows(2).for_each(|pair| self.line(pair[0], pair[1])),
            Shape::Polygon(count) => corners(count).into_iter().for_each(|polygon| self.polygon(polygon)),
            Shape::Tetrahedron => self.solid(corners(4), &TETRAHEDRON),
            Shape::Wedge => self.solid(corners(6), &WEDGE),
            Shape::Hexahedron => self.solid(corners(8), &HEXAHEDRON),
        }
    }

    fn line(&mut self, a: i64, b: i64) {
        if a != b && self.seen.insert([a.min(b), a.max(b)]) {
            self.lines.push([a, b]);
        }
    }

    fn polygon(&mut self, corners: &[i64]) {
        (0..corners.len()).for_each(|i| self.line(corners[i], corners[(i + 1) % corners.len()]));
    }

    fn solid(&mut self, corners: Option<&[i64]>, faces: &[&[usize]]) {
        let Some(corners) = corners else { return };
        for face in faces {
            let own: Vec<i64> = face.iter().map(|&i| corners[i]).collect();
            let mut key = own.clone();
            key.sort_unstable();
            if let Some(known) = self.faces.get_mut(&key) {
                *known = None;
            } else {
                self.order.push(key.clone());
                self.faces.insert(key, Some(own));
            }
        }
    }

    /// All lines, each once.
    pub(crate) fn finish(mut self) -> Vec<[i64; 2]> {
        let faces = std::mem::take(&mut self.faces);
        for key in std::mem::take(&mut self.order) {
            if let Some(Some(corners)) = faces.get(&key) {
                self.polygon(corners);
            }
        }
        self.lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_bricks_show_their_surface_only() {
        let mut edges = Edges::default();
        edges.add(Shape::Hexahedron, &[1, 2, 3, 4, 5, 6, 7, 8]);
        edges.add(Shape::Hexahedron, &[5, 6, 7, 8, 9, 10, 11, 12]);
        assert_eq!(edges.finish().len(), 20);
        let mut row = Edges::default();
        row.add(Shape::Line, &[1, 2, 3]);
        row.add(Shape::Line, &[2, 1]);
        row.add(Shape::Polygon(4), &[1, 2]);
        assert_eq!(row.finish(), [[1, 2], [2, 3]]);
    }
}
