//! Case 3 of section 5.2: three dashpots and three friction devices, tables 5.8 and 5.9. Linear algebra, not a test: each run
//! is a mode with a tip velocity of 68.7 m/s, and the force is what balances the energy.

use super::energy_support::*;
use dashpot::control::Control;
use dashpot::effects::{Effect, Place, Source};
use dashpot::identify::{Outcome, Settings, identify};
use dashpot::measurement::{Quantity, Run};
use dashpot::structure::Structure;
use faer::c64;
use std::f64::consts::PI;

const TIP_VELOCITY: f64 = 68.7;

fn runs(structure: &Structure) -> Vec<Run> {
    let modes = structure.modes().unwrap();
    (0..8)
        .map(|r| {
            let omega = modes.omega[r];
            let x = |dof: usize| modes.shapes[(dof, r)] / modes.shapes[(18, r)] * TIP_VELOCITY / omega;
            let viscous: f64 =
                [(3, 0.2), (13, 0.5), (17, 0.15)].iter().map(|&(l, c)| PI * c * omega * x(l - 1).powi(2)).sum();
            let friction: f64 = [(7, 3.2), (15, 5.1), (19, 1.0)].iter().map(|&(l, f)| 4.0 * f * x(l - 1).abs()).sum();
            // Input energy pi Im(conj(X) F) of a force in quadrature with the tip.
            let force = c64::new(0.0, (viscous + friction) / (PI * x(18)));
            let mut channels = vec![channel(Quantity::Force, 18, vec![force], 0.0)];
            for dof in [6, 10, 18] {
                channels.push(channel(Quantity::Acceleration, dof, vec![c64::new(-x(dof) * omega * omega, 0.0)], 0.0));
            }
            run(format!("mode {}", r + 1), omega, channels)
        })
        .collect()
}

fn candidates(structure: &Structure) -> Vec<Source> {
    [Effect::Viscous, Effect::Coulomb].into_iter().flat_map(|effect| each_dof(structure, effect)).collect()
}

/// Names such as `C13` and `v3` with values. With the same tip velocity in every run a dashpot at the tip is parallel to
/// friction there, and either may be found: it is told as friction, `4 F X = pi c v X`.
fn named(outcome: &Outcome, sources: &[Source], count: usize) -> (Vec<(String, f64)>, f64) {
    let step = outcome.steps.iter().find(|s| s.count == count).unwrap();
    let name = |s: usize, value: f64| {
        let Place::Dofs(dofs) = &sources[s].place else { panic!() };
        match (sources[s].effect, dofs[0] + 1) {
            (Effect::Viscous, 19) => ("C19".to_string(), value * PI * TIP_VELOCITY / 4.0),
            (Effect::Viscous, label) => (format!("v{label}"), value),
            (_, label) => (format!("C{label}"), value),
        }
    };
    let mut found: Vec<(String, f64)> = step.sources.iter().map(|e| name(e.source, e.coefficient)).collect();
    found.sort_by(|a, b| a.0.cmp(&b.0));
    (found, step.angle_deg)
}

fn assert_named(outcome: &Outcome, sources: &[Source], expected: &[(&str, f64)], angle_deg: f64, tolerance: f64) {
    let (found, angle) = named(outcome, sources, expected.len());
    for ((name, value), (expected_name, expected_value)) in found.iter().zip(expected) {
        assert_eq!(name, expected_name, "{found:?} {angle} deg");
        assert!((value - expected_value).abs() <= tolerance * expected_value, "{found:?}");
    }
    assert!((angle - angle_deg).abs() < 6e-4, "{found:?}: {angle} deg");
}

#[test]
fn table_5_9_case_3() {
    let structure = cantilever(10);
    let sources = candidates(&structure);
    let settings = Settings { max_sources: 6, stop_angle_deg: 1e-4, ..thesis_settings() };
    let outcome = identify(&structure, &sources, &runs(&structure), &settings, &Control::unattended()).unwrap();
    assert_named(&outcome, &sources, &[("C13", 35.35)], 0.947, 2e-4);
    assert_named(&outcome, &sources, &[("C13", 28.1), ("C15", 5.9)], 0.236, 3e-3);
    assert_named(&outcome, &sources, &[("C15", 7.81), ("C19", 6.36), ("v13", 0.472)], 0.0898, 2e-3);
    let exact = [("C15", 5.1), ("C19", 1.0), ("C7", 3.2), ("v13", 0.5), ("v17", 0.15), ("v3", 0.2)];
    assert_named(&outcome, &sources, &exact, 0.0, 1e-6);
    assert!(
        outcome.warnings.iter().any(|w| w.contains("viscous dashpot at DOF 19 and Coulomb friction at DOF 19")),
        "{:?}",
        outcome.warnings
    );
    assert_eq!(outcome.accepted_step().count, 6);
}
