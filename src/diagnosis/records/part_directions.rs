//! Errors of the parts of a structure - springs, masses, groups of elements - as the few directions that its followed modes
//! show.
//!
//! ```text
//! theta_p = s sum_k V_pk z_k,    z_k ~ N(0, 1),    J_(rs),p = s phi_r^T K_p phi_s / (omega_r omega_s)  and  s phi_r^T M_p phi_s
//! ```
//!
//! `theta_p` is the logarithm of the factor on a part, `s` its prior deviation, `V` the right singular vectors of `J`. Modes of a
//! structure whose parts are independently wrong are wrong together, in frequency and shape (Friswell and Mottershead 1995, chapter
//! 8); what moves no followed mode is no unknown of a record.

use crate::diagnosis::updating::parts::parts;
use crate::math::eigen::symmetric;
use crate::structure::modes::Modes;
use crate::structure::share::{Share, Triplets};
use crate::structure::{Part, Structure};
use dashpot_numerics::Cholesky;
use faer::Mat;

/// Prior deviation of the logarithm of a part.
pub(super) const PART: f64 = 0.02;
/// Relative change of the modal matrices by one deviation below which a direction is left out, and most directions beyond the
/// number of modes.
const LEAST: f64 = 1e-3;
const BEYOND: usize = 2;
/// Prior deviation of the logarithm of all stiffness.
pub(super) const ALL: f64 = 0.03;
/// Prior deviation of the logarithm of a mode's stiffness, and of its shape at a sensor, where errors of parts stand beside them:
/// little but gains is left.
pub(super) const MODE: f64 = 0.01;

/// Parts with the directions in which they are wrong.
#[derive(Debug, Clone, Default)]
pub(super) struct PartDirections {
    /// The parts.
    parts: Vec<Part>,
    /// Logarithm of the factor on each part by one deviation of each direction, `[direction][part]`.
    pub weights: Vec<Vec<f64>>,
    /// Logarithm of the factor on the stiffness of each kept mode by the same, to first order: a mode is the stiffer for a part,
    /// `phi^T K_p phi / omega^2`, and the softer for its mass, `phi^T M_p phi`.
    by_mode: Vec<Vec<f64>>,
}

impl PartDirections {
    /// Of the first `kept` modes; none where these are one or the structure shows no parts. Supports that give way are no part here: they
    /// move modes in ways that those on rigid supports do not show; corrections of modes and shapes stand for them.
    pub(super) fn new(structure: &Structure, modes: &Modes, kept: usize) -> Self {
        let mut list = parts(structure, &[]);
        list.retain(|part| !matches!(part, Part::Stiffness | Part::Mass | Part::Mode(_) | Part::Support(_)));
        if kept < 2 || list.is_empty() {
            return Self::default();
        }
        let changes: Vec<ModalChange> =
            list.iter().map(|part| ModalChange::new(structure.share(*part).unwrap_or_default(), modes, kept)).collect();
        let columns: Vec<Vec<f64>> = changes.iter().map(ModalChange::column).collect();
        let products = Mat::from_fn(list.len(), list.len(), |p, q| {
            columns[p].iter().zip(&columns[q]).map(|(a, b)| a * b).sum::<f64>()
        });
        let Ok(eigen) = symmetric(products.as_ref()) else { return Self::default() };
        let mut order: Vec<usize> = (0..list.len()).filter(|&k| eigen.values[k] > LEAST * LEAST).collect();
        order.sort_by(|&a, &b| eigen.values[b].total_cmp(&eigen.values[a]));
        order.truncate(kept + BEYOND);
        let weight = |k: usize, p: usize| PART * eigen.vectors[(p, k)];
        let weights: Vec<Vec<f64>> = order.iter().map(|&k| (0..list.len()).map(|p| weight(k, p)).collect()).collect();
        let stiffer = |weights: &Vec<f64>, r: usize| {
            let by_part = |change: &ModalChange| change.stiffness[(r, r)] - change.mass[(r, r)];
            weights.iter().zip(&changes).map(|(w, change)| w * by_part(change)).sum::<f64>()
        };
        let by_mode = weights.iter().map(|w| (0..kept).map(|r| stiffer(w, r)).collect()).collect();
        Self { parts: list, weights, by_mode }
    }

