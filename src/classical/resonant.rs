//! Complex modes at all DOFs from a few runs near the resonances, with the help of the model, and shapes at sensors expanded
//! to all DOFs.
//!
//! ```text
//! y = x - sum_{j != r} phi_j phi_j^T f / (w_j^2 - w^2) = psi_r (psi_r^T f) / (i w - lambda_r)        psi^T M psi ~ 1 / (2 i w_r)
//! phi_r^T M y = phi_r^T f / (2 i w_r (i w - lambda_r))
//! ```
//!
//! The undamped motion of the other modes is taken off, so that what is left has the shape of the damped mode, and its modal
//! amplitude gives the pole. **Needs** mass, stiffness, a run within [`NEAR`] of the natural frequency and a sensor at its
//! drive. **Limits**: errors are of second order in the damping; errors of the model all end in the shapes. Where lines are many
//! [`super::poly_reference`] does without the model.

use super::data::ModalData;
use super::error::ClassicalError;
use super::linear::form;
use super::responses::FrequencyResponses;
use crate::math::fill::{filled, filled_complex};
use crate::math::least_squares::LeastSquares;
use crate::structure::SystemMatrices;
use crate::structure::modes::Modes;
use faer::c64;

/// Part of a mode's largest motion below which a set of sensors does not see it.
const UNSEEN: f64 = 1e-4;
/// Largest distance of a run from a natural frequency, as a part of it.
pub(crate) const NEAR: f64 = 0.012;
/// Condition of the shapes at the sensors above which the highest modes are left out.
const WORST_CONDITION: f64 = 1e3;

/// The lowest modes, up to the first without a run near it; scaled (3.82) by the mass matrix.
///
/// # Errors
/// [`ClassicalError::Few`] where even the lowest has none; those of the linear algebra.
pub(crate) fn from_runs(
    matrices: &SystemMatrices,
    model: &Modes,
    responses: &FrequencyResponses,
) -> Result<ModalData, ClassicalError> {
    let mut poles = Vec::new();
    let mut shapes: Vec<Vec<c64>> = Vec::new();
    for r in 0..model.len() {
        let Some((line, drive)) = best_line(model, responses, r) else { break };
        let (omega, h) = (responses.omega[line], &responses.values[line]);
        let at_drive = responses.drives[drive];
        let rest = |dof: usize| -> f64 {
            let term = |j: usize| model.shapes[(dof, j)] * model.shapes[(at_drive, j)];
            let others = (0..model.len()).filter(|&j| j != r);
            others.map(|j| term(j) / (model.omega[j].powi(2) - omega * omega)).sum()
        };
        let left: Vec<c64> = responses.sensors.iter().enumerate().map(|(s, &dof)| h[(s, drive)] - rest(dof)).collect();
        let full = expanded(model, &responses.sensors, &left, r)?;
        // psi^T M psi = 1 / (2 i w) to first order.
        let twice = c64::new(0.0, 2.0 * model.omega[r]);
        let size = (form(&full, matrices.mass.as_ref(), &full) * twice).sqrt();
        let psi: Vec<c64> = full.iter().map(|v| v / size).collect();
        let own: Vec<c64> = model.shapes.col(r).iter().map(|&v| c64::new(v, 0.0)).collect();
        let modal = form(&own, matrices.mass.as_ref(), &full);
        let lambda = c64::new(0.0, omega) - c64::new(model.shapes[(at_drive, r)], 0.0) / (twice * modal);
        if !(lambda.re < 0.0 && lambda.im > 0.0) {
            break;
        }
        poles.push(lambda);
        shapes.push(psi);
    }
    if poles.is_empty() {
        let what = "runs near natural frequencies with a sensor at the drive";
        return Err(ClassicalError::Few { what, needed: 1, found: 0 });
    }
    let n = model.shapes.nrows();
    Ok(ModalData { shapes: filled_complex(n, poles.len(), |i, p| shapes[p][i]), poles, scaled: true })
}

/// Line and drive that say most of mode `r`.
fn best_line(model: &Modes, responses: &FrequencyResponses, r: usize) -> Option<(usize, usize)> {
    let near = |w: f64| (w - model.omega[r]).abs();
    let line =
        (0..responses.omega.len()).min_by(|&a, &b| near(responses.omega[a]).total_cmp(&near(responses.omega[b])))?;
    let share = |j: usize| model.shapes[(responses.drives[j], r)].abs();
    let measured = |&j: &usize| responses.sensors.contains(&responses.drives[j]);
    let drive = (0..responses.drives.len()).filter(measured).max_by(|&a, &b| share(a).total_cmp(&share(b)))?;
    let seen = share(drive) > 1e-3 * model.shapes.col(r).norm_max();
    (near(responses.omega[line]) < NEAR * model.omega[r] && seen).then_some((line, drive))
}

/// A shape at the sensors expanded to all DOFs by the model's modes: mode `r` and the lowest others, as many as there are
/// sensors at most.
///
/// # Errors
/// Those of the linear algebra.
pub(crate) fn expanded(model: &Modes, sensors: &[usize], values: &[c64], r: usize) -> Result<Vec<c64>, ClassicalError> {
    let n = model.shapes.nrows();
    if sensors.len() == n {
        let mut full = vec![c64::new(0.0, 0.0); n];
        sensors.iter().zip(values).for_each(|(&dof, &v)| full[dof] = v);
        return Ok(full);
    }
    let (problem, picked) = basis(model, sensors, r)?;
    let re = problem.solve(&values.iter().map(|v| v.re).collect::<Vec<_>>())?.x;
    let im = problem.solve(&values.iter().map(|v| v.im).collect::<Vec<_>>())?.x;
    let motion_of_dof =
        |i: usize| picked.iter().enumerate().map(|(k, &j)| c64::new(re[k], im[k]) * model.shapes[(i, j)]).sum::<c64>();
    Ok((0..n).map(motion_of_dof).collect())
}

/// Whether mode `r` moves any of the sensors noticeably.
pub(super) fn is_seen(model: &Modes, sensors: &[usize], r: usize) -> bool {
    let most = sensors.iter().map(|&dof| model.shapes[(dof, r)].abs()).fold(0.0, f64::max);
    most > UNSEEN * model.shapes.col(r).norm_max()
}

/// Mode `r` and the lowest others at the sensors: as many as these tell apart.
fn basis(model: &Modes, sensors: &[usize], r: usize) -> Result<(LeastSquares, Vec<usize>), ClassicalError> {
    let mut picked = vec![r];
    picked.extend((0..model.len()).filter(|&j| j != r && is_seen(model, sensors, j)).take(sensors.len() - 1));
    loop {
        let shapes = filled(sensors.len(), picked.len(), |s, k| model.shapes[(sensors[s], picked[k])]);
        let problem = LeastSquares::new(shapes.as_ref())?;
        if picked.len() == 1 || (problem.rank() == picked.len() && problem.condition() < WORST_CONDITION) {
            return Ok((problem, picked));
        }
        // The highest mode is the one that the sensors see least of.
        picked.truncate((picked.len() - 1).min(9 * picked.len() / 10).max(1));
    }
}
