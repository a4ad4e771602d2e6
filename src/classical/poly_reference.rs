//! Complex modes from measured frequency responses: the poly-reference least-squares complex frequency-domain estimator
//! (Peeters, Van der Auweraer, Guillaume 2004) within the band of every resonance, then maximum likelihood (`refine`).
//!
//! ```text
//! H(w) = B(z) A(z)^-1        A = sum_r alpha_r z^r, m x m        z = exp(i theta), theta from 0 to pi over the band
//! M = sum_o (T_o - S_o^T R_o^-1 S_o)        R = Re X^H X, S = Re X^H Y, T = Re Y^H Y, alpha_0 = I
//! ```
//!
//! with `X = w_o [1 z z^2 ...]`, `Y = -X (x) H_o`, rows weighted by `1 / |H_o|` for noise in proportion. Poles are the eigenvalues of
//! the companion matrix; those that return from order to order with a frequency and damping that do not move are modes:
//! the stabilisation diagram. Then every band is fitted again with the modes of the others taken off (`neighbours`). **Needs** receptances with several lines within every half-power band. **Limits**: modes
//! that show as one peak are told apart only by several drives or sensors; the linear estimate alone is biased by noise.

use super::data::ModalData;
use super::error::ClassicalError;
use super::extracted_mode::ExtractedMode;
use super::neighbours::{self, FittedBand};
use super::normal_sums::NormalSums;
use super::refine::{Band, refine};
use super::responses::FrequencyResponses;
use crate::control::Control;
use crate::math::eigen::general_values;
use crate::math::fill::filled_complex;
use crate::math::least_squares::solve_symmetric;
use faer::{Mat, c64};
use std::f64::consts::PI;

/// Highest order of the denominator with one drive, and the number of its poles up to which it is raised with several: a
/// band holds few modes, and the denominator has as many poles as its order times the drives.
const MOST_ORDER: usize = 12;
const MOST_POLES: usize = 48;
/// Highest order with any number of drives: a mode must return in [`LEAST_ORDERS`], and noise may take it from one.
const LEAST_MOST: usize = 6;
/// Half-width of a band in half-power widths of its peak.
const WIDTHS: f64 = 5.0;
/// Least number of lines on each side of a peak.
const LEAST_LINES: usize = 8;
/// Least number of lines within the half-power band.
const LEAST_INSIDE: usize = 3;
/// A pole is stable when its frequency moves by less than this part of the band from one order to the next ...
const STABLE_FREQUENCY: f64 = 0.01;
/// ... and its decay rate by less than this part of itself.
const STABLE_DAMPING: f64 = 0.3;
/// Orders in which a mode must be stable.
const LEAST_ORDERS: usize = 3;
/// A peak counts when it stands out of the valleys on both sides by this factor in power.
const STANDS_OUT: f64 = 2.5;

/// Height of a mode's own peak, as a part of the strongest in its band, at or below which it only mends the fit.
const WEAK: f64 = 0.02;

/// One pole of the stabilisation diagram.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiagramPole {
    /// Order of the denominator.
    pub order: usize,
    /// Pole, rad/s.
    pub pole: c64,
    /// Whether it returned from the order before.
    pub stable: bool,
}

/// All modes, ascending, and the diagram that shows why.
#[derive(Debug, Clone, PartialEq)]
pub struct Extraction {
    /// Modes in ascending order of frequency.
    pub modes: Vec<ExtractedMode>,
    /// Every pole of every order in its band.
    pub diagram: Vec<DiagramPole>,
}

impl Extraction {
    /// Shapes at the sensors. Scaled where a drive is also a sensor; then `psi_d = sqrt(R_dd)`, `psi = R_:d / psi_d`.
    pub fn modal_data(&self, responses: &FrequencyResponses) -> ModalData {
        let point = |j: usize| responses.sensors.iter().position(|s| *s == responses.drives[j]);
        let drives = 0..responses.drives.len();
        let scaled = drives.clone().any(|j| point(j).is_some());
        let shape = |mode: &ExtractedMode| -> Vec<c64> {
            let r = &mode.residues;
            let size = |j: usize| match (scaled, point(j)) {
                (true, Some(row)) => r[(row, j)].norm(),
                (true, None) => -1.0,
                (false, _) => r.col(j).squared_norm_l2(),
            };
            let best = drives.clone().max_by(|&a, &b| size(a).total_cmp(&size(b))).unwrap_or(0);
            let own = point(best).map_or(c64::new(1.0, 0.0), |row| r[(row, best)].sqrt());
            r.col(best).iter().map(|v| v / own).collect()
        };
        let shapes: Vec<Vec<c64>> = self.modes.iter().map(shape).collect();
        ModalData {
            poles: self.modes.iter().map(|mode| mode.pole).collect(),
            shapes: filled_complex(responses.sensors.len(), shapes.len(), |i, p| shapes[p][i]),
            scaled,
        }
    }
}

