//! The study of incompleteness as one call: figures 3.9 to 3.13, fewer sensors, and what it refuses.

use super::energy_support::cantilever;
use dashpot::classical::ClassicalError;
use dashpot::classical::incompleteness::{Grid, Incompleteness, incompleteness, known_damping, spread_sensors};
use dashpot::classical::method::Method;
use dashpot::control::Control;
use dashpot::effects::{Effect, Place, Source, State};
use dashpot::session::workers::Threads;
use dashpot::structure::Structure;
use faer::Mat;
use std::sync::Arc;

fn truth() -> Mat<f64> {
    let mut c = Mat::zeros(20, 20);
    for (label, value) in [(3, 0.2), (13, 0.5), (17, 0.15)] {
        c[(label - 1, label - 1)] = value;
    }
    c
}

fn study(structure: &Structure, sensors: &[usize], modes: &[usize]) -> Incompleteness {
    let set = |&count: &usize| if count == 20 { (0..20).collect() } else { spread_sensors(structure, count) };
    let grid = Grid { sensors: sensors.iter().map(set).collect(), modes: modes.to_vec(), mac: true };
    incompleteness(structure, truth().as_ref(), &grid, &Control::unattended()).unwrap()
}

#[test]
fn figures_3_12_and_3_13_from_one_call() {
    let structure = cantilever(10);
    let modes = [1, 5, 10, 15, 19, 20];
    let found = study(&structure, &[20], &modes);
    let printed = [
        (Method::Lancaster, [97.47, 89.58, 29.84, 9.76, 1.30, 0.0]),
        (Method::FrfInverse, [87.05, 53.93, 2.90, 0.82, 0.03, 0.0]),
        (Method::AdhikariWoodhouse, [99.99, 99.98, 99.97, 83.38, 20.51, 0.0]),
    ];
    for (method, values) in printed {
        let curve = found.eps_c(0, method);
        assert_eq!(curve.iter().map(|p| p[0] as usize).collect::<Vec<_>>(), modes);
        for ([m, error], value) in curve.into_iter().zip(values) {
            assert!((error - value).abs() < f64::max(0.006, 6e-4 * value), "{method:?}, {m} modes: {error} {value}");
        }
    }
    for (case, value) in found.cases.iter().zip([85.3, 25.1, 1.29, 0.94, 0.28, 0.0]) {
        let (m, error) = (case.modes, case.eps_p);
        assert!((error - value).abs() < if value > 10.0 { 0.051 } else { 0.0055 }, "{m} modes: {error} {value}");
    }
    let last = found.cases.last().unwrap();
    // Figures 3.6 to 3.8: with all modes each method gives the measured modes back.
    assert!(last.methods.iter().all(|e| e.as_ref().unwrap().mac.unwrap() < 1e-6));
}

/// What the table of docs/literature.md says of fewer sensors: completing the receptance loses its lead.
#[test]
fn fewer_sensors_cost_the_inverse_most() {
    let structure = cantilever(10);
    let found = study(&structure, &[20, 10, 5], &[1, 3, 5, 10, 20]);
    let error_of = |s: usize, method, m: f64| found.eps_c(s, method).into_iter().find(|p| p[0] == m).unwrap()[1];
    for (s, inverse, lancaster) in [(0, 2.90, 29.8), (1, 21.3, 32.8)] {
        assert!((error_of(s, Method::FrfInverse, 10.0) / inverse - 1.0).abs() < 0.005);
        assert!((error_of(s, Method::Lancaster, 10.0) / lancaster - 1.0).abs() < 0.005);
    }
    // No more modes than sensors, unless every DOF has one.
    let most = |s: usize| found.cases.iter().filter(|c| c.sensors == s).map(|c| c.modes).max().unwrap();
    assert_eq!([most(0), most(1), most(2)], [20, 10, 5]);
}

#[test]
fn a_grid_is_made_for_any_structure_and_shared_among_workers() {
    let structure = cantilever(10);
    let grid = Grid::new(&structure, &[18, 6, 10]);
    assert_eq!(grid.sensors.iter().map(Vec::len).collect::<Vec<_>>(), [20, 10, 5, 3, 3]);
    assert_eq!(grid.sensors[4], [6, 10, 18]);
    assert!(grid.mac && grid.modes.len() == 20);
    let small = Grid { modes: vec![2, 7], ..grid };
    let alone = incompleteness(&structure, truth().as_ref(), &small, &Control::unattended()).unwrap();
    let control = Control::unattended().with_workers(Arc::new(Threads));
    assert_eq!(incompleteness(&structure, truth().as_ref(), &small, &control).unwrap(), alone);
    assert!((control.progress() - 1.0).abs() < 1e-6);
}

#[test]
fn what_cannot_be_studied_is_said() {
    let structure = cantilever(10);
    let grid = Grid::new(&structure, &[]);
    let nothing = incompleteness(&structure, Mat::zeros(20, 20).as_ref(), &grid, &Control::unattended());
    assert!(matches!(nothing, Err(ClassicalError::Missing { .. })));
    let wrong = incompleteness(&structure, Mat::identity(3, 3).as_ref(), &grid, &Control::unattended());
    assert!(matches!(wrong, Err(ClassicalError::Structure(_))));
    let control = Control::unattended();
    control.cancel();
    let cancelled = incompleteness(&structure, truth().as_ref(), &grid, &control);
    assert_eq!(cancelled, Err(ClassicalError::Cancelled));
}

#[test]
fn the_damping_to_be_found_is_what_is_known_or_for_reference() {
    let structure = cantilever(10);
    let mut source = Source::known(Effect::Viscous, Place::Dofs(vec![2]), &[0.2]);
    let known = known_damping(&structure, std::slice::from_ref(&source)).unwrap();
    assert_eq!((known[(2, 2)], known.norm_l2()), (0.2, 0.2));
    source.state = State::Reference;
    assert_eq!(known_damping(&structure, std::slice::from_ref(&source)), Some(known));
    source.state = State::Candidate;
    assert_eq!(known_damping(&structure, &[source]), None);
    let friction = Source::known(Effect::Coulomb, Place::Dofs(vec![2]), &[0.2]);
    assert_eq!(known_damping(&structure, &[friction]), None);
}
