//! At the very natural frequencies of the undamped structure, where its receptance has no digits left: linear sources
//! against a direct solve of the whole dynamic stiffness, nonlinear ones by their energy and by closed forms.

use super::support::{balanced, cantilever, five_masses, source};
use crate::common::models::{oscillator, uniform_chain};
use dashpot::effects::{Effect, Source};
use dashpot::response::dynamic_stiffness::DynamicStiffness;
use dashpot::response::harmonic_balance::{Excitation, ForwardModel, Response, Settings};
use dashpot::response::sensitivity::{Unknown, sensitivities};
use dashpot::structure::Structure;
use faer::c64;
use std::f64::consts::PI;

/// Largest error of the response to a force at the last translation, relative to the largest amplitude.
fn off_direct_solve(structure: &Structure, sources: &[Source], omega: f64, dof: usize) -> f64 {
    let force = c64::new(0.7, -0.4);
    let response = balanced(structure, sources, &Excitation::sine(omega, dof, force), &Settings::default());
    let mut load = vec![c64::new(0.0, 0.0); structure.len()];
    load[dof] = force;
    let direct = DynamicStiffness::new(structure, sources).unwrap().solve(omega, &load).unwrap();
    let largest = direct.iter().fold(0.0_f64, |m, x| m.max(x.norm()));
    (0..structure.len()).fold(0.0_f64, |m, i| m.max((response.amplitude(i, 1) - direct[i]).norm())) / largest
}

#[test]
fn linear_sources_at_every_natural_frequency() {
    let beam_sources = [source(Effect::Viscous, &[14], &[0.5]), source(Effect::Hysteretic, &[8, 12], &[300.0])];
    let mass_sources = [source(Effect::Viscous, &[1, 2], &[0.8]), source(Effect::Hysteretic, &[4], &[50.0])];
    let (beam, masses) = (cantilever(10), five_masses());
    // Beyond the size up to which the inverse is formed.
    let many = uniform_chain(70, 1.0, 1e5);
    for (name, structure, sources, dof) in [
        ("beam", &beam, &beam_sources[..], 18),
        ("one source on the beam", &beam, &beam_sources[..1], 18),
        ("masses", &masses, &mass_sources[..], 4),
        ("many masses", &many, &mass_sources[..], 69),
    ] {
        let modes = structure.modes().unwrap();
        for (r, &omega) in modes.omega.iter().enumerate().take(5) {
            for shift in [1.0, 1.0 + 1e-7, 0.998, 1.02] {
                let error = off_direct_solve(structure, sources, shift * omega, dof);
                // What a direct solve itself loses grows with the amplification of the mode.
                assert!(error < 1e-9, "{name}, mode {r}, {shift} of its frequency: off by {error:.1e}");
            }
        }
    }
}

/// Energy per cycle: that put in, and that taken out by every source.
fn energies(response: &Response, excitation: &Excitation) -> [f64; 2] {
    let force = &excitation.forces[0];
    let input = PI * (force.harmonics[0] * response.amplitude(force.dof, 1).conj()).im;
    let taken = response.forces.iter().flat_map(|force| {
        (1..=response.order()).map(|h| {
            let d = force.leg.relative(|i| response.amplitude(i, h));
            PI * h as f64 * (force.harmonics[h - 1] * d.conj()).im
        })
    });
    [input, taken.sum()]
}

/// Nothing damps but a nonlinear source: the force is balanced by it alone.
#[test]
fn nonlinear_sources_alone_at_natural_frequencies() {
    let settings = Settings { estimate: false, tolerance: 1e-11, ..Settings::fixed(9) };
    let (beam, masses) = (cantilever(10), five_masses());
    for (name, structure, extra, dof, force) in [
        ("masses, quadratic", &masses, source(Effect::Quadratic, &[2], &[200.0]), 4, 20.0),
        ("masses, power", &masses, source(Effect::Power, &[2], &[60.0, 0.6]), 4, 20.0),
        ("beam, quadratic", &beam, source(Effect::Quadratic, &[18], &[0.3]), 18, 1.0),
        ("beam, power", &beam, source(Effect::Power, &[12], &[0.5, 1.5]), 18, 1.0),
    ] {
        let modes = structure.modes().unwrap();
        for r in 0..2 {
            let excitation = Excitation::sine(modes.omega[r], dof, c64::new(force, 0.0));
            let response = balanced(structure, std::slice::from_ref(&extra), &excitation, &settings);
            let [input, taken] = energies(&response, &excitation);
            assert!(input > 0.0 && (taken / input - 1.0).abs() < 1e-8, "{name}, mode {r}: {input} {taken}");
        }
    }
}

