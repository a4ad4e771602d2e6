//! A test by time integration, recorded: finer steps than the record's, a filter against aliasing, a converter of so many bits.
//!
//! The filter has no delay (`math::decimation`): flat to 0.34 of the sampling rate, 80 dB down from 0.5. It is the same for forces and motions.

use super::base::BaseMotion;
use super::loading::Loading;
use crate::control::Control;
use crate::effects::{Constant, Source};
use crate::math::decimation::low_pass;
use crate::measurement::{Channel, Quantity};
use crate::response::simulation::{SimulationError, sensor_errors};
use crate::response::time_integration::{TimeError, TimeModel};
use crate::structure::{Structure, modes::modes};
use dashpot_numerics::solve_indefinite;
use faer::Mat;

/// Steps of the integrator in one of the record.
const FINER: usize = 16;
/// Half length of the filter, steps of the record.
const HALF: usize = 16;
/// Frequency at which the filter is down to one half, over the sampling rate.
const CUT: f64 = 0.42;
/// Steps that are integrated at a time.
const CHUNK: usize = 2048;

/// What is done and recorded.
#[derive(Debug, Clone, Copy)]
pub struct TestSetup<'a> {
    /// What drives the structure.
    pub loading: &'a Loading,
    /// DOF of the force, or the one whose displacement a release names.
    pub dof: usize,
    /// Channels, in the order of the record.
    pub channels: &'a [Channel],
    /// Errors of the measuring chain.
    pub sensors: &'a [Source],
    /// Samples a second, Hz.
    pub rate_hz: f64,
    /// Samples a channel.
    pub samples: usize,
    /// Whether the signals are filtered before they are sampled.
    pub filter: bool,
}

/// Instants and samples of every channel, SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct TestRecord {
    /// Instants, s.
    pub time: Vec<f64>,
    /// One list a channel.
    pub samples: Vec<Vec<f64>>,
}

/// State that a structure is released from.
#[derive(Debug, Clone, PartialEq)]
pub struct Release {
    /// Displacement of every DOF, m.
    pub displacement: Vec<f64>,
}

/// Records a test of `structure` with `sources`.
///
/// # Errors
/// [`SimulationError`]: laws that have no force in time, steps that fail, a release from a mode that is not there.
pub fn record_test(
    structure: &Structure,
    sources: &[Source],
    setup: &TestSetup,
    control: &Control,
) -> Result<TestRecord, SimulationError> {
    recorded(structure, sources, setup, None, control)
}

/// The same on a base that moves; the loading of `setup` is not looked at.
///
/// # Errors
/// [`SimulationError`]: laws that have no force in time, steps that fail.
pub fn record_base_test(
    structure: &Structure,
    sources: &[Source],
    setup: &TestSetup,
    base: &BaseMotion,
    control: &Control,
) -> Result<TestRecord, SimulationError> {
    recorded(structure, sources, setup, Some(base), control)
}

fn recorded(
    structure: &Structure,
    sources: &[Source],
    setup: &TestSetup,
    base: Option<&BaseMotion>,
    control: &Control,
) -> Result<TestRecord, SimulationError> {
    let fine = 1.0 / (setup.rate_hz * FINER as f64);
    let count = (setup.samples + HALF + 1) * FINER;
    let ridden = base.map(|base| (base, base.at_steps(count + 1, fine)));
    let force = setup.loading.force(setup.samples * FINER, fine).filter(|_| base.is_none()).map(|mut force| {
        force.resize(count + 1, 0.0);
        force
    });
    let mut model = match &ridden {
        Some((base, steps)) => {
            let loads: Vec<(usize, f64)> = base.loads.iter().map(|(dof, load)| (*dof, -load)).collect();
            TimeModel::under_loads(structure, sources, Some((&loads, &steps[0])), fine)?
        }
        None => TimeModel::under_force(structure, sources, force.as_deref().map(|f| (setup.dof, f)), fine)?,
    };
    if let Loading::Release { displacement_m, mode } = *setup.loading {
        let release = release(structure, sources, setup.dof, displacement_m, mode)?;
        model.start(&release.displacement, &vec![0.0; structure.len()]);
    }
    let mut signals = march(&mut model, setup, force.as_deref(), count, control)?;
    if let Some((base, steps)) = &ridden {
        for (signal, channel) in signals.iter_mut().zip(setup.channels) {
            let added = base.added(steps, channel).unwrap_or_default();
            signal.iter_mut().zip(added).for_each(|(y, b)| *y += b);
        }
    }
    let time: Vec<f64> = (0..setup.samples).map(|n| n as f64 / setup.rate_hz).collect();
    let kernel = if setup.filter { low_pass(HALF * FINER, CUT / FINER as f64) } else { vec![1.0] };
    let sample = |(c, signal): (usize, &Vec<f64>)| {
        let [delay, gain] = sensor_errors(setup.sensors, &setup.channels[c]);
        let early = if setup.channels[c].quantity == Quantity::Displacement { signal[0] } else { 0.0 };
        let recorded = |n: usize| gain * filtered(signal, early, &kernel, n as f64 * FINER as f64 - delay / fine);
        (0..setup.samples).map(recorded).collect()
    };
    Ok(TestRecord { samples: signals.iter().enumerate().map(sample).collect(), time })
}

