//! The energy equation over windows of a record that is not steady.
//!
//! ```text
//! int_a^b x'^T B u dt - [T + V]_a^b - known = sum_j c_j int_a^b x'^T phi_j dt,    T = x'^T M x' / 2,  V = x^T K x / 2
//! ```
//!
//! One row a window, many windows a record; a decay has `u = 0`, a steady motion over a period `[T + V] = 0`, which is the
//! equation of `super::energy`. Motion at all DOFs comes from the modes of the undamped structure in the record's band
//! (`band`, `motion`), the work of sources from that motion (`work`), the covariance of the rows from the noise of the
//! channels (`covariance`). Windows are whole multiples of the period of the mode that holds most energy and follow one
//! another without gap: with their exact covariance, overlapping ones, which are sums of these, would add nothing.

pub(crate) mod band;
mod component;
mod covariance;
pub(crate) mod motion;
mod window_rows;
pub(crate) mod work;

pub use window_rows::{WindowError, WindowRows};

use crate::control::Control;
use crate::effects::Source;
use crate::measurement::TransientRun;
use crate::response::linear_matrices::LinearMatrices;
use crate::structure::{Structure, StructureKind, SystemMatrices, modes::modes};
use dashpot_numerics::EquilibratedCholesky;
use faer::Mat;
use motion::Motion;
use std::f64::consts::TAU;
use work::Works;

/// Most rows of one record.
const MOST_ROWS: usize = 100;
/// Energy, over that of the noise, below which a window says nothing: an amplitude of ten deviations.
const LEAST_ENERGY: f64 = 100.0;
/// Share of the variance of a row that is added to it: neighbouring windows may all but repeat each other.
const RIDGE: f64 = 1e-9;

/// Rows of every record, known `sources` subtracted at their values, `columns` at unit coefficient.
///
/// # Errors
/// [`WindowError`] of the first record that gives none.
pub fn window_rows(
    structure: &Structure,
    known: &[Source],
    columns: &[Source],
    runs: &[&TransientRun],
    control: &Control,
) -> Result<Vec<WindowRows>, WindowError> {
    let Some(first) = runs.first() else { return Ok(Vec::new()) };
    if structure.kind() == StructureKind::Component {
        return runs.iter().map(|run| component::rows(structure, known, columns, run)).collect();
    }
    let no_matrices = || WindowError::NoMatrices { file: first.file.clone() };
    let linear = LinearMatrices::new(structure, known).map_err(|_| no_matrices())?;
    let matrices = SystemMatrices { mass: linear.mass, stiffness: linear.stiffness };
    let modes = modes(&matrices).map_err(|error| WindowError::Modes { reason: error.to_string() })?;
    let mut all = Vec::new();
    for run in runs {
        let motion = Motion::new(&modes, run, control)?;
        all.push(rows(structure, known, columns, run, &motion, control)?);
    }
    Ok(all)
}

fn rows(
    structure: &Structure,
    known: &[Source],
    columns: &[Source],
    run: &TransientRun,
    motion: &Motion,
    control: &Control,
) -> Result<WindowRows, WindowError> {
    let dominant = dominant(motion);
    let ends = windows(motion, dominant).ok_or_else(|| WindowError::OnlyNoise { file: run.file.clone() })?;
    let over = |power: &[f64]| ends.iter().map(|&(a, b)| integral(power, a, b, motion.step)).collect::<Vec<f64>>();
    let mut works = Works::new(structure, motion);
    let work = |works: &mut Works<'_>, source: &Source| over(&works.power(source));
    let units: Vec<Vec<f64>> = columns.iter().map(|s| work(&mut works, &s.with_coefficient(1.0))).collect();
    // Mass and stiffness that are known are in the matrices.
    let stored = |source: &Source| source.effect.is_mass_or_spring();
    let zeros = vec![0.0; ends.len()];
    let taken: Vec<Vec<f64>> =
        known.iter().map(|s| if stored(s) { zeros.clone() } else { work(&mut works, s) }).collect();
    let input = over(&input_power(motion));
    let change = |k: usize| motion.energy(ends[k].1) - motion.energy(ends[k].0);
    let e: Vec<f64> = (0..ends.len()).map(|k| input[k] - change(k) - taken.iter().map(|t| t[k]).sum::<f64>()).collect();
    let squares: f64 = over(&speed_squares(motion)).iter().sum();
    let kappa = if squares > 0.0 { (e.iter().sum::<f64>() / squares).max(0.0) } else { 0.0 };
    let time = |n: usize| run.time()[0] + n as f64 * motion.step;
    Ok(WindowRows {
        span_s: ends.iter().map(|&(a, b)| [time(a), time(b)]).collect(),
        g: Mat::from_fn(ends.len(), units.len(), |k, j| units[j][k]),
        known: Mat::from_fn(ends.len(), taken.len(), |k, j| taken[j][k]),
        e,
        input,
        released: (0..ends.len()).map(|k| -change(k)).collect(),
        stored: ends.iter().map(|&(a, _)| motion.energy(a)).collect(),
        covariance: covariance::covariance(motion, &ends, kappa, control),
        modes: motion.band.modes.clone(),
        dominant: motion.band.modes[dominant],
        corner_hz: motion.band.low[1],
    })
}