/// Finds the resonances, and in the band of each the modes.
///
/// # Errors
/// [`ClassicalError::Few`] where no resonance has lines enough; those of the linear algebra; cancellation.
pub fn extract(responses: &FrequencyResponses, control: &Control) -> Result<Extraction, ClassicalError> {
    let bands = bands(&responses.omega, &responses.power());
    if bands.is_empty() {
        let (what, found) = ("lines of frequency response around a resonance", responses.omega.len());
        return Err(ClassicalError::Few { what, needed: 2 * LEAST_LINES, found });
    }
    let found = control.map(bands.len(), |k| {
        control.check()?;
        let (first, last) = bands[k];
        let band = Band::new(responses, first, last);
        let (poles, stable) = stable_poles(&band)?;
        let modes = physical(&band, stable)?;
        Ok::<_, ClassicalError>((poles, FittedBand { band, modes }))
    });
    control.report(0.5);
    let (mut diagram, mut bands) = (Vec::new(), Vec::new());
    for one in found {
        let (poles, fitted) = one?;
        diagram.extend(poles);
        bands.push(fitted);
    }
    Ok(Extraction { modes: neighbours::settled(bands, control)?, diagram })
}

/// Refined modes of a band without those that only mend the fit: poles that leave the band, and weak ones beside a strong
/// one, are dropped one by one, the weakest first.
fn physical(band: &Band, mut poles: Vec<c64>) -> Result<Vec<ExtractedMode>, ClassicalError> {
    let inside = |m: &ExtractedMode| {
        let (first, last) = (band.omega[0], band.omega[band.omega.len() - 1]);
        m.pole.re < 0.0 && -m.pole.re < last - first && m.pole.im > first && m.pole.im < last
    };
    let strength = |m: &ExtractedMode| if inside(m) { m.residues.norm_l2() / m.pole.re.abs() } else { 0.0 };
    loop {
        if poles.is_empty() {
            return Ok(Vec::new());
        }
        let modes = refine(band, &poles)?;
        let strongest = modes.iter().map(strength).fold(0.0, f64::max);
        let weakest = (0..modes.len()).min_by(|&a, &b| strength(&modes[a]).total_cmp(&strength(&modes[b])));
        match weakest.filter(|&k| strength(&modes[k]) <= WEAK * strongest) {
            Some(k) => {
                poles.remove(k);
            }
            None => return Ok(modes),
        }
    }
}

/// First and last line of the band around each peak of the power that stands out.
fn bands(omega: &[f64], power: &[f64]) -> Vec<(usize, usize)> {
    let mut peaks: Vec<usize> = Vec::new();
    let mut valley = f64::INFINITY;
    let mut top: Option<usize> = None;
    for i in 0..power.len() {
        match top {
            None if power[i] > STANDS_OUT * valley => top = Some(i),
            Some(t) if power[i] > power[t] => top = Some(i),
            Some(t) if power[i] * STANDS_OUT < power[t] => {
                peaks.push(t);
                (top, valley) = (None, power[i]);
            }
            _ => {}
        }
        valley = if top.is_none() { valley.min(power[i]) } else { f64::INFINITY };
    }
    (0..peaks.len()).filter_map(|k| band(omega, power, &peaks, k)).collect()
}

