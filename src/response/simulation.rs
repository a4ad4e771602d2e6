//! What a model's sensors would show: periodic steady state under given forces, recorded through the measuring chain.
//!
//! `Y_h = T(h omega) (i h omega)^k X_h` with `k` the derivatives of the channel's quantity and `T` the transfer of its
//! known errors (delay, gain).

use super::harmonic_balance::{Excitation, Response};
use super::synthesis::ChannelMotion;
use crate::effects::effect::Kind;
use crate::effects::{Place, Source};
use crate::measurement::{Channel, Quantity};
use crate::structure::Structure;
use faer::c64;

/// What each of `channels` shows of `response` under `excitation`, in SI units.
///
/// `sensors` are sources of effects `delay` and `gain` at channels; they act on what is recorded, forces included.
pub fn recorded(
    response: &Response,
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
            Quantity::Velocity | Quantity::Acceleration => 0.0,
        };
        let mean = mean * transfer(sensors, channel, 0.0).re;
        let harmonics = response.order().max(excitation.forces.iter().map(|f| f.harmonics.len()).max().unwrap_or(0));
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

/// The force channels and every translation's acceleration, which is what is recorded unless the project says otherwise.
pub fn usual_channels(structure: &Structure, excitation: &Excitation) -> Vec<Channel> {
    let channel = |quantity, dof| Channel { quantity, dof, label: structure.label(dof).to_owned() };
    let driven = excitation.forces.iter().map(|force| channel(Quantity::Force, force.dof));
    let translations = (0..structure.len()).filter(|&dof| !structure.dofs()[dof].direction.is_rotation());
    driven.chain(translations.map(|dof| channel(Quantity::Acceleration, dof))).collect()
}