/// What every channel shows at each of `count` fine steps.
fn march(
    model: &mut TimeModel,
    setup: &TestSetup,
    force: Option<&[f64]>,
    count: usize,
    control: &Control,
) -> Result<Vec<Vec<f64>>, TimeError> {
    let mut signals: Vec<Vec<f64>> = vec![Vec::with_capacity(count); setup.channels.len()];
    let mut done = 0;
    while done < count {
        control.check()?;
        let chunk = CHUNK.min(count - done);
        let motion = model.record(chunk)?;
        for (signal, channel) in signals.iter_mut().zip(setup.channels) {
            match channel.quantity {
                Quantity::Force if channel.dof == setup.dof => match force {
                    Some(force) => signal.extend_from_slice(&force[done..done + chunk]),
                    None => signal.extend(std::iter::repeat_n(0.0, chunk)),
                },
                Quantity::Force | Quantity::Base => signal.extend(std::iter::repeat_n(0.0, chunk)),
                Quantity::Displacement => signal.extend_from_slice(motion.displacement.col_as_slice(channel.dof)),
                Quantity::Velocity | Quantity::Acceleration => {
                    signal.extend_from_slice(motion.velocity.col_as_slice(channel.dof));
                }
            }
        }
        done += chunk;
        control.report(done as f64 / count as f64);
    }
    let accelerometer = |c: usize| setup.channels[c].quantity == Quantity::Acceleration;
    for (_, signal) in signals.iter_mut().enumerate().filter(|(c, _)| accelerometer(*c)) {
        *signal = differentiated(signal, model.time() / count as f64);
    }
    Ok(signals)
}

/// The rate of a signal at steps of `step` s, from two neighbours on each side (fewer at its ends). Forces are constant over a fine step,
/// so that stiff modes follow them half a step late: the acceleration of an instant, to which such modes and the force itself give
/// large and opposite shares, would show that; the velocity does not.
fn differentiated(signal: &[f64], step: f64) -> Vec<f64> {
    let last = signal.len() - 1;
    let rise = |n: usize, by: usize| signal[(n + by).min(last)] - signal[n.saturating_sub(by)];
    let rate = |n: usize| match n.min(last - n) {
        0 => rise(n, 1) / step,
        1 => rise(n, 1) / (2.0 * step),
        _ => (8.0 * rise(n, 1) - rise(n, 2)) / (12.0 * step),
    };
    (0..=last).map(rate).collect()
}

/// The shape that the structure is held in, scaled to `displacement_m` at the DOF.
fn release(
    structure: &Structure,
    sources: &[Source],
    dof: usize,
    displacement_m: f64,
    mode: Option<usize>,
) -> Result<Release, SimulationError> {
    let matrices = structure.matrices().ok_or(TimeError::NoMatrices)?;
    let n = structure.len();
    let shape: Vec<f64> = if let Some(number) = mode {
        let modes = modes(matrices).map_err(|_| TimeError::NoMatrices)?;
        let index = number.checked_sub(1).filter(|&r| r < modes.len());
        modes.shape(index.ok_or(SimulationError::NoSuchMode { mode: number, count: modes.len() })?)
    } else {
        let mut stiffness = matrices.stiffness.clone();
        for source in sources.iter().filter(|source| source.effect.adds_to(Constant::Stiffness)) {
            for leg in source.place.legs() {
                let ends = [Some((leg.first, 1.0)), leg.second.map(|second| (second, -1.0))];
                for (i, a) in ends.iter().flatten() {
                    for (j, b) in ends.iter().flatten() {
                        stiffness[(*i, *j)] += a * b * source.parameters[0];
                    }
                }
            }
        }
        let load = Mat::from_fn(n, 1, |i, _| f64::from(u8::from(i == dof)));
        solve_indefinite(stiffness.as_ref(), load.as_ref()).col(0).iter().copied().collect()
    };
    let scale = displacement_m / shape[dof];
    if !scale.is_finite() || shape.iter().any(|x| !x.is_finite()) {
        return Err(SimulationError::NoRelease { dof: structure.label(dof).to_owned() });
    }
    Ok(Release { displacement: shape.iter().map(|x| scale * x).collect() })
}

