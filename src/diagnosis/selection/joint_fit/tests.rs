//! Effects, model and drift of the runs together, by records whose truth is known.

#![allow(clippy::unwrap_used, reason = "tests")]
use super::*;
use crate::control::Control;
use crate::diagnosis::Problem;
use crate::diagnosis::residual::data::Data;
use crate::diagnosis::residual::prediction::{FINAL, Predictor};
use crate::effects::{Effect, Place};
use crate::measurement::{Channel, ChannelFit, HarmonicFit, Quantity, Run};
use crate::response::harmonic_balance::{Excitation, ForwardModel};
use crate::structure::Structure;
use crate::structure::chain::ChainParameters;
use faer::c64;
use std::sync::Arc;

const FORCES: [f64; 3] = [0.5, 1.0, 2.0];
const OMEGAS: [f64; 4] = [46.0, 48.0, 50.0, 52.0];

fn chain(factor: f64) -> Structure {
    let ground_stiffness = vec![2e4 * factor, 0.0, 0.0];
    ChainParameters { masses: vec![1.0; 3], ground_stiffness, coupling_stiffness: vec![1e4, 1.5e4] }.build(&[]).unwrap()
}

fn known() -> Vec<Source> {
    vec![Source::known(Effect::Viscous, Place::Dofs(vec![0]), &[0.8])]
}

fn hidden() -> Source {
    Source::known(Effect::CubicStiffness, Place::Dofs(vec![2]), &[4e6])
}

/// Relative stiffness of run `r`.
fn shift(r: usize) -> f64 {
    [4e-4, -6e-4, 2e-4, 0.0, -3e-4][r % 5]
}

/// Records of a chain whose ground spring is 2 % stiffer than stated, whose runs drift, and which hides a cubic spring.
fn runs() -> Vec<Run> {
    let model = ForwardModel::new(&chain(1.02), &known()).unwrap();
    let channel_fit = |name: usize, quantity, dof: usize, amplitudes: Vec<c64>| ChannelFit {
        channel: Channel { quantity, dof, label: format!("{}", name + 1) },
        offset: 0.0,
        slope: 0.0,
        covariance: Mat::from_fn(2 * amplitudes.len(), 2 * amplitudes.len(), |i, j| if i == j { 1e-14 } else { 0.0 }),
        amplitudes,
        noise: 1e-7,
    };
    let run = |r: usize| {
        let (omega, force) = (OMEGAS[r / FORCES.len()], FORCES[r % FORCES.len()]);
        let sources = [known(), vec![hidden()]].concat();
        let excitation = Excitation::sine(omega, 2, c64::new(force, 0.0));
        let model = model.at(omega).stiffened(1.0 + shift(r));
        let response = model.respond(&sources, &excitation, &FINAL, None, &Control::unattended()).unwrap();
        let zeros = vec![c64::new(0.0, 0.0); 2];
        let forces = [vec![c64::new(force, 0.0)], zeros].concat();
        let mut channels = vec![channel_fit(2, Quantity::Force, 2, forces)];
        let motion = |d: usize| (1..=3).map(|h| response.amplitude(d, h)).collect();
        channels.extend((0..3).map(|d| channel_fit(d, Quantity::Displacement, d, motion(d))));
        let fit = HarmonicFit { omega, omega_deviation: 0.0, channels };
        Run::from_harmonics(format!("{r}"), None, true, fit, &[])
    };
    (0..FORCES.len() * OMEGAS.len()).map(run).collect()
}

/// What `check` finds on the reference model of those records, its updating parameters free.
fn with_base(check: impl Fn(&ReferenceModel)) {
    let (stated, known, runs) = (chain(1.0), known(), runs());
    let problem = Problem { structure: &stated, sources: &known, runs: &runs };
    let data = Data::new(&problem).unwrap();
    let predictor = Arc::new(Predictor::new(&stated, known.clone(), &data).unwrap());
    let (control, early) = (Control::unattended(), |_: &[crate::diagnosis::result::Suggestion]| {});
    let reference = ReferenceModel::new(predictor, &data, &control, &early).unwrap();
    let updating = Updating::all(&stated, &known, &data);
    check(&reference.updated(&updating, &[hidden()], &Vec::new()).unwrap());
}

fn joint<'a, 'b>(reference: &'a ReferenceModel<'b>, variables: &'a Variables) -> Joint<'a, 'b> {
    let updating = reference.linearisation.updating.of_model();
    let of_model: Vec<usize> = (0..updating.len()).filter(|&k| updating.parameters[k].is_of_model()).collect();
    let units = natural_units(&updating, &of_model, reference.data.runs.len());
    let noise = reference.noise.of_channels(&reference.linearisation);
    let (settings, most, starts) = (FINAL, f64::INFINITY, Vec::new());
    Joint { reference, variables, updating, of_model, units, noise, settings, most, starts, last: None }
}

#[test]
fn the_jacobian_is_that_of_the_residual_in_effects_updating_parameters_and_shifts() {
    with_base(|reference| {
        let (variables, mut at) = Variables::new(&[hidden()]);
        let mut problem = joint(reference, &variables);
        at.extend(vec![0.1; problem.of_model.len() + reference.data.runs.len()]);
        let residual = problem.residual(&at).unwrap();
        let jacobian = problem.jacobian(&at, &residual).unwrap();
        for k in 0..at.len() {
            let moved =
                |by: f64| at.iter().enumerate().map(|(j, x)| if j == k { x + by } else { *x }).collect::<Vec<_>>();
            let step = 1e-5;
            let (up, down) = (problem.residual(&moved(step)).unwrap(), problem.residual(&moved(-step)).unwrap());
            let (mut off, mut size) = (0.0, 0.0);
            for i in 0..up.len() {
                let slope = (up[i] - down[i]) / (2.0 * step);
                off += (slope - jacobian[(i, k)]).powi(2);
                size += slope * slope;
            }
            assert!(off.sqrt() < 2e-3 * size.sqrt() + 1e-6, "variable {k}: {} of {}", off.sqrt(), size.sqrt());
        }
    });
}

#[test]
fn effect_model_and_drift_of_the_runs_are_found_together() {
    with_base(|reference| {
        let start = Source { parameters: vec![3e6], ..hidden() };
        let fit = reference.joint_fit(&[start], &Vec::new(), &FINAL, 30, f64::INFINITY).unwrap();
        let size = fit.effects[0].parameters[0];
        assert!((size / 4e6 - 1.0).abs() < 0.02, "{size}");
        // What is common to all runs is the model's; the prior draws the rest to nothing, each run as far as it is not seen.
        let centred = |list: &[f64]| -> Vec<f64> {
            let mean = list.iter().sum::<f64>() / list.len() as f64;
            list.iter().map(|x| x - mean).collect()
        };
        let truth = centred(&(0..reference.data.runs.len()).map(shift).collect::<Vec<_>>());
        let found = centred(&fit.updating.shifts);
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let cosine = product(&truth, &found) / (product(&truth, &truth) * product(&found, &found)).sqrt();
        assert!(cosine > 0.9, "{found:?} for {truth:?}");
    });
}
