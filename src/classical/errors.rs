//! How far an identified matrix is from a known one: `eps_C` (3.135), the generalised MAC (3.132-3.134).

use super::linear::times;
use crate::math::fill::filled;
use crate::structure::damped_modes::DampedMode;
use faer::{Mat, MatRef, c64};

/// `100 |C - C_identified| / |C|` in the Frobenius norm, per cent (3.135).
pub fn matrix_error(truth: MatRef<'_, f64>, identified: MatRef<'_, f64>) -> f64 {
    100.0 * (truth - identified).norm_l2() / truth.norm_l2()
}

/// A mode as a state `(lambda psi, psi)` with the products its own weight needs.
struct Weighted {
    lambda: c64,
    psi: Vec<c64>,
    mass: Vec<c64>,
    damping: Vec<c64>,
    stiffness: Vec<c64>,
}

impl Weighted {
    fn new(mode: &DampedMode, m: MatRef<'_, f64>, c: MatRef<'_, f64>, k: MatRef<'_, f64>) -> Self {
        let psi = mode.shape.clone();
        Self { lambda: mode.lambda, mass: times(m, &psi), damping: times(c, &psi), stiffness: times(k, &psi), psi }
    }

    /// `other^T W self` with `W = |lambda| [0 M; M C] + [-M 0; 0 K]` of this mode (3.133).
    fn product(&self, other: &Self) -> c64 {
        let dot = |v: &[c64]| other.psi.iter().zip(v).map(|(a, b)| a * b).sum::<c64>();
        let (mass, size) = (dot(&self.mass), self.lambda.norm());
        let cross = (other.lambda + self.lambda) * mass + dot(&self.damping);
        cross * size - other.lambda * self.lambda * mass + dot(&self.stiffness)
    }
}

/// `MAC(j, k)` (3.132) between the modes of the identified `C` (rows) and those of the true one (columns).
pub fn generalised_mac(
    m: MatRef<'_, f64>,
    k: MatRef<'_, f64>,
    identified: (&[DampedMode], MatRef<'_, f64>),
    truth: (&[DampedMode], MatRef<'_, f64>),
) -> Mat<f64> {
    let weigh = |(modes, c): (&[DampedMode], MatRef<'_, f64>)| -> Vec<Weighted> {
        modes.iter().map(|mode| Weighted::new(mode, m, c, k)).collect()
    };
    let (rows, columns) = (weigh(identified), weigh(truth));
    let own = |list: &[Weighted]| -> Vec<c64> { list.iter().map(|w| w.product(w)).collect() };
    let (own_rows, own_columns) = (own(&rows), own(&columns));
    filled(rows.len(), columns.len(), |j, p| {
        let cross = rows[j].product(&columns[p]) * columns[p].product(&rows[j]);
        cross.norm() / (own_rows[j] * own_columns[p]).norm().max(f64::MIN_POSITIVE)
    })
}

/// `|I - MAC|` (3.134).
pub fn mac_error(mac: MatRef<'_, f64>) -> Mat<f64> {
    filled(mac.nrows(), mac.ncols(), |i, j| (f64::from(u8::from(i == j)) - mac[(i, j)]).abs())
}
