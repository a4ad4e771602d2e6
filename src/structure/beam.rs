//! Euler-Bernoulli beam with consistent mass: `E I w'''' + rho A w_tt = 0`, Hermite cubics on equal elements of length l,
//!
//! ```text
//! K_e = E I / l^3 [ 12  6l  -12  6l ; . 4l^2  -6l  2l^2 ; . . 12  -6l ; . . . 4l^2 ]
//! M_e = rho A l / 420 [ 156  22l  54  -13l ; . 4l^2  13l  -3l^2 ; . . 156  -22l ; . . . 4l^2 ]
//! ```
//!
//! with the local DOFs (w1, w1', w2, w2'), `A = b h`, `I = b h^3 / 12`. The axis lies along x, bending is in z (the
//! direction of `depth`); a rotation is the slope w'.

use super::assemble::{MOST_DOFS, Parts};
use super::error::{StructureError, positive};
use super::geometry::{Direction, Dof, Node};
use super::lumped_mass::LumpedMass;
use super::matrices::{Element, SystemMatrices};
use super::system::{Structure, StructureKind};
use faer::Mat;
use nalgebra::Matrix4;
use serde::{Deserialize, Serialize};

/// How the two ends of a beam are held, left end first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[expect(missing_docs, reason = "the names say it")]
pub enum Supports {
    ClampedFree,
    FreeFree,
    PinnedPinned,
    ClampedClamped,
    ClampedPinned,
}

impl Supports {
    /// All supports.
    pub const ALL: [Self; 5] =
        [Self::ClampedFree, Self::FreeFree, Self::PinnedPinned, Self::ClampedClamped, Self::ClampedPinned];

    /// Whether (translation, rotation) are held at the left and at the right end.
    fn held(self) -> [[bool; 2]; 2] {
        const CLAMPED: [bool; 2] = [true, true];
        const PINNED: [bool; 2] = [true, false];
        const FREE: [bool; 2] = [false, false];
        match self {
            Self::ClampedFree => [CLAMPED, FREE],
            Self::FreeFree => [FREE, FREE],
            Self::PinnedPinned => [PINNED, PINNED],
            Self::ClampedClamped => [CLAMPED, CLAMPED],
            Self::ClampedPinned => [CLAMPED, PINNED],
        }
    }
}

/// A uniform beam of rectangular section.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BeamParameters {
    /// Length, m.
    pub length: f64,
    /// Width of the section, m.
    pub breadth: f64,
    /// Height of the section in the direction of bending, m.
    pub depth: f64,
    /// Young's modulus, Pa.
    pub youngs_modulus: f64,
    /// Density, kg/m^3.
    pub density: f64,
    /// Number of equal elements.
    pub elements: usize,
    /// How the ends are held.
    pub supports: Supports,
}

impl BeamParameters {
    /// Builds the beam with its lumped masses.
    ///
    /// # Errors
    /// [`StructureError`] for a parameter that is not positive and finite, no elements, or an unknown DOF.
    ///
    /// ```
    /// use dashpot::structure::beam::{BeamParameters, Supports};
    /// let beam = BeamParameters { length: 0.56, breadth: 0.04, depth: 0.004, youngs_modulus: 69e9, density: 2700.0,
    ///                             elements: 10, supports: Supports::ClampedFree };
    /// let structure = beam.build(&[]).unwrap();
    /// assert_eq!(structure.len(), 20);
    /// assert_eq!(structure.label(18), "19"); // the tip's translation
    /// ```
    pub fn build(&self, lumped: &[LumpedMass]) -> Result<Structure, StructureError> {
        self.check()?;
        let n = self.elements;
        let rows = self.free_rows();
        let size = rows.iter().flatten().count();
        if size == 0 {
            return Err(StructureError::NothingFree { elements: n });
        }
        let elements: Vec<Element> = (0..n).map(|e| self.element(rows[2 * e..2 * e + 4].to_vec())).collect();
        let matrices = SystemMatrices {
            mass: assemble(size, &elements, |e| &e.mass),
            stiffness: assemble(size, &elements, |e| &e.stiffness),
        };
        let step = self.length / n as f64;
        let node = |k: usize| Node { label: k.to_string(), position: [k as f64 * step, 0.0, 0.0] };
        let nodes = (0..=n).map(node).collect();
        let lines = (0..n).map(|k| [k, k + 1]).collect();
        let dofs = dofs(&rows);
        Parts { kind: StructureKind::Beam, dofs, nodes, lines, matrices: Some(matrices), elements }.finish(lumped)
    }

    fn check(&self) -> Result<(), StructureError> {
        positive("length", self.length, "m")?;
        positive("breadth", self.breadth, "m")?;
        positive("depth", self.depth, "m")?;
        positive("youngs_modulus", self.youngs_modulus, "Pa")?;
        positive("density", self.density, "kg/m^3")?;
        match self.elements {
            0 => Err(StructureError::NoElements),
            n if n > MOST_DOFS / 2 => Err(StructureError::TooLarge { degrees: n.saturating_mul(2), limit: MOST_DOFS }),
            _ => Ok(()),
        }
    }

    /// Row of every nodal DOF (translation, rotation of node 0, 1, ...), `None` where it is held.
    fn free_rows(&self) -> Vec<Option<usize>> {
        let [left, right] = self.supports.held();
        let last = self.elements;
        let mut next = 0;
        (0..2 * (last + 1))
            .map(|k| {
                let held = (k / 2 == 0 && left[k % 2]) || (k / 2 == last && right[k % 2]);
                (!held).then(|| {
                    next += 1;
                    next - 1
                })
            })
            .collect()
    }

