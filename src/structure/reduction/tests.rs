//! Reduced beams against closed forms and against the modes of the whole model.
#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::common::models::cantilever_parameters;
use crate::structure::beam::{BeamParameters, Supports};
use crate::structure::error::StructureError;
use crate::structure::geometry::Direction;
use crate::structure::system::Structure;
use dashpot_numerics::SparseSymmetric;
use faer::MatRef;

fn beam(elements: usize, supports: Supports) -> (BeamParameters, Structure) {
    let p = BeamParameters { supports, ..cantilever_parameters(elements) };
    let structure = p.build(&[]).unwrap();
    (p, structure)
}

fn sparse(a: MatRef<'_, f64>) -> SparseSymmetric {
    let n = a.nrows();
    let places = (0..n).flat_map(|j| (j..n).map(move |i| (i, j)));
    let entries: Vec<_> = places.filter(|&p| a[p] != 0.0).map(|(i, j)| (i, j, a[(i, j)])).collect();
    SparseSymmetric::from_entries(n, &entries).unwrap()
}

fn system(structure: &Structure) -> (SparseSystem, Vec<Direction>) {
    let matrices = structure.matrices().unwrap();
    let directions = structure.dofs().iter().map(|dof| dof.direction).collect();
    (SparseSystem { mass: sparse(matrices.mass.as_ref()), stiffness: sparse(matrices.stiffness.as_ref()) }, directions)
}

/// `beta L` of a cantilever; `f = (beta L)^2 sqrt(E I / rho A) / (2 pi L^2)`.
#[test]
fn craig_bampton_reaches_the_closed_form_of_a_cantilever() {
    let (p, structure) = beam(60, Supports::ClampedFree);
    let (system, directions) = system(&structure);
    let wanted = Wanted { method: ReductionMethod::CraigBampton, up_to_hz: 1500.0, band_hz: 700.0, error: 1.0 };
    let (_, reduction) = reduce(&system, &directions, &[30, 60, 118], wanted).unwrap();
    let stiffness = p.youngs_modulus * p.breadth * p.depth.powi(3) / 12.0;
    let speed = (stiffness / (p.density * p.breadth * p.depth)).sqrt();
    let exact = [1.875_104_07, 4.694_091_13, 7.854_757_44, 10.995_540_73];
    assert_eq!((reduction.kept, reduction.fixed_interface_modes, reduction.modes.len()), (3, 5, 5));
    // The same reduction with dense matrices by LAPACK, a route of its own.
    assert!((reduction.modes[2].reduced_hz / 182.838_092_76 - 1.0).abs() < 1e-9);
    for (mode, beta) in reduction.modes.iter().zip(exact) {
        let hz = beta * beta * speed / (std::f64::consts::TAU * p.length * p.length);
        // What the modes above 1500 Hz would add.
        assert!((mode.reduced_hz / hz - 1.0).abs() < 3e-3, "{} {hz}", mode.reduced_hz);
        assert!(mode.frequency_error().abs() < 3e-3 && mode.mac > 0.999, "{mode:?}");
    }
}

#[test]
fn frequencies_are_those_of_the_whole_model() {
    let (_, structure) = beam(60, Supports::ClampedFree);
    let (system, directions) = system(&structure);
    let own = structure.modes().unwrap();
    for (method, tolerance) in [(ReductionMethod::CraigBampton, 2e-3), (ReductionMethod::Guyan, 0.02)] {
        let wanted = Wanted { method, up_to_hz: 2000.0, band_hz: 300.0, error: 1.0 };
        let (_, reduction) = reduce(&system, &directions, &[20, 40, 60, 80, 100, 118], wanted).unwrap();
        assert_eq!(reduction.modes.len(), own.omega.iter().filter(|w| **w < 300.0 * std::f64::consts::TAU).count());
        for (r, mode) in reduction.modes.iter().enumerate() {
            assert!((mode.full_hz / own.frequency_hz(r) - 1.0).abs() < 1e-8, "{mode:?}");
            // Rayleigh and Ritz: never below.
            assert!((-1e-8..tolerance).contains(&mode.frequency_error()), "{method:?} {mode:?}");
        }
    }
}

