//! Supports that give way: a held DOF on a spring, in the matrices of the DOFs that are not held.
//!
//! ```text
//! [K    k_h         ]        [M    m_h ]
//! [k_h^T  k_hh + k_s],       [m_h^T m_hh],       k_s = k_hh f / (1 - f)
//! ```
//!
//! The held DOFs are condensed statically (Guyan 1965), `u_h = -g b^T u`, `b = k_h / k_hh`, `g = 1 - f`; the lower modes then are put
//! right, because the mass of a pinned end moves them by tens of percent: with `Phi` the shapes of the lower modes as they are with
//! the held DOFs, and above them those of the condensed matrices, all at the DOFs that are not held,
//!
//! ```text
//! M' = Phi^-T Phi^-1,      K' = Phi^-T diag(omega^2) Phi^-1
//! ```
//!
//! (SEREP with all modes: O'Callahan, Avitabile and Riemer 1989).

use super::matrices::{Element, SystemMatrices};
use super::share::{HeldDof, Part, Share, add};
use crate::math::eigen::generalised_symmetric;
use dashpot_numerics::RealLu;
use faer::Mat;
use std::sync::OnceLock;

/// Share of the modes that are put right: those above are no modes of the structure, but of its mesh.
const PUT_RIGHT: f64 = 0.75;
/// Least `g` of a support whose held DOF is followed as it moves.
const SOFT: f64 = 1e-3;
/// Largest `g`, of either sign, up to which the matrices are linear in it.
const LINEAR: f64 = 1.1 * SOFT;

/// The supports of a structure that give way.
#[derive(Debug, Clone)]
pub struct ElasticSupports {
    /// Matrices on rigid supports.
    pub(super) rigid: SystemMatrices,
    /// Factors `f` of the held DOFs.
    pub(super) factors: Vec<(HeldDof, f64)>,
    /// Changes of the matrices by the logarithms of the factors of parts, once they were asked for.
    pub(super) slopes: OnceLock<Vec<(Part, Share)>>,
}

impl PartialEq for ElasticSupports {
    fn eq(&self, other: &Self) -> bool {
        self.rigid == other.rigid && self.factors == other.factors
    }
}

impl ElasticSupports {
    /// Held DOFs of `elements` with their factors, on matrices of rigid supports, and the matrices of the DOFs that are not held; none
    /// where all are rigid.
    pub(super) fn new(
        rigid: SystemMatrices,
        factors: Vec<(HeldDof, f64)>,
        elements: &[Element],
    ) -> Option<(Self, SystemMatrices)> {
        let held: Vec<(HeldColumn, f64)> = factors
            .iter()
            .map(|(held, f)| Some((HeldColumn::new(elements, *held)?, 1.0 - f)))
            .collect::<Option<_>>()?;
        if held.iter().all(|(_, g)| *g == 0.0) {
            return None;
        }
        // Those that hardly give way, or are stiffer than rigid, move nothing fast: they are condensed in any case.
        let (mut base, mut condensed) = (rigid.clone(), rigid.clone());
        for (column, g) in &held {
            column.condense(&mut condensed, *g);
            if *g < SOFT {
                column.condense(&mut base, *g);
            }
        }
        let soft: Vec<usize> = (0..held.len()).filter(|&k| held[k].1 >= SOFT).collect();
        // Two held DOFs of one element would be coupled.
        let alone = |k: &usize| !soft.iter().any(|o| o != k && factors[*o].0.element == factors[*k].0.element);
        let springs: Vec<&(HeldColumn, f64)> = soft.iter().map(|&k| &held[k]).collect();
        let found = if soft.iter().all(alone) { put_right(&base, &condensed, &springs) } else { None };
        Some((Self { rigid, factors, slopes: OnceLock::new() }, found.unwrap_or(condensed)))
    }

    /// Factors with one more, multiplied with that of the same DOF where there is one.
    pub(super) fn add(factors: &mut Vec<(HeldDof, f64)>, held: HeldDof, factor: f64) {
        match factors.iter_mut().find(|(own, _)| *own == held) {
            Some((_, own)) => *own *= factor,
            None => factors.push((held, factor)),
        }
    }

    /// Factor of a support of these.
    pub(super) fn factor(&self, held: HeldDof) -> Option<f64> {
        self.factors.iter().find(|(own, _)| *own == held).map(|(_, factor)| *factor)
    }

