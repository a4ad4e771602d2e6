#![allow(warnings)]
// Periodic responses by harmonic balance: one response against time stepping, a sweep through folds, growth in size, and
// the comparison of a model with 24 runs.

use dashpot::control::Control;
use dashpot::effects::{Effect, Place, Source};
use dashpot::explain::{Problem, compare};
use dashpot::measurement::{Run, fit::fit};
use dashpot::response::harmonic_balance::{Excitation, ForwardModel, Settings, SweepSettings, sweep};
use dashpot::response::sensitivity::{Unknown, sensitivities};
use dashpot::response::simulation::{SteadyState, recorded, usual_channels};
use dashpot::response::synthesis::{Noise, sampling_times, synthesise};
use dashpot::response::time_integration::{Settling, TimeError, TimeModel};
use dashpot::structure::Structure;
use dashpot::structure::beam::{BeamParameters, Supports};
use dashpot::structure::chain::ChainParameters;
use faer::{Mat, c64};
use std::f64::consts::TAU;
use std::hint::black_box;

fn beam(elements: usize) -> Structure {
    let (youngs_modulus, density, supports) = (69e9, 2700.0, Supports::ClampedFree);
    BeamParameters { length: 0.56, breadth: 0.04, depth: 0.004, youngs_modulus, density, elements, supports }
        .build(&[])
        .unwrap_or_else(|error| panic!("{error}"))
}

fn source(effect: Effect, dof: usize, parameters: &[f64]) -> Source {
    Source::known(effect, Place::Dofs(vec![dof]), parameters)
}

fn damped() -> Source {
    Source::known(Effect::StiffnessProportional, Place::Whole(None), &[2e-5])
}

/// Translation of a beam of `n` DOFs at a share of its length.
fn row(n: usize, share: f64) -> usize {
    2 * ((n / 2 - 1) as f64 * share) as usize
}

fn friction(n: usize, count: usize) -> Vec<Source> {
    let at = |k: usize| source(Effect::Coulomb, row(n, (k + 1) as f64 / count as f64), &[0.3 / (k + 1) as f64]);
    [vec![damped(), source(Effect::Viscous, row(n, 0.2), &[0.2])], (0..count).map(at).collect()].concat()
}

/// 24 runs of the beam with friction: eight frequencies, three forces.
fn measured() -> (Structure, Vec<Source>, Vec<Run>) {
    let (structure, sources) = (beam(10), friction(20, 3));
    let mut runs = Vec::new();
    let Ok(model) = ForwardModel::new(&structure, &sources) else { return (structure, sources, runs) };
    for k in 0..24 {
        let hz = [9.5, 10.2, 11.0, 60.0, 65.0, 70.0, 175.0, 185.0][k % 8];
        let excitation = Excitation::sine(TAU * hz, 18, c64::new([1.0, 2.0, 4.0][k / 8], 0.0));
        let Ok(response) = model.respond(&excitation, &Settings::default(), None, &Control::unattended()) else {
            continue;
        };
        let state = SteadyState { mean: response.mean, harmonics: response.harmonics };
        let motions = recorded(&state, &excitation, &usual_channels(&structure, &excitation)[..5], &[]);
        let noise = Noise { ratio: 0.01, seed: 1, stream: k as u64 };
        let time = sampling_times(excitation.omega, 20.0, 1000);
        let Ok(record) = synthesise(excitation.omega, &time, &motions, Some(noise)) else { continue };
        let Ok(fit) = fit(&record, excitation.omega, 7) else { continue };
        let file = format!("run-{k:02}.csv");
        let run = Run { file, level: None, enabled: true, record: None, fit, noise_ratio: 0.01, findings: Vec::new() };
        runs.push(run);
    }
    (structure, sources, runs)
}

use std::time::Instant;
fn main() {
    faer::set_global_parallelism(faer::Par::Seq);
    let what = std::env::args().nth(1).unwrap_or_default();
    if what == "compare" {
        let (structure, sources, runs) = measured();
        for (name, sources) in [("linear", &sources[..2]), ("friction", &sources[..])] {
            let problem = Problem { structure: &structure, sources, runs: &runs };
            let mut best = f64::INFINITY;
            for _ in 0..20 {
                let t = Instant::now();
                let c = compare(&problem, &[], &Control::unattended()).unwrap();
                black_box(&c);
                best = best.min(t.elapsed().as_secs_f64());
            }
            let c = compare(&problem, &[], &Control::unattended()).unwrap();
            println!("{name}: {:.2} ms, error {} floor {}", best * 1e3, c.error, c.noise_floor);
        }
    }
    if what == "steps" {
        let (structure, sources, runs) = measured();
        let model = ForwardModel::new(&structure, &sources).unwrap();
        for run in &runs {
            let forces = run
                .fit
                .channels
                .iter()
                .filter(|c| c.channel.quantity == dashpot::measurement::Quantity::Force)
                .map(|c| dashpot::response::harmonic_balance::HarmonicForce {
                    dof: c.channel.dof,
                    mean: 0.0,
                    harmonics: c.amplitudes.clone(),
                })
                .collect();
            let excitation = Excitation { omega: run.fit.omega, forces };
            let settings = Settings {
                harmonics: 15,
                most_harmonics: 31,
                watched: 7,
                truncation: 3.2e-5,
                tolerance: 1e-9,
                estimate: true,
            };
            let at = model.at(excitation.omega);
            let mut best = f64::INFINITY;
            for _ in 0..5 {
                let at = model.at(excitation.omega);
                let t = Instant::now();
                at.respond(&sources, &excitation, &settings, None, &Control::unattended()).unwrap();
                best = best.min(t.elapsed().as_secs_f64());
            }
            let r = at.respond(&sources, &excitation, &settings, None, &Control::unattended()).unwrap();
            let largest = r.amplitude(18, 1).norm();
            println!(
                "{:7.2} Hz {:.2} ms {:?} {:?} trunc {:?}",
                run.fit.omega / TAU,
                best * 1e3,
                r.status,
                r.history.iter().map(|s| (s.harmonics, s.steps, s.attempt)).collect::<Vec<_>>(),
                r.truncation.iter().take(5).map(|t| (t / largest * 1e6).round()).collect::<Vec<_>>()
            );
        }
    }
    if what == "sweep" {
        let sources = [damped(), source(Effect::CubicStiffness, 18, &[5e6])];
        let model = ForwardModel::new(&beam(10), &sources).unwrap();
        let excitation = Excitation::sine(TAU * 10.0, 18, c64::new(0.003, 0.0));
        let settings = SweepSettings { largest_step: 0.01, ..SweepSettings::default() };
        let range = [TAU * 6.0, TAU * 20.0];
        let t = Instant::now();
        let curve = sweep(&model, &excitation, range, &settings, &Control::unattended()).unwrap();
        println!("{} points {:?} {:.1} ms", curve.points.len(), curve.end, t.elapsed().as_secs_f64() * 1e3);
        for (i, p) in curve.points.iter().enumerate().filter(|(i, _)| i % 10 == 0 || curve.points.len() - i < 20) {
            let a = |h| p.response.amplitude(18, h);
            println!(
                "{i} {:.6} {} {:.5e} {:.3} {:.3e} {:.3e} {:.3e}",
                p.response.omega / TAU,
                p.stable,
                a(1).norm(),
                a(1).arg(),
                a(3).norm(),
                a(5).norm(),
                a(7).norm()
            );
        }
    }
}
