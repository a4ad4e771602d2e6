//! Parts of a structure whose stiffness or mass a factor may multiply: what model updating changes.
//!
//! ```text
//! K' = f_K (K + sum_p (f_p - 1) K_p),      M' = f_M (M + sum_p (f_p - 1) M_p)
//! ```
//!
//! with `K_p`, `M_p` the share of part `p`: a range of elements, a spring, the stiffness of one mode, a point mass, a support
//! (Friswell and Mottershead, Finite Element Model Updating in Structural Dynamics, 1995, chapter 8).

use super::elastic_supports::{ElasticSupports, HeldColumn};
use super::matrices::Element;
use super::modal_stiffness::ModalStiffness;
use super::mode_damping::{DampingOfMode, modal_pattern};
use super::share::{HeldDof, Part, Share, Triplets, add};
use super::system::{Structure, StructureKind};
use faer::Mat;

/// Change of the logarithm of a factor for derivatives by differences.
const STEP: f64 = 1e-5;

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
            Part::Stiffness
            | Part::Mass
            | Part::Mode(_)
            | Part::ModeCoupling(_)
            | Part::ModeDamping(_)
            | Part::ModeDampingPerOctave(_) => return None,
            Part::ElementStiffness(range) => self.of_elements(range, false),
            Part::ElementMass(range) => self.of_elements(range, true),
            Part::GroundSpring(i) => Share::of_stiffness(vec![(i, i, (0..k.ncols()).map(|j| k[(i, j)]).sum())]),
            Part::Coupling([i, j]) => Share::of_stiffness(spring(i, j)),
            Part::PointMass(i) => Share::of_mass(vec![(i, i, matrices.mass[(i, i)])]),
            Part::Support(held) => self.of_support(held)?,
        })
    }

    /// The change of the matrices by a support, of one that hardly gives way to first order in that.
    fn of_support(&self, held: HeldDof) -> Option<Share> {
        if let Some(share) = self.slope_beside_supports(Part::Support(held)) {
            return Some(share.clone());
        }
        let factor = self.origin.elastic_supports.as_ref().and_then(|supports| supports.factor(held)).unwrap_or(1.0);
        let Share { stiffness, mass } = HeldColumn::new(&self.elements, held)?.share();
        let scaled = |list: Triplets| list.into_iter().map(|(i, j, v)| (i, j, factor * v)).collect();
        Some(Share { stiffness: scaled(stiffness), mass: scaled(mass) })
    }

    /// The change of the matrices by a part with which held DOFs move; none where none does.
    fn slope_beside_supports(&self, part: Part) -> Option<&Share> {
        let supports = self.origin.elastic_supports.as_ref()?;
        let slope = |part: Part| Some((part, self.slope(part)?));
        let slopes = supports.slopes.get_or_init(|| supports.parts().into_iter().filter_map(slope).collect());
        slopes.iter().find(|(own, _)| *own == part).map(|(_, share)| share)
    }

    /// Derivative of the matrices by the logarithm of the factor of a part, by differences.
    fn slope(&self, part: Part) -> Option<Share> {
        let (own, more) = (self.matrices.as_ref()?, self.with_factors(&[(part, STEP.exp())]).matrices?);
        let entries = |own: &Mat<f64>, more: &Mat<f64>| -> Triplets {
            let entry = |i: usize, j: usize| (i, j, (more[(i, j)] - own[(i, j)]) / STEP);
            (0..own.ncols()).flat_map(|j| (0..own.nrows()).map(move |i| entry(i, j))).collect()
        };
        Some(Share { stiffness: entries(&own.stiffness, &more.stiffness), mass: entries(&own.mass, &more.mass) })
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

    /// Label of the node of a held DOF.
    pub fn held_node(&self, held: HeldDof) -> Option<&str> {
        let node = self.lines.get(held.element)?[usize::from(held.dof >= 2)];
        self.nodes.get(node).map(|node| node.label.as_str())
    }

    /// Stiffness of a held DOF in its element, `k_hh` (N/m, N m/rad).
    pub fn stiffness_at(&self, held: HeldDof) -> Option<f64> {
        self.elements.get(held.element).map(|element| element.stiffness[(held.dof, held.dof)])
    }

    /// The share of the elements `first..=last`, their mass or their stiffness.
    fn of_elements(&self, [first, last]: [usize; 2], mass: bool) -> Share {
        let mut share = Share::default();
        for (e, element) in self.elements.iter().enumerate().take(last + 1).skip(first) {
            let part = if mass { Part::ElementMass([e; 2]) } else { Part::ElementStiffness([e; 2]) };
            if let Some(Share { stiffness, mass }) = self.slope_beside_supports(part) {
                share.stiffness.extend(stiffness);
                share.mass.extend(mass);
                continue;
            }
            if mass {
                share.mass.extend(element.entries(&element.mass));
            } else {
                share.stiffness.extend(element.entries(&element.stiffness));
            }
        }
        share
    }

    /// The same structure with its parts multiplied by positive factors; a part named twice is multiplied twice.
    #[must_use]
    pub fn with_factors(&self, factors: &[(Part, f64)]) -> Self {
        let mut changed = self.clone();
        let Some(stated) = changed.matrices.take() else { return changed };
        let (mut rigid, mut supports) = match changed.origin.elastic_supports.take() {
            Some(elastic) => (elastic.rigid, elastic.factors),
            None => (stated, Vec::new()),
        };
        // On rigid supports.
        let bare = Self { matrices: Some(rigid.clone()), ..changed.clone() };
        for &(part, factor) in factors {
            if let Part::Support(held) = part {
                ElasticSupports::add(&mut supports, held, factor);
            } else if let Some(share) = bare.share(part) {
                add(&mut rigid.stiffness, &share.stiffness, factor - 1.0);
                add(&mut rigid.mass, &share.mass, factor - 1.0);
            }
            changed.scale_elements(part, factor);
        }
        let (mut elastic, mut matrices) = match ElasticSupports::new(rigid.clone(), supports, &changed.elements) {
            Some((elastic, matrices)) => (Some(elastic), matrices),
            None => (None, rigid),
        };
        changed.matrices = Some(matrices.clone());
        // Modes are those of the structure with its parts as they are now.
        let modes_of = || changed.modes().ok().map(|modes| (modes.omega, modes.shapes));
        let mut corrected = ModalStiffness::new(&matrices, modes_of, factors);
        let added = corrected.as_ref().map(ModalStiffness::stiffness);
        for matrices in [Some(&mut matrices), elastic.as_mut().map(|e| &mut e.rigid)].into_iter().flatten() {
            if let Some(added) = &added {
                matrices.stiffness += added;
            }
            for &(part, factor) in factors {
                match part {
                    Part::Stiffness => matrices.stiffness *= faer::Scale(factor),
                    Part::Mass => matrices.mass *= faer::Scale(factor),
                    _ => {}
                }
            }
        }
        for &(part, factor) in factors.iter().filter(|(part, _)| matches!(part, Part::Stiffness | Part::Mass)) {
            changed.scale_range([0, self.elements.len().saturating_sub(1)], part == Part::Mass, factor);
            if let Some(corrected) = corrected.as_mut().filter(|_| part == Part::Stiffness) {
                corrected.multiply(factor);
            }
        }
        changed.origin.modal_stiffness = corrected;
        (changed.matrices, changed.origin.elastic_supports) = (Some(matrices), elastic);
        changed.correct_damping(factors);
        changed.correct_base_loads(&bare, factors);
        changed
    }

    /// The loads of a moving base of a reduced model, which its matrices do not tell, with its masses multiplied.
    fn correct_base_loads(&mut self, bare: &Self, factors: &[(Part, f64)]) {
        let Some(reduction) = &mut self.origin.reduction else { return };
        for &(part, factor) in factors {
            match part {
                Part::PointMass(row) => {
                    let Some(axis) = self.dofs.get(row).and_then(|dof| dof.direction.axis()) else { continue };
                    let own: f64 = bare.share(part).into_iter().flat_map(|share| share.mass).map(|(_, _, m)| m).sum();
                    reduction.base_loads[axis][row] += (factor - 1.0) * own;
                }
                Part::Mass => reduction.base_loads.iter_mut().flatten().for_each(|load| *load *= factor),
                _ => {}
            }
        }
    }

    /// Factor on the damping that laws of the whole structure give a mode at its natural frequency; 1 where it is not corrected.
    pub fn mode_damping(&self, mode: usize) -> f64 {
        self.origin.damping_of_modes.iter().find(|d| d.mode == mode).map_or(1.0, |d| d.factor)
    }

    /// The same at `omega`, rad/s.
    pub fn mode_damping_at(&self, mode: usize, omega: f64) -> f64 {
        self.origin.damping_of_modes.iter().find(|d| d.mode == mode).map_or(1.0, |d| d.factor_at(omega))
    }

    /// Modes whose damping is corrected.
    pub fn damping_of_modes(&self) -> &[DampingOfMode] {
        &self.origin.damping_of_modes
    }

    /// The corrected stiffness of modes and their couplings; none where none is corrected.
    pub(crate) fn modal_stiffness(&self) -> Option<&ModalStiffness> {
        self.origin.modal_stiffness.as_ref()
    }

    /// Takes the factors on the damping of modes among `factors` beside those that are there, on the modes as they are now.
    fn correct_damping(&mut self, factors: &[(Part, f64)]) {
        let mut all: Vec<(usize, [f64; 2])> =
            self.origin.damping_of_modes.iter().map(|d| (d.mode, [d.factor, d.per_octave])).collect();
        for &(part, factor) in factors {
            let (mode, which) = match part {
                Part::ModeDamping(mode) => (mode, 0),
                Part::ModeDampingPerOctave(mode) => (mode, 1),
                _ => continue,
            };
            let k = all.iter().position(|(own, _)| *own == mode).unwrap_or_else(|| {
                all.push((mode, [1.0; 2]));
                all.len() - 1
            });
            all[k].1[which] *= factor;
        }
        all.retain(|(_, factors)| *factors != [1.0; 2]);
        self.origin.damping_of_modes.clear();
        let (false, Some(matrices)) = (all.is_empty(), &self.matrices) else { return };
        let Ok(modes) = self.modes() else { return };
        let corrected = |(mode, [factor, per_octave]): (usize, [f64; 2])| DampingOfMode {
            mode,
            factor,
            per_octave,
            pattern: modal_pattern(&matrices.mass, modes.shapes.col_as_slice(mode)),
            square: modes.omega[mode].powi(2),
        };
        self.origin.damping_of_modes = all.into_iter().filter(|(mode, _)| *mode < modes.len()).map(corrected).collect();
    }

    fn scale_elements(&mut self, part: Part, factor: f64) {
        match part {
            Part::ElementStiffness(range) => self.scale_range(range, false, factor),
            Part::ElementMass(range) => self.scale_range(range, true, factor),
            _ => {}
        }
    }

    fn scale_range(&mut self, [first, last]: [usize; 2], mass: bool, factor: f64) {
        for element in self.elements.iter_mut().take(last + 1).skip(first) {
            let local = if mass { &mut element.mass } else { &mut element.stiffness };
            *local *= faer::Scale(factor);
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::{chain, short_cantilever};
    use crate::structure::SystemMatrices;

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
}
