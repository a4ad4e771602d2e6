//! Runs made from a known model, with and without noise.

use dashpot::effects::{Effect, Place, Source};
use dashpot::identify::{Outcome, Settings};
use dashpot::measurement::{Channel, ChannelFit, HarmonicFit, Quantity, Run};
use dashpot::response::dynamic_stiffness::DynamicStiffness;
use dashpot::structure::Structure;
use dashpot::structure::beam::{BeamParameters, Supports};
use dashpot::structure::chain::ChainParameters;
use faer::{Mat, c64};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use std::f64::consts::TAU;

/// The five masses of section 6.
pub(crate) fn five_masses() -> Structure {
    let chain = ChainParameters {
        masses: vec![1.727, 5.122, 8.213, 2.609, 1.339],
        ground_stiffness: vec![94263.0; 5],
        coupling_stiffness: vec![75136.0, 67744.0, 75466.0, 83396.0],
    };
    chain.build(&[]).unwrap()
}

pub(crate) fn cantilever() -> Structure {
    let beam = BeamParameters {
        length: 0.56,
        breadth: 0.04,
        depth: 0.004,
        youngs_modulus: 69e9,
        density: 2700.0,
        elements: 10,
        supports: Supports::ClampedFree,
    };
    beam.build(&[]).unwrap()
}

pub(crate) fn source(effect: Effect, dofs: &[usize], value: f64) -> Source {
    Source::known(effect, Place::Dofs(dofs.to_vec()), &[value])
}

pub(crate) fn candidate(effect: Effect, dofs: &[usize]) -> Source {
    Source::candidate(effect, Place::Dofs(dofs.to_vec()))
}

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
                let mut channels = vec![channel(Quantity::Force, structure, self.drive, vec![force[self.drive]])];
                for &dof in &self.sensors {
                    let acceleration = vec![-x[dof] * omega * omega];
                    channels.push(channel(Quantity::Acceleration, structure, dof, acceleration));
                }
                run(format!("{f:.2} Hz"), omega, channels)
            })
            .collect()
    }
}

/// A noise-free channel.
pub(crate) fn channel(quantity: Quantity, structure: &Structure, dof: usize, amplitudes: Vec<c64>) -> ChannelFit {
    let size = 2 * amplitudes.len();
    ChannelFit {
        channel: Channel { quantity, dof, label: structure.label(dof).to_string() },
        offset: 0.0,
        slope: 0.0,
        amplitudes,
        covariance: Mat::zeros(size, size),
        noise: 0.0,
    }
}

pub(crate) fn run(name: String, omega: f64, channels: Vec<ChannelFit>) -> Run {
    Run {
        file: name,
        level: None,
        session: None,
        enabled: true,
        insisted: false,
        record: None,
        fit: HarmonicFit { omega, omega_deviation: 0.0, channels },
        noise_ratio: 0.0,
        findings: Vec::new(),
        per_unit_force: false,
    }
}

/// Adds noise of `relative` deviation of each channel's largest amplitude (real and imaginary part each) and states it.
pub(crate) fn with_noise(runs: &[Run], relative: f64, seed: u64) -> Vec<Run> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut noisy = runs.to_vec();
    for channel in noisy.iter_mut().flat_map(|r| r.fit.channels.iter_mut()) {
        let deviation = relative * channel.amplitudes.iter().fold(0.0_f64, |m, a| m.max(a.norm()));
        for amplitude in &mut channel.amplitudes {
            let mut sample = || -> f64 { StandardNormal.sample(&mut random) };
            *amplitude += c64::new(sample(), sample()) * deviation;
        }
        let size = 2 * channel.amplitudes.len();
        channel.covariance = Mat::from_fn(size, size, |i, j| if i == j { deviation * deviation } else { 0.0 });
    }
    noisy
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
