//! Records by time integration: of the periodic motion, or of the motion on its way there.
//!
//! The periodic motion is recorded by its harmonics, as a data recorder with a filter against aliasing would. A transient
//! starts from `1 - fraction` times the periodic state, so that fraction 1 is the structure switched on at rest; there the
//! record of a channel is `gain y(t - delay)` with `y` interpolated between the steps of the integrator.

use super::harmonic_balance::{Excitation, ForwardModel, ResponseError, Settings};
use super::simulation::{SimulationError, SteadyState, recorded, sensor_errors};
use super::synthesis::signals;
use super::time_integration::{Samples, Settling, TimeModel};
use crate::control::Control;
use crate::effects::Source;
use crate::measurement::{Channel, Quantity};
use crate::structure::Structure;
use std::f64::consts::TAU;

/// Harmonics taken from the periodic motion.
const HARMONICS: usize = 31;
/// Change of the state over a period that counts as none, relative to the state.
const PERIODIC: f64 = 1e-7;

/// How to integrate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InTime {
    /// Steps a period of the fundamental.
    pub steps: usize,
    /// Share of the periodic motion that is missing at the start of the record, 0 to 1.
    pub transient: f64,
}

impl Default for InTime {
    fn default() -> Self {
        Self { steps: 4000, transient: 0.0 }
    }
}

/// What is recorded.
#[derive(Debug, Clone, Copy)]
pub struct Recorder<'a> {
    /// Channels, in the order of the record.
    pub channels: &'a [Channel],
    /// Errors of the measuring chain: sources of effects `delay` and `gain` at channels.
    pub sensors: &'a [Source],
    /// Instants of the samples, s, rising.
    pub time: &'a [f64],
}

/// Samples of every channel, SI units, of `structure` with `sources` under `excitation`.
///
/// # Errors
/// [`SimulationError`]: laws that have no force in time, steps that fail, a motion that does not become periodic.
pub fn record_in_time(
    structure: &Structure,
    sources: &[Source],
    excitation: &Excitation,
    recorder: &Recorder,
    in_time: &InTime,
    control: &Control,
) -> Result<Vec<Vec<f64>>, SimulationError> {
    let mut model = settled(structure, sources, excitation, in_time.steps, control)?;
    if in_time.transient == 0.0 {
        let state = steady_state(&mut model)?;
        let motions = recorded(&state, excitation, recorder.channels, recorder.sensors);
        return Ok(signals(excitation.omega, recorder.time, &motions));
    }
    let share = 1.0 - in_time.transient;
    let state = |value: &dyn Fn(usize) -> f64| (0..model.len()).map(|i| share * value(i)).collect::<Vec<f64>>();
    let (displacement, velocity) = (state(&|i| model.displacement(i)), state(&|i| model.velocity(i)));
    model.start(&displacement, &velocity);
    let track = Track::new(&mut model, excitation, recorder, control)?;
    let signal = |(c, channel): (usize, &Channel)| {
        let [delay, gain] = sensor_errors(recorder.sensors, channel);
        let recorded_at = |&t: &f64| match channel.quantity {
            Quantity::Force => gain * force(excitation, channel.dof, t - delay),
            _ => gain * track.at(c, t - delay),
        };
        recorder.time.iter().map(recorded_at).collect()
    };
    Ok(recorder.channels.iter().enumerate().map(signal).collect())
}

/// The model in its periodic motion: a route that shares nothing with harmonic balance but the first guess.
fn settled(
    structure: &Structure,
    sources: &[Source],
    excitation: &Excitation,
    steps: usize,
    control: &Control,
) -> Result<TimeModel, SimulationError> {
    let mut model = TimeModel::new(structure, sources, excitation, steps)?;
    match ForwardModel::new(structure, sources)?.respond(excitation, &Settings::default(), None, control) {
        Ok(response) => model.start_from(&response),
        // Without a start nearby the motion is sought from rest.
        Err(ResponseError::NotConverged { .. }) => {}
        Err(other) => return Err(other.into()),
    }
    model.settle(&Settling { tolerance: PERIODIC, ..Settling::default() }, control)?;
    Ok(model)
}

/// Mean and harmonics of the next period.
fn steady_state(model: &mut TimeModel) -> Result<SteadyState, SimulationError> {
    let harmonics = model.harmonics(HARMONICS.min(model.steps / 4))?;
    let samples = model.record(model.steps)?.displacement;
    let mean = |dof: usize| samples.col(dof).iter().sum::<f64>() / model.steps as f64;
    Ok(SteadyState { mean: (0..model.len()).map(mean).collect(), harmonics })
}

/// Force on a DOF at time `t`, N.
fn force(excitation: &Excitation, dof: usize, t: f64) -> f64 {
    let wave = |h: usize, f: faer::c64| {
        let (sin, cos) = (h as f64 * excitation.omega * t).sin_cos();
        f.re * cos - f.im * sin
    };
    let force_of = |force: &super::harmonic_balance::HarmonicForce| {
        (1..=force.harmonics.len()).fold(force.mean, |sum, h| sum + wave(h, force.amplitude(h)))
    };
    excitation.forces.iter().filter(|force| force.dof == dof).map(force_of).sum()
}

/// What the channels show at the steps of the integrator.
struct Track {
    step: f64,
    /// Time of the first step, s: a whole number of periods.
    origin: f64,
    /// One list a channel.
    values: Vec<Vec<f64>>,
}

impl Track {
    /// From the start of the record to its end.
    fn new(
        model: &mut TimeModel,
        excitation: &Excitation,
        recorder: &Recorder,
        control: &Control,
    ) -> Result<Self, SimulationError> {
        let period = TAU / excitation.omega;
        let [first, last] = [recorder.time.first(), recorder.time.last()].map(|t| t.copied().unwrap_or(0.0));
        let origin = (first / period).floor() * period;
        let early = recorder.channels.iter().map(|c| -sensor_errors(recorder.sensors, c)[0]).fold(0.0, f64::max);
        let periods = ((last - origin + early) / period).ceil() as usize + 1;
        let mut values = vec![Vec::new(); recorder.channels.len()];
        for k in 0..periods {
            control.check()?;
            let samples = model.record(model.steps)?;
            for (values, channel) in values.iter_mut().zip(recorder.channels) {
                if let Some(shown) = shown(&samples, channel) {
                    values.extend_from_slice(shown);
                }
            }
            control.report((k + 1) as f64 / periods as f64);
        }
        Ok(Self { step: model.step, origin, values })
    }

    /// Value of a channel at time `t`; before the start, that at the start.
    fn at(&self, channel: usize, t: f64) -> f64 {
        let values = &self.values[channel];
        let steps = (t - self.origin) / self.step;
        let count = values.len();
        let steps = steps.clamp(0.0, (count - 1) as f64);
        let n = (steps as usize).min(count - 1);
        let next = (n + 1).min(count - 1);
        values[n] + (steps - n as f64) * (values[next] - values[n])
    }
}

/// The motion that a response channel sees; none for forces.
fn shown<'a>(samples: &'a Samples, channel: &Channel) -> Option<&'a [f64]> {
    let motion = match channel.quantity {
        Quantity::Force | Quantity::Base => return None,
        Quantity::Displacement => &samples.displacement,
        Quantity::Velocity => &samples.velocity,
        Quantity::Acceleration => &samples.acceleration,
    };
    Some(motion.col_as_slice(channel.dof))
}
