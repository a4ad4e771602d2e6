//! Sorts sources into the linear part and elements, and assembles the reduced matrices with their derivatives.

use super::element::Form;
use super::error::TransientError;
use super::reduction::{RESIDUAL_DAMPING, Reduction};
use super::setup::{TransientParameter, TransientSetup};
use super::system::Matrices;
use crate::effects::{Basis, Constant, Effect, Kind, Law, Leg, Place, Source};
use crate::response::equivalent_viscous;
use crate::structure::share::Triplets;
use faer::Mat;
use std::f64::consts::PI;

/// Phase of a residual coordinate in a step, rad, from which on it only follows.
const RESOLVED: f64 = 4.0;

/// A nonlinear relative motion: its source, leg, form, law and parameters.
pub(super) type Nonlinear = (usize, Leg, Form, &'static dyn Law, Vec<f64>);

/// Whether a source belongs to the linear part.
pub(super) fn is_linear(effect: Effect) -> bool {
    effect.constant().is_some()
}

/// Whether steps of any length are exact for an effect: it belongs to the linear part or is no force.
pub fn has_exact_steps(effect: Effect) -> bool {
    is_linear(effect) || matches!(effect.kind(), Kind::Channel(_))
}

/// Whether a law between places has a force in time that can be stepped: hysteretic damping has none, but is stepped as viscous
/// damping of the modes (`response/equivalent_viscous`).
pub fn has_force_in_time(effect: Effect) -> bool {
    let hysteretic = effect.adds_to(Constant::Hysteretic);
    effect.law().is_some_and(|law| (is_linear(effect) && !hysteretic) || Form::of(law).is_some())
}

/// The elements of a source that does not belong to the linear part.
pub(super) fn nonlinear(index: usize, source: &Source) -> Result<Vec<Nonlinear>, TransientError> {
    if has_exact_steps(source.effect) {
        return Ok(Vec::new());
    }
    let refuse = TransientError::NoTimeDomain { effect: source.effect.name() };
    let law = source.effect.law().ok_or(refuse.clone())?;
    let form = Form::of(law).ok_or(refuse)?;
    Ok(source.place.legs().into_iter().map(|leg| (index, leg, form, law, source.parameters.clone())).collect())
}

pub(super) fn pattern_matrix(n: usize, legs: &[Leg]) -> Mat<f64> {
    let mut patterns = Mat::zeros(n, legs.len());
    for (j, leg) in legs.iter().enumerate() {
        patterns[(leg.first, j)] += 1.0;
        if let Some(second) = leg.second {
            patterns[(second, j)] -= 1.0;
        }
    }
    patterns
}

/// Stiffness of a coordinate, 1/s^2, with the factors on all stiffness and on that of its mode.
pub(super) fn modal_stiffness(setup: &TransientSetup, reduction: &Reduction, r: usize) -> f64 {
    let own = if r < reduction.kept { setup.mode_stiffness.get(r).copied().unwrap_or(0.0) } else { 0.0 };
    setup.factors[0] * own.exp() * reduction.omega[r].powi(2)
}

/// Factor on the damping that laws of the whole structure give a coordinate ([`crate::structure::mode_damping`]).
fn mode_damping(setup: &TransientSetup, reduction: &Reduction, r: usize) -> f64 {
    let own = if r < reduction.kept { setup.mode_damping.get(r).copied().unwrap_or(0.0) } else { 0.0 };
    setup.structure.mode_damping(r) * own.exp()
}

/// Derivatives of the damping of the whole structure by the logarithms of the factors on that of the kept modes.
fn by_mode_damping(reduction: &Reduction, whole: &Mat<f64>) -> Vec<(TransientParameter, Matrices)> {
    let size = reduction.omega.len();
    let damping_of_mode = |r: usize| {
        let mut by = Matrices::zeros(size);
        for s in 0..size {
            by.damping[(r, s)] += 0.5 * whole[(r, s)];
            by.damping[(s, r)] += 0.5 * whole[(s, r)];
        }
        (TransientParameter::ModeDamping(r), by)
    };
    (0..reduction.kept).map(damping_of_mode).collect()
}

/// Reduced matrices with all linear sources, and their derivatives by every parameter of the linear part.
pub(super) fn assemble(
    setup: &TransientSetup,
    reduction: &Reduction,
    along: &dyn Fn(Leg) -> Vec<f64>,
) -> (Matrices, Vec<(TransientParameter, Matrices)>) {
    let size = reduction.omega.len();
    let heavy = setup.factors[1];
    let mut own = Matrices::zeros(size);
    for r in 0..size {
        own.mass[(r, r)] = heavy;
        own.stiffness[(r, r)] = modal_stiffness(setup, reduction, r);
    }
    let frequencies = own.frequencies();
    let mut changes = add_parts(setup, reduction, &mut own);
    let mut total = own.clone();
    let (mut by_stiffness, mut by_mass) = (Matrices::zeros(size), Matrices::zeros(size));
    by_stiffness.stiffness = own.stiffness.clone();
    by_mass.mass = own.mass.clone();
    let mut whole = Mat::<f64>::zeros(size, size);
    for (index, source) in setup.sources.iter().enumerate().filter(|(_, s)| is_linear(s.effect)) {
        let hysteretic = source.effect.adds_to(Constant::Hysteretic);
        let mut unit = unit_matrix(setup, reduction, source, &own, along);
        if hysteretic {
            unit = equivalent_viscous::in_coordinates(&unit, &frequencies);
        }
        let mut by = Matrices::zeros(size);
        let (value, scaled) = (source.parameters[0], faer::Scale(source.parameters[0]));
        match source.effect.constant() {
            Some(Constant::Mass) => (total.mass, by.mass) = (&total.mass + &unit * scaled, unit),
            Some(Constant::Stiffness) => (total.stiffness, by.stiffness) = (&total.stiffness + &unit * scaled, unit),
            _ => (total.damping, by.damping) = (&total.damping + &unit * scaled, unit),
        }
        if let Kind::Whole(law) = source.effect.kind() {
            let by_basis = if law.basis() == Basis::Stiffness { &mut by_stiffness } else { &mut by_mass };
            by_basis.damping += &by.damping * faer::Scale(value);
        }
        if hysteretic {
            // The natural frequencies by which it is divided go with the roots of stiffness and mass.
            by_stiffness.damping -= &by.damping * faer::Scale(0.5 * value);
            by_mass.damping += &by.damping * faer::Scale(0.5 * value);
        }
        if source.place == Place::Whole(None) {
            whole += &by.damping * faer::Scale(value);
        }
        changes.push((TransientParameter::Source { source: index, parameter: 0 }, by));
    }
    let linear = setup.sources.iter().all(|s| is_linear(s.effect));
    for r in reduction.kept..size {
        let omega = reduction.omega[r];
        total.damping[(r, r)] += 2.0 * residual_damping(setup.step.map(|step| omega * step), linear) * omega;
    }
    changes.push((TransientParameter::Stiffness, by_stiffness));
    changes.push((TransientParameter::Mass, by_mass));
    changes.extend(by_mode_damping(reduction, &whole));
    (total, changes)
}

/// Adds to the matrices of a structure what its parts are more than stated, and gives the derivatives by them.
fn add_parts(setup: &TransientSetup, reduction: &Reduction, own: &mut Matrices) -> Vec<(TransientParameter, Matrices)> {
    let size = reduction.omega.len();
    let reduced = |entries: &Triplets, factor: f64| {
        let mut sum = Mat::<f64>::zeros(size, size);
        for &(i, j, value) in entries {
            for s in 0..size {
                let along = factor * value * reduction.basis[(j, s)];
                (0..size).for_each(|r| sum[(r, s)] += reduction.basis[(i, r)] * along);
            }
        }
        sum
    };
    let mut changes = vec![Matrices::zeros(size); setup.directions.len()];
    for (p, (part, logarithm)) in setup.parts.iter().enumerate() {
        let Some(share) = setup.structure.share(*part) else { continue };
        let (stiffness, mass) = (reduced(&share.stiffness, setup.factors[0]), reduced(&share.mass, setup.factors[1]));
        own.stiffness += &stiffness * faer::Scale(logarithm.exp_m1());
        own.mass += &mass * faer::Scale(logarithm.exp_m1());
        for (by, weights) in changes.iter_mut().zip(setup.directions) {
            by.stiffness += &stiffness * faer::Scale(weights[p] * logarithm.exp());
            by.mass += &mass * faer::Scale(weights[p] * logarithm.exp());
        }
    }
    changes.into_iter().enumerate().map(|(k, by)| (TransientParameter::Direction(k), by)).collect()
}

/// Damping ratio of a residual coordinate that moves by so many rad from sample to sample and in a step of a model that is not linear. One
/// that swings faster than the steps can follow would ring under forces that jump from step to step, and its alias would turn the sign of
/// what holds friction at rest. Of a linear model no force jumps: there a coordinate within the sampled band moves as it does, or the
/// driving point would be late. One beyond it is braked as in a model that is not linear, or a law that adds nothing would leave less than
/// none.
fn residual_damping([sample, step]: [f64; 2], linear: bool) -> f64 {
    if linear && sample < PI {
        return RESIDUAL_DAMPING;
    }
    (step / RESOLVED).powi(4).clamp(RESIDUAL_DAMPING, 1.0)
}

/// What a linear source of unit parameter adds to its matrix.
fn unit_matrix(
    setup: &TransientSetup,
    reduction: &Reduction,
    source: &Source,
    own: &Matrices,
    along: &dyn Fn(Leg) -> Vec<f64>,
) -> Mat<f64> {
    let size = reduction.omega.len();
    if let (Kind::Whole(law), Place::Whole(range)) = (source.effect.kind(), &source.place) {
        let mass = law.basis() == Basis::Mass;
        let Some(range) = range else {
            let matrix = if mass { &own.mass } else { &own.stiffness };
            let root: Vec<f64> = (0..size).map(|r| mode_damping(setup, reduction, r).sqrt()).collect();
            return Mat::from_fn(size, size, |r, s| root[r] * root[s] * matrix[(r, s)]);
        };
        let mut sum = Mat::zeros(size, size);
        let factor = setup.factors[usize::from(mass)];
        for (i, j, value) in law.basis().entries(setup.structure, *range) {
            for (r, s) in (0..size).flat_map(|r| (0..size).map(move |s| (r, s))) {
                sum[(r, s)] += factor * reduction.basis[(i, r)] * value * reduction.basis[(j, s)];
            }
        }
        return sum;
    }
    let mut sum = Mat::zeros(size, size);
    for leg in source.place.legs() {
        let b = along(leg);
        sum += Mat::from_fn(size, size, |r, s| b[r] * b[s]);
    }
    sum
}