    /// Number of directions.
    pub(super) fn len(&self) -> usize {
        self.weights.len()
    }

    /// Whether there are none.
    pub(super) fn is_empty(&self) -> bool {
        self.weights.is_empty()
    }

    /// Logarithms of the factors on the parts, of the deviations `z` along the directions.
    pub(super) fn logarithms(&self, z: &[f64]) -> Vec<(Part, f64)> {
        let logarithm = |(p, part): (usize, &Part)| (*part, self.weights.iter().zip(z).map(|(w, z)| w[p] * z).sum());
        self.parts.iter().enumerate().map(logarithm).collect()
    }

    /// Deviations of these logarithms, of those of the directions; a part that no direction moves stays as uncertain as it was.
    pub(super) fn deviations(&self, own: &[f64]) -> Vec<f64> {
        let deviation_of_part = |p: usize| {
            let pairs = || self.weights.iter().map(|w| w[p]).zip(own);
            let known: f64 = pairs().map(|(w, _)| w * w).sum();
            let told: f64 = pairs().map(|(w, d)| (w * d).powi(2)).sum();
            ((PART.powi(2) - known).max(0.0) + told).sqrt()
        };
        (0..self.parts.len()).map(deviation_of_part).collect()
    }

    /// Logarithms of the factors on the stiffness of `kept` modes that stand for the deviations `z`, to first order.
    pub(super) fn stiffness_of_modes(&self, z: &[f64], kept: usize) -> Vec<f64> {
        (0..kept).map(|r| self.by_mode.iter().zip(z).map(|(by, z)| by[r] * z).sum()).collect()
    }

    /// Logarithm of the factor on all stiffness, and deviations along the directions, that most probably stand for these logarithms
    /// on the stiffness of the modes; `None` where there are no directions.
    pub(super) fn explaining(&self, modes: &[f64]) -> Option<(f64, Vec<f64>)> {
        if self.is_empty() {
            return None;
        }
        let count = self.len() + 1;
        let slope = |r: usize, k: usize| if k == 0 { ALL } else { self.by_mode[k - 1][r] };
        let sum = |term: &dyn Fn(usize) -> f64| (0..modes.len()).map(term).sum::<f64>() / (MODE * MODE);
        let products =
            Mat::from_fn(count, count, |i, j| sum(&|r| slope(r, i) * slope(r, j)) + f64::from(u8::from(i == j)));
        let against = Mat::from_fn(count, 1, |i, _| sum(&|r| slope(r, i) * modes[r]));
        let z = Cholesky::new(products.as_ref())?.solve(against.as_ref());
        Some((ALL * z[(0, 0)], (1..count).map(|k| z[(k, 0)]).collect()))
    }
}

/// Relative change of the modal matrices by the logarithm of the factor on a part, kept x kept.
struct ModalChange {
    stiffness: Mat<f64>,
    mass: Mat<f64>,
}

impl ModalChange {
    fn new(share: Share, modes: &Modes, kept: usize) -> Self {
        let lowest = modes.omega.iter().copied().find(|w| *w > 0.0).unwrap_or(1.0);
        let along = |entries: &Triplets, r: usize, s: usize| -> f64 {
            entries.iter().map(|&(i, j, value)| modes.shapes[(i, r)] * value * modes.shapes[(j, s)]).sum()
        };
        let elastic = |r: usize, s: usize| modes.omega[r].max(lowest) * modes.omega[s].max(lowest);
        Self {
            stiffness: Mat::from_fn(kept, kept, |r, s| along(&share.stiffness, r, s) / elastic(r, s)),
            mass: Mat::from_fn(kept, kept, |r, s| along(&share.mass, r, s)),
        }
    }

