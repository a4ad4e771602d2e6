//! Runs made from a known model, with and without noise.

pub(crate) use crate::common::models::{candidate, cantilever, cantilever_parameters, five_masses, source};
pub(crate) use crate::common::runs::{channel, run, with_noise};
use dashpot::effects::Source;
use dashpot::identify::{Outcome, Settings};
use dashpot::measurement::{Quantity, Run};
use dashpot::response::dynamic_stiffness::DynamicStiffness;
use dashpot::structure::Structure;
use faer::c64;
use std::f64::consts::TAU;

/// What is measured, and how.
#[derive(Clone)]
pub(crate) struct Rig {
    pub drive: usize,
    pub sensors: Vec<usize>,
    pub frequencies_hz: Vec<f64>,
    pub force: f64,
}

impl Rig {
    /// Frequencies of the first `count` modes times `factor`.
    pub(crate) fn near_modes(
        structure: &Structure,
        count: usize,
        factor: f64,
        drive: usize,
        sensors: &[usize],
    ) -> Self {
        let modes = structure.modes().unwrap();
        let frequencies_hz = (0..count).map(|r| modes.frequency_hz(r) * factor).collect();
        Self { drive, sensors: sensors.to_vec(), frequencies_hz, force: 1.0 }
    }

    /// Noise-free runs of a linear model.
    pub(crate) fn runs(&self, structure: &Structure, sources: &[Source]) -> Vec<Run> {
        let stiffness = DynamicStiffness::new(structure, sources).unwrap();
        self.frequencies_hz
            .iter()
            .map(|f| {
                let omega = TAU * f;
                let mut force = vec![c64::new(0.0, 0.0); structure.len()];
                force[self.drive] = c64::new(self.force, 0.0);
                let x = stiffness.solve(omega, &force).unwrap();
                let mut channels = vec![channel(Quantity::Force, self.drive, vec![force[self.drive]], 0.0)];
                for &dof in &self.sensors {
                    let acceleration = vec![-x[dof] * omega * omega];
                    channels.push(channel(Quantity::Acceleration, dof, acceleration, 0.0));
                }
                run(format!("{f:.2} Hz"), omega, channels)
            })
            .collect()
    }
}

pub(crate) fn all_sets() -> Settings {
    Settings { keep: 0, max_sources: 4, ..Settings::default() }
}

/// Coefficients of the accepted set by index of source.
pub(crate) fn accepted(outcome: &Outcome) -> Vec<(usize, f64)> {
    outcome.accepted_step().sources.iter().map(|e| (e.source, e.coefficient)).collect()
}

/// Checks that exactly the expected sources were found, each to a relative tolerance, and what holds for every outcome.
pub(crate) fn assert_found(outcome: &Outcome, expected: &[(usize, f64)], tolerance: f64) {
    let found = accepted(outcome);
    let which = |list: &[(usize, f64)]| list.iter().map(|e| e.0).collect::<Vec<_>>();
    assert_eq!(which(&found), which(expected), "{}\n{found:?}", outcome.reason);
    for ((_, value), (_, truth)) in found.iter().zip(expected) {
        assert!((value - truth).abs() <= tolerance * truth, "{found:?} instead of {expected:?}: {}", outcome.reason);
    }
    assert!((outcome.sources.iter().map(|s| s.energy_percent).sum::<f64>() - 100.0).abs() < 1e-9);
    assert!((outcome.results.energy_percent.iter().sum::<f64>() - 100.0).abs() < 1e-9);
}
