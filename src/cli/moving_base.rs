//! A moving base in `dashpot simulate`: what it does to the structure, and what it adds to the sensors.

use crate::effects::Source;
use crate::exchange::project::Plan;
use crate::exchange::project::file::BaseResponse;
use crate::exchange::project::load_base::base;
use crate::measurement::base::{AXES, Base};
use crate::measurement::{Channel, Quantity};
use crate::response::harmonic_balance::{Excitation, HarmonicForce};
use crate::response::simulation::transfer;
use crate::response::synthesis::ChannelMotion;
use anyhow::{Context, anyhow};
use faer::c64;

/// A base that moves along one axis.
pub(super) struct MovingBase {
    base: Base,
    channel: Channel,
    /// Complex amplitudes of its acceleration, m/s^2.
    harmonics: Vec<c64>,
    /// Whether sensors show it.
    is_absolute: bool,
}

/// The channel of the base along an axis (0 to 2).
pub(super) fn channel(plan: &Plan, axis: usize) -> Channel {
    let dof = plan.structure.carried_by_base(axis).first().copied().unwrap_or(0);
    Channel { quantity: Quantity::Base, dof, label: AXES[axis].to_owned() }
}

impl MovingBase {
    pub(super) fn new(plan: &Plan, run: usize, axis: usize, harmonics: Vec<c64>) -> anyhow::Result<Self> {
        let base = base(&plan.structure, axis).context("a structure without mass has no force from its base")?;
        if base.along.is_empty() {
            let label = &base.label;
            return Err(anyhow!("no DOF of the structure moves along {label}; correct `base` of the run"));
        }
        let is_absolute = plan.runs[run].response == BaseResponse::Absolute;
        Ok(Self { base, channel: channel(plan, axis), harmonics, is_absolute })
    }

    pub(super) fn channel(&self) -> Channel {
        self.channel.clone()
    }

    /// Adds `-M r a` to what drives the structure.
    pub(super) fn drive(&self, excitation: &mut Excitation) {
        for (dof, _, load) in &self.base.loads {
            let harmonics = self.harmonics.iter().map(|a| a * -load).collect();
            excitation.forces.push(HarmonicForce { dof: *dof, mean: 0.0, harmonics });
        }
    }

    /// Puts its acceleration into its own channel and its motion into the sensors that show it.
    pub(super) fn show(&self, motions: &mut [ChannelMotion], omega: f64, sensors: &[Source]) {
        for motion in motions {
            let channel = &motion.channel;
            let own = *channel == self.channel;
            let rides = self.is_absolute
                && !matches!(channel.quantity, Quantity::Force | Quantity::Base)
                && self.base.along.contains(&channel.dof);
            let order = channel.quantity.derivatives().unwrap_or(0) - 2;
            if channel.quantity == Quantity::Force {
                // The sensor of an exciter does not feel what the base does to the mass beside it.
                let load =
                    self.base.loads.iter().find(|(dof, ..)| *dof == channel.dof).map_or(0.0, |(_, _, load)| *load);
                for (h, (y, a)) in (1..).zip(motion.amplitudes.iter_mut().zip(&self.harmonics)) {
                    *y += a * load * transfer(sensors, channel, f64::from(h) * omega);
                }
            }
            if own {
                motion.amplitudes.iter_mut().for_each(|y| *y = c64::new(0.0, 0.0));
            }
            for (h, a) in self.harmonics.iter().enumerate().filter(|_| own || rides) {
                let w = (h + 1) as f64 * omega;
                if motion.amplitudes.len() <= h {
                    motion.amplitudes.resize(h + 1, c64::new(0.0, 0.0));
                }
                motion.amplitudes[h] += a * c64::new(0.0, w).powi(order) * transfer(sensors, channel, w);
            }
        }
    }
}
