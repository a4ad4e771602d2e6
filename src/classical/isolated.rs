//! One mode of measured responses on its own, for methods that know one mode only: what the other modes do is taken off, and
//! all functions are laid together by the residues of the mode.
//!
//! ```text
//! e_r(w) = sum_ij g_ij R_ij,r* (H_ij - sum_{p != r} (R_ij,p / (i w - lambda_p) + R_ij,p* / (i w - lambda_p*))) / sum_ij g_ij |R_ij,r|^2
//! ```
//!
//! with `g = 1 / deviation^2` at the resonance. D. J. Ewins, *Modal Testing*, 2nd edition, 4.3 (the other modes taken off) and
//! R. J. Allemang, D. L. Brown, *A complete review of the complex mode indicator function*, ISMA 2006 (enhanced response).

use super::extracted_mode::ExtractedMode;
use super::responses::FrequencyResponses;
use crate::math::fill::{filled, filled_complex};
use faer::{Mat, c64};

/// Half-width of the lines in half-power half-widths: those of a circle and what a half-power width needs, with room to spare.
const REACH: f64 = 8.0;

/// The response of one mode.
pub(super) struct Isolated {
    /// Pole of the mode as it was extracted, rad/s.
    pub pole: c64,
    /// Circular frequencies of the lines about the resonance, rad/s.
    pub omega: Vec<f64>,
    /// Its response there, all functions together, s.
    pub response: Vec<c64>,
}

/// Mode `r` of `modes`, which were extracted from `responses`.
pub(super) fn isolated(responses: &FrequencyResponses, modes: &[ExtractedMode], r: usize) -> Isolated {
    let pole = modes[r].pole;
    let lines = about(&responses.omega, pole);
    let weights = weights(responses, &modes[r], pole.im);
    let own =
        filled_complex(weights.nrows(), weights.ncols(), |i, j| modes[r].residues[(i, j)].conj() * weights[(i, j)]);
    let laid = |value: &dyn Fn((usize, usize)) -> c64| pairs(&own).map(|p| own[p] * value(p)).sum::<c64>();
    let total = laid(&|p| modes[r].residues[p]);
    // What the other modes add to the sum is that of their residues over the distance from their poles.
    let others: Vec<(c64, c64, c64)> = modes
        .iter()
        .enumerate()
        .filter(|(p, _)| *p != r)
        .map(|(_, m)| (m.pole, laid(&|p| m.residues[p]), laid(&|p| m.residues[p].conj())))
        .collect();
    let response_at_line = |k: usize| {
        let s = c64::new(0.0, responses.omega[k]);
        let rest: c64 =
            others.iter().map(|(pole, direct, other)| direct / (s - pole) + other / (s - pole.conj())).sum();
        (laid(&|p| responses.values[k][p]) - rest) / total
    };
    let response = lines.clone().map(response_at_line).collect();
    Isolated { pole, omega: responses.omega[lines].to_vec(), response }
}

/// One function at one line without the modes beside `r`.
pub(super) fn alone(
    responses: &FrequencyResponses,
    modes: &[ExtractedMode],
    r: usize,
    line: usize,
    pair: (usize, usize),
) -> c64 {
    let s = c64::new(0.0, responses.omega[line]);
    let term = |m: &ExtractedMode| {
        let residue = m.residues[pair];
        residue / (s - m.pole) + residue.conj() / (s - m.pole.conj())
    };
    let others = modes.iter().enumerate().filter(|(p, _)| *p != r).map(|(_, mode)| term(mode));
    responses.values[line][pair] - others.sum::<c64>()
}

/// Lines about the resonance of a pole.
pub(super) fn about(omega: &[f64], pole: c64) -> std::ops::Range<usize> {
    let reach = REACH * pole.re.abs();
    let from = omega.partition_point(|&w| w < pole.im - reach);
    from..omega.partition_point(|&w| w <= pole.im + reach)
}

fn pairs(matrix: &Mat<c64>) -> impl Iterator<Item = (usize, usize)> + use<> {
    let (rows, columns) = matrix.shape();
    (0..columns).flat_map(move |j| (0..rows).map(move |i| (i, j)))
}

/// What every function weighs: by its noise at the resonance, where that is known.
fn weights(responses: &FrequencyResponses, mode: &ExtractedMode, omega: f64) -> Mat<f64> {
    let (rows, columns) = mode.residues.shape();
    let line = responses.omega.partition_point(|&w| w < omega).min(responses.omega.len() - 1);
    let weight = |i: usize, j: usize| match responses.deviations.get(line) {
        Some(known) if known[(i, j)] > 0.0 => known[(i, j)].powi(-2),
        _ => 1.0,
    };
    filled(rows, columns, weight)
}