    /// The parts whose shares are no sums over elements, because held DOFs move with them: supports that are not all but rigid, and the
    /// elements next to them.
    pub(super) fn parts(&self) -> Vec<Part> {
        let moving = self.factors.iter().filter(|(_, factor)| (1.0 - factor).abs() > LINEAR).map(|(held, _)| *held);
        let mut parts: Vec<Part> = moving
            .flat_map(|held| {
                let element = [held.element; 2];
                [Part::Support(held), Part::ElementStiffness(element), Part::ElementMass(element)]
            })
            .collect();
        parts.sort_unstable();
        parts.dedup();
        parts
    }
}

/// What couples a held DOF with those of its element that are not held.
pub(super) struct HeldColumn {
    /// Row with its entries of stiffness and mass.
    rows: Vec<(usize, f64, f64)>,
    stiffness: f64,
    mass: f64,
}

impl HeldColumn {
    pub(super) fn new(elements: &[Element], held: HeldDof) -> Option<Self> {
        let element = elements.get(held.element)?;
        let (k, m, h) = (&element.stiffness, &element.mass, held.dof);
        let entry = |(i, row): (usize, &Option<usize>)| row.map(|row| (row, k[(i, h)], m[(i, h)]));
        let rows = element.dofs.iter().enumerate().filter_map(entry).collect();
        Some(Self { rows, stiffness: k[(h, h)], mass: m[(h, h)] })
    }

    /// What a rigid support adds to one that gives way, to first order in `g`: `k_h k_h^T / k_hh` and `m_h b^T + b m_h^T`.
    pub(super) fn share(&self) -> Share {
        let mut share = Share::default();
        for &(i, ki, mi) in &self.rows {
            for &(j, kj, mj) in &self.rows {
                share.stiffness.push((i, j, ki * kj / self.stiffness));
                share.mass.push((i, j, (mi * kj + ki * mj) / self.stiffness));
            }
        }
        share
    }

    /// Condenses the DOF statically: `K - g k_h k_h^T / k_hh`, `M - g (m_h b^T + b m_h^T) + g^2 m_hh b b^T`.
    fn condense(&self, matrices: &mut SystemMatrices, g: f64) {
        let Share { stiffness, mass } = self.share();
        add(&mut matrices.stiffness, &stiffness, -g);
        add(&mut matrices.mass, &mass, -g);
        let own = self.mass / (self.stiffness * self.stiffness);
        for &(i, ki, _) in &self.rows {
            for &(j, kj, _) in &self.rows {
                matrices.mass[(i, j)] += g * g * own * ki * kj;
            }
        }
    }
}

/// The matrices with the held DOFs behind the others, each on its spring: `k_hh + k_s = k_hh / g`.
fn with_held(matrices: &SystemMatrices, held: &[&(HeldColumn, f64)]) -> SystemMatrices {
    let n = matrices.mass.ncols();
    let grown = |own: &Mat<f64>| {
        Mat::from_fn(n + held.len(), n + held.len(), |i, j| if i < n && j < n { own[(i, j)] } else { 0.0 })
    };
    let (mut stiffness, mut mass) = (grown(&matrices.stiffness), grown(&matrices.mass));
    for (at, (column, g)) in (n..).zip(held) {
        stiffness[(at, at)] = column.stiffness / g;
        mass[(at, at)] = column.mass;
        for &(row, k, m) in &column.rows {
            for (i, j) in [(row, at), (at, row)] {
                stiffness[(i, j)] = k;
                mass[(i, j)] = m;
            }
        }
    }
    SystemMatrices { mass, stiffness }
}

