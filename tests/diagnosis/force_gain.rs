//! A force channel that reads wrongly by as much as load cells do: the size of a law that depends on the amplitude is known no
//! better, and says so.

use super::random::Random;
use crate::common::models::three_masses;
use dashpot::control::Control;
use dashpot::diagnosis::Problem;
use dashpot::diagnosis::diagnose::diagnose;
use dashpot::diagnosis::result::Added;
use dashpot::effects::{Effect, Place, Source};
use dashpot::measurement::{Channel, ChannelFit, HarmonicFit, Quantity, Run};
use dashpot::response::harmonic_balance::{Excitation, ForwardModel, Settings};
use faer::{Mat, c64};

/// What the force channel reads over the force; noise of all readings, relative.
const READS: f64 = 1.015;
const NOISE: f64 = 2e-3;
const FRICTION: f64 = 0.4;

fn channel(quantity: Quantity, dof: usize, mut amplitudes: Vec<c64>, random: &mut Random) -> ChannelFit {
    let size = NOISE * amplitudes[0].norm();
    amplitudes.iter_mut().for_each(|y| *y += c64::new(random.normal(), random.normal()) * size);
    let count = 2 * amplitudes.len();
    ChannelFit {
        channel: Channel { quantity, dof, label: format!("{}", dof + 1) },
        offset: 0.0,
        slope: 0.0,
        covariance: Mat::from_fn(count, count, |i, j| if i == j { size * size } else { 0.0 }),
        amplitudes,
        noise: size,
    }
}

fn dashpot(c: f64) -> Source {
    Source::known(Effect::Viscous, Place::Dofs(vec![0]), &[c])
}

/// Runs of three masses with `sources` whose channels of force and of motion read so many times what is there.
fn runs(sources: &[Source], [force_reads, first_reads]: [f64; 2]) -> Vec<Run> {
    let mut random = Random::new(11);
    let model = ForwardModel::new(&three_masses([1.01, 0.99, 1.012]), sources).unwrap();
    let mut runs = Vec::new();
    for omega in [60.0, 64.0, 66.0, 150.0, 158.0] {
        for force in [1.0, 3.0, 9.0] {
            let excitation = Excitation::sine(omega, 1, c64::new(force, 0.0));
            let response = model.at(omega);
            let response =
                response.respond(sources, &excitation, &Settings::default(), None, &Control::unattended()).unwrap();
            let still = c64::new(0.0, 0.0);
            let read = vec![c64::new(force * force_reads, 0.0), still, still];
            let mut channels = vec![channel(Quantity::Force, 1, read, &mut random)];
            let reads = |d: usize| if d == 0 { first_reads } else { 1.0 };
            let motion = |d: usize| (1..=3).map(|h| response.amplitude(d, h) * reads(d)).collect();
            channels.extend((0..3).map(|d| channel(Quantity::Displacement, d, motion(d), &mut random)));
            let fit = HarmonicFit { omega, omega_deviation: 0.0, channels };
            runs.push(Run::from_harmonics(format!("{omega} {force}"), None, true, fit, &[]));
        }
    }
    runs
}

/// The first suggestion beside the model as it is stated.
fn first_suggestion(runs: &[Run]) -> Added {
    let (stated, known) = (three_masses([1.0; 3]), [dashpot(2.3)]);
    let problem = Problem { structure: &stated, sources: &known, runs };
    diagnose(&problem, &Control::unattended()).unwrap().suggestions[0].added.clone()
}

#[test]
fn a_friction_force_is_known_no_better_than_the_force_that_was_measured() {
    let friction = Source::known(Effect::Coulomb, Place::Dofs(vec![2]), &[FRICTION]);
    let first = first_suggestion(&runs(&[dashpot(2.0), friction.clone()], [READS, 1.0]));
    assert!(first.source.is_same(&friction), "{:?}", first.source);
    let (value, deviation) = (first.source.parameters[0], first.deviations[0]);
    assert!((value - FRICTION).abs() < 3.0 * deviation, "{value} +- {deviation}");
    assert!((0.003..0.03).contains(&(deviation / value)), "{value} +- {deviation}");
}

/// A wrong sensitivity is no error of some per cent: the response is linear in the inverse of what the channel reads.
#[test]
fn a_channel_that_reads_a_fraction_or_a_multiple_of_its_quantity_is_named() {
    for (reads, name, gain) in [
        ([0.55, 1.0], "force@2", 0.55),
        ([0.3, 1.0], "force@2", 0.3),
        ([2.6, 1.0], "force@2", 2.6),
        ([1.0, 0.4], "disp@1", 0.4),
    ] {
        let first = first_suggestion(&runs(&[dashpot(2.0)], reads));
        let expected = Source::known(Effect::Gain, Place::Channel(name.into()), &[gain]);
        assert!(first.source.is_same(&expected), "{name} {gain}: {:?}", first.source);
        let value = first.source.parameters[0];
        assert!((value / gain - 1.0).abs() < 0.05, "{name} {gain}: {value}");
    }
}
