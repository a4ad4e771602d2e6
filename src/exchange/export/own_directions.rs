//! Damping in the directions in which the grid points of a model move (field `CD` of `GRID`).
//!
//! ```text
//! u_own = T u,    C_own = T C T^T        T: rows the own directions in basic axes, one block a grid point and kind of motion
//! ```

use super::dashpots::grid_component;
use crate::structure::Structure;
use faer::Mat;
use std::collections::HashMap;

/// What of a direction counts as rounding of the positions of a deck.
const ROUNDING: f64 = 1e-9;

/// Grid point and component, 1 to 6, 0 for a generalised coordinate.
pub(super) type Component = (usize, u8);

/// Own directions of the grid points of a structure that have some.
pub(super) struct OwnDirections<'a> {
    structure: &'a Structure,
    axes: HashMap<&'a str, [[f64; 3]; 3]>,
}

impl<'a> OwnDirections<'a> {
    pub(super) fn of(structure: &'a Structure) -> Self {
        let turned = &structure.origin().turned;
        Self { structure, axes: turned.iter().map(|node| (node.label.as_str(), node.axes)).collect() }
    }

    /// The components along which a degree of freedom moves, each with the cosine between both.
    pub(super) fn parts(&self, row: usize) -> Vec<(Component, f64)> {
        let (grid, component) = grid_component(self.structure, row);
        let label = self.structure.nodes()[self.structure.dofs()[row].node].label.as_str();
        let (Some(axes), 1..) = (self.axes.get(label), component) else {
            return vec![((grid, component), 1.0)];
        };
        let (kind, axis) = ((component - 1) / 3 * 3, usize::from((component - 1) % 3));
        let parts = (1..=3_u8).zip(axes).map(|(own, direction)| ((grid, kind + own), direction[axis]));
        parts.filter(|(_, cosine)| cosine.abs() > ROUNDING).collect()
    }

    /// The degree of freedom in the basic system.
    pub(super) fn basic(&self, row: usize) -> Component {
        grid_component(self.structure, row)
    }

    /// The component that is the degree of freedom, and its sense, where one alone is.
    pub(super) fn alone(&self, row: usize) -> Option<(Component, f64)> {
        match self.parts(row)[..] {
            [(component, cosine)] => Some((component, cosine.signum())),
            _ => None,
        }
    }

    /// The components of all degrees of freedom, and a symmetric matrix of theirs in these components.
    pub(super) fn turned(&self, values: &Mat<f64>) -> (Vec<Component>, Mat<f64>) {
        let mut components: Vec<Component> = Vec::new();
        let mut place: HashMap<Component, usize> = HashMap::new();
        let mut rows = Vec::new();
        for row in 0..values.nrows() {
            let parts = self.parts(row).into_iter().map(|(component, cosine)| {
                let at = *place.entry(component).or_insert(components.len());
                if at == components.len() {
                    components.push(component);
                }
                (at, cosine)
            });
            rows.push(parts.collect::<Vec<_>>());
        }
        let mut own = Mat::zeros(components.len(), components.len());
        for (j, column) in rows.iter().enumerate() {
            for (i, row) in rows.iter().enumerate().filter(|(i, _)| values[(*i, j)] != 0.0) {
                for &(b, second) in column {
                    for &(a, first) in row {
                        own[(a, b)] += first * values[(i, j)] * second;
                    }
                }
            }
        }
        (components, own)
    }
}
