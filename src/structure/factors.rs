//! Parts of a structure whose stiffness or mass a factor may multiply: what model updating changes.
//!
//! ```text
//! K' = f_K (K + sum_p (f_p - 1) K_p),      M' = f_M (M + sum_p (f_p - 1) M_p)
//! ```
//!
//! with `K_p`, `M_p` the share of part `p`: a range of elements, a spring, the stiffness of one mode, a point mass
//! (Friswell and Mottershead, Finite Element Model Updating in Structural Dynamics, 1995, chapter 8).

use super::{Structure, StructureKind, SystemMatrices};
use faer::Mat;

/// A part of a structure; rows are counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Part {
    /// All stiffness.
    Stiffness,
    /// All mass.
    Mass,
    /// Stiffness of the elements first..=last.
    ElementStiffness([usize; 2]),
    /// Mass of the elements first..=last.
    ElementMass([usize; 2]),
    /// Stiffness of one undamped mode.
    Mode(usize),
    /// Spring from a DOF to the ground: the sum of its row.
    GroundSpring(usize),
    /// Spring between two DOFs: minus the entry of the stiffness matrix.
    Coupling([usize; 2]),
    /// Mass on the diagonal at a DOF.
    PointMass(usize),
}

/// Entries of a symmetric matrix, `(row, column, value)`, both triangles.
pub type Triplets = Vec<(usize, usize, f64)>;

/// The share of one part in the matrices.
#[derive(Debug, Clone, PartialEq)]
pub enum Share {
    /// Of the stiffness matrix, N/m.
    Stiffness(Triplets),
    /// Of the mass matrix, kg.
    Mass(Triplets),
}

impl Structure {
    /// The share of `part` in the matrices; `None` for all stiffness, all mass, modes and structures without matrices.
    pub fn share(&self, part: Part) -> Option<Share> {
        let matrices = self.matrices.as_ref()?;
        let k = &matrices.stiffness;
        let spring = |i: usize, j: usize| {
            let value = -k[(i, j)];
            vec![(i, i, value), (j, j, value), (i, j, -value), (j, i, -value)]
        };
        Some(match part {
            Part::Stiffness | Part::Mass | Part::Mode(_) => return None,
            Part::ElementStiffness(range) => Share::Stiffness(self.of_elements(range, false)),
            Part::ElementMass(range) => Share::Mass(self.of_elements(range, true)),
            Part::GroundSpring(i) => Share::Stiffness(vec![(i, i, (0..k.ncols()).map(|j| k[(i, j)]).sum())]),
            Part::Coupling([i, j]) => Share::Stiffness(spring(i, j)),
            Part::PointMass(i) => Share::Mass(vec![(i, i, matrices.mass[(i, i)])]),
        })
    }

    fn of_elements(&self, [first, last]: [usize; 2], mass: bool) -> Triplets {
        let mut entries = Triplets::new();
        for element in self.elements.iter().take(last + 1).skip(first) {
            let local = if mass { &element.mass } else { &element.stiffness };
            for (a, row) in element.dofs.iter().enumerate() {
                for (b, column) in element.dofs.iter().enumerate() {
                    if let (Some(row), Some(column)) = (row, column) {
                        entries.push((*row, *column, local[(a, b)]));
                    }
                }
            }
        }
        entries
    }

    /// The same structure with its parts multiplied by positive factors; a part named twice is multiplied twice.
    #[must_use]
    pub fn with_factors(&self, factors: &[(Part, f64)]) -> Self {
        let mut changed = self.clone();
        let Some(mut matrices) = changed.matrices.take() else { return changed };
        self.add_modes(&mut matrices, factors);
        for &(part, factor) in factors {
            match self.share(part) {
                Some(Share::Stiffness(entries)) => add(&mut matrices.stiffness, &entries, factor - 1.0),
                Some(Share::Mass(entries)) => add(&mut matrices.mass, &entries, factor - 1.0),
                None => {}
            }
            changed.scale_elements(part, factor);
        }
        for &(part, factor) in factors {
            match part {
                Part::Stiffness => matrices.stiffness *= faer::Scale(factor),
                Part::Mass => matrices.mass *= faer::Scale(factor),
                _ => {}
            }
        }
        changed.matrices = Some(matrices);
        changed
    }

    fn scale_elements(&mut self, part: Part, factor: f64) {
        let all = [0, self.elements.len().saturating_sub(1)];
        let (range, mass) = match part {
            Part::Stiffness => (all, false),
            Part::Mass => (all, true),
            Part::ElementStiffness(range) => (range, false),
            Part::ElementMass(range) => (range, true),
            _ => return,
        };
        for element in self.elements.iter_mut().take(range[1] + 1).skip(range[0]) {
            let local = if mass { &mut element.mass } else { &mut element.stiffness };
            *local *= faer::Scale(factor);
        }
    }

