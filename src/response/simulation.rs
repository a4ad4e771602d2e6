//! What a model's sensors would show: periodic steady state under given forces, recorded through the measuring chain.
//!
//! `Y_h = T(h omega) (i h omega)^k X_h` with `k` the derivatives of the channel's quantity and `T` the transfer of its
//! known errors (delay, gain).

use super::dynamic_stiffness::{DynamicStiffness, DynamicStiffnessError};
use super::harmonic_balance::{Excitation, ForwardModel, ModelError, ResponseError, Settings};
use super::steady_state::steady_state;
use super::synthesis::ChannelMotion;
use super::time_integration::TimeError;
use crate::control::{Cancelled, Control};
use crate::effects::{Kind, Place, Source};
use crate::measurement::{Channel, Quantity};
use crate::structure::Structure;
use faer::{Mat, c64};

/// Why there is no steady state to record.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "the messages are those of the solvers")]
pub enum SimulationError {
    #[error(transparent)]
    Model(#[from] ModelError),
    #[error(transparent)]
    Linear(#[from] DynamicStiffnessError),
    #[error(transparent)]
    Nonlinear(#[from] ResponseError),
    #[error(transparent)]
    Stepped(#[from] TimeError),
    #[error("there is no mode {mode} to release the structure from; it has {count}")]
    NoSuchMode { mode: usize, count: usize },
    #[error("the structure cannot be released from a shape that moves DOF {dof}; name another DOF or mode")]
    NoRelease { dof: String },
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Periodic displacement of every DOF, m.
#[derive(Debug, Clone, PartialEq)]
pub struct SteadyState {
    /// Static part, n values.
    pub mean: Vec<f64>,
    /// Complex amplitudes, n x H.
    pub harmonics: Mat<c64>,
}

impl SteadyState {
    /// Complex amplitude of harmonic `h` (from 1) at a DOF, 0 beyond the last harmonic.
    fn amplitude(&self, dof: usize, h: usize) -> c64 {
        if h <= self.harmonics.ncols() { self.harmonics[(dof, h - 1)] } else { c64::new(0.0, 0.0) }
    }
}

/// The structure with sources, ready for any number of runs.
///
/// ```
/// use dashpot::response::{harmonic_balance::Excitation, simulation::Simulator};
/// use dashpot::{control::Control, effects::{Effect, Place, Source}, structure::chain::ChainParameters};
/// use faer::c64;
///
/// let chain = ChainParameters { masses: vec![2.0], ground_stiffness: vec![800.0], coupling_stiffness: vec![] };
/// let structure = chain.build(&[])?;
/// let dashpot = Source::known(Effect::Viscous, Place::Dofs(vec![0]), &[4.0]);
/// let force = Excitation::sine(20.0, 0, c64::new(1.0, 0.0)); // at resonance: x = f / (i omega c)
/// let state = Simulator::new(&structure, &[dashpot])?.respond(&force, &Control::unattended())?;
/// assert!((state.harmonics[(0, 0)] - c64::new(0.0, -1.0 / 80.0)).norm() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub enum Simulator<'a> {
    /// All laws are linear: each harmonic is solved directly, which loses nothing at a resonance.
    Linear(DynamicStiffness<'a>),
    /// Some law is not: harmonic balance.
    Nonlinear(ForwardModel),
}

impl<'a> Simulator<'a> {
    /// Takes every source at its values, whatever its state.
    pub fn new(structure: &'a Structure, sources: &[Source]) -> Result<Self, SimulationError> {
        if sources.iter().all(|source| source.effect.is_linear()) {
            Ok(Self::Linear(DynamicStiffness::new(structure, sources)?))
        } else {
            Ok(Self::Nonlinear(ForwardModel::new(structure, sources)?))
        }
    }

    /// Steady state under `excitation`.
    pub fn respond(&self, excitation: &Excitation, control: &Control) -> Result<SteadyState, SimulationError> {
        match self {
            Self::Linear(stiffness) => linear(stiffness, excitation),
            Self::Nonlinear(model) => {
                let response = model.respond(excitation, &Settings::default(), None, control)?;
                Ok(SteadyState { mean: response.mean, harmonics: response.harmonics })
            }
        }
    }
}

fn linear(stiffness: &DynamicStiffness<'_>, excitation: &Excitation) -> Result<SteadyState, SimulationError> {
    let n = stiffness.size();
    let harmonics = excitation.forces.iter().map(|force| force.harmonics.len()).max().unwrap_or(0);
    let forces: Vec<Vec<c64>> =
        (1..=harmonics).map(|h| (0..n).map(|dof| force(excitation, dof, h)).collect()).collect();
    let response = steady_state(stiffness, excitation.omega, &forces)?;
    Ok(SteadyState { mean: vec![0.0; n], harmonics: Mat::from_fn(n, harmonics, |dof, h| response[h][dof]) })
}

/// What each of `channels` shows of `response` under `excitation`, in SI units.
///
/// `sensors` are sources of effects `delay` and `gain` at channels; they act on what is recorded, forces included.
pub fn recorded(
    response: &SteadyState,
    excitation: &Excitation,
    channels: &[Channel],
    sensors: &[Source],
) -> Vec<ChannelMotion> {
    let show = |channel: &Channel| {
        let amplitude = |h: usize| {
            let w = h as f64 * excitation.omega;
            let truth = match channel.quantity.derivatives() {
                None => force(excitation, channel.dof, h),
                Some(order) => response.amplitude(channel.dof, h) * c64::new(0.0, w).powi(order),
            };
            truth * transfer(sensors, channel, w)
        };
        let mean = match channel.quantity {
            Quantity::Force => force(excitation, channel.dof, 0).re,
            Quantity::Displacement => response.mean[channel.dof],
            Quantity::Velocity | Quantity::Acceleration | Quantity::Base => 0.0,
        };
        let mean = mean * transfer(sensors, channel, 0.0).re;
        let harmonics =
            response.harmonics.ncols().max(excitation.forces.iter().map(|f| f.harmonics.len()).max().unwrap_or(0));
        ChannelMotion { channel: channel.clone(), mean, amplitudes: (1..=harmonics).map(amplitude).collect() }
    };
    channels.iter().map(show).collect()
}

/// Complex amplitude of harmonic `h` of all forces at a DOF, N.
fn force(excitation: &Excitation, dof: usize, h: usize) -> c64 {
    excitation.forces.iter().filter(|force| force.dof == dof).map(|force| force.amplitude(h)).sum()
}

/// Ratio of recorded to true amplitude of a channel at circular frequency `w` (rad/s).
pub fn transfer(sensors: &[Source], channel: &Channel, w: f64) -> c64 {
    let name = channel.to_string();
    let mut ratio = c64::new(1.0, 0.0);
    for sensor in sensors {
        if sensor.place == Place::Channel(name.clone())
            && let Kind::Channel(law) = sensor.effect.kind()
        {
            ratio *= law.transfer(sensor.parameters[0], w);
        }
    }
    ratio
}

/// Known delay (s) and gain of a channel, 0 and 1 without errors.
pub(crate) fn sensor_errors(sensors: &[Source], channel: &Channel) -> [f64; 2] {
    let place = Place::Channel(channel.to_string());
    sensors.iter().filter(|sensor| sensor.place == place).fold([0.0, 1.0], |[delay, gain], sensor| {
        match sensor.effect.kind() {
            Kind::Channel(law) if law.turns_phase() => [law.joined(delay, sensor.parameters[0]), gain],
            Kind::Channel(law) => [delay, law.joined(gain, sensor.parameters[0])],
            _ => [delay, gain],
        }
    })
}

/// The force channels and every translation's acceleration, which is what is recorded unless the project says otherwise.
pub fn usual_channels(structure: &Structure, excitation: &Excitation) -> Vec<Channel> {
    let channel = |quantity, dof| Channel { quantity, dof, label: structure.label(dof).to_owned() };
    let driven = excitation.forces.iter().map(|force| channel(Quantity::Force, force.dof));
    let translations = (0..structure.len()).filter(|&dof| !structure.dofs()[dof].direction.is_rotation());
    driven.chain(translations.map(|dof| channel(Quantity::Acceleration, dof))).collect()
}