    /// Entries by one prior deviation; those of pairs of modes count twice.
    fn column(&self) -> Vec<f64> {
        let kept = self.mass.ncols();
        let pairs = (0..kept).flat_map(|r| (0..=r).map(move |s| (r, s)));
        let weighted = |(r, s): (usize, usize)| {
            let times = PART * if r == s { 1.0 } else { 2.0_f64.sqrt() };
            [times * self.stiffness[(r, s)], times * self.mass[(r, s)]]
        };
        pairs.flat_map(weighted).collect()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::structure::chain::ChainParameters;

    fn chain() -> Structure {
        let chain = ChainParameters {
            masses: vec![1.0, 2.0, 1.5, 1.0, 3.0, 2.0],
            ground_stiffness: vec![4e3, 0.0, 0.0, 1e3, 0.0, 2e3],
            coupling_stiffness: vec![6e3, 5e3, 8e3, 4e3, 7e3],
        };
        chain.build(&[]).unwrap()
    }

    fn moved(structure: &Structure, directions: &PartDirections, z: &[f64]) -> Structure {
        let factors: Vec<(Part, f64)> = directions.logarithms(z).iter().map(|(part, v)| (*part, v.exp())).collect();
        structure.with_factors(&factors)
    }

    /// First-order changes of the modes against those of the structure with its parts multiplied.
    #[test]
    fn modes_move_as_the_parts_along_a_direction() {
        let structure = chain();
        let modes = structure.modes().unwrap();
        let directions = PartDirections::new(&structure, &modes, 4);
        assert!((4..=6).contains(&directions.len()), "{}", directions.len());
        for k in 0..directions.len() {
            let z: Vec<f64> = (0..directions.len()).map(|j| if j == k { 0.01 } else { 0.0 }).collect();
            let after = moved(&structure, &directions, &z).modes().unwrap();
            for (r, expected) in directions.stiffness_of_modes(&z, 4).into_iter().enumerate() {
                let found = 2.0 * (after.omega[r] / modes.omega[r]).ln();
                assert!((found - expected).abs() < 2e-6, "direction {k}, mode {r}: {found:.2e} for {expected:.2e}");
            }
        }
    }

    /// What explains the frequencies of wrong parts is the most probable: no other deviations cost less.
    #[test]
    fn frequencies_of_wrong_parts_are_explained_by_the_likeliest_directions() {
        let structure = chain();
        let modes = structure.modes().unwrap();
        let directions = PartDirections::new(&structure, &modes, 4);
        let wrong = [(Part::Coupling([1, 2]), 0.95), (Part::PointMass(4), 1.05)];
        let after = structure.with_factors(&wrong).modes().unwrap();
        let shifts: Vec<f64> = (0..4).map(|r| 2.0 * (after.omega[r] / modes.omega[r]).ln()).collect();
        let cost = |all: f64, z: &[f64]| {
            let left = shifts.iter().zip(directions.stiffness_of_modes(z, 4)).map(|(s, by)| s - all - by);
            left.map(|l| (l / MODE).powi(2)).sum::<f64>() + z.iter().map(|z| z * z).sum::<f64>() + (all / ALL).powi(2)
        };
        let (all, z) = directions.explaining(&shifts).unwrap();
        let least = cost(all, &z);
        assert!(least < cost(0.0, &vec![0.0; z.len()]), "{least}");
        for k in 0..=z.len() {
            for by in [-0.05, 0.05] {
                let mut other = z.clone();
                other.iter_mut().skip(k).take(1).for_each(|z| *z += by);
                let all = if k == z.len() { all + by * ALL } else { all };
                assert!(cost(all, &other) > least, "{k} by {by}");
            }
        }
    }

    /// What no direction shows keeps its prior deviation; what they all tell is told.
    #[test]
    fn parts_that_no_mode_shows_stay_uncertain() {
        let structure = chain();
        let directions = PartDirections::new(&structure, &structure.modes().unwrap(), 4);
        let unknown = directions.deviations(&vec![1.0; directions.len()]);
        let told = directions.deviations(&vec![0.0; directions.len()]);
        for (before, after) in unknown.into_iter().zip(told) {
            assert!((before / PART - 1.0).abs() < 1e-9, "{before}");
            assert!(after <= before);
        }
    }
}
