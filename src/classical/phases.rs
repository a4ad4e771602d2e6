//! Whether scaled complex modes are those of viscous damping, by the phases of their residues.
//!
//! ```text
//! viscous      H = sum phi phi^T / (s^2 + 2 zeta w s + w^2)      psi psi^T = phi phi^T / (2 i Im lambda)
//! hysteretic   H = sum phi phi^T / (s^2 + w^2 (1 + i eta))       psi psi^T = phi phi^T / (2 lambda),   lambda = i w sqrt(1 + i eta)
//! ```
//!
//! so that `t = -arg(2 i Im lambda  psi^T M psi) / zeta` is 0 for viscous and 1 for hysteretic damping, `zeta = eta / 2`. Formulas that
//! are exact for viscous modes (3.69, 3.91) take `C` from that phase and from the real part of the pole in equal parts: a phase that
//! is off by `t zeta` changes their damping ratios by about half of `t`, as relative error.

use super::data::{Damping, ModalData};
use super::linear::column;
use crate::math::statistics::median;
use faer::{MatRef, c64};

/// `t` from which on it is said: ratios are then off by a quarter.
const OFF: f64 = 0.5;

/// `damping` with a remark where the phases of `modes` are not those of viscous damping; `m` is the mass matrix, kg.
pub(super) fn remarked(mut damping: Damping, m: MatRef<'_, f64>, modes: &ModalData) -> Damping {
    let turns: Vec<f64> = (0..modes.len()).filter_map(|p| turn(m, modes, p)).collect();
    let sizes: Vec<f64> = turns.iter().map(|t| t.abs()).collect();
    if turns.is_empty() || median(&sizes) < OFF {
        return damping;
    }
    let (t, off) = (median(&turns), (50.0 * median(&sizes)).min(100.0));
    damping.notes.push(if (t - 1.0).abs() < OFF {
        format!("the phases of the modes are those of hysteretic damping, this method assumes viscous: its ratios may be off by {off:.0} %")
    } else {
        format!("the phases of the modes are not those of viscous damping, which this method assumes: its ratios may be off by {off:.0} %")
    });
    damping
}

/// `t` of mode `p`; `None` without damping.
fn turn(m: MatRef<'_, f64>, modes: &ModalData, p: usize) -> Option<f64> {
    let (psi, n) = (column(modes.shapes.as_ref(), p), m.nrows());
    let row = |i: usize| (0..n).map(|j| psi[j] * m[(i, j)]).sum::<c64>();
    let modal: c64 = (0..n).map(|i| psi[i] * row(i)).sum();
    let zeta = modes.damping_ratio(p);
    (zeta > 0.0).then(|| -(c64::new(0.0, 2.0 * modes.poles[p].im) * modal).arg() / zeta)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::classical::lancaster::lancaster;
    use faer::Mat;

    /// Two modes of two masses with their poles and the squares of what scales their real shapes.
    fn modes(scaled: [(c64, c64); 2]) -> (Mat<f64>, ModalData) {
        let mass = Mat::from_fn(2, 2, |i, j| if i == j { 2.0 } else { 0.0 });
        let shape = |i: usize, p: usize| if i == 1 && p == 1 { -0.5 } else { 0.5 };
        let shapes = Mat::from_fn(2, 2, |i, p| scaled[p].1.sqrt() * shape(i, p));
        (mass, ModalData { poles: scaled.iter().map(|(pole, _)| *pole).collect(), shapes, scaled: true })
    }

    fn notes(scaled: [(c64, c64); 2]) -> Vec<String> {
        let (mass, modes) = modes(scaled);
        remarked(lancaster(mass.as_ref(), &modes).expect("scaled modes"), mass.as_ref(), &modes).notes
    }

    #[test]
    fn phases_of_hysteretic_modes_are_told_and_those_of_viscous_modes_are_not() {
        let i = c64::new(0.0, 1.0);
        let viscous = |omega: f64, zeta: f64| {
            let pole = omega * c64::new(-zeta, (1.0 - zeta * zeta).sqrt());
            (pole, 1.0 / (2.0 * i * pole.im))
        };
        let hysteretic = |omega: f64, eta: f64| {
            let pole = i * omega * c64::new(1.0, eta).sqrt();
            (pole, 1.0 / (2.0 * pole))
        };
        assert!(notes([viscous(10.0, 0.02), viscous(30.0, 0.01)]).is_empty());
        let said = notes([hysteretic(10.0, 0.04), hysteretic(30.0, 0.02)]);
        assert_eq!(said.len(), 1);
        assert!(said[0].contains("hysteretic") && said[0].ends_with("may be off by 50 %"), "{}", said[0]);
    }

    /// Lancaster's ratio of a hysteretic mode is half of it: what the remark says.
    #[test]
    fn the_ratio_that_is_doubted_is_half_of_the_truth() {
        let pole = c64::new(0.0, 20.0) * c64::new(1.0, 0.04).sqrt();
        let mass = Mat::from_fn(1, 1, |_, _| 1.0);
        let shapes = Mat::from_fn(1, 1, |_, _| (1.0 / (2.0 * pole)).sqrt());
        let c =
            lancaster(mass.as_ref(), &ModalData { poles: vec![pole], shapes, scaled: true }).expect("scaled").viscous;
        let zeta = c[(0, 0)] / (2.0 * 20.0);
        assert!((zeta / 0.02 - 0.5).abs() < 0.01, "{zeta}");
    }
}
