//! Degrees of freedom in directions of their own, turned to x, y and z of the basic system.
//!
//! ```text
//! u_own = T u,    K' = T^T K T        T: rows the own directions in basic axes, one block a node and kind of motion
//! ```
//!
//! Displacements and rotations of a node turn alike. Where a matrix has only some of the three components of a node, they can be
//! turned if they span the same space as some of x, y and z; else the matrix is refused.

use crate::error::{FileError, Place, Problem};
use crate::{Matrix, NodeDof};
use std::collections::HashMap;

/// What of a direction may lie outside of the space that the components of a matrix span: rounding of positions in files of
/// eight characters, squared.
const OUTSIDE: f64 = 1e-9;

/// A node whose displacements are in directions of their own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turned {
    /// Node number.
    pub node: i64,
    /// Number of the coordinate system of its displacements.
    pub system: i64,
    /// Directions of components 1, 2 and 3 as unit vectors in the basic system.
    pub axes: [[f64; 3]; 3],
}

impl Matrix {
    /// The matrix with the degrees of freedom of `turned` nodes in basic directions.
    ///
    /// # Errors
    /// [`Problem::Turned`] where the rows of a node cannot be turned.
    pub fn in_basic(self, file: &str, turned: &[Turned]) -> Result<Self, FileError> {
        let Some(dofs) = &self.dofs else { return Ok(self) };
        let (parts, named) = rows(dofs, file, turned)?;
        if parts.is_empty() {
            return Ok(self);
        }
        let mut given = Vec::with_capacity(self.entries.len());
        for &(i, j, value) in &self.entries {
            let own = |row: usize| parts.get(&row).cloned().unwrap_or_else(|| vec![(row, 1.0)]);
            if !parts.contains_key(&i) && !parts.contains_key(&j) {
                given.push((i, j, value));
                continue;
            }
            for &(row, a) in &own(i) {
                for &(column, b) in &own(j) {
                    // Entries are those of the lower triangle: the mirrored one turns into the mirrored place.
                    if i == j && row < column {
                        continue;
                    }
                    let twice = if i != j && row == column { 2.0 } else { 1.0 };
                    given.push((row.max(column), row.min(column), twice * a * b * value));
                }
            }
        }
        Self::new(file, &self.name, self.size, Some(named), given)
    }
}

/// Places and factors of a row in basic directions.
type Parts = Vec<(usize, f64)>;

/// The parts of each row that is turned, and the new names of all rows.
fn rows(dofs: &[NodeDof], file: &str, turned: &[Turned]) -> Result<(HashMap<usize, Parts>, Vec<NodeDof>), FileError> {
    let place: HashMap<NodeDof, usize> = dofs.iter().enumerate().map(|(row, &dof)| (dof, row)).collect();
    let (mut parts, mut named) = (HashMap::new(), dofs.to_vec());
    for node in turned.iter().filter(|node| (1..=6).any(|c| place.contains_key(&dof(node.node, c)))) {
        let id = node.node;
        for offset in [0_u8, 3] {
            let own: Vec<(usize, usize)> =
                (0..3_u8).filter_map(|c| Some((usize::from(c), *place.get(&dof(id, offset + c + 1))?))).collect();
            let basic = spanned(&own, &node.axes).ok_or_else(|| {
                let components = own.iter().map(|(c, _)| (offset as usize + c + 1).to_string()).collect();
                FileError::new(file, Place::File, Problem::Turned { node: id, system: node.system, components })
            })?;
            for (&(_, row), &k) in own.iter().zip(&basic) {
                named[row] = dof(id, offset + k as u8 + 1);
            }
            for &(c, row) in &own {
                let factors = own.iter().zip(&basic).map(|(&(_, to), &k)| (to, node.axes[c][k]));
                parts.insert(row, factors.filter(|(_, factor)| *factor != 0.0).collect::<Vec<_>>());
            }
        }
    }
    Ok((parts, named))
}

fn dof(node: i64, component: u8) -> NodeDof {
    NodeDof { node, component }
}

