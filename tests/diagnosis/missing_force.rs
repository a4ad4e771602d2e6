//! The missing force as it is drawn, and what is said of channels and runs, against what made the records.

use crate::common::models;
use dashpot::control::Control;
use dashpot::diagnosis::Problem;
use dashpot::diagnosis::candidates::restoring_force::{RestoringForce, at_best_place, restoring_force};
use dashpot::diagnosis::updating::scatter::scatter;
use dashpot::effects::{Effect, Place, Source};
use dashpot::exchange::Project;
use dashpot::exchange::project::load;
use dashpot::measurement::{Channel, ChannelFit, HarmonicFit, Quantity, Run};
use dashpot::response::dynamic_stiffness::DynamicStiffness;
use dashpot::structure::Structure;
use faer::{Mat, c64};
use std::path::Path;

fn sample(name: &str) -> Project {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("sample-data").join(name).join("project.toml");
    load(&path, &Control::unattended()).unwrap()
}

fn problem(p: &Project) -> Problem<'_> {
    Problem { structure: &p.structure, sources: &p.sources, runs: &p.runs }
}

/// Root mean square of a difference over that of a size.
fn relative(pairs: impl Iterator<Item = (f64, f64)> + Clone) -> f64 {
    let square = |list: &mut dyn Iterator<Item = f64>| list.map(|v| v * v).sum::<f64>();
    (square(&mut pairs.clone().map(|(a, b)| a - b)) / square(&mut pairs.map(|(_, b)| b))).sqrt()
}

/// Distance of the points of the run that moves most from `k3 d^3`, relative.
fn cubic(force: &RestoringForce, k3: f64) -> f64 {
    let largest = force.runs.iter().max_by(|a, b| peak(a).total_cmp(&peak(b))).unwrap();
    relative(largest.points.iter().map(|p| (p.force, k3 * p.displacement.powi(3))))
}

fn peak(run: &dashpot::diagnosis::candidates::restoring_force::RunForce) -> f64 {
    run.points.iter().map(|p| p.displacement.abs()).fold(0.0, f64::max)
}

/// The records were made by time steps with `3e9 d^3` at the second mass: that is the curve which is seen, whatever law it
/// is drawn with, and with none.
#[test]
fn a_hidden_cubic_spring_is_seen_as_the_cube_of_the_displacement() {
    let p = sample("five-masses-cubic");
    let source = Source::known(Effect::CubicStiffness, Place::Dofs(vec![1]), &[3e9]);
    let control = Control::unattended();
    let force = restoring_force(&problem(&p), &[], &[], &source, true, &control).unwrap().unwrap();
    assert!(cubic(&force, 3e9) < 0.06, "{}", cubic(&force, 3e9));
    for run in &force.runs {
        // The curve of the law runs through the points, within their deviation and a little of the truncation.
        let law = run.law.iter().step_by(4).map(|p| p.force);
        let difference = relative(run.points.iter().map(|p| p.force).zip(law));
        let size = run.points.iter().map(|p| p.force.abs()).fold(0.0, f64::max);
        assert!(difference < 0.03 + 3.0 * run.deviation / size, "run {}: {difference}", run.run + 1);
        assert!(run.deviation > 0.0 && run.deviation < 0.5 * size);
    }
    let bare = at_best_place(&problem(&p), &[], &control).unwrap().unwrap();
    assert_eq!((&bare.place, &bare.law), (&source.place, &None));
    assert!(bare.runs.iter().all(|run| run.law.is_empty()));
    assert!(cubic(&bare, 3e9) < 0.06, "{}", cubic(&bare, 3e9));
}

/// Friction of 0.15 N opposes the velocity: plus at half the points, minus at the others.
#[test]
fn hidden_friction_is_seen_to_oppose_the_velocity() {
    let p = sample("cantilever-friction");
    let source = Source::known(Effect::Coulomb, Place::Dofs(vec![12]), &[0.15]);
    let force = restoring_force(&problem(&p), &[], &[], &source, true, &Control::unattended()).unwrap().unwrap();
    for run in &force.runs {
        let fastest = run.points.iter().map(|p| p.velocity.abs()).fold(0.0, f64::max);
        let fast = run.points.iter().filter(|p| p.velocity.abs() > 0.5 * fastest);
        let mean = fast.clone().map(|p| p.force * p.velocity.signum()).sum::<f64>() / fast.count() as f64;
        // A square wave cut off after its harmonics overshoots: the mean over its middle does not.
        assert!((mean / 0.15 - 1.0).abs() < 0.1, "run {}: {mean} N", run.run + 1);
    }
}

