//! Corrections alone, of a beam whose clamp gives way.

#![allow(clippy::unwrap_used, reason = "tests")]
use super::*;
use crate::common::models::{cantilever, source};
use crate::common::runs::{displacements_run, with_noise};
use crate::control::Control;
use crate::diagnosis::Problem;
use crate::diagnosis::result::Suggestion;
use crate::effects::Effect;
use crate::measurement::Run;
use crate::response::harmonic_balance::{Excitation, ForwardModel};
use crate::structure::Part;

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
    let bare = model.bare().unwrap();
    let updating = &bare.linearisation.updating;
    let k = updating.parameters.iter().position(|p| *p == UpdatingParameter::Structure(held)).unwrap();
    assert!((updating.values[k].exp() / 0.2 - 1.0).abs() < 0.1, "{}", updating.values[k].exp());
    assert!(bare.misfit() < 1.5, "{}", bare.misfit());
}
