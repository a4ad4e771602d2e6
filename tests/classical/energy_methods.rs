//! Liang's balance of every DOF.

use super::support::*;
use dashpot::balance::expansion::Acting;
use dashpot::balance::{Expander, Expansion, Measured};
use dashpot::classical::ClassicalError;
use dashpot::classical::liang::{Period, liang};
use dashpot::effects::{Effect, Place, Source};
use dashpot::measurement::{Channel, ChannelFit, HarmonicFit, Quantity, Run};
use dashpot::structure::Structure;
use faer::{Mat, c64};
use std::f64::consts::TAU;

fn channel(structure: &Structure, quantity: Quantity, dof: usize, amplitude: c64) -> ChannelFit {
    ChannelFit {
        channel: Channel { quantity, dof, label: structure.label(dof).to_string() },
        offset: 0.0,
        slope: 0.0,
        amplitudes: vec![amplitude],
        covariance: Mat::zeros(2, 2),
        noise: 0.0,
    }
}

fn periods(structure: &Structure, sensors: usize) -> Result<Vec<Period>, ClassicalError> {
    let lines = [21.0, 33.0, 42.0, 53.0, 65.0];
    let h = receptance(structure, &damping(), &Mat::zeros(5, 5), &lines);
    let expander = Expander::new(structure, Expansion::None, &[]).unwrap();
    (0..lines.len())
        .map(|k| {
            let mut channels = vec![channel(structure, Quantity::Force, 4, c64::new(2.0, 0.5))];
            for dof in 0..sensors {
                let x = h.matrices[k][(dof, 4)] * c64::new(2.0, 0.5);
                channels.push(channel(structure, Quantity::Displacement, dof, x));
            }
            let fit = HarmonicFit { omega: TAU * lines[k], omega_deviation: 0.0, channels };
            let run = Run {
                file: format!("{k}"),
                level: None,
                session: None,
                insisted: false,
                enabled: true,
                record: None,
                fit,
                noise_ratio: 0.0,
                findings: vec![],
                per_unit_force: false,
                functions: None,
                on_moving_base: false,
            };
            let measured = Measured::new(&run).unwrap();
            let expanded = expander.expand(&measured, Acting::NOTHING).unwrap();
            Period::of_run(&measured, &expanded)
        })
        .collect()
}

fn pattern() -> Vec<Source> {
    let grounded = (0..5).map(|i| Source::candidate(Effect::Viscous, Place::Dofs(vec![i])));
    let between = (0..4).map(|i| Source::candidate(Effect::Viscous, Place::Dofs(vec![i, i + 1])));
    grounded.chain(between).collect()
}

#[test]
fn liang_is_exact_on_the_pattern_that_holds_the_truth() {
    let structure = five_masses();
    let found = liang(&structure, &periods(&structure, 5).unwrap(), &pattern(), &[]).unwrap();
    assert_exact(&found.damping.viscous, &damping());
    assert!(found.damping.notes.is_empty(), "{:?}", found.damping.notes);
}

#[test]
fn liang_needs_every_sensor() {
    let structure = five_masses();
    let error = periods(&structure, 4).unwrap_err();
    assert_eq!(error, ClassicalError::Missing { what: "the motion of every DOF in every run".to_string() });
}