fn chain(factor: f64) -> Structure {
    models::chain(&[1.0, 2.0, 1.5], &[4000.0, 0.0, 2000.0].map(|k| k * factor), &[3000.0, 5000.0].map(|k| k * factor))
}

/// Steady runs about the resonances of a chain, noise of 1e-4, whose second sensor reads 2 % too large and 40 us late, and
/// whose fourth run is 0.1 % stiffer.
fn runs(sources: &[Source]) -> Vec<Run> {
    let mut seed = 7_u64;
    let mut noise = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        2.0 * ((seed >> 33) as f64 / f64::from(1_u32 << 31)) - 1.0
    };
    let omegas: Vec<f64> =
        chain(1.0).modes().unwrap().omega.iter().flat_map(|w| [0.98 * w, 0.995 * w, 1.006 * w, 1.02 * w]).collect();
    let mut run = |(k, &omega): (usize, &f64)| {
        let structure = chain(if k == 3 { 1.001 } else { 1.0 });
        let mut load = vec![c64::new(0.0, 0.0); 3];
        load[2] = c64::new(1.0, 0.0);
        let x = DynamicStiffness::new(&structure, sources).unwrap().solve(omega, &load).unwrap();
        let mut channel = |quantity, dof: usize, y: c64| {
            let sigma = 1e-4 * y.norm();
            ChannelFit {
                channel: Channel { quantity, dof, label: (dof + 1).to_string() },
                offset: 0.0,
                slope: 0.0,
                amplitudes: vec![y + c64::new(noise(), noise()) * (3.0_f64.sqrt() * sigma)],
                covariance: Mat::from_fn(2, 2, |i, j| if i == j { sigma * sigma } else { 0.0 }),
                noise: sigma,
            }
        };
        let mut channels = vec![channel(Quantity::Force, 2, c64::new(1.0, 0.0))];
        for dof in 0..3 {
            let late = c64::new(0.0, -omega * 4e-5).exp() * 1.02;
            let reading = if dof == 1 { late } else { c64::new(1.0, 0.0) };
            channels.push(channel(Quantity::Acceleration, dof, -omega * omega * x[dof] * reading));
        }
        let fit = HarmonicFit { omega, omega_deviation: 0.0, channels };
        Run::from_harmonics(format!("{}", k + 1), None, true, fit, &[])
    };
    omegas.iter().enumerate().map(&mut run).collect()
}

#[test]
fn what_a_channel_reads_too_large_and_late_and_a_run_that_shifted_are_told() {
    let sources = [Source::known(Effect::Viscous, Place::Dofs(vec![0]), &[1.5])];
    let (structure, runs) = (chain(1.0), runs(&sources));
    let problem = Problem { structure: &structure, sources: &sources, runs: &runs };
    let found = scatter(&problem, &[], &[], &Control::unattended()).unwrap().unwrap();
    assert_eq!(found.runs.len(), 12);
    let second = found.channels.iter().find(|c| c.channel == "acc@2").unwrap();
    let (gain, delay) = (second.gain, second.delay.unwrap());
    // What is common to all channels no data tell: it is shared among them, so that one stands out against the others.
    let others: Vec<f64> = found
        .channels
        .iter()
        .filter(|c| c.channel.starts_with("acc") && c.channel != "acc@2")
        .map(|c| c.gain.value)
        .collect();
    let apart = gain.value - others.iter().sum::<f64>() / others.len() as f64;
    assert!((apart - 0.02).abs() < 1e-3, "{apart} {gain:?}");
    assert!((gain.value - 0.02).abs() < 3.0 * gain.deviation, "{gain:?}");
    assert!((delay.value - 4e-5).abs() < 3.0 * delay.deviation && delay.deviations() > 5.0, "{delay:?}");
    for other in found.channels.iter().filter(|c| c.channel != "acc@2") {
        assert!(other.gain.value.abs() < 2.0 * other.gain.deviation, "{other:?}");
    }
    // What all runs share is the structure's: a run has shifted against the others.
    let shifted = &found.runs[3].frequency;
    let others = (0..12).filter(|&r| r != 3).map(|r| found.runs[r].frequency.value).sum::<f64>() / 11.0;
    let off = shifted.value - others - 5e-4;
    assert!(off.abs() < 4.0 * shifted.deviation && shifted.deviation < 1e-5, "{shifted:?} against {others}");
    let largest = found.runs.iter().max_by(|a, b| a.frequency.value.abs().total_cmp(&b.frequency.value.abs())).unwrap();
    assert_eq!(largest.run, 3, "{:?}", found.runs.iter().map(|r| r.frequency).collect::<Vec<_>>());
}
