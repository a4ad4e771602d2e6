//! Corrections alone, of a beam whose clamp gives way; what the level of the force of a run does to a response that is not linear.

#![allow(clippy::unwrap_used, reason = "tests")]
use super::*;
use crate::common::models::{cantilever, source};
use crate::common::runs::{displacements_run, with_noise};
use crate::control::Control;
use crate::diagnosis::Problem;
use crate::diagnosis::residual::prediction::Predictor;
use crate::diagnosis::result::Suggestion;
use crate::diagnosis::selection::stated_chain::{hidden, with_stated};
use crate::diagnosis::updating::noise_model::OWN;
use crate::diagnosis::updating::parameters::UpdatingParameter;
use crate::effects::Effect;
use crate::measurement::Run;
use crate::response::harmonic_balance::{Excitation, ForwardModel};
use crate::structure::Part;
use dashpot_numerics::{Cholesky, dot};
use faer::Mat;

/// Runs about the first two modes of a beam with a dashpot at its tip, on a clamp of which a fifth is left.
fn runs(held: Part, known: &[Source]) -> Vec<Run> {
    let structure = cantilever(4).with_factors(&[(held, 0.2)]);
    let omegas = structure.modes().unwrap().omega;
    let model = ForwardModel::new(&structure, known).unwrap();
    let run_at_frequency = |omega: f64| {
        let excitation = Excitation::sine(omega, 6, c64::new(1.0, 0.0));
        let response = model.at(omega).respond(known, &excitation, &FINAL, None, &Control::unattended()).unwrap();
        let motion: Vec<c64> = (0..8).map(|dof| response.amplitude(dof, 1)).collect();
        displacements_run(omega, (6, 1.0), &motion, 0.0)
    };
    let around = |omega: &f64| [0.9, 0.97, 1.03, 1.1].map(|factor| factor * omega);
    with_noise(&omegas[..2].iter().flat_map(around).map(run_at_frequency).collect::<Vec<_>>(), 1e-3, 7)
}

/// Corrections alone find that it is the clamp that gives way, not the elements beside it.
#[test]
fn corrections_find_a_clamp_that_gives_way() {
    let (stated, known) = (cantilever(4), [source(Effect::Viscous, &[6], &[0.5])]);
    let held = Part::Support(stated.supports()[0]);
    let runs = runs(held, &known);
    let data = Data::new(&Problem { structure: &stated, sources: &known, runs: &runs }).unwrap();
    let predictor = Arc::new(Predictor::new(&stated, known.to_vec(), &data).unwrap());
    let (control, early) = (Control::unattended(), |_: &[Suggestion]| {});
    let model = ReferenceModel::new(predictor, &data, &control, &early).unwrap();
    // Nothing is free yet: there is nothing to scale, and no run is lost.
    assert!(model.count() > 0 && model.with_scales(Scales::SEARCH).count() == model.count());
    let bare = model.bare().unwrap();
    let updating = &bare.linearisation.updating;
    let k = updating.parameters.iter().position(|p| *p == UpdatingParameter::Structure(held)).unwrap();
    assert!((updating.values[k].exp() / 0.2 - 1.0).abs() < 0.1, "{}", updating.values[k].exp());
    assert!(bare.misfit() < 1.5, "{}", bare.misfit());
}