/// The mode that holds most energy over the usable part.
fn dominant(motion: &Motion) -> usize {
    let energy = |r: usize| motion.usable.clone().map(|n| motion.mode_energy(r, n)).sum::<f64>();
    let energies: Vec<f64> = (0..motion.q.len()).map(energy).collect();
    (0..energies.len()).max_by(|&a, &b| energies[a].total_cmp(&energies[b])).unwrap_or(0)
}

/// First and last sample of each window; none where the motion does not stand out of the noise.
fn windows(motion: &Motion, dominant: usize) -> Option<Vec<(usize, usize)>> {
    let period = TAU / motion.band.omega[dominant] / motion.step;
    let first = motion.usable.start + 1;
    let last = motion.usable.end.saturating_sub(2);
    let floor = LEAST_ENERGY * noise_energy(motion);
    let half = (0.5 * period).ceil() as usize;
    let stands_out = |n: usize| {
        let around = n.saturating_sub(half)..(n + half).min(motion.usable.end);
        around.map(|n| motion.energy(n)).fold(0.0, f64::max) > floor
    };
    let steps = |count: usize| (count as f64 * period).round() as usize;
    let periods = last.saturating_sub(first) as f64 / period;
    let each = (periods / MOST_ROWS as f64).ceil().max(1.0) as usize;
    let mut ends = Vec::new();
    let mut count = 0;
    while first + steps(count + each) <= last && ends.len() < MOST_ROWS {
        let window = (first + steps(count), first + steps(count + each));
        if stands_out(window.0) && stands_out(window.1) || !motion.forces.is_empty() && stands_out(window.1) {
            ends.push(window);
        } else if !ends.is_empty() && motion.forces.is_empty() {
            // Under a force the motion may rise again: a sweep goes on to its next resonance.
            break;
        }
        count += each;
    }
    (ends.len() >= 2).then_some(ends)
}

/// Energy that the noise pretends, J.
fn noise_energy(motion: &Motion) -> f64 {
    let band = &motion.band;
    let lines = 400;
    let top = band.high[1];
    let width = top / f64::from(lines);
    let noise_of_mode = |r: usize| {
        let line = |k: i32| {
            let hz = (f64::from(k) + 0.5) * width;
            let omega = TAU * hz;
            let spectrum: f64 = motion
                .sensors
                .iter()
                .enumerate()
                .map(|(s, (order, variance))| band.expansion[(r, s)].powi(2) * variance * omega.powi(-2 * order))
                .sum();
            2.0 * motion.step * spectrum * band.gain(hz).powi(2) * 0.5 * (omega.powi(2) + band.omega[r].powi(2)) * width
        };
        (0..lines).map(line).sum::<f64>()
    };
    (0..motion.q.len()).map(noise_of_mode).sum()
}

/// Power of the exciters at every sample, W.
fn input_power(motion: &Motion) -> Vec<f64> {
    let shapes = &motion.band.shapes;
    let power_at = |n: usize| {
        let power_of_force = |(dof, u): &(usize, Vec<f64>)| {
            u[n] * (0..motion.v.len()).map(|r| shapes[(*dof, r)] * motion.v[r][n]).sum::<f64>()
        };
        motion.forces.iter().map(power_of_force).sum()
    };
    (0..motion.q[0].len()).map(power_at).collect()
}

/// `sum v_r^2` at every sample.
fn speed_squares(motion: &Motion) -> Vec<f64> {
    (0..motion.q[0].len()).map(|n| motion.v.iter().map(|v| v[n] * v[n]).sum()).collect()
}

/// Integral from sample `a` to `b` by the trapezoidal rule with Gregory's correction at the ends (fourth order).
fn integral(y: &[f64], a: usize, b: usize, step: f64) -> f64 {
    let inside: f64 = y[a..=b].iter().sum::<f64>() - 0.5 * (y[a] + y[b]);
    let slope = |n: usize| 0.5 * (y[n + 1] - y[n - 1]);
    step * (inside - (slope(b) - slope(a)) / 12.0)
}

impl WindowRows {
    /// Number of rows.
    pub fn len(&self) -> usize {
        self.e.len()
    }

    /// Whether there is none; never true.
    pub fn is_empty(&self) -> bool {
        self.e.is_empty()
    }

    /// The rows made independent and of unit variance: `L^-1 G` and `L^-1 e` with `L L^T` their covariance.
    pub fn whitened(&self) -> (Mat<f64>, Vec<f64>) {
        let (n, columns) = (self.len(), self.g.ncols());
        let rows = Mat::from_fn(n, columns + 1, |k, j| if j < columns { self.g[(k, j)] } else { self.e[k] });
        let rows = match EquilibratedCholesky::new(self.covariance.as_ref(), RIDGE) {
            Some(factor) => factor.whiten(rows),
            // Rows that are correlated beyond all digits are taken to be independent.
            None => Mat::from_fn(n, columns + 1, |k, j| {
                rows[(k, j)] / self.covariance[(k, k)].max(f64::MIN_POSITIVE).sqrt()
            }),
        };
        (rows.subcols(0, columns).to_owned(), rows.col_as_slice(columns).to_vec())
    }
}