/// The filtered signal at a place between fine steps; before the first there is `early`, after the last the last.
fn filtered(signal: &[f64], early: f64, kernel: &[f64], place: f64) -> f64 {
    let base = place.floor();
    let share = place - base;
    let half = (kernel.len() / 2) as i64;
    let first = base as i64 - half;
    let sample_at = |n: i64| match usize::try_from(n) {
        Ok(n) => signal[n.min(signal.len() - 1)],
        Err(_) => early,
    };
    let value = |shift: i64| kernel.iter().zip(first + shift..).map(|(w, n)| w * sample_at(n)).sum::<f64>();
    if share == 0.0 { value(0) } else { (1.0 - share) * value(0) + share * value(1) }
}

/// Rounds a channel to the steps of a converter of so many bits whose range (1, 2 or 5 times a power of ten) holds it;
/// gives the step.
pub fn quantise(samples: &mut [f64], bits: u32) -> f64 {
    let peak = samples.iter().fold(0.0_f64, |most, y| most.max(y.abs()));
    if peak == 0.0 {
        return 0.0;
    }
    let decade = 10f64.powf(peak.log10().floor());
    let range = [1.0, 2.0, 5.0, 10.0].into_iter().map(|digit| digit * decade).find(|range| *range >= peak);
    let step = range.unwrap_or(10.0 * decade) / 2f64.powi(bits as i32 - 1);
    samples.iter_mut().for_each(|y| *y = (*y / step).round() * step);
    step
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models;
    use crate::effects::{Effect, Place};
    use crate::response::dynamic_stiffness::DynamicStiffness;
    use faer::c64;
    use std::f64::consts::{PI, TAU};

    /// Of 10 Hz.
    fn oscillator() -> Structure {
        models::oscillator(2.0, 2.0 * (TAU * 10.0).powi(2))
    }

    fn record(loading: &Loading, sources: &[Source], quantity: Quantity, samples: usize) -> TestRecord {
        let channels = [Channel { quantity, dof: 0, label: "1".into() }];
        let setup =
            TestSetup { loading, dof: 0, channels: &channels, sensors: &[], rate_hz: 400.0, samples, filter: true };
        record_test(&oscillator(), sources, &setup, &Control::unattended()).unwrap()
    }

    /// Dry friction takes `4 F / k` from the amplitude in every period, and the mass stops where `k |x| < F`.
    #[test]
    fn a_ring_down_under_dry_friction_falls_in_a_line_and_stops() {
        let stiffness = 2.0 * (TAU * 10.0).powi(2);
        let force = 0.0123 * stiffness * 0.01;
        let friction = Source::known(Effect::Coulomb, Place::Dofs(vec![0]), &[force]);
        let release = Loading::Release { displacement_m: 0.01, mode: None };
        let made = record(&release, &[friction], Quantity::Displacement, 1600);
        for period in 1..19 {
            let expected = 0.01 - 4.0 * force / stiffness * f64::from(period);
            let found = made.samples[0][40 * period as usize];
            assert!((found - expected).abs() < 2e-6, "{period}: {found} {expected}");
        }
        let (last, before) = (made.samples[0][1599], made.samples[0][1500]);
        assert!((last - before).abs() < 1e-9 && last.abs() <= force / stiffness, "{last}");
    }

    /// The driven place of a beam, where stiff modes and the force give large and opposite shares, against its dynamic stiffness.
    #[test]
    fn the_accelerance_of_the_driven_place_is_that_of_the_matrices() {
        let structure = models::cantilever(8);
        let sources =
            [models::whole(Effect::StiffnessProportional, 4e-5), models::whole(Effect::MassProportional, 60.0)];
        let (dof, frequency, rate_hz) = (14, 400.0, 2048.0);
        let loading = Loading::Sweep { force_n: 3.0, from_hz: frequency, to_hz: frequency, logarithmic: false };
        let channel = |quantity| Channel { quantity, dof, label: "15".into() };
        let channels = [channel(Quantity::Force), channel(Quantity::Acceleration)];
        let setup = TestSetup {
            loading: &loading,
            dof,
            channels: &channels,
            sensors: &[],
            rate_hz,
            samples: 2048,
            filter: false,
        };
        let made = record_test(&structure, &sources, &setup, &Control::unattended()).unwrap();
        let amplitude = |samples: &[f64]| -> c64 {
            let turned = |(n, y): (usize, &f64)| c64::cis(-TAU * frequency * n as f64 / rate_hz) * *y;
            samples.iter().enumerate().skip(1536).map(turned).sum()
        };
        let found = amplitude(&made.samples[1]) / amplitude(&made.samples[0]);
        let omega = TAU * frequency;
        let stiffness = DynamicStiffness::new(&structure, &sources).unwrap().factorise(omega);
        let expected = -stiffness.receptance_column(dof).unwrap()[dof] * omega * omega;
        assert!((found - expected).norm() < 2e-3 * expected.norm(), "{found} {expected}");
    }

    /// A mass struck by a short impulse moves off with its momentum.
    #[test]
    fn a_hammer_gives_its_momentum() {
        let hammer = Loading::Impulse { peak_n: 100.0, width_s: 0.001, at_s: 0.1, again_s: None };
        let made = record(&hammer, &[], Quantity::Velocity, 400);
        let most = made.samples[0].iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let expected = 2.0 / PI * 100.0 * 0.001 / 2.0;
        assert!((most / expected - 1.0).abs() < 0.01, "{most} {expected}");
    }

    /// An oscillator on a base that begins to move as a sine, against the closed form of its relative motion,
    /// `x = -A / (w0^2 - w^2) (sin(w t) - w / w0 sin(w0 t))`; what rides on the base shows both.
    #[test]
    fn a_moving_base_drives_by_its_acceleration() {
        let (omega0, omega, size) = (TAU * 10.0, TAU * 4.0, 3.0);
        let channel = |quantity| Channel { quantity, dof: 0, label: "1".into() };
        let moving = Channel { quantity: Quantity::Base, dof: 0, label: "x".into() };
        let acceleration: Vec<f64> = (0..80_000).map(|n| size * (omega * 2.5e-5 * f64::from(n)).sin()).collect();
        let channels = [moving.clone(), channel(Quantity::Displacement), channel(Quantity::Acceleration)];
        let setup = TestSetup {
            loading: &Loading::Base,
            dof: 0,
            channels: &channels,
            sensors: &[],
            rate_hz: 400.0,
            samples: 400,
            filter: false,
        };
        for is_absolute in [false, true] {
            let base = BaseMotion {
                loads: &[(0, 2.0)],
                along: &[0],
                channel: &moving,
                acceleration: &acceleration,
                step_s: 2.5e-5,
                is_absolute,
            };
            let made = record_base_test(&oscillator(), &[], &setup, &base, &Control::unattended()).unwrap();
            for n in [10, 100, 333] {
                let t = made.time[n];
                let a = size * (omega * t).sin();
                let relative = -size / (omega0.powi(2) - omega.powi(2))
                    * ((omega * t).sin() - omega / omega0 * (omega0 * t).sin());
                let rides = if is_absolute { size * (t / omega - (omega * t).sin() / omega.powi(2)) } else { 0.0 };
                assert!((made.samples[0][n] - a).abs() < 1e-3, "{n}: {} {a}", made.samples[0][n]);
                let d = made.samples[1][n];
                assert!((d - relative - rides).abs() < 2e-5 * size, "{n} {is_absolute}: {d} {relative} {rides}");
                // x'' = -w0^2 x - a, and what rides on the base shows a beside it.
                let expected = -omega0.powi(2) * relative - if is_absolute { 0.0 } else { a };
                assert!((made.samples[2][n] - expected).abs() < 0.01 * size, "{n} {is_absolute}");
            }
        }
    }

    #[test]
    fn the_filter_passes_what_it_should() {
        let kernel = low_pass(HALF * FINER, CUT / FINER as f64);
        let gain = |ratio: f64| {
            let half = (kernel.len() / 2) as f64;
            kernel
                .iter()
                .enumerate()
                .map(|(k, w)| w * (TAU * ratio * (k as f64 - half) / FINER as f64).cos())
                .sum::<f64>()
        };
        assert!((0..34).all(|k| (gain(0.01 * f64::from(k)) - 1.0).abs() < 3e-4));
        assert!((50..700).all(|k| gain(0.01 * f64::from(k)).abs() < 3e-4));
    }

    #[test]
    fn a_converter_rounds_to_its_steps() {
        let mut samples = vec![0.3, -1.7, 0.001];
        let step = quantise(&mut samples, 8);
        assert_eq!(step, 2.0 / 128.0);
        assert_eq!(samples, [19.0 * step, -109.0 * step, 0.0]);
    }
}
