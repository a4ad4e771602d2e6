//! Parts of a structure whose stiffness or mass a factor may multiply: what model updating changes.
//!
//! ```text
//! K' = f_K (K + sum_p (f_p - 1) K_p),      M' = f_M (M + sum_p (f_p - 1) M_p)
//! ```
//!
//! with `K_p`, `M_p` the share of part `p`: a range of elements, a spring, the stiffness of one mode, a point mass, a support
//! (Friswell and Mottershead, Finite Element Model Updating in Structural Dynamics, 1995, chapter 8).

use super::mode_damping::{DampingOfMode, modal_pattern};
use super::system::{Element, Structure, StructureKind, SystemMatrices};
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
    /// Damping that laws of the whole structure give one undamped mode.
    ModeDamping(usize),
    /// Spring from a DOF to the ground: the sum of its row.
    GroundSpring(usize),
    /// Spring between two DOFs: minus the entry of the stiffness matrix.
    Coupling([usize; 2]),
    /// Mass on the diagonal at a DOF.
    PointMass(usize),
    /// Support of a held DOF of a beam, taken for rigid: `k_s / (k_s + k_hh)` of a spring `k_s` in its stead, `k_hh` being the
    /// stiffness of the element there.
    Support(HeldDof),
}

/// A DOF of an element that a support holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct HeldDof {
    /// The element, from 0.
    pub element: usize,
    /// Which of its local DOFs.
    pub dof: usize,
}

/// Entries of a symmetric matrix, `(row, column, value)`, both triangles.
pub(crate) type Triplets = Vec<(usize, usize, f64)>;

/// The share of one part in the matrices.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Share {
    /// Of the stiffness matrix, N/m.
    pub stiffness: Triplets,
    /// Of the mass matrix, kg.
    pub mass: Triplets,
}

impl Share {
    fn of_stiffness(stiffness: Triplets) -> Self {
        Self { stiffness, mass: Triplets::new() }
    }

