//! A base that moves in time, straight from sample to sample of its acceleration.
//!
//! ```text
//! M x'' + C x' + K x + f = -M r a,    x relative to the base; absolute motions are x + r (a, v or d of the base)
//! ```
//!
//! Velocity and displacement of the base follow from its acceleration without error of integration, from rest at the start:
//! `v+ = v + h (a + a+) / 2`, `d+ = d + h v + h^2 (2 a + a+) / 6`.

use crate::measurement::{Channel, Quantity};

/// How a base moves along an axis and what it does to a structure.
#[derive(Debug, Clone, Copy)]
pub struct BaseMotion<'a> {
    /// Rows with their `M r`, kg.
    pub loads: &'a [(usize, f64)],
    /// Rows of the translations along the axis.
    pub along: &'a [usize],
    /// Its channel in the record.
    pub channel: &'a Channel,
    /// Acceleration, m/s^2, in equal steps from the start of the record; at rest behind its end.
    pub acceleration: &'a [f64],
    /// Time between its samples, s.
    pub step_s: f64,
    /// Whether sensors show it.
    pub is_absolute: bool,
}

impl BaseMotion<'_> {
    /// Its acceleration (m/s^2), velocity (m/s) and displacement (m) at `count` steps of `step` s.
    pub(super) fn at_steps(&self, count: usize, step: f64) -> [Vec<f64>; 3] {
        let acceleration_at_step = |n: usize| {
            let place = n as f64 * step / self.step_s;
            let (k, share) = (place.floor() as usize, place.fract());
            let sample = |k: usize| self.acceleration.get(k).copied().unwrap_or(0.0);
            (1.0 - share) * sample(k) + share * sample(k + 1)
        };
        let a: Vec<f64> = (0..count).map(acceleration_at_step).collect();
        let (mut v, mut d) = (vec![0.0; count], vec![0.0; count]);
        for n in 1..count {
            v[n] = v[n - 1] + 0.5 * step * (a[n - 1] + a[n]);
            d[n] = d[n - 1] + step * v[n - 1] + step * step * (2.0 * a[n - 1] + a[n]) / 6.0;
        }
        [a, v, d]
    }

    /// What it adds to a channel of motion; nothing to one that does not ride on it.
    pub(super) fn added<'s>(&self, [a, v, d]: &'s [Vec<f64>; 3], channel: &Channel) -> Option<&'s [f64]> {
        let rides = self.is_absolute && self.along.contains(&channel.dof);
        match channel.quantity {
            Quantity::Base => (channel == self.channel).then_some(&a[..]),
            Quantity::Acceleration if rides => Some(a),
            Quantity::Velocity if rides => Some(v),
            Quantity::Displacement if rides => Some(d),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::BaseMotion;
    use crate::measurement::{Channel, Quantity};
    use std::f64::consts::TAU;

    /// The motion of a sine, from rest: `a = sin(w t)`, `v = (1 - cos(w t)) / w`, `d = t / w - sin(w t) / w^2`.
    #[test]
    fn velocity_and_displacement_follow_from_the_acceleration() {
        let (omega, step_s) = (TAU * 3.0, 1e-4);
        let acceleration: Vec<f64> = (0..20_000).map(|n| (omega * step_s * f64::from(n)).sin()).collect();
        let channel = Channel { quantity: Quantity::Base, dof: 0, label: "x".into() };
        let base = BaseMotion {
            loads: &[],
            along: &[],
            channel: &channel,
            acceleration: &acceleration,
            step_s,
            is_absolute: true,
        };
        let [a, v, d] = base.at_steps(10_000, 1.3e-4);
        for n in [1_usize, 777, 5000, 9999] {
            let t = 1.3e-4 * n as f64;
            assert!((a[n] - (omega * t).sin()).abs() < 1e-5);
            assert!((v[n] - (1.0 - (omega * t).cos()) / omega).abs() < 1e-6, "{n}");
            assert!((d[n] - (t / omega - (omega * t).sin() / omega.powi(2))).abs() < 1e-6, "{n}");
        }
    }
}
