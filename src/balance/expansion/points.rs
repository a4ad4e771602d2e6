//! No expansion: the motion is known where a sensor is, and nowhere else. Sensors at one DOF are averaged with weights
//! inverse to their variances.

use super::expanded::{Expanded, from_maps, no_maps};
use super::map::Map;
use crate::balance::measured::Measured;

pub(super) fn expand(n: usize, measured: &Measured) -> Expanded {
    let harmonics = measured.harmonics();
    let mut known = vec![false; n];
    measured.sensors.dofs.iter().for_each(|&dof| known[dof] = true);
    let places: Vec<usize> = (0..n).filter(|&dof| known[dof]).collect();
    let map = |k: usize| {
        let averages = |&dof: &usize| measured.average_at(dof, k).into_iter().map(move |(s, weight)| (dof, s, weight));
        Map::Few { rows: n, entries: places.iter().flat_map(averages).collect() }
    };
    let maps = (0..harmonics).map(map).collect();
    from_maps(measured, maps, no_maps(n, harmonics), known)
}