fn band(omega: &[f64], power: &[f64], peaks: &[usize], k: usize) -> Option<(usize, usize)> {
    let peak = peaks[k];
    let half = |i: &usize| power[*i] < 0.5 * power[peak];
    let below = (0..peak).rev().find(half).unwrap_or(0);
    let above = (peak + 1..power.len()).find(half).unwrap_or(power.len() - 1);
    if above - below <= LEAST_INSIDE {
        return None;
    }
    let reach = WIDTHS * (omega[above] - omega[below]);
    let first = omega.partition_point(|&w| w < omega[peak] - reach).min(peak.saturating_sub(LEAST_LINES));
    let last = omega.partition_point(|&w| w <= omega[peak] + reach).max(peak + LEAST_LINES + 1) - 1;
    // Half-way to the neighbours at most.
    let first = if k > 0 { first.max(usize::midpoint(peaks[k - 1], peak)) } else { first };
    let last = if k + 1 < peaks.len() { last.min(usize::midpoint(peak, peaks[k + 1])) } else { last };
    let last = last.min(power.len() - 1);
    (last - first >= LEAST_LINES).then_some((first, last))
}

/// The diagram of a band, and the poles that are stable: the last of each chain.
fn stable_poles(band: &Band) -> Result<(Vec<DiagramPole>, Vec<c64>), ClassicalError> {
    let width = band.omega[band.omega.len() - 1] - band.omega[0];
    let same = |a: c64, b: c64| {
        (a.im - b.im).abs() < STABLE_FREQUENCY * width && (a.re - b.re).abs() < STABLE_DAMPING * a.re.abs()
    };
    let mut diagram: Vec<DiagramPole> = Vec::new();
    // Each chain: its newest pole and its length.
    let mut chains: Vec<(c64, usize, usize)> = Vec::new();
    let most = orders(band.drives());
    let angles: Vec<f64> = band.omega.iter().map(|w| (w - band.omega[0]) * step(band) + 0.01 * PI).collect();
    let sums = NormalSums::new(band, &angles, most);
    for order in (2..=most).filter(|order| 2 * (order + 1) * band.drives() < band.omega.len() * band.outputs()) {
        for pole in poles(band, &sums, order)? {
            let chain = chains.iter_mut().find(|(newest, _, at)| at + 1 == order && same(*newest, pole));
            let stable = chain.is_some();
            match chain {
                Some(chain) => *chain = (pole, chain.1 + 1, order),
                None => chains.push((pole, 1, order)),
            }
            diagram.push(DiagramPole { order, pole, stable });
        }
    }
    let mut kept: Vec<c64> = Vec::new();
    chains.sort_by_key(|chain| std::cmp::Reverse(chain.1));
    for (pole, length, _) in chains {
        if length >= LEAST_ORDERS && kept.iter().all(|k| (k - pole).norm() > pole.re.abs().min(k.re.abs())) {
            kept.push(pole);
        }
    }
    Ok((diagram, kept))
}

/// Angle a rad/s on the unit circle: a margin of one per cent of pi at both ends keeps the poles off the real axis.
fn step(band: &Band) -> f64 {
    0.98 * PI / (band.omega[band.omega.len() - 1] - band.omega[0])
}

/// The highest order that is tried with so many drives.
fn orders(drives: usize) -> usize {
    (MOST_POLES / drives).clamp(LEAST_MOST, MOST_ORDER)
}

/// Decaying poles of one order within the band.
fn poles(band: &Band, sums: &NormalSums, order: usize) -> Result<Vec<c64>, ClassicalError> {
    let (m, first, step) = (band.drives(), band.omega[0], step(band));
    let normal = sums.reduced(order)?;
    let size = m * order;
    let inner = normal.submatrix(m, m, size, size);
    let right = -normal.submatrix(m, 0, size, m);
    let alpha = solve_symmetric(inner, right.as_ref())?;
    // z^p alpha_p = -(I + sum z^r alpha_r): with u = 1/z the companion matrix of u^p + u^(p-1) alpha_1 + ... + alpha_p.
    let mut companion = Mat::<f64>::zeros(size, size);
    for r in 0..order {
        for j in 0..m {
            for i in 0..m {
                companion[(i, m * r + j)] = -alpha[(m * r + i, j)];
            }
            if r + 1 < order {
                companion[(m * (r + 1) + j, m * r + j)] = 1.0;
            }
        }
    }
    let values = general_values(companion.as_ref())?;
    let back = |u: &c64| {
        let s = -u.ln();
        (s.im > 0.01 * PI && s.im < 0.99 * PI && s.re < 0.0)
            .then(|| c64::new(s.re / step, first + (s.im - 0.01 * PI) / step))
    };
    Ok(values.iter().filter(|u| u.norm() > 0.0).filter_map(back).collect())
}
