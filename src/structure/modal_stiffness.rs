//! Corrected stiffness of undamped modes and of their couplings: what errors of single elements do to a model of which no element is
//! known by itself.
//!
//! ```text
//! K' = K + P (exp(E) - I) P^T,      P = M [omega_1 phi_1, omega_2 phi_2, ...]
//! ```
//!
//! `E_rr` is the logarithm of the factor on the stiffness of mode `r`, `E_rs` that of the coupling of modes `r` and `s`: to first order
//! `phi_r^T K' phi_s = E_rs omega_r omega_s`. The exponential keeps the stiffness positive definite, however large the corrections
//! (as generic elements have their modal stiffness for parameters: Gladwell and Ahmadian 1995, Mechanical Systems and Signal Processing 9, 601).

use super::matrices::SystemMatrices;
use super::mode_damping::modal_pattern;
use super::share::Part;
use crate::math::eigen::{SymmetricEigen, symmetric};
use faer::{Mat, c64};

/// Modes whose stiffness is corrected, and by what: in the eigenvectors `V` of `E`, of eigenvalues `a`.
#[derive(Debug, Clone, PartialEq)]
pub struct ModalStiffness {
    /// Numbers of the modes, from 0.
    modes: Vec<usize>,
    /// `P V`, square root of N/m.
    patterns: Mat<f64>,
    /// Eigenvalues `a` of `E`.
    values: Vec<f64>,
    /// Eigenvectors `V` of `E`, columns.
    vectors: Mat<f64>,
    /// `(e^a - e^b) / (a - b)` of each two eigenvalues.
    divided: Mat<f64>,
}

/// The two modes of a part that corrects their stiffness, twice the same for that of one.
fn pair(part: Part) -> Option<[usize; 2]> {
    match part {
        Part::Mode(mode) => Some([mode; 2]),
        Part::ModeCoupling(pair) => Some(pair),
        _ => None,
    }
}

impl ModalStiffness {
    /// Of the modes among `factors` of a structure with these matrices, whose circular frequencies (rad/s) and mass-normalised shapes are
    /// `modes_of`; none where no factor on a mode differs from 1.
    pub(super) fn new(
        matrices: &SystemMatrices,
        modes_of: impl FnOnce() -> Option<(Vec<f64>, Mat<f64>)>,
        factors: &[(Part, f64)],
    ) -> Option<Self> {
        let pairs: Vec<([usize; 2], f64)> =
            factors.iter().filter_map(|&(part, factor)| Some((pair(part)?, factor.ln()))).collect();
        if pairs.iter().all(|(_, v)| *v == 0.0) {
            return None;
        }
        let (omega, shapes) = modes_of()?;
        let mut modes: Vec<usize> = pairs.iter().flat_map(|(pair, _)| *pair).filter(|r| *r < omega.len()).collect();
        modes.sort_unstable();
        modes.dedup();
        let place = |mode: usize| modes.iter().position(|own| *own == mode);
        let mut logarithms = Mat::zeros(modes.len(), modes.len());
        for ([r, s], v) in &pairs {
            let (Some(a), Some(b)) = (place(*r), place(*s)) else { continue };
            logarithms[(a, b)] += v;
            if a != b {
                logarithms[(b, a)] += v;
            }
        }
        let eigen = symmetric(logarithms.as_ref()).ok()?;
        let pattern = |&r: &usize| modal_pattern(&matrices.mass, shapes.col_as_slice(r));
        let columns: Vec<Vec<f64>> = modes.iter().map(pattern).collect();
        let patterns = Mat::from_fn(matrices.mass.nrows(), modes.len(), |i, a| columns[a][i] * omega[modes[a]]);
        let SymmetricEigen { values, vectors } = eigen;
        let divided = Mat::from_fn(modes.len(), modes.len(), |a, b| divided_difference(values[a], values[b]));
        Some(Self { modes, patterns: patterns * &vectors, values, vectors, divided })
    }

    /// `P (exp(E) - I) P^T`, N/m.
    pub(super) fn stiffness(&self) -> Mat<f64> {
        let along = &self.patterns;
        let scaled = Mat::from_fn(along.nrows(), along.ncols(), |i, a| along[(i, a)] * self.values[a].exp_m1());
        scaled * along.transpose()
    }

    /// The same where all stiffness is multiplied by `factor`.
    pub(super) fn multiply(&mut self, factor: f64) {
        self.patterns *= faer::Scale(factor.sqrt());
    }

