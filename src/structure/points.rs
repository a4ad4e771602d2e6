//! Points without mass and stiffness: what is measured is all there is, and only the energy balance can be used.

use super::assemble::Parts;
use super::error::StructureError;
use super::geometry::{Direction, Dof, Node};
use super::system::{Structure, StructureKind};
use serde::{Deserialize, Serialize};

/// The measured points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PointParameters {
    /// Labels.
    pub dofs: Vec<String>,
    /// Positions in m; without them the points stand in a row, 1 m apart.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub positions: Option<Vec<[f64; 3]>>,
}

impl PointParameters {
    /// Builds a structure without matrices.
    ///
    /// # Errors
    /// [`StructureError`] for no labels, duplicate labels, or positions that are not one a label and finite.
    pub fn build(&self) -> Result<Structure, StructureError> {
        if let Some(positions) = &self.positions {
            self.check_positions(positions)?;
        }
        let position = |i: usize| self.positions.as_ref().map_or([i as f64, 0.0, 0.0], |p| p[i]);
        let named = || self.dofs.iter().enumerate();
        Parts {
            kind: StructureKind::Points,
            dofs: named().map(|(i, l)| Dof { label: l.clone(), node: i, direction: Direction::Z }).collect(),
            nodes: named().map(|(i, l)| Node { label: l.clone(), position: position(i) }).collect(),
            lines: Vec::new(),
            matrices: None,
            elements: Vec::new(),
        }
        .finish(&[])
    }

    fn check_positions(&self, positions: &[[f64; 3]]) -> Result<(), StructureError> {
        if positions.len() != self.dofs.len() {
            return Err(StructureError::Count {
                what: "positions",
                found: positions.len(),
                expected: self.dofs.len(),
                hint: " (one a label in dofs)",
            });
        }
        for (i, position) in positions.iter().enumerate() {
            if let Some(&value) = position.iter().find(|v| !v.is_finite()) {
                let name = format!("a coordinate of point {}", self.dofs[i]);
                return Err(StructureError::NotAPosition { name, value });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn every_pair_is_a_neighbour() {
        let points = PointParameters { dofs: vec!["a".into(), "b".into(), "c".into()], positions: None };
        assert_eq!(points.build().unwrap().neighbours(), [[0, 1], [0, 2], [1, 2]]);
        assert!(points.build().unwrap().matrices().is_none());
    }

    #[test]
    fn labels_must_differ_and_exist() {
        let twice = PointParameters { dofs: vec!["a".into(), "a".into()], positions: None };
        assert_eq!(twice.build(), Err(StructureError::DuplicateDof { label: "a".into() }));
        assert_eq!(PointParameters { dofs: vec![], positions: None }.build(), Err(StructureError::NoDofs));
        let short = PointParameters { dofs: vec!["a".into()], positions: Some(vec![]) };
        assert!(short.build().unwrap_err().to_string().starts_with("positions has 0 values but 1 are needed"));
    }
}