    fn of_mass(mass: Triplets) -> Self {
        Self { stiffness: Triplets::new(), mass }
    }
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
            Part::Stiffness | Part::Mass | Part::Mode(_) | Part::ModeDamping(_) => return None,
            Part::ElementStiffness(range) => Share::of_stiffness(self.of_elements(range, false)),
            Part::ElementMass(range) => Share::of_mass(self.of_elements(range, true)),
            Part::GroundSpring(i) => Share::of_stiffness(vec![(i, i, (0..k.ncols()).map(|j| k[(i, j)]).sum())]),
            Part::Coupling([i, j]) => Share::of_stiffness(spring(i, j)),
            Part::PointMass(i) => Share::of_mass(vec![(i, i, matrices.mass[(i, i)])]),
            Part::Support(held) => self.of_support(held)?,
        })
    }

    /// What a rigid support of the held DOF `h` adds to one that gives way: with `u_h = -g b^T u`, `b = k_h / k_hh` (static
    /// condensation, Guyan 1965) and `g = 1 - f`,
    ///
    /// ```text
    /// K' = K - g k_h k_h^T / k_hh,      M' = M - g (m_h b^T + b m_h^T) + g^2 m_hh b b^T
    /// ```
    ///
    /// The share is what is linear in `g`.
    fn of_support(&self, held: HeldDof) -> Option<Share> {
        let element = self.elements.get(held.element)?;
        let (k, m, h) = (&element.stiffness, &element.mass, held.dof);
        let mut share = Share::default();
        for (i, row, j, column) in element.free_pairs() {
            share.stiffness.push((row, column, k[(i, h)] * k[(h, j)] / k[(h, h)]));
            let coupled = (m[(i, h)] * k[(h, j)] + k[(i, h)] * m[(h, j)]) / k[(h, h)];
            share.mass.push((row, column, coupled));
        }
        Some(share)
    }

    /// The support of each end of a beam that most likely gives way: the rotation of a clamp, the translation of a pin.
    pub fn supports(&self) -> Vec<HeldDof> {
        let of_element = |(element, e): (usize, &Element)| {
            let held: Vec<usize> = (0..e.dofs.len()).filter(|&dof| e.dofs[dof].is_none()).collect();
            let ends = [held.iter().copied().rfind(|dof| *dof < 2), held.iter().copied().rfind(|dof| *dof >= 2)];
            ends.into_iter().flatten().map(move |dof| HeldDof { element, dof }).collect::<Vec<_>>()
        };
        self.elements.iter().enumerate().flat_map(of_element).collect()
    }

    /// `m_hh b b^T`, kg.
    fn of_held_mass(&self, held: HeldDof) -> Triplets {
        let Some(element) = self.elements.get(held.element) else { return Triplets::new() };
        let (k, h) = (&element.stiffness, held.dof);
        let size = element.mass[(h, h)] / (k[(h, h)] * k[(h, h)]);
        element.free_pairs().map(|(i, row, j, column)| (row, column, size * k[(i, h)] * k[(h, j)])).collect()
    }

    /// Label of the node of a held DOF.
    pub fn held_node(&self, held: HeldDof) -> Option<&str> {
        let node = self.lines.get(held.element)?[usize::from(held.dof >= 2)];
        self.nodes.get(node).map(|node| node.label.as_str())
    }

    /// Stiffness of a held DOF in its element, `k_hh` (N/m, N m/rad).
    pub fn stiffness_at(&self, held: HeldDof) -> Option<f64> {
        self.elements.get(held.element).map(|element| element.stiffness[(held.dof, held.dof)])
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
        for &(part, factor) in factors {
            if let Some(share) = self.share(part) {
                add(&mut matrices.stiffness, &share.stiffness, factor - 1.0);
                add(&mut matrices.mass, &share.mass, factor - 1.0);
            }
            if let Part::Support(held) = part {
                add(&mut matrices.mass, &self.of_held_mass(held), (factor - 1.0).powi(2));
                changed.elements.get_mut(held.element).into_iter().for_each(|e| e.release(held.dof, factor));
            }
            changed.scale_elements(part, factor);
        }
        changed.matrices = Some(matrices.clone());
        // Modes are those of the structure with its parts as they are now.
        changed.add_modes(&mut matrices, factors);
        for &(part, factor) in factors {
            match part {
                Part::Stiffness => matrices.stiffness *= faer::Scale(factor),
                Part::Mass => matrices.mass *= faer::Scale(factor),
                _ => {}
            }
        }
        changed.matrices = Some(matrices);
        changed.correct_damping(factors);
        changed
    }

    /// Factor on the damping that laws of the whole structure give a mode; 1 where it is not corrected.
    pub fn mode_damping(&self, mode: usize) -> f64 {
        self.origin.damping_of_modes.iter().find(|d| d.mode == mode).map_or(1.0, |d| d.factor)
    }

    /// Modes whose damping is corrected.
    pub fn damping_of_modes(&self) -> &[DampingOfMode] {
        &self.origin.damping_of_modes
    }

    /// Takes the factors on the damping of modes among `factors` beside those that are there, on the modes as they are now.
    fn correct_damping(&mut self, factors: &[(Part, f64)]) {
        let mut all: Vec<(usize, f64)> = self.origin.damping_of_modes.iter().map(|d| (d.mode, d.factor)).collect();
        for &(part, factor) in factors {
            let Part::ModeDamping(mode) = part else { continue };
            match all.iter_mut().find(|(own, _)| *own == mode) {
                Some((_, own)) => *own *= factor,
                None => all.push((mode, factor)),
            }
        }
        all.retain(|(_, factor)| *factor != 1.0);
        self.origin.damping_of_modes.clear();
        let (false, Some(matrices)) = (all.is_empty(), &self.matrices) else { return };
        let Ok(modes) = self.modes() else { return };
        let of = |(mode, factor): (usize, f64)| DampingOfMode {
            mode,
            factor,
            pattern: modal_pattern(&matrices.mass, modes.shapes.col_as_slice(mode)),
            square: modes.omega[mode].powi(2),
        };
        self.origin.damping_of_modes = all.into_iter().filter(|(mode, _)| *mode < modes.len()).map(of).collect();
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
            let weighted = modal_pattern(&matrices.mass, shape);
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

impl Element {
    /// Pairs of free DOFs: local DOF and row of each.
    fn free_pairs(&self) -> impl Iterator<Item = (usize, usize, usize, usize)> {
        let free = |(local, row): (usize, &Option<usize>)| row.map(|row| (local, row));
        let free: Vec<(usize, usize)> = self.dofs.iter().enumerate().filter_map(free).collect();
        free.clone()
            .into_iter()
            .flat_map(move |(i, row)| free.clone().into_iter().map(move |(j, column)| (i, row, j, column)))
    }

    /// Takes the share `1 - factor` of the support of local DOF `h` away from what is held there: with the motion
    /// `u_h = -g b^T u` taken out, `k_hh` is `k_hh / f` and `m_h` is `m_h - g m_hh b`, so that shares are those of what is left.
    fn release(&mut self, h: usize, factor: f64) {
        let size = (1.0 - factor) * self.mass[(h, h)] / self.stiffness[(h, h)];
        for i in (0..self.dofs.len()).filter(|&i| i != h) {
            let moved = size * self.stiffness[(i, h)];
            self.mass[(i, h)] -= moved;
            self.mass[(h, i)] -= moved;
        }
        self.stiffness[(h, h)] /= factor;
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
    use crate::common::models::{cantilever_parameters, chain, short_cantilever};
    use crate::structure::beam::{BeamParameters, Supports};

    #[test]
    fn frequencies_move_as_the_factors_say() {
        let structure = short_cantilever(5);
        let factors = [(Part::Stiffness, 1.02), (Part::Mass, 0.99), (Part::Mode(1), 1.04)];
        let (before, after) =
            (structure.modes().unwrap().omega, structure.with_factors(&factors).modes().unwrap().omega);
        for r in 0..4 {
            let expected = 0.5 * (1.02_f64 / 0.99 * if r == 1 { 1.04 } else { 1.0 }).ln();
            assert!(((after[r] / before[r]).ln() - expected).abs() < 1e-9, "mode {r}");
        }
    }

    /// The factor of a mode is on the mode of the structure with its parts as they are then.
    #[test]
    fn modes_are_taken_after_parts() {
        let structure = short_cantilever(5);
        let (part, mode) = ((Part::ElementStiffness([0, 1]), 1.2), (Part::Mode(1), 1.06));
        let at_once = structure.with_factors(&[mode, part]).modes().unwrap().omega;
        let stepwise = structure.with_factors(&[part]).with_factors(&[mode]).modes().unwrap().omega;
        for r in 0..6 {
            assert!((at_once[r] / stepwise[r] - 1.0).abs() < 1e-9, "mode {r}: {} for {}", at_once[r], stepwise[r]);
        }
    }

    #[test]
    fn groups_of_elements_add_up_to_all() {
        let structure = short_cantilever(5);
        let groups = [(Part::ElementStiffness([0, 1]), 1.1), (Part::ElementStiffness([2, 4]), 1.1)];
        let (by_groups, at_once) = (structure.with_factors(&groups), structure.with_factors(&[(Part::Stiffness, 1.1)]));
        let difference = &by_groups.matrices().unwrap().stiffness - &at_once.matrices().unwrap().stiffness;
        assert!(difference.norm_max() < 1e-9 * at_once.matrices().unwrap().stiffness.norm_max());
        assert!((&by_groups.elements[3].stiffness - &at_once.elements[3].stiffness).norm_max() < 1e-6);
    }

    #[test]
    fn springs_of_a_chain_are_those_it_was_built_from() {
        let chain = chain(&[1.0, 2.0, 3.0], &[5.0, 0.0, 7.0], &[11.0, 13.0]);
        let expected = [Part::GroundSpring(0), Part::Coupling([0, 1]), Part::Coupling([1, 2]), Part::GroundSpring(2)];
        assert_eq!(chain.springs(40), expected);
        let stiffer = chain.with_factors(&[(Part::Coupling([0, 1]), 2.0), (Part::PointMass(1), 1.5)]);
        let SystemMatrices { mass, stiffness } = stiffer.matrices().unwrap();
        assert!((stiffness[(0, 1)] + 22.0).abs() < 1e-12 && (stiffness[(0, 0)] - 27.0).abs() < 1e-12);
        assert!((mass[(1, 1)] - 3.0).abs() < 1e-12);
    }

    /// A clamp whose rotation is held by a spring: natural frequencies of the beam with that DOF and spring in its matrices.
    fn on_a_spring(beam: &BeamParameters, spring: f64) -> Vec<f64> {
        let free = BeamParameters { supports: Supports::FreeFree, ..beam.clone() }.build(&[]).unwrap();
        let SystemMatrices { mass, stiffness } = free.matrices().unwrap();
        let n = free.len() - 1;
        let mass = Mat::from_fn(n, n, |i, j| mass[(i + 1, j + 1)]);
        let mut stiffness = Mat::from_fn(n, n, |i, j| stiffness[(i + 1, j + 1)]);
        stiffness[(0, 0)] += spring;
        let matrices = Some(SystemMatrices { mass, stiffness });
        let held = Structure { matrices, dofs: free.dofs[1..].to_vec(), elements: Vec::new(), ..free };
        held.modes().unwrap().omega
    }

    #[test]
    fn a_clamp_that_gives_way_is_a_rotation_on_a_spring() {
        let beam = BeamParameters { length: 0.5, ..cantilever_parameters(8) };
        let model = beam.build(&[]).unwrap();
        let [held] = model.supports()[..] else { panic!("one support") };
        assert_eq!((held, model.held_node(held)), (HeldDof { element: 0, dof: 1 }, Some("0")));
        let k = model.stiffness_at(held).unwrap();
        for factor in [0.9, 0.6, 0.4] {
            let updated = model.with_factors(&[(Part::Support(held), factor)]).modes().unwrap().omega;
            let exact = on_a_spring(&beam, k * factor / (1.0 - factor));
            let rigid = model.modes().unwrap().omega;
            for mode in 0..3 {
                let (shift, error) = (rigid[mode] / exact[mode] - 1.0, updated[mode] / exact[mode] - 1.0);
                assert!(shift > 0.005 && error.abs() < 0.005 * shift + 1e-6, "{factor} {mode}: {shift} {error}");
            }
        }
        let both = model.with_factors(&[(Part::Support(held), 0.5)]);
        let (left, whole) = (both.share(Part::Support(held)).unwrap(), model.share(Part::Support(held)).unwrap());
        for (a, b) in left.stiffness.iter().zip(&whole.stiffness) {
            assert!((a.2 - 0.5 * b.2).abs() < 1e-12 * b.2.abs());
        }
        // Half of it twice is a quarter, and what is left is the derivative by the factor.
        let (twice, quarter) =
            (both.with_factors(&[(Part::Support(held), 0.5)]), model.with_factors(&[(Part::Support(held), 0.25)]));
        let more = model.with_factors(&[(Part::Support(held), 0.5 + 1e-6)]);
        let masses = [&twice, &quarter, &both, &more].map(|s| s.matrices().unwrap().mass.clone());
        assert!((&masses[0] - &masses[1]).norm_max() < 1e-12 * masses[0].norm_max());
        for (i, j, value) in left.mass {
            let slope = 0.5 * (masses[3][(i, j)] - masses[2][(i, j)]) / 1e-6;
            assert!((value - slope).abs() < 1e-5 * masses[0].norm_max(), "{i} {j}: {value} {slope}");
        }
    }
}