    fn element(&self, dofs: Vec<Option<usize>>) -> Element {
        let l = self.length / self.elements as f64;
        let area = self.breadth * self.depth;
        let inertia = self.breadth * self.depth.powi(3) / 12.0;
        let stiffness = element_stiffness(l) * (self.youngs_modulus * inertia / l.powi(3));
        let mass = element_mass(l) * (self.density * area * l / 420.0);
        Element { dofs, mass: to_faer(&mass), stiffness: to_faer(&stiffness) }
    }
}

/// Labels, nodes and directions of the free rows.
fn dofs(rows: &[Option<usize>]) -> Vec<Dof> {
    rows.iter()
        .enumerate()
        .filter_map(|(k, row)| {
            let direction = if k % 2 == 0 { Direction::Z } else { Direction::Ry };
            row.map(|row| Dof { label: (row + 1).to_string(), node: k / 2, direction })
        })
        .collect()
}

/// In units of E I / l^3.
#[rustfmt::skip]
fn element_stiffness(l: f64) -> Matrix4<f64> {
    Matrix4::new(
        12.0,     6.0 * l,       -12.0,    6.0 * l,
        6.0 * l,  4.0 * l * l,   -6.0 * l, 2.0 * l * l,
        -12.0,    -6.0 * l,      12.0,     -6.0 * l,
        6.0 * l,  2.0 * l * l,   -6.0 * l, 4.0 * l * l,
    )
}

/// In units of rho A l / 420.
#[rustfmt::skip]
fn element_mass(l: f64) -> Matrix4<f64> {
    Matrix4::new(
        156.0,     22.0 * l,      54.0,      -13.0 * l,
        22.0 * l,  4.0 * l * l,   13.0 * l,  -3.0 * l * l,
        54.0,      13.0 * l,      156.0,     -22.0 * l,
        -13.0 * l, -3.0 * l * l,  -22.0 * l, 4.0 * l * l,
    )
}

fn to_faer(a: &Matrix4<f64>) -> Mat<f64> {
    Mat::from_fn(4, 4, |i, j| a[(i, j)])
}

/// Sum of the elements' matrices over the free rows.
fn assemble(size: usize, elements: &[Element], matrix: impl Fn(&Element) -> &Mat<f64>) -> Mat<f64> {
    let mut sum = Mat::zeros(size, size);
    for element in elements {
        element.entries(matrix(element)).for_each(|(i, j, value)| sum[(i, j)] += value);
    }
    sum
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    fn thesis_beam() -> BeamParameters {
        BeamParameters {
            length: 0.56,
            breadth: 0.04,
            depth: 0.004,
            youngs_modulus: 69e9,
            density: 2700.0,
            elements: 10,
            supports: Supports::ClampedFree,
        }
    }

    #[test]
    fn tip_deflection_of_a_cantilever() {
        let beam = thesis_beam();
        let structure = beam.build(&[]).unwrap();
        let mut load = Mat::zeros(20, 1);
        load[(18, 0)] = 1.0;
        let stiffness = structure.matrices().unwrap().stiffness.as_ref();
        let x = crate::math::least_squares::solve_symmetric(stiffness, load.as_ref()).unwrap();
        let ei = 69e9 * 0.04 * 0.004f64.powi(3) / 12.0;
        assert!((x[(18, 0)] / (0.56f64.powi(3) / (3.0 * ei)) - 1.0).abs() < 1e-9);
        assert!((x[(19, 0)] / (0.56f64.powi(2) / (2.0 * ei)) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn total_mass_and_lumped_mass() {
        let beam = BeamParameters { supports: Supports::FreeFree, ..thesis_beam() };
        let structure = beam.build(&[LumpedMass { dof: "21".into(), mass: 0.5 }]).unwrap();
        let rows = structure.translations();
        let mass = &structure.matrices().unwrap().mass;
        let total: f64 = rows.iter().flat_map(|&i| rows.iter().map(move |&j| mass[(i, j)])).sum();
        assert!((total - (2700.0 * 0.56 * 0.04 * 0.004 + 0.5)).abs() < 1e-12);
        assert_eq!(structure.neighbours().len(), 10);
    }

    #[test]
    fn labels_skip_the_supports() {
        let beam = BeamParameters { supports: Supports::ClampedPinned, elements: 3, ..thesis_beam() };
        let structure = beam.build(&[]).unwrap();
        let directions: Vec<_> = structure.dofs().iter().map(|d| (d.label.as_str(), d.node, d.direction)).collect();
        assert_eq!(directions[4], ("5", 3, Direction::Ry));
        assert_eq!(structure.neighbours(), [[0, 2]]);
    }

    #[test]
    fn errors_name_the_parameter() {
        let bad = BeamParameters { depth: -1.0, ..thesis_beam() }.build(&[]).unwrap_err();
        assert_eq!(bad.to_string(), "depth is -1 m: give a positive number of at most 1e30");
        let lumped = thesis_beam().build(&[LumpedMass { dof: "21".into(), mass: 1.0 }]).unwrap_err();
        assert!(lumped.to_string().starts_with("there is no DOF \"21\"; labels near it: 20, 19"), "{lumped}");
        let one = BeamParameters { elements: 1, supports: Supports::ClampedClamped, ..thesis_beam() };
        assert_eq!(one.build(&[]), Err(StructureError::NothingFree { elements: 1 }));
    }
}