    /// `K + sum (f - 1) omega_r^2 (M phi_r)(M phi_r)^T` for the modes among `factors`.
    fn add_modes(&self, matrices: &mut SystemMatrices, factors: &[(Part, f64)]) {
        if !factors.iter().any(|(part, f)| matches!(part, Part::Mode(_)) && *f != 1.0) {
            return;
        }
        let Ok(modes) = self.modes() else { return };
        let n = self.len();
        for &(part, factor) in factors {
            let Part::Mode(r) = part else { continue };
            let shape = modes.shapes.col_as_slice(r);
            let row = |i: usize| matrices.mass.col_as_slice(i).iter().zip(shape).map(|(m, x)| m * x).sum::<f64>();
            let weighted: Vec<f64> = (0..n).map(row).collect();
            let size = (factor - 1.0) * modes.omega[r].powi(2);
            for j in 0..n {
                for i in 0..n {
                    matrices.stiffness[(i, j)] += size * weighted[i] * weighted[j];
                }
            }
        }
    }

    /// Springs to the ground and between DOFs, where all are translations and the stiffness couples few: those of a chain,
    /// or of small matrices.
    pub fn springs(&self, most: usize) -> Vec<Part> {
        let Some(matrices) = &self.matrices else { return Vec::new() };
        if !self.elements.is_empty() || self.dofs.iter().any(|dof| dof.direction.is_rotation()) {
            return Vec::new();
        }
        let (k, n) = (&matrices.stiffness, self.len());
        let mut springs = Vec::new();
        for i in 0..n {
            if (0..n).map(|j| k[(i, j)]).sum::<f64>() > 1e-9 * k[(i, i)] {
                springs.push(Part::GroundSpring(i));
            }
            let joined = |&j: &usize| -k[(i, j)] > 1e-9 * (k[(i, i)] * k[(j, j)]).sqrt();
            springs.extend((i + 1..n).filter(joined).map(|j| Part::Coupling([i, j])));
        }
        if springs.len() > most && self.kind != StructureKind::Chain { Vec::new() } else { springs }
    }
}

fn add(matrix: &mut Mat<f64>, entries: &Triplets, factor: f64) {
    for &(i, j, value) in entries {
        matrix[(i, j)] += factor * value;
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::structure::beam::{BeamParameters, Supports};
    use crate::structure::chain::ChainParameters;

    fn beam() -> Structure {
        let (length, breadth, depth) = (0.5, 0.04, 0.004);
        let (youngs_modulus, density, elements) = (7e10, 2700.0, 5);
        let supports = Supports::ClampedFree;
        BeamParameters { length, breadth, depth, youngs_modulus, density, elements, supports }.build(&[]).unwrap()
    }

    #[test]
    fn frequencies_move_as_the_factors_say() {
        let structure = beam();
        let factors = [(Part::Stiffness, 1.02), (Part::Mass, 0.99), (Part::Mode(1), 1.04)];
        let (before, after) =
            (structure.modes().unwrap().omega, structure.with_factors(&factors).modes().unwrap().omega);
        for r in 0..4 {
            let expected = 0.5 * (1.02_f64 / 0.99 * if r == 1 { 1.04 } else { 1.0 }).ln();
            assert!(((after[r] / before[r]).ln() - expected).abs() < 1e-9, "mode {r}");
        }
    }

    #[test]
    fn groups_of_elements_add_up_to_all() {
        let structure = beam();
        let groups = [(Part::ElementStiffness([0, 1]), 1.1), (Part::ElementStiffness([2, 4]), 1.1)];
        let (by_groups, at_once) = (structure.with_factors(&groups), structure.with_factors(&[(Part::Stiffness, 1.1)]));
        let difference = &by_groups.matrices().unwrap().stiffness - &at_once.matrices().unwrap().stiffness;
        assert!(difference.norm_max() < 1e-9 * at_once.matrices().unwrap().stiffness.norm_max());
        assert!((&by_groups.elements[3].stiffness - &at_once.elements[3].stiffness).norm_max() < 1e-6);
    }

    #[test]
    fn springs_of_a_chain_are_those_it_was_built_from() {
        let chain = ChainParameters {
            masses: vec![1.0, 2.0, 3.0],
            ground_stiffness: vec![5.0, 0.0, 7.0],
            coupling_stiffness: vec![11.0, 13.0],
        };
        let chain = chain.build(&[]).unwrap();
        let expected = [Part::GroundSpring(0), Part::Coupling([0, 1]), Part::Coupling([1, 2]), Part::GroundSpring(2)];
        assert_eq!(chain.springs(40), expected);
        let stiffer = chain.with_factors(&[(Part::Coupling([0, 1]), 2.0), (Part::PointMass(1), 1.5)]);
        let SystemMatrices { mass, stiffness } = stiffer.matrices().unwrap();
        assert!((stiffness[(0, 1)] + 22.0).abs() < 1e-12 && (stiffness[(0, 0)] - 27.0).abs() < 1e-12);
        assert!((mass[(1, 1)] - 3.0).abs() < 1e-12);
    }
}