/// The `condensed` matrices with the lower modes of those with the held DOFs; `None` where they cannot be had.
fn put_right(base: &SystemMatrices, condensed: &SystemMatrices, held: &[&(HeldColumn, f64)]) -> Option<SystemMatrices> {
    if held.is_empty() {
        return None;
    }
    let modes_of = |m: &SystemMatrices| generalised_symmetric(m.stiffness.as_ref(), m.mass.as_ref()).ok();
    let (own, exact) = (modes_of(condensed)?, modes_of(&with_held(base, held))?);
    let n = own.values.len();
    let lower = (PUT_RIGHT * n as f64).ceil() as usize;
    let shapes = Mat::from_fn(n, n, |i, r| if r < lower { exact.vectors[(i, r)] } else { own.vectors[(i, r)] });
    let square = |r: usize| if r < lower { exact.values[r] } else { own.values[r] };
    let inverse = RealLu::new(shapes.as_ref()).solve(Mat::<f64>::identity(n, n).as_ref());
    let product = |weight: &dyn Fn(usize) -> f64| {
        let weighted = Mat::from_fn(n, n, |r, j| weight(r) * inverse[(r, j)]);
        let product = inverse.transpose() * &weighted;
        Mat::from_fn(n, n, |i, j| 0.5 * (product[(i, j)] + product[(j, i)]))
    };
    let found = SystemMatrices { mass: product(&|_| 1.0), stiffness: product(&square) };
    let finite = |matrix: &Mat<f64>| matrix.col_iter().all(|c| c.iter().all(|x| x.is_finite()));
    (finite(&found.mass) && finite(&found.stiffness)).then_some(found)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::cantilever_parameters;
    use crate::structure::beam::{BeamParameters, Supports};
    use crate::structure::modes::modes;
    use crate::structure::share::Triplets;

    /// Natural frequencies with the DOFs `free` of the beam without supports, those of `springs` on springs to the ground.
    fn on_springs(beam: &BeamParameters, held: &[usize], springs: &[(usize, f64)]) -> Vec<f64> {
        let whole = BeamParameters { supports: Supports::FreeFree, ..beam.clone() }.build(&[]).unwrap();
        let free: Vec<usize> = (0..whole.len()).filter(|i| !held.contains(i)).collect();
        let SystemMatrices { mass, stiffness } = whole.matrices().unwrap();
        let free_part = |own: &Mat<f64>| Mat::from_fn(free.len(), free.len(), |i, j| own[(free[i], free[j])]);
        let (mass, mut stiffness) = (free_part(mass), free_part(stiffness));
        for (dof, spring) in springs {
            let row = free.iter().position(|i| i == dof).unwrap();
            stiffness[(row, row)] += spring;
        }
        modes(&SystemMatrices { mass, stiffness }).unwrap().omega
    }

    fn assert_same(updated: &[f64], exact: &[f64], count: usize) {
        for mode in 0..count {
            let error = updated[mode] / exact[mode] - 1.0;
            assert!(error.abs() < 1e-7, "mode {mode}: {error}");
        }
    }

    #[test]
    fn a_clamp_that_gives_way_is_a_rotation_on_a_spring() {
        let beam = BeamParameters { length: 0.5, ..cantilever_parameters(8) };
        let model = beam.build(&[]).unwrap();
        let [held] = model.supports()[..] else { panic!("one support") };
        assert_eq!((held, model.held_node(held)), (HeldDof { element: 0, dof: 1 }, Some("0")));
        let k = model.stiffness_at(held).unwrap();
        for factor in [0.9, 0.4, 0.05] {
            let updated = model.with_factors(&[(Part::Support(held), factor)]).modes().unwrap().omega;
            assert_same(&updated, &on_springs(&beam, &[0], &[(1, k * factor / (1.0 - factor))]), 12);
        }
    }

    /// The mass of a pinned end, which static condensation alone puts at its neighbour, moves the upper modes by tens of percent.
    #[test]
    fn pins_that_give_way_are_translations_on_springs() {
        let beam = BeamParameters { supports: Supports::PinnedPinned, ..cantilever_parameters(6) };
        let model = beam.build(&[]).unwrap();
        let held = model.supports();
        let k = model.stiffness_at(held[0]).unwrap();
        let spring = |f: f64| k * f / (1.0 - f);
        let factors: Vec<(Part, f64)> = held.iter().map(|h| (Part::Support(*h), 0.25)).collect();
        let both = model.with_factors(&factors);
        let exact = on_springs(&beam, &[], &[(0, spring(0.25)), (12, spring(0.25))]);
        assert_same(&both.modes().unwrap().omega, &exact, 9);
        // One after the other, and with all of the beam softer and heavier.
        let first = model.with_factors(&factors[..1]);
        assert_same(&first.with_factors(&factors[1..]).modes().unwrap().omega, &exact, 9);
        let other = first.with_factors(&[factors[1], (Part::Stiffness, 0.9), (Part::Mass, 1.1)]);
        let softer: Vec<f64> = exact.iter().map(|w| w * (0.9_f64 / 1.1).sqrt()).collect();
        assert_same(&other.modes().unwrap().omega, &softer, 9);
        let stiffer = first.with_factors(&[(Part::ElementStiffness([0, 5]), 1.2), factors[1]]);
        let harder: Vec<f64> = exact.iter().map(|w| w * 1.2_f64.sqrt()).collect();
        assert_same(&stiffer.modes().unwrap().omega, &harder, 9);
    }

    /// Half of a support twice is a quarter of it, and its share is the derivative by the logarithm of the factor.
    #[test]
    fn factors_are_multiplied_and_shares_are_derivatives() {
        let beam = BeamParameters { supports: Supports::PinnedPinned, ..cantilever_parameters(5) };
        let model = beam.build(&[]).unwrap();
        let support = Part::Support(model.supports()[1]);
        let both = model.with_factors(&[(support, 0.5)]);
        let (twice, quarter) = (both.with_factors(&[(support, 0.5)]), model.with_factors(&[(support, 0.25)]));
        let [twice, quarter] = [&twice, &quarter].map(|s| s.matrices().unwrap().clone());
        assert!((&twice.mass - &quarter.mass).norm_max() < 1e-9 * quarter.mass.norm_max());
        assert!((&twice.stiffness - &quarter.stiffness).norm_max() < 1e-9 * quarter.stiffness.norm_max());
        // Of the elements next to it as well, whose held end moves.
        for part in [support, Part::ElementStiffness([3, 4]), Part::ElementMass([4, 4])] {
            let share = both.share(part).unwrap();
            let step = 1e-3;
            let [more, less] =
                [step, -step].map(|by: f64| both.with_factors(&[(part, by.exp())]).modes().unwrap().omega);
            let modes = both.modes().unwrap();
            let along = |entries: &Triplets, r: usize| -> f64 {
                entries.iter().map(|&(i, j, v)| modes.shapes[(i, r)] * v * modes.shapes[(j, r)]).sum()
            };
            for r in 0..6 {
                let square = modes.omega[r].powi(2);
                let told = along(&share.stiffness, r) - square * along(&share.mass, r);
                let slope = (more[r].powi(2) - less[r].powi(2)) / (2.0 * step);
                assert!((told - slope).abs() < 1e-4 * square, "{part:?} mode {r}: {told} {slope}");
            }
        }
    }

    /// Modes that are put right are no sum of parts: the shapes move with the support and the element next to it as well.
    #[test]
    fn shares_next_to_a_support_that_gives_way_are_derivatives_of_the_matrices() {
        let model = BeamParameters { supports: Supports::PinnedPinned, ..cantilever_parameters(5) }.build(&[]).unwrap();
        let support = Part::Support(model.supports()[1]);
        for factor in [0.5, 1.2] {
            let yielding = model.with_factors(&[(support, factor)]);
            for part in [support, Part::ElementStiffness([4, 4]), Part::ElementMass([4, 4])] {
                let (share, step) = (yielding.share(part).unwrap(), 1e-3);
                let [more, less] =
                    [step, -step].map(|by: f64| yielding.with_factors(&[(part, by.exp())]).matrices().unwrap().clone());
                let pairs =
                    [(&share.stiffness, &more.stiffness, &less.stiffness), (&share.mass, &more.mass, &less.mass)];
                for (told, more, less) in pairs {
                    let mut left = (more - less) * faer::Scale(0.5 / step);
                    let allowed = 1e-3 * left.norm_max() + 1e-9 * more.norm_max();
                    add(&mut left, told, -1.0);
                    assert!(left.norm_max() < allowed, "{factor} {part:?}: {} of {allowed}", left.norm_max());
                }
            }
        }
    }

    /// A support that is stiffer than rigid is no spring: what is linear in its factor is kept, and joins what is softer.
    #[test]
    fn factors_beyond_rigid_are_linear() {
        let model = cantilever_parameters(4).build(&[]).unwrap();
        let support = Part::Support(model.supports()[0]);
        let [below, rigid, above] =
            [0.999, 1.0, 1.001].map(|f| model.with_factors(&[(support, f)]).modes().unwrap().omega);
        for r in 0..3 {
            let [up, down] = [above[r] - rigid[r], rigid[r] - below[r]];
            assert!(up > 0.0 && (up / down - 1.0).abs() < 0.02, "{up} {down}");
        }
    }
}
