//! Rows of the energy equation of a component whose displacement is imposed: one a cycle.
//!
//! ```text
//! int (F - F_0 - m d'') d' dt - known = sum_j c_j int d' f_j dt
//! ```
//!
//! over every whole cycle of a record. `F_0`, the zero of the force cell, does no work over a cycle that closes; what it does
//! over one that does not is taken out with the mean force. Noise of the force acts through the velocity.

use super::window_rows::{WindowError, WindowRows};
use crate::balance::loops::{ComponentError, LoopRecord};
use crate::effects::Source;
use crate::measurement::TransientRun;
use crate::structure::Structure;
use faer::Mat;

/// Share of the work of a cycle by which any loop is wrong: the velocity is a derivative of what was measured.
const NUMERICAL: f64 = 1e-3;

/// Rows of one record.
pub(super) fn rows(
    structure: &Structure,
    known: &[Source],
    columns: &[Source],
    run: &TransientRun,
) -> Result<WindowRows, WindowError> {
    let one = LoopRecord::new(0, run)?;
    let period = 1.0 / (one.frequency_hz * one.step);
    let count = (one.d.len() as f64 / period).floor() as usize;
    if count < 1 {
        return Err(WindowError::OnlyNoise { file: run.file.clone() });
    }
    let ends: Vec<(usize, usize)> = (0..count)
        .map(|k| ((k as f64 * period) as usize, (((k + 1) as f64 * period) as usize).min(one.d.len())))
        .collect();
    let work = |force: &[f64]| -> Vec<f64> {
        let over = |&(a, b): &(usize, usize)| one.step * (a..b).map(|n| force[n] * one.v[n]).sum::<f64>();
        ends.iter().map(over).collect()
    };
    let energies_of = |source: &Source| -> Result<Vec<f64>, WindowError> {
        let none = ComponentError::NoTimeDomain { law: source.effect.name() };
        Ok(work(&one.law_force(source).ok_or(none)?))
    };
    let units: Vec<Vec<f64>> =
        columns.iter().map(|s| energies_of(&s.with_coefficient(1.0))).collect::<Result<_, _>>()?;
    let taken: Vec<Vec<f64>> = known.iter().map(energies_of).collect::<Result<_, _>>()?;
    let mean = one.force.iter().sum::<f64>() / one.force.len() as f64;
    let mass = structure.origin().component_mass;
    let driven: Vec<f64> = one.force.iter().zip(&one.a).map(|(f, a)| f - mean - mass * a).collect();
    let input = work(&driven);
    let e: Vec<f64> = (0..count).map(|k| input[k] - taken.iter().map(|t| t[k]).sum::<f64>()).collect();
    let variance = |k: usize| {
        let (a, b) = ends[k];
        let squares: f64 = one.v[a..b].iter().map(|v| v * v).sum();
        (one.noise * one.step).powi(2) * squares + (NUMERICAL * input[k]).powi(2)
    };
    let variances: Vec<f64> = (0..count).map(variance).collect();
    let time = |n: usize| one.first_s + n as f64 * one.step;
    Ok(WindowRows {
        span_s: ends.iter().map(|&(a, b)| [time(a), time(b)]).collect(),
        g: Mat::from_fn(count, units.len(), |k, j| units[j][k]),
        known: Mat::from_fn(count, taken.len(), |k, j| taken[j][k]),
        e,
        input,
        released: vec![0.0; count],
        stored: vec![0.0; count],
        covariance: Mat::from_fn(count, count, |k, l| if k == l { variances[k] } else { 0.0 }),
        modes: Vec::new(),
        dominant: 0,
        corner_hz: 0.0,
    })
}
