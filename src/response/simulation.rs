//! What a model's sensors would show: linear steady state under given forces, recorded through the measuring chain.
//!
//! `Y_h = T(h omega) (i h omega)^k X_h` with `k` the derivatives of the channel's quantity and `T` the transfer of its
//! known errors (delay, gain); `Z(h omega) X_h = F_h`.

use super::dynamic_stiffness::{DynamicStiffness, DynamicStiffnessError};
use super::steady_state::steady_state;
use super::synthesis::ChannelMotion;
use crate::effects::effect::Kind;
use crate::effects::{Place, Source};
use crate::measurement::{Channel, Quantity};
use faer::c64;

/// Complex amplitudes of harmonics 1, 2, ... of the force at one DOF, N.
#[derive(Debug, Clone, PartialEq)]
pub struct HarmonicForce {
    /// Row of the DOF.
    pub dof: usize,
    /// Amplitudes.
    pub amplitudes: Vec<c64>,
}

/// What each of `channels` shows in steady state at `omega` (rad/s) under `forces`.
///
/// `sensors` are sources of effects `delay` and `gain` at channels; they act on what is recorded, forces included.
///
/// # Errors
/// [`DynamicStiffnessError`] at an undamped resonance.
pub fn recorded(
    stiffness: &DynamicStiffness<'_>,
    omega: f64,
    forces: &[HarmonicForce],
    channels: &[Channel],
    sensors: &[Source],
) -> Result<Vec<ChannelMotion>, DynamicStiffnessError> {
    let harmonics = forces.iter().map(|force| force.amplitudes.len()).max().unwrap_or(0);
    let zero = c64::new(0.0, 0.0);
    let mut spectrum = vec![vec![zero; stiffness.size()]; harmonics];
    for force in forces {
        for (h, amplitude) in force.amplitudes.iter().enumerate() {
            spectrum[h][force.dof] += amplitude;
        }
    }
    let response = steady_state(stiffness, omega, &spectrum)?;
    let show = |channel: &Channel| {
        let amplitudes = (0..harmonics)
            .map(|h| {
                let w = (h + 1) as f64 * omega;
                let truth = match channel.quantity.derivatives() {
                    None => spectrum[h][channel.dof],
                    Some(order) => response[h][channel.dof] * c64::new(0.0, w).powi(order),
                };
                truth * transfer(sensors, channel, w)
            })
            .collect();
        ChannelMotion { channel: channel.clone(), mean: 0.0, amplitudes }
    };
    Ok(channels.iter().map(show).collect())
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

/// The force channels and every translation's acceleration, which is what is recorded unless the project says otherwise.
pub fn usual_channels(structure: &crate::structure::Structure, forces: &[HarmonicForce]) -> Vec<Channel> {
    let channel = |quantity, dof| Channel { quantity, dof, label: structure.label(dof).to_owned() };
    let driven = forces.iter().map(|force| channel(Quantity::Force, force.dof));
    let translations = (0..structure.len()).filter(|&dof| !structure.dofs()[dof].direction.is_rotation());
    driven.chain(translations.map(|dof| channel(Quantity::Acceleration, dof))).collect()
}