#[test]
fn modes_are_kept_until_the_error_that_is_told_is_what_was_asked() {
    let (_, structure) = beam(60, Supports::ClampedFree);
    let (system, directions) = system(&structure);
    let loose = Wanted { method: ReductionMethod::CraigBampton, up_to_hz: 1500.0, band_hz: 700.0, error: 1.0 };
    let worst = |wanted: Wanted| {
        let (matrices, reduction) = reduce(&system, &directions, &[30, 60, 118], wanted).unwrap();
        assert_eq!(matrices.mass.nrows(), reduction.kept + reduction.fixed_interface_modes);
        (reduction.worst().unwrap().frequency_error(), reduction.fixed_interface_modes, reduction.wanted.up_to_hz)
    };
    let (before, few, asked) = worst(loose);
    assert!(before > 1e-3 && few == 5 && asked == 1500.0, "{before} {few}");
    for error in [1e-3, 1e-4] {
        let (after, more, up_to) = worst(Wanted { error, ..loose });
        assert!(after <= error && more > few && up_to > asked, "{error}: {after} {more} {up_to}");
    }
    // What cannot be reached ends with the best.
    let (best, ..) = worst(Wanted { error: 0.0, ..loose });
    assert!(best < 1e-4);
}

/// Static displacements under forces at kept degrees of freedom are exact by Guyan.
#[test]
fn guyan_is_exact_at_rest() {
    let (_, structure) = beam(20, Supports::ClampedFree);
    let (system, directions) = system(&structure);
    let wanted = Wanted { method: ReductionMethod::Guyan, up_to_hz: 100.0, band_hz: 100.0, error: 1.0 };
    let kept = [10, 38];
    let (matrices, _) = reduce(&system, &directions, &kept, wanted).unwrap();
    let whole = dashpot_numerics::Cholesky::new(structure.matrices().unwrap().stiffness.as_ref()).unwrap();
    let part = dashpot_numerics::Cholesky::new(matrices.stiffness.as_ref()).unwrap();
    let force = faer::Mat::from_fn(40, 1, |i, _| if i == 38 { 1.0 } else { 0.0 });
    let x = whole.solve(force.as_ref());
    let y = part.solve(faer::mat![[0.0], [1.0]].as_ref());
    assert!((0..2).all(|k| (x[(kept[k], 0)] / y[(k, 0)] - 1.0).abs() < 1e-8));
}

#[test]
fn a_free_beam_keeps_its_rigid_motions_and_its_mass() {
    let (p, structure) = beam(40, Supports::FreeFree);
    let (system, directions) = system(&structure);
    let wanted = Wanted { method: ReductionMethod::CraigBampton, up_to_hz: 1000.0, band_hz: 400.0, error: 1.0 };
    let (matrices, reduction) = reduce(&system, &directions, &[0], wanted).unwrap();
    assert!(reduction.modes[1].full_hz == 0.0 && reduction.modes[1].reduced_hz < 1e-2, "{:?}", reduction.modes);
    assert!(reduction.modes[2].frequency_error().abs() < 1e-4);
    // A rigid translation z: r^T M r is the mass of the beam.
    let mass = p.density * p.length * p.breadth * p.depth;
    let load = &reduction.base_loads[2];
    let inverse = dashpot_numerics::Cholesky::new(matrices.mass.as_ref()).unwrap();
    let right = faer::Mat::from_fn(load.len(), 1, |i, _| load[i]);
    let r = inverse.solve(right.as_ref());
    let total: f64 = (0..load.len()).map(|i| r[(i, 0)] * load[i]).sum();
    assert!((total / mass - 1.0).abs() < 1e-6, "{total} {mass}");
}

#[test]
fn what_cannot_be_done_is_said() {
    let (_, structure) = beam(10, Supports::FreeFree);
    let (system, directions) = system(&structure);
    let wanted = Wanted { method: ReductionMethod::Guyan, up_to_hz: 1000.0, band_hz: 400.0, error: 1.0 };
    assert_eq!(reduce(&system, &directions, &[], wanted).unwrap_err(), StructureError::NothingKept);
    let all: Vec<usize> = (0..22).collect();
    let error = reduce(&system, &directions, &all, wanted).unwrap_err();
    assert_eq!(error, StructureError::NothingReduced { kept: 22, degrees: 22 });
}

#[test]
fn limits_that_were_computed_are_said_to_six_digits() {
    let (_, structure) = beam(12, Supports::ClampedFree);
    let (system, directions) = system(&structure);
    let wanted =
        Wanted { method: ReductionMethod::CraigBampton, up_to_hz: 6.0 * 308.1, band_hz: 3.0 * 308.1, error: 0.5 };
    assert_eq!(wanted.up_to_hz.to_string(), "1848.6000000000001");
    let sentence = reduce(&system, &directions, &[10, 22], wanted).unwrap().1.sentence();
    assert!(sentence.contains("up to 1848.6 Hz") && sentence.contains("up to 924.3 Hz"), "{sentence}");
}