/// Friction and a dashpot at resonance, with the answer a billionth of the frequency away as judge.
#[test]
fn friction_at_natural_frequencies() {
    let settings = Settings { estimate: false, ..Settings::fixed(15) };
    let structure = cantilever(10);
    let sources = [source(Effect::Viscous, &[14], &[0.5]), source(Effect::Coulomb, &[18], &[0.2])];
    for r in 0..3 {
        let omega = structure.modes().unwrap().omega[r];
        let excitation = Excitation::sine(omega, 18, c64::new(1.0, 0.0));
        let at = balanced(&structure, &sources, &excitation, &settings);
        let beside = balanced(&structure, &sources, &excitation.at(omega * (1.0 + 1e-9)), &settings);
        let [input, taken] = energies(&at, &excitation);
        assert!((taken / input - 1.0).abs() < 1e-5, "mode {r}: {input} {taken}");
        for h in [1, 3] {
            let size = (0..20).fold(0.0_f64, |m, i| m.max(at.amplitude(i, h).norm()));
            let change = (0..20).fold(0.0_f64, |m, i| m.max((at.amplitude(i, h) - beside.amplitude(i, h)).norm()));
            assert!(change < 1e-4 * size, "mode {r}, harmonic {h}: {:.1e}", change / size);
        }
    }
}

/// One harmonic of an oscillator without other damping: `f = 8/(3 pi) c w^2 x^2`, `x` a quarter behind the force.
#[test]
fn a_quadratic_damper_alone_holds_an_oscillator_at_resonance() {
    let (c, force) = (3.0, 10.0);
    let settings = Settings { estimate: false, ..Settings::fixed(1) };
    let excitation = Excitation::sine(20.0, 0, c64::new(force, 0.0));
    let sources = [source(Effect::Quadratic, &[0], &[c])];
    let response = balanced(&oscillator(2.0, 800.0), &sources, &excitation, &settings);
    let expected = c64::new(0.0, -(force * 3.0 * PI / (8.0 * c * 400.0)).sqrt());
    assert!((response.amplitude(0, 1) - expected).norm() < 1e-4 * expected.norm());
}

/// Derivatives there by linear, nonlinear and structural unknowns, against central differences.
#[test]
fn derivatives_at_a_natural_frequency() {
    let structure = five_masses();
    let settings = Settings { estimate: false, tolerance: 1e-13, ..Settings::fixed(5) };
    let sources = |x: [f64; 3]| {
        [
            source(Effect::Viscous, &[1, 2], &[8.0 * x[0]]),
            source(Effect::Quadratic, &[2], &[300.0 * x[1]]),
            source(Effect::Mass, &[3], &[0.001 * x[2]]),
        ]
    };
    let excitation = Excitation::sine(structure.modes().unwrap().omega[1], 4, c64::new(20.0, 0.0));
    let response_with = |x: [f64; 3]| balanced(&structure, &sources(x), &excitation, &settings);
    let (all, start) = (sources([1.0; 3]), response_with([1.0; 3]));
    let run = ForwardModel::new(&structure, &all).unwrap().at(excitation.omega);
    let unknowns: Vec<Unknown> = (0..3).map(|source| Unknown::Source { source, parameter: 0 }).collect();
    let derivatives =
        sensitivities(&run, &all, &excitation, &start, &(0..run.len()).collect::<Vec<_>>(), &unknowns).unwrap();
    for (k, scale) in [8.0, 300.0, 0.001].into_iter().enumerate() {
        let step = 1e-4;
        let moved = |sign: f64| {
            let mut x = [1.0; 3];
            x[k] += sign * step;
            response_with(x)
        };
        let (plus, minus) = (moved(1.0), moved(-1.0));
        for h in [1, 3] {
            for i in 0..5 {
                let central = (plus.amplitude(i, h) - minus.amplitude(i, h)) / (2.0 * step * scale);
                let size = (0..5).fold(0.0_f64, |m, i| m.max(derivatives[k][(i, h - 1)].norm()));
                let error = (derivatives[k][(i, h - 1)] - central).norm() / size;
                assert!(error < 1e-5, "unknown {k}, harmonic {h}: {error:.1e}");
            }
        }
    }
}