/// Which of x, y and z the directions of the components `own` span; as many as there are components, or none.
fn spanned(own: &[(usize, usize)], axes: &[[f64; 3]; 3]) -> Option<Vec<usize>> {
    let within = |k: usize| own.iter().map(|&(c, _)| axes[c][k] * axes[c][k]).sum::<f64>();
    let basic: Vec<usize> = (0..3).filter(|&k| within(k) > 0.5).collect();
    (basic.len() == own.len() && basic.iter().all(|&k| within(k) > 1.0 - OUTSIDE)).then_some(basic)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::nastran::read;

    /// Stiffness of a bar from the origin to a node, `k e e^T` at the node in basic axes, with a spring of `g` to the ground.
    fn bar(k: f64, g: f64, e: [f64; 3]) -> [[f64; 3]; 3] {
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| k * e[i] * e[j] + if i == j { g } else { 0.0 }))
    }

    /// The deck of one node whose stiffness is stated in directions `own`, given by hand for each system.
    fn deck(systems: &str, grid: &str, own: [[f64; 3]; 3], basic: [[f64; 3]; 3]) -> String {
        let mut text = format!("{systems}{grid}DMIG,KAAX,0,6,2,0\n");
        for c in 0..3 {
            for r in c..3 {
                let value: f64 = (0..3).flat_map(|i| (0..3).map(move |j| own[r][i] * basic[i][j] * own[c][j])).sum();
                text.push_str(&format!("DMIG*,KAAX,1,{},,+\n*+,1,{},{value:.16E}\n", c + 1, r + 1));
            }
        }
        text
    }

    /// One node at (3, 4, 5) with the same stiffness, stated in the directions of every kind of system: all come back to it. The
    /// directions are worked out by hand, not by the reader.
    #[test]
    fn directions_of_every_kind_of_system() {
        let (r, h) = (5.0_f64, 0.5_f64.sqrt());
        let truth = bar(1000.0, 7.0, [0.36, 0.48, 0.8]);
        let grids = "GRID,10,,0.,0.,0.\nGRID,11,,0.,0.,2.\nGRID,12,,1.,0.,0.\n";
        let (sin, cos) = 30_f64.to_radians().sin_cos();
        let rectangular = [[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]];
        let cylinder = [[3.0 / r, 4.0 / r, 0.0], [-4.0 / r, 3.0 / r, 0.0], [0.0, 0.0, 1.0]];
        // Distance 5 sqrt(2) from the origin, 45 degrees from z.
        let sphere = [[0.6 * h, 0.8 * h, h], [0.6 * h, 0.8 * h, -h], [-0.8, 0.6, 0.0]];
        let cases = [
            (format!("CORD2R,7,,0.,0.,0.,0.,0.,1.\n,{cos:.14},{sin:.14},0.\n"), rectangular),
            ("CORD2C,7,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n".to_owned(), cylinder),
            ("CORD2S,7,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n".to_owned(), sphere),
            (format!("CORD1C,7,10,11,12\n{grids}"), cylinder),
            // Its z is that of the basic x: the axes of a system by grid points, the second on its card.
            (format!("CORD1R,5,10,11,12,7,10,12,11\n{grids}"), [[0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]]),
        ];
        for (systems, own) in cases {
            let text = deck(&systems, "GRID,1,,3.,4.,5.,7\n", own, truth);
            let bulk = read(&text, "m.bdf").unwrap();
            let matrix = bulk.matrices[0].clone().in_basic("m.bdf", &bulk.geometry.turned).unwrap();
            assert_ne!(matrix, bulk.matrices[0], "{systems}");
            for &(i, j, value) in &matrix.entries {
                let [a, b] = [i, j].map(|row| usize::from(matrix.dofs.as_ref().unwrap()[row].component) - 1);
                assert!((value - truth[a][b]).abs() < 1e-9, "{systems}: {a} {b} {value} {}", truth[a][b]);
            }
            assert_eq!(matrix.entries.len(), 6);
        }
    }

    /// A node on the axis of its cylinder moves in the directions of the system; what lies in the plane of a turn stays without the rest.
    #[test]
    fn some_components_are_turned_where_that_is_possible() {
        let system = "CORD2C,7,,0.,0.,0.,0.,0.,1.\n,0.,1.,0.\n";
        let read_deck = |grid: &str, rows: &str| {
            let bulk = read(&format!("{system}{grid}DMIG,KAAX,0,6,2,0\n{rows}"), "m.bdf").unwrap();
            bulk.matrices[0].clone().in_basic("m.bdf", &bulk.geometry.turned)
        };
        // Radial on the axis is the direction of the angle 0, here y.
        let along = read_deck("GRID,1,,0.,0.,3.,7\n", "DMIG,KAAX,1,1,,1,1,5.\n").unwrap();
        assert_eq!((along.dofs.unwrap()[0], along.entries), (NodeDof { node: 1, component: 2 }, vec![(0, 0, 5.0)]));
        let z = read_deck("GRID,1,,3.,4.,5.,7\n", "DMIG,KAAX,1,3,,1,3,5.\n").unwrap();
        assert_eq!(z.dofs.unwrap()[0], NodeDof { node: 1, component: 3 });
        let refused = read_deck("GRID,1,,3.,4.,5.,7\n", "DMIG,KAAX,1,1,,1,1,5.\n").unwrap_err().to_string();
        assert!(
            refused.starts_with(
                "m.bdf: grid point 1 moves in coordinate system 7, and its components 1 alone cannot be turned"
            ),
            "{refused}"
        );
        // Rotations turn as displacements do, and a node between is left as it is.
        let turned = read_deck("GRID,1,,0.,2.,5.,7\nGRID,2,,1.,1.,1.\n", "DMIG,KAAX,1,4,,2,1,5.\n").unwrap();
        assert_eq!(turned.dofs.unwrap(), [NodeDof { node: 1, component: 5 }, NodeDof { node: 2, component: 1 }]);
        assert_eq!(turned.entries.len(), 1);
    }
}
