//! No expansion: the motion is known where a sensor is, and nowhere else. Sensors at one DOF are averaged with weights
//! inverse to their variances.

use super::expanded::{Expanded, from_maps, no_maps};
use crate::balance::measured::Measured;
use faer::{Mat, c64};

pub(super) fn expand(n: usize, measured: &Measured) -> Expanded {
    let harmonics = measured.harmonics();
    let mut known = vec![false; n];
    measured.sensors.dofs.iter().for_each(|&dof| known[dof] = true);
    let maps = (0..harmonics)
        .map(|k| {
            let mut map: Mat<c64> = Mat::zeros(n, measured.sensors.len());
            for &dof in &measured.sensors.dofs {
                for (s, weight) in measured.average_at(dof, k) {
                    map[(dof, s)] = c64::new(weight, 0.0);
                }
            }
            map
        })
        .collect();
    from_maps(measured, maps, no_maps(n, measured.forces.len(), harmonics), known)
}