/// The response of a chain with a cubic spring follows the level of its force by its derivative, by differences, which is not the
/// response; of the linear chain it is that, and not asked for.
#[test]
fn the_level_of_a_run_is_that_of_its_force() {
    const STEP: f64 = 1e-5;
    let effects = [hidden()];
    let follows = |reference: ReferenceModel, effects: &[Source]| {
        let response =
            |reference: &ReferenceModel| reference.estimator().predict(effects, &FINAL, &Vec::new()).unwrap();
        let mut runs = reference.data.runs.clone();
        let forces = runs.iter_mut().flat_map(|run| &mut run.forces).flat_map(|force| &mut force.measured);
        forces.for_each(|amplitude| *amplitude *= 1.0 + STEP);
        let data = Data { runs, ..reference.data.clone() };
        let louder = ReferenceModel { data: &data, ..reference.shallow() };
        let (here, there) = (response(&reference), response(&louder));
        let mut unlike: f64 = 0.0;
        for (r, level) in reference.linearisation.derivatives.level.iter().enumerate() {
            for (c, level) in level.iter().enumerate() {
                let difference = (there[r].channels[c][0] - here[r].channels[c][0]) / STEP;
                assert!((level[0] - difference).norm() < 1e-3 * difference.norm(), "{} for {difference}", level[0]);
                unlike = unlike.max((level[0] / here[r].channels[c][0] - 1.0).norm());
            }
        }
        unlike
    };
    assert!(with_stated(&effects, |reference| follows(reference, &effects)) > 0.3);
    assert!(with_stated(&[], |reference| reference.linearisation.derivatives.level.iter().all(Vec::is_empty)));
}

/// Whatever the scales, what is left with all parameters eliminated is `r^T C^-1 r`, and what they cost is `ln det C`, of the covariance
/// `C = 1 + B B^T + V V^T` of the whitened residual `r` itself.
#[test]
fn eliminated_parameters_are_a_covariance_at_all_scales() {
    let effects = [hidden()];
    let differences = |reference: ReferenceModel| {
        let predictions = reference.estimator().predict(&effects, &FINAL, &Vec::new()).unwrap();
        let list = reference.linearisation.updating.scales.list();
        let compared = |factor: f64| {
            let scaled = reference.with_scales(Scales::from_list(list.map(|scale| factor * scale)));
            let (covariance, rows) = covariance(&scaled.doubting_harmonics(), &predictions);
            let solved = Cholesky::new(covariance.as_ref()).unwrap();
            let right = Mat::from_fn(rows.len(), 1, |i, _| rows[i]);
            let square = dot(&rows, solved.solve(right.as_ref()).col_as_slice(0));
            let log_determinant: f64 = (0..rows.len()).map(|i| 2.0 * solved.factor()[(i, i)].ln()).sum();
            let told = sum_of_squares(&scaled.estimator().residual(&predictions));
            let cost = scaled.noise.cost() - scaled.linearisation.updating.scales.prior_cost();
            [told / square - 1.0, cost / log_determinant - 1.0]
        };
        [1.0, 0.3, 4.0].map(compared)
    };
    for [square, determinant] in with_stated(&effects, differences) {
        assert!(square.abs() < 1e-6 && determinant.abs() < 1e-6, "{square} {determinant}");
    }
}

/// Covariance of the whitened residual of all runs, entry by entry, and that residual.
fn covariance(reference: &ReferenceModel, predictions: &[RunPrediction]) -> (Mat<f64>, Vec<f64>) {
    let (data, linearisation) = (reference.data, &reference.linearisation);
    assert!(linearisation.updating.values.iter().all(|value| *value == 0.0), "nothing is corrected yet");
    let (mut rows, mut common) = (Vec::new(), vec![Vec::new(); linearisation.updating.len()]);
    let mut own = Vec::new();
    for (r, (run, prediction)) in data.runs.iter().zip(predictions).enumerate() {
        let (noise, first) = (&reference.noise.runs[r], rows.len());
        rows.extend(noise.rows(|c, h| run.responses[c].measured[h - 1] - prediction.channels[c][h - 1]));
        let column = |which: usize, k: usize| noise.rows(|c, h| linearisation.of_harmonic(r, h)[which][k][c]);
        common.iter_mut().enumerate().for_each(|(k, list)| list.extend(column(0, k)));
        own.extend((0..OWN).map(|k| (first, column(1, k))));
    }
    let mut covariance = Mat::<f64>::identity(rows.len(), rows.len());
    let columns = common.into_iter().map(|column| (0, column)).chain(own);
    for (first, column) in columns {
        for (i, a) in column.iter().enumerate() {
            column.iter().enumerate().for_each(|(j, b)| covariance[(first + i, first + j)] += a * b);
        }
    }
    (covariance, rows)
}
