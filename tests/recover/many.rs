//! Hundreds of candidates on a structure whose higher modes are left to a series, in part below its lowest mode, where the far end
//! moves less than a millionth of the driven one.

use super::support::*;
use crate::common::models;
use dashpot::control::Control;
use dashpot::effects::{Effect, Place, Source};
use dashpot::identify::{Form, Settings, identify};
use dashpot::structure::Structure;

const DOFS: usize = 300;
const TRUTH: [(usize, f64); 4] = [(63, 0.45), (141, 0.30), (198, 0.75), (270, 0.15)];

fn chain() -> Structure {
    let masses: Vec<f64> = (0..DOFS).map(|i| 1.0 + 0.1 * (0.7 * i as f64).sin()).collect();
    let coupling: Vec<f64> = (1..DOFS).map(|i| 2.25e4 * (1.0 + 0.2 * (0.3 * i as f64).cos())).collect();
    models::chain(&masses, &[298.0; DOFS], &coupling)
}

#[test]
fn four_of_four_dashpots_are_put_in_their_places_among_hundreds() {
    let structure = chain();
    let truth: Vec<Source> = TRUTH.iter().map(|&(dof, c)| source(Effect::Viscous, &[dof], &[c])).collect();
    let near = (0..DOFS - 1).map(|i| vec![i, i + 1]);
    let places = (0..DOFS).map(|i| vec![i]).chain(near);
    let sources: Vec<Source> = places.map(|dofs| candidate(Effect::Viscous, &dofs)).collect();
    let sensors: Vec<usize> = (0..10).map(|s| 15 + 30 * s).chain([9, 108, 225]).collect();
    let mut runs = Vec::new();
    for drive in [9, 108, 225] {
        let frequencies_hz = (0..20).map(|r| (11.0 + 0.9 * f64::from(r)) / std::f64::consts::TAU).collect();
        let rig = Rig { drive, sensors: sensors.clone(), frequencies_hz, force: 1.0 };
        runs.extend(rig.runs(&structure, &truth));
    }
    let smallest = |run: &dashpot::measurement::Run| {
        let norms = run.fit.channels[1..].iter().map(|channel| channel.amplitudes[0].norm());
        let (low, high) = norms.fold((f64::INFINITY, 0.0_f64), |(low, high), x| (low.min(x), high.max(x)));
        low / high
    };
    assert!(runs.iter().any(|run| smallest(run) < 1e-6), "some of the runs are below the lowest mode");
    let runs = with_noise(&runs, 1e-3, 15);
    let settings = Settings { max_sources: 5, harmonics: 1, ..Settings::default() };
    let outcome = identify(&structure, &sources, &runs, &settings, &Control::unattended()).unwrap();
    assert_eq!(outcome.form, Form::Response, "{}", outcome.reason);
    let found = &outcome.accepted_step().sources;
    for (dof, c) in TRUTH {
        let is_here = |place: &Place| matches!(place, Place::Dofs(d) if d.len() == 1 && d[0].abs_diff(dof) <= 1);
        let own = found.iter().filter(|e| is_here(&sources[e.source].place));
        let sum: f64 = own.map(|e| e.coefficient).sum();
        assert!((sum / c - 1.0).abs() < 0.05, "{dof}: {sum} for {c}; {found:?}");
    }
    // Neighbours may share a dashpot (0.7505 and 0.0014 N s/m here); nothing is found elsewhere.
    let is_elsewhere =
        |place: &Place| matches!(place, Place::Dofs(d) if TRUTH.iter().all(|(t, _)| d[0].abs_diff(*t) > 1));
    assert!(!found.iter().any(|e| is_elsewhere(&sources[e.source].place)), "{found:?}");
}
