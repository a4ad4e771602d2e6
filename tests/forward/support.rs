//! Structures and comparisons that the tests share.

use crate::common::models::five_masses_on;
pub(crate) use crate::common::models::{cantilever, source, whole};
use dashpot::control::Control;
use dashpot::effects::Source;
use dashpot::response::harmonic_balance::{Excitation, ForwardModel, Response, Settings};
use dashpot::response::time_integration::{Settling, TimeModel};
use dashpot::structure::Structure;
use faer::{Mat, c64};

/// The five masses of the thesis' experiment (6.2), the first on a spring to the ground.
pub(crate) fn five_masses() -> Structure {
    five_masses_on([94263.0, 0.0, 0.0, 0.0, 0.0])
}

/// Steady state by harmonic balance.
pub(crate) fn balanced(
    structure: &Structure,
    sources: &[Source],
    excitation: &Excitation,
    settings: &Settings,
) -> Response {
    let model = ForwardModel::new(structure, sources).unwrap();
    model.respond(excitation, settings, None, &Control::unattended()).unwrap()
}

/// Harmonics 1..=5 by time stepping from rest.
pub(crate) fn stepped(structure: &Structure, sources: &[Source], excitation: &Excitation, steps: usize) -> Mat<c64> {
    let mut model = TimeModel::new(structure, sources, excitation, steps).unwrap();
    model.settle(&Settling::default(), &Control::unattended()).unwrap();
    model.harmonics(5).unwrap()
}

/// Harmonics 1..=5 by time stepping from the state of a response nearby: what it settles to is its own.
pub(crate) fn stepped_from(
    start: &Response,
    structure: &Structure,
    sources: &[Source],
    excitation: &Excitation,
    steps: usize,
) -> Mat<c64> {
    let mut model = TimeModel::new(structure, sources, excitation, steps).unwrap();
    model.start_from(start);
    model.settle(&Settling::default(), &Control::unattended()).unwrap();
    model.harmonics(5).unwrap()
}

/// Largest difference of harmonic `h` over all DOFs, relative to the largest amplitude of that harmonic.
pub(crate) fn difference(response: &Response, reference: &Mat<c64>, h: usize) -> f64 {
    let n = reference.nrows();
    let largest = (0..n).fold(0.0_f64, |m, i| m.max(reference[(i, h - 1)].norm()));
    (0..n).fold(0.0_f64, |m, i| m.max((response.amplitude(i, h) - reference[(i, h - 1)]).norm())) / largest
}

/// `X_h^H K X_h`: four times the mean, twice the greatest elastic energy of harmonic `h`, J.
pub(crate) fn elastic(structure: &Structure, response: &Response, h: usize) -> f64 {
    let stiffness = &structure.matrices().unwrap().stiffness;
    let mut sum = 0.0;
    for i in 0..structure.len() {
        for j in 0..structure.len() {
            sum += (response.amplitude(i, h).conj() * response.amplitude(j, h)).re * stiffness[(i, j)];
        }
    }
    sum
}
