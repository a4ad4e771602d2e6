//! A structure given by its mass and stiffness matrices, with an optional map of their rows to nodes and directions.

use super::assemble::{MOST_DOFS, Parts};
use super::error::{StructureError, nearest};
use super::geometry::{Direction, Dof, Node};
use super::lumped_mass::LumpedMass;
use super::matrices::SystemMatrices;
use super::system::{Structure, StructureKind};
use faer::Mat;

/// One row of the table of DOFs.
#[derive(Debug, Clone, PartialEq)]
pub struct ImportedDof {
    /// Label of the DOF.
    pub label: String,
    /// Label of its node.
    pub node: String,
    /// Direction of positive displacement.
    pub direction: Direction,
}

/// Matrices and tables as they were read.
#[derive(Debug, Clone, PartialEq)]
pub struct ImportedParameters {
    /// Mass, n x n.
    pub mass: Mat<f64>,
    /// Stiffness, n x n.
    pub stiffness: Mat<f64>,
    /// Positions of the nodes; without them nodes stand in a row, 1 m apart.
    pub nodes: Option<Vec<Node>>,
    /// One entry a matrix row; without them rows are labelled 1..n, each a node of its own, moving in z.
    pub dofs: Option<Vec<ImportedDof>>,
    /// Pairs of node labels joined by a line.
    pub lines: Vec<[String; 2]>,
}

impl ImportedParameters {
    /// Checks matrices and tables against each other and adds the lumped masses.
    ///
    /// # Errors
    /// [`StructureError`] for matrices that are not square, symmetric, of one size, finite, or whose mass is not positive
    /// definite; for tables of the wrong length, duplicate labels and unknown nodes.
    pub fn build(&self, lumped: &[LumpedMass]) -> Result<Structure, StructureError> {
        let n = self.check_sizes()?;
        let nodes = self.named_nodes(n);
        let find = |label: &str| {
            nodes.iter().position(|node| node.label == label).ok_or_else(|| StructureError::UnknownNode {
                label: label.to_string(),
                near: nearest(label, nodes.iter().map(|node| node.label.as_str())),
            })
        };
        let dofs = match &self.dofs {
            Some(rows) => rows
                .iter()
                .map(|row| Ok(Dof { label: row.label.clone(), node: find(&row.node)?, direction: row.direction }))
                .collect::<Result<Vec<Dof>, StructureError>>()?,
            None => (0..n).map(|i| Dof { label: (i + 1).to_string(), node: i, direction: Direction::Z }).collect(),
        };
        let lines = self
            .lines
            .iter()
            .map(|[first, second]| Ok([find(first)?, find(second)?]))
            .collect::<Result<Vec<[usize; 2]>, StructureError>>()?;
        let matrices = Some(SystemMatrices { mass: self.mass.clone(), stiffness: self.stiffness.clone() });
        Parts { kind: StructureKind::Matrices, dofs, nodes, lines, matrices, elements: Vec::new() }.finish(lumped)
    }

    fn check_sizes(&self) -> Result<usize, StructureError> {
        let n = self.mass.nrows();
        if self.mass.ncols() != n || self.stiffness.shape() != (n, n) {
            return Err(StructureError::Sizes {
                mass_rows: n,
                mass_columns: self.mass.ncols(),
                stiffness_rows: self.stiffness.nrows(),
                stiffness_columns: self.stiffness.ncols(),
            });
        }
        if n > MOST_DOFS {
            return Err(StructureError::TooLarge { degrees: n, limit: MOST_DOFS });
        }
        if let Some(dofs) = &self.dofs
            && dofs.len() != n
        {
            return Err(StructureError::Count {
                what: "the table of DOFs",
                found: dofs.len(),
                expected: n,
                hint: " (one a matrix row)",
            });
        }
        // Without a table of DOFs, row i belongs to node i.
        if let (None, Some(nodes)) = (&self.dofs, &self.nodes)
            && nodes.len() < n
        {
            return Err(StructureError::Count {
                what: "the table of nodes",
                found: nodes.len(),
                expected: n,
                hint: " (one a matrix row, as there is no table of DOFs)",
            });
        }
        Ok(n)
    }

    /// The nodes given, or those the DOFs mention, in a row.
    fn named_nodes(&self, n: usize) -> Vec<Node> {
        if let Some(nodes) = &self.nodes {
            return nodes.clone();
        }
        let mut labels: Vec<String> = Vec::new();
        match &self.dofs {
            Some(dofs) => {
                for dof in dofs {
                    if !labels.contains(&dof.node) {
                        labels.push(dof.node.clone());
                    }
                }
            }
            None => labels.extend((1..=n).map(|i| i.to_string())),
        }
        labels.into_iter().enumerate().map(|(i, label)| Node { label, position: [i as f64, 0.0, 0.0] }).collect()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use faer::mat;

    fn plain() -> ImportedParameters {
        ImportedParameters {
            mass: mat![[1.0, 0.0], [0.0, 2.0]],
            stiffness: mat![[3.0, -1.0], [-1.0, 1.0]],
            nodes: None,
            dofs: None,
            lines: vec![["1".into(), "2".into()]],
        }
    }

    #[test]
    fn plain_matrices_are_numbered() {
        let structure = plain().build(&[]).unwrap();
        assert_eq!(structure.label(1), "2");
        assert_eq!(structure.neighbours(), [[0, 1]]);
    }

    #[test]
    fn lines_join_equal_directions_only() {
        let dof =
            |label: &str, node: &str, direction| ImportedDof { label: label.into(), node: node.into(), direction };
        let parameters = ImportedParameters {
            mass: Mat::identity(4, 4),
            stiffness: Mat::identity(4, 4),
            nodes: None,
            dofs: Some(vec![
                dof("a.z", "a", Direction::Z),
                dof("a.x", "a", Direction::X),
                dof("b.x", "b", Direction::X),
                dof("b.ry", "b", Direction::Ry),
            ]),
            lines: vec![["b".into(), "a".into()]],
        };
        assert_eq!(parameters.build(&[]).unwrap().neighbours(), [[1, 2]]);
    }

    #[test]
    fn errors_say_what_is_wrong() {
        let asymmetric = ImportedParameters { stiffness: mat![[3.0, -1.0], [-1.5, 1.0]], ..plain() };
        let message = asymmetric.build(&[]).unwrap_err().to_string();
        assert!(message.starts_with("the stiffness matrix is not symmetric: row 1, column 2 is -1e0"), "{message}");
        let massless = ImportedParameters { mass: mat![[1.0, 0.0], [0.0, 0.0]], ..plain() };
        assert_eq!(massless.build(&[]), Err(StructureError::MassNotPositive { least: 0.0, dof: "2".into() }));
        let sizes = ImportedParameters { mass: Mat::identity(3, 3), ..plain() };
        assert!(sizes.build(&[]).unwrap_err().to_string().contains("3 x 3 and the stiffness matrix 2 x 2"));
        let nan = ImportedParameters { mass: mat![[f64::NAN, 0.0], [0.0, 0.0]], ..plain() };
        assert!(matches!(nan.build(&[]), Err(StructureError::NotFinite { matrix: "mass", row: 1, column: 1, .. })));
        let line = ImportedParameters { lines: vec![["1".into(), "7".into()]], ..plain() };
        assert_eq!(line.build(&[]).unwrap_err().to_string(), "there is no node \"7\"; labels near it: 2, 1");
    }
}
