//! Chain of masses: `m_i x_i'' + g_i x_i + k_i (x_i - x_i+1) + k_i-1 (x_i - x_i-1) = f_i` with springs `g` to the ground
//! and `k` between consecutive masses.

use super::assemble::{MOST_DOFS, Parts};
use super::error::{StructureError, not_negative, positive};
use super::geometry::{Direction, Dof, Node};
use super::lumped_mass::LumpedMass;
use super::matrices::SystemMatrices;
use super::system::{Structure, StructureKind};
use faer::Mat;
use serde::{Deserialize, Serialize};

/// A chain of n masses.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChainParameters {
    /// n masses, kg.
    pub masses: Vec<f64>,
    /// n springs to the ground, N/m; 0 where there is none.
    pub ground_stiffness: Vec<f64>,
    /// n - 1 springs between mass i and i + 1, N/m.
    pub coupling_stiffness: Vec<f64>,
}

impl ChainParameters {
    /// Builds the chain with its lumped masses; DOFs are labelled 1..n.
    ///
    /// # Errors
    /// [`StructureError`] for lists of the wrong length, masses that are not positive, or negative springs.
    pub fn build(&self, lumped: &[LumpedMass]) -> Result<Structure, StructureError> {
        self.check()?;
        let n = self.masses.len();
        let mass = Mat::from_fn(n, n, |i, j| if i == j { self.masses[i] } else { 0.0 });
        let mut stiffness = Mat::zeros(n, n);
        for (i, g) in self.ground_stiffness.iter().enumerate() {
            stiffness[(i, i)] += g;
        }
        for (i, k) in self.coupling_stiffness.iter().enumerate() {
            stiffness[(i, i)] += k;
            stiffness[(i + 1, i + 1)] += k;
            stiffness[(i, i + 1)] -= k;
            stiffness[(i + 1, i)] -= k;
        }
        let label = |i: usize| (i + 1).to_string();
        Parts {
            kind: StructureKind::Chain,
            dofs: (0..n).map(|i| Dof { label: label(i), node: i, direction: Direction::X }).collect(),
            nodes: (0..n).map(|i| Node { label: label(i), position: [i as f64, 0.0, 0.0] }).collect(),
            lines: (1..n).map(|i| [i - 1, i]).collect(),
            matrices: Some(SystemMatrices { mass, stiffness }),
            elements: Vec::new(),
        }
        .finish(lumped)
    }

    fn check(&self) -> Result<(), StructureError> {
        let n = self.masses.len();
        if n == 0 {
            return Err(StructureError::NoDofs);
        }
        if n > MOST_DOFS {
            return Err(StructureError::TooLarge { degrees: n, limit: MOST_DOFS });
        }
        count("ground_stiffness", self.ground_stiffness.len(), n, " (one a mass, 0 where there is none)")?;
        count("coupling_stiffness", self.coupling_stiffness.len(), n - 1, " (one less than masses)")?;
        for (i, &m) in self.masses.iter().enumerate() {
            positive(format!("mass {}", i + 1), m, "kg")?;
        }
        for (i, &k) in self.ground_stiffness.iter().enumerate() {
            not_negative(format!("ground_stiffness {}", i + 1), k, "N/m")?;
        }
        for (i, &k) in self.coupling_stiffness.iter().enumerate() {
            not_negative(format!("coupling_stiffness {}", i + 1), k, "N/m")?;
        }
        Ok(())
    }
}

fn count(what: &'static str, found: usize, expected: usize, hint: &'static str) -> Result<(), StructureError> {
    if found == expected { Ok(()) } else { Err(StructureError::Count { what, found, expected, hint }) }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use faer::mat;

    #[test]
    fn matrices_of_three_masses() {
        let chain = ChainParameters {
            masses: vec![1.0, 2.0, 3.0],
            ground_stiffness: vec![10.0, 0.0, 5.0],
            coupling_stiffness: vec![100.0, 200.0],
        };
        let structure = chain.build(&[LumpedMass { dof: "2".into(), mass: 0.5 }]).unwrap();
        let matrices = structure.matrices().unwrap();
        assert_eq!(matrices.stiffness, mat![[110.0, -100.0, 0.0], [-100.0, 300.0, -200.0], [0.0, -200.0, 205.0]]);
        assert_eq!(matrices.mass[(1, 1)], 2.5);
        assert_eq!(structure.neighbours(), [[0, 1], [1, 2]]);
    }

    #[test]
    fn wrong_lengths_are_named() {
        let chain =
            ChainParameters { masses: vec![1.0; 3], ground_stiffness: vec![0.0; 3], coupling_stiffness: vec![1.0; 3] };
        let message = chain.build(&[]).unwrap_err().to_string();
        assert_eq!(message, "coupling_stiffness has 3 values but 2 are needed (one less than masses)");
        let nan = ChainParameters { masses: vec![f64::NAN], ground_stiffness: vec![0.0], coupling_stiffness: vec![] };
        assert_eq!(nan.build(&[]).unwrap_err().to_string(), "mass 1 is NaN kg: give a positive number of at most 1e30");
    }
}
