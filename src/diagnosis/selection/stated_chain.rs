//! A chain whose model states a ground spring 2 % too soft and not the cubic spring that its runs show, for the tests of these files.

#![allow(clippy::unwrap_used, reason = "tests")]
use crate::common::models::{source, three_masses};
use crate::common::runs::{channel, run};
use crate::control::Control;
use crate::diagnosis::Problem;
use crate::diagnosis::residual::data::Data;
use crate::diagnosis::residual::prediction::{FINAL, Predictor};
use crate::diagnosis::result::Suggestion;
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::diagnosis::updating::parameters::Updating;
use crate::effects::{Effect, Source};
use crate::measurement::{Quantity, Run};
use crate::response::harmonic_balance::{Excitation, ForwardModel};
use faer::c64;
use std::sync::Arc;

/// The dashpot that is stated.
pub(super) fn known() -> Source {
    source(Effect::Viscous, &[0], &[0.8])
}

/// The cubic spring that is not.
pub(super) fn hidden() -> Source {
    source(Effect::CubicStiffness, &[2], &[4e6])
}

/// Runs at two levels about the first mode of a chain whose ground spring is 2 % stiffer than stated and which hides a cubic spring.
fn runs() -> Vec<Run> {
    let (structure, deviation) = (three_masses([1.02, 1.0, 1.0]), 1e-7);
    let model = ForwardModel::new(&structure, &[known()]).unwrap();
    let measured_run = |(omega, force): (f64, f64)| {
        let amplitude = c64::new(force, 0.0);
        let excitation = Excitation::sine(omega, 2, amplitude);
        let (sources, control) = ([known(), hidden()], Control::unattended());
        let response = model.at(omega).respond(&sources, &excitation, &FINAL, None, &control).unwrap();
        let motion = |dof: usize| (1..=3).map(|h| response.amplitude(dof, h)).collect();
        let zero = c64::new(0.0, 0.0);
        let mut channels = vec![channel(Quantity::Force, 2, vec![amplitude, zero, zero], deviation)];
        channels.extend((0..3).map(|dof| channel(Quantity::Displacement, dof, motion(dof), deviation)));
        run(format!("{omega} rad/s, {force} N"), omega, channels)
    };
    [46.0, 48.0, 50.0, 52.0].into_iter().flat_map(|omega| [(omega, 1.0), (omega, 2.0)]).map(measured_run).collect()
}

/// Does a test with the model as it is stated, linearised beside `effects`.
pub(super) fn with_stated<T>(effects: &[Source], test: impl FnOnce(ReferenceModel) -> T) -> T {
    let (stated, sources, runs) = (three_masses([1.0; 3]), vec![known()], runs());
    let data = Data::new(&Problem { structure: &stated, sources: &sources, runs: &runs }).unwrap();
    let predictor = Arc::new(Predictor::new(&stated, sources.clone(), &data).unwrap());
    let (control, early) = (Control::unattended(), |_: &[Suggestion]| {});
    let model = ReferenceModel::new(predictor, &data, &control, &early).unwrap();
    test(model.updated(&Updating::all(&stated, &sources, &data), effects, &Vec::new()).unwrap())
}