/// Known springs and masses shift the natural frequencies; nothing damps but a nonlinear source. With one harmonic its
/// force is a dynamic stiffness times its motion: with that in its place, a direct solve gives the same motion.
#[test]
fn nonlinear_sources_alone_at_shifted_natural_frequencies() {
    let settings = Settings { estimate: false, tolerance: 1e-12, ..Settings::fixed(1) };
    let (beam, masses) = (cantilever(10), five_masses());
    let many = uniform_chain(70, 1.0, 1e5);
    let spring = |dofs: &[usize], k: f64| source(Effect::Stiffness, dofs, &[k]);
    let mass = |dof: usize, m: f64| source(Effect::Mass, &[dof], &[m]);
    for (name, structure, linear, damper, dof, force) in [
        ("a spring", &masses, vec![spring(&[2], 3e4)], source(Effect::Quadratic, &[2], &[200.0]), 4, 20.0),
        (
            "spring, mass",
            &masses,
            vec![spring(&[0, 3], -2e4), mass(1, 0.7)],
            source(Effect::Power, &[3], &[60.0, 0.6]),
            4,
            20.0,
        ),
        ("beam", &beam, vec![spring(&[12], 900.0), mass(18, 0.02)], source(Effect::Quadratic, &[18], &[0.3]), 18, 1.0),
        (
            "many",
            &many,
            vec![spring(&[40], 4e3), spring(&[3, 9], 2e4)],
            source(Effect::Quadratic, &[69], &[40.0]),
            69,
            1.0,
        ),
    ] {
        let shifted = natural_frequencies(structure, &linear);
        for (r, &omega) in shifted.iter().enumerate().take(3) {
            for share in [1.0, 1.0 + 1e-9] {
                let excitation = Excitation::sine(share * omega, dof, c64::new(force, 0.0));
                let sources = [&linear[..], std::slice::from_ref(&damper)].concat();
                let response = balanced(structure, &sources, &excitation, &settings);
                let place = damper.place.legs()[0];
                let answer = response.forces.iter().find(|f| f.source == linear.len()).unwrap().harmonics[0];
                let z = answer / place.relative(|i| response.amplitude(i, 1));
                let equivalent = [
                    source(Effect::Stiffness, &[place.first], &[z.re]),
                    source(Effect::Hysteretic, &[place.first], &[z.im]),
                ];
                let all = [&linear[..], &equivalent].concat();
                let mut load = vec![c64::new(0.0, 0.0); structure.len()];
                load[dof] = c64::new(force, 0.0);
                let direct = DynamicStiffness::new(structure, &all).unwrap().solve(excitation.omega, &load).unwrap();
                let largest = direct.iter().fold(0.0_f64, |m, x| m.max(x.norm()));
                let error =
                    (0..structure.len()).fold(0.0_f64, |m, i| m.max((response.amplitude(i, 1) - direct[i]).norm()));
                assert!(error < 1e-9 * largest, "{name}, mode {r}: off by {:.1e}", error / largest);
            }
        }
    }
}

/// Natural circular frequencies of the structure with springs and masses.
fn natural_frequencies(structure: &Structure, linear: &[Source]) -> Vec<f64> {
    let mut matrices = structure.matrices().unwrap().clone();
    for source in linear {
        let matrix = if source.effect == Effect::Mass { &mut matrices.mass } else { &mut matrices.stiffness };
        for leg in source.place.legs() {
            let ends = [Some((leg.first, 1.0)), leg.second.map(|j| (j, -1.0))];
            for (i, a) in ends.into_iter().flatten() {
                for (j, b) in ends.into_iter().flatten() {
                    matrix[(i, j)] += a * b * source.parameters[0];
                }
            }
        }
    }
    dashpot::structure::modes::modes(&matrices).unwrap().omega
}
