//! Expansion on undamped mode shapes: `X = Phi q`, `q = Phi_S^+ Y` by least squares over the sensors.
//!
//! With one mode, that nearest to the frequency (4.23 to 4.31), `q = phi_S^T Y / phi_S^T phi_S`. With several (SEREP): the
//! modes nearest to the frequency, no more than there are sensors and as many as the sensors can tell apart.

use super::expanded::{Expanded, from_maps, no_maps};
use super::map::Map;
use super::modal_model::ModalModel;
use crate::balance::error::BalanceError;
use crate::balance::measured::Measured;
use crate::math::least_squares::LeastSquares;
use faer::{Mat, c64};

/// Part of a shape's largest entry below which the sensors do not see the mode.
const UNSEEN: f64 = 1e-6;
/// Condition of the shapes at the sensors above which the farthest mode is left out.
const WORST_CONDITION: f64 = 1e3;

pub(super) fn expand(model: &ModalModel, measured: &Measured, most: usize) -> Result<Expanded, BalanceError> {
    let n = model.size();
    let maps: Result<Vec<Mat<c64>>, BalanceError> =
        (0..measured.harmonics()).map(|k| map(model, measured, k, most)).collect();
    let maps = maps?.into_iter().map(Map::Full).collect();
    Ok(from_maps(measured, maps, no_maps(n, measured.harmonics()), vec![true; n]))
}

fn map(model: &ModalModel, measured: &Measured, k: usize, most: usize) -> Result<Mat<c64>, BalanceError> {
    let order = model.by_distance(measured.frequency(k));
    let mut count = most.min(measured.sensors.len()).min(order.len());
    loop {
        let chosen = &order[..count];
        let at_sensors =
            Mat::from_fn(measured.sensors.len(), count, |s, r| model.shape(chosen[r], measured.sensors.dofs[s]));
        let largest = (0..model.size()).fold(0.0_f64, |m, i| m.max(model.shape(order[0], i).abs()));
        if at_sensors.col(0).iter().all(|v| v.abs() < UNSEEN * largest) {
            let harmonic = measured.numbers[k];
            return Err(BalanceError::ModeUnseen { file: measured.file.clone(), harmonic, mode: order[0] + 1 });
        }
        let fit = LeastSquares::new(at_sensors.as_ref()).map_err(|e| BalanceError::Modes { reason: e.to_string() })?;
        if count > 1 && (fit.rank() < count || fit.condition() > WORST_CONDITION) {
            count -= 1;
            continue;
        }
        let inverse = fit.pseudo_inverse();
        return Ok(Mat::from_fn(model.size(), measured.sensors.len(), |i, s| {
            c64::new((0..count).map(|r| model.shape(chosen[r], i) * inverse[(r, s)]).sum(), 0.0)
        }));
    }
}