    /// Derivative of `K' x` (N) by `E_rs`, of the motion `x` (m, by DOF); none where one of the modes is not corrected.
    ///
    /// In the eigenvectors of `E` the derivative of the exponential along `X` is `x_ab (e^a - e^b) / (a - b)` (Daleckii and Krein).
    pub(crate) fn change(&self, [r, s]: [usize; 2], x: &[c64]) -> Option<Vec<c64>> {
        let place = |mode: usize| self.modes.iter().position(|own| *own == mode);
        let (first, second) = (place(r)?, place(s)?);
        let (v, count) = (&self.vectors, self.values.len());
        let along = |a: usize, b: usize| {
            let product = v[(first, a)] * v[(second, b)];
            if first == second { product } else { product + v[(second, a)] * v[(first, b)] }
        };
        let column = |a: usize| self.patterns.col_as_slice(a);
        let modal: Vec<c64> = (0..count).map(|a| column(a).iter().zip(x).map(|(p, x)| *x * *p).sum()).collect();
        let mut change = vec![c64::new(0.0, 0.0); x.len()];
        for a in 0..count {
            let force: c64 = (0..count).map(|b| modal[b] * (along(a, b) * self.divided[(a, b)])).sum();
            change.iter_mut().zip(column(a)).for_each(|(sum, p)| *sum += force * *p);
        }
        Some(change)
    }
}

/// `(e^a - e^b) / (a - b)`.
fn divided_difference(a: f64, b: f64) -> f64 {
    let half = 0.5 * (a - b);
    let quotient = if half.abs() < 1e-6 { 1.0 } else { half.sinh() / half };
    (0.5 * (a + b)).exp() * quotient
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::short_cantilever;

    /// A coupling alone: in the modes of the structure before, `phi_r^T K' phi_s = sinh(v) omega_r omega_s`.
    #[test]
    fn a_coupling_joins_two_modes() {
        let structure = short_cantilever(5);
        let (modes, v) = (structure.modes().unwrap(), 0.1_f64);
        let coupled = structure.with_factors(&[(Part::ModeCoupling([0, 2]), v.exp())]);
        let modal = modes.shapes.transpose() * &coupled.matrices().unwrap().stiffness * &modes.shapes;
        let relative = |r: usize, s: usize| modal[(r, s)] / (modes.omega[r] * modes.omega[s]);
        assert!((relative(0, 2) - v.sinh()).abs() < 1e-7, "{}", relative(0, 2));
        assert!((relative(0, 0) - v.cosh()).abs() < 1e-7 && (relative(1, 1) - 1.0).abs() < 1e-7);
        assert!(relative(0, 1).abs() < 1e-7);
    }

    /// However large the couplings, no mode loses its stiffness.
    #[test]
    fn stiffness_stays_positive() {
        let pairs = [[0, 1], [0, 2], [1, 2], [0, 3], [1, 3]];
        let factors: Vec<(Part, f64)> = pairs.iter().map(|pair| (Part::ModeCoupling(*pair), 5.0)).collect();
        let modes = short_cantilever(5).with_factors(&factors).modes().unwrap();
        assert!(modes.omega.iter().all(|w| *w > 0.0));
    }

    /// Against differences, at corrections of several modes at once.
    #[test]
    fn derivatives_are_those_of_differences() {
        let structure = short_cantilever(4);
        let parts = [Part::Mode(0), Part::Mode(1), Part::ModeCoupling([0, 1]), Part::ModeCoupling([0, 2])];
        let values = [0.1, -0.05, 0.2, -0.15];
        let stiffness = |values: &[f64]| {
            let factors: Vec<(Part, f64)> = parts.iter().zip(values).map(|(p, v)| (*p, v.exp())).collect();
            structure.with_factors(&[&[(Part::Stiffness, 1.3)], factors.as_slice()].concat())
        };
        let corrected = stiffness(&values);
        let n = structure.len();
        for (k, part) in parts.iter().enumerate() {
            let moved = |step: f64| {
                let mut values = values;
                values[k] += step;
                stiffness(&values).matrices().unwrap().stiffness.clone()
            };
            let difference = (moved(1e-5) - moved(-1e-5)) * faer::Scale(0.5e5);
            for column in 0..n {
                let unit: Vec<c64> = (0..n).map(|i| c64::new(if i == column { 1.0 } else { 0.0 }, 0.0)).collect();
                let own = corrected.modal_stiffness().unwrap().change(pair(*part).unwrap(), &unit).unwrap();
                for (i, own) in own.iter().enumerate() {
                    let error = (own.re - difference[(i, column)]).abs() / difference.norm_max();
                    assert!(error < 1e-6, "{part:?}: {error}");
                }
            }
        }
    }
}
