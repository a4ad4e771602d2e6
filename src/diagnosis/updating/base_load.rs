//! The load of a moving base, `-M r a` (`r` its rigid motion, `a` its acceleration), on a model whose masses are updated: it is that of
//! the updated masses.

use crate::diagnosis::residual::data::{Data, RunData};
use crate::diagnosis::updating::parameters::{Updating, UpdatingParameter};
use crate::response::sensitivity::Unknown;
use crate::structure::Structure;

/// Step of a factor by which loads are differentiated: they are linear in it.
const STEP: f64 = 0.1;

/// Load of each degree of freedom of a structure over that of the structure as it is `stated`; one where no base loads it.
pub(crate) fn load_ratios(stated: &Structure, updated: &Structure) -> Vec<f64> {
    let axes: Vec<_> = (0..3).filter_map(|axis| Some((stated.base_load(axis)?, updated.base_load(axis)?))).collect();
    let ratio = |dof: usize| {
        let loaded = axes.iter().find(|(old, _)| old[dof] != 0.0);
        loaded.map_or(1.0, |(old, new)| new[dof] / old[dof])
    };
    (0..stated.len()).map(ratio).collect()
}

impl Updating {
    /// The same with what each parameter does to the loads of a base, where one moves in `data`.
    pub(super) fn with_base_loads(mut self, structure: &Structure, data: &Data) -> Self {
        if data.runs.iter().any(|run| run.on_moving_base) {
            self.load_slopes = self.parameters.iter().map(|parameter| slopes(structure, parameter)).collect();
        }
        self
    }

    /// Derivatives of the response of a run by the forces of its base as parameter `k` changes them.
    pub(super) fn by_base_load(&self, k: usize, run: &RunData) -> Vec<(Unknown, f64)> {
        let Some(slopes) = self.load_slopes.get(k).filter(|_| run.on_moving_base) else { return Vec::new() };
        let slope_of = |dof: usize| slopes.iter().find(|(loaded, _)| *loaded == dof).map(|(_, slope)| *slope);
        let forces = run.forces.iter().enumerate();
        forces.filter_map(|(i, force)| Some((Unknown::ForceScale(i), slope_of(force.dof)?))).collect()
    }
}

/// Degrees of freedom whose load a parameter changes, each with the relative change by a relative change of 1 of the parameter.
fn slopes(structure: &Structure, parameter: &UpdatingParameter) -> Vec<(usize, f64)> {
    let UpdatingParameter::Structure(part) = parameter else { return Vec::new() };
    let ratios = load_ratios(structure, &structure.with_factors(&[(*part, 1.0 + STEP)]));
    let slope = |(dof, ratio): (usize, f64)| (dof, (ratio - 1.0) / STEP);
    ratios.into_iter().enumerate().map(slope).filter(|(_, slope)| slope.abs() > 1e-9).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::chain;
    use crate::common::runs::{channel, run};
    use crate::control::Control;
    use crate::diagnosis::Problem;
    use crate::diagnosis::residual::prediction::{FINAL, Predictor};
    use crate::measurement::Quantity;
    use crate::structure::Part;
    use faer::c64;

    /// A floor that is heavier takes more of the base, and the derivative of the response by its mass contains that.
    #[test]
    fn the_load_of_a_base_follows_the_masses() {
        let structure = chain(&[2.0, 1.0], &[800.0, 0.0], &[1500.0]);
        let amplitudes = [-2.0, -1.0].map(|load| c64::new(load, 0.3 * load));
        let omega = 12.0;
        let force = |dof: usize| channel(Quantity::Force, dof, vec![amplitudes[dof]], 1e-3);
        let motion = |dof: usize| channel(Quantity::Displacement, dof, vec![c64::new(1e-2, 0.0)], 1e-6);
        let mut driven = run("12 rad/s".into(), omega, vec![force(0), force(1), motion(0), motion(1)]);
        let mut predicted = |on_base: bool, factor: f64| {
            driven.on_moving_base = on_base;
            let runs = [driven.clone()];
            let data = Data::new(&Problem { structure: &structure, sources: &[], runs: &runs }).unwrap();
            let updating = Updating {
                parameters: vec![UpdatingParameter::Structure(Part::PointMass(1))],
                values: vec![factor.ln()],
                ..Updating::default()
            }
            .with_base_loads(&structure, &data);
            let predictor = Predictor::new(&structure, Vec::new(), &data).unwrap().updated(&updating).unwrap();
            let control = Control::unattended();
            let response = predictor.predict(0, &data.runs[0], &[], &FINAL, None, &control).unwrap().response;
            (response.amplitude(1, 1), updating.unknowns(0, &[], &data.runs[0]))
        };
        // By hand: (K - w^2 M) x = f, the second force in proportion to the second mass.
        let by_hand = |factor: f64, load: f64| {
            let (a, b, c) = (2300.0 - omega * omega * 2.0, -1500.0, 1500.0 - omega * omega * factor);
            (amplitudes[1] * load * a - amplitudes[0] * b) / (a * c - b * b)
        };
        for (on_base, load) in [(false, 1.0), (true, 1.2)] {
            let (x, unknowns) = predicted(on_base, 1.2);
            let expected = by_hand(1.2, load);
            assert!((x - expected).norm() < 1e-9 * expected.norm(), "{on_base}: {x} {expected}");
            assert_eq!(unknowns.len(), if on_base { 2 } else { 1 });
        }
        let (_, unknowns) = predicted(true, 1.0);
        assert!(matches!(unknowns[1], (Unknown::ForceScale(1), slope) if (slope - 1.0).abs() < 1e-9), "{unknowns:?}");
    }
}
