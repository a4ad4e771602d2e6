//! Base excitation: the harmonics of a run whose structure stands on a moving base, as forces on the structure and motions
//! relative to the base, so that nothing that follows knows of a base.
//!
//! ```text
//! F_h = -M r A_h                         A: acceleration of the base, m/s^2;  M r: load of each DOF, kg
//! Y_h (relative) = Y_h (absolute) - r A_h (i h omega)^(k - 2)      k = 0, 1, 2: displacement, velocity, acceleration
//! ```
//!
//! All forces share the one error of `A`, but are carried on as independent. Their variance is `kappa^2` times that of
//! `-M r A`, `kappa^2 = (sum |M r|)^2 / sum (M r)^2`: exact where the structure answers all of them alike, too large elsewhere
//! (Cauchy and Schwarz, for equal masses).

use super::channel::{Channel, Quantity};
use super::fit::{ChannelFit, HarmonicFit, turn_covariance};
use faer::c64;

/// How a structure takes a motion of its base along one axis.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Base {
    /// The base's label: `x`, `y` or `z`.
    pub label: String,
    /// Row, label and `M r` (kg) of the DOFs that are loaded.
    pub loads: Vec<(usize, String, f64)>,
    /// Rows of the translations along the axis.
    pub along: Vec<usize>,
}

/// Names of the axes.
pub(crate) const AXES: [&str; 3] = ["x", "y", "z"];

/// The run's harmonics with its base channels turned into forces; `is_absolute` tells whether its motions are.
pub(crate) fn driven(mut fit: HarmonicFit, bases: &[Base], is_absolute: bool) -> HarmonicFit {
    let (moving, mut channels): (Vec<ChannelFit>, Vec<ChannelFit>) =
        fit.channels.into_iter().partition(|c| c.channel.quantity == Quantity::Base);
    for motion in &moving {
        let Some(base) = bases.iter().find(|base| base.label == motion.channel.label) else { continue };
        if is_absolute {
            let above = channels.iter_mut().filter(|c| base.along.contains(&c.channel.dof));
            above.for_each(|channel| subtract(channel, motion, fit.omega));
        }
        let (sum, squares) =
            base.loads.iter().fold((0.0, 0.0), |(sum, squares), (_, _, m)| (sum + m.abs(), squares + m * m));
        let spread = if squares > 0.0 { sum * sum / squares } else { 0.0 };
        for (dof, label, mass) in &base.loads {
            let mut force = force(motion, *dof, label, -mass);
            force.covariance *= faer::Scale(spread);
            add(&mut channels, force);
        }
    }
    fit.channels = channels;
    fit
}

/// Takes the base's motion from a channel of displacement, velocity or acceleration.
fn subtract(channel: &mut ChannelFit, motion: &ChannelFit, omega: f64) {
    let Some(order) = channel.channel.quantity.derivatives() else { return };
    let factors: Vec<c64> =
        (1..=channel.amplitudes.len()).map(|h| c64::new(0.0, h as f64 * omega).powi(order - 2)).collect();
    for ((y, a), z) in channel.amplitudes.iter_mut().zip(&motion.amplitudes).zip(&factors) {
        *y -= a * z;
    }
    channel.covariance += turn_covariance(&motion.covariance, &factors);
    channel.noise = channel.noise.hypot(motion.noise * factors.first().map_or(0.0, |z| z.norm()));
}

fn force(motion: &ChannelFit, dof: usize, label: &str, factor: f64) -> ChannelFit {
    let factors = vec![c64::new(factor, 0.0); motion.amplitudes.len()];
    ChannelFit {
        channel: Channel { quantity: Quantity::Force, dof, label: label.to_owned() },
        offset: motion.offset * factor,
        slope: motion.slope * factor,
        amplitudes: motion.amplitudes.iter().map(|a| a * factor).collect(),
        covariance: turn_covariance(&motion.covariance, &factors),
        noise: motion.noise * factor.abs(),
    }
}

/// Adds a force to that of an exciter at the same DOF, or as a channel of its own.
fn add(channels: &mut Vec<ChannelFit>, force: ChannelFit) {
    let same =
        channels.iter_mut().find(|c| c.channel.quantity == Quantity::Force && c.channel.dof == force.channel.dof);
    let Some(known) = same else {
        channels.push(force);
        return;
    };
    known.amplitudes.iter_mut().zip(&force.amplitudes).for_each(|(sum, f)| *sum += f);
    known.covariance += force.covariance;
    known.offset += force.offset;
    known.slope += force.slope;
    known.noise = known.noise.hypot(force.noise);
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::Mat;

    fn channel(quantity: Quantity, dof: usize, label: &str, value: c64) -> ChannelFit {
        ChannelFit {
            channel: Channel { quantity, dof, label: label.into() },
            offset: 0.0,
            slope: 0.0,
            amplitudes: vec![value],
            covariance: Mat::from_fn(2, 2, |i, j| if i == j { 0.01 } else { 0.0 }),
            noise: 0.1,
        }
    }

    #[test]
    fn absolute_motions_lose_the_base_and_forces_appear() {
        let a = c64::new(2.0, 1.0);
        let fit = HarmonicFit {
            omega: 10.0,
            omega_deviation: 0.0,
            channels: vec![
                channel(Quantity::Base, 0, "x", a),
                channel(Quantity::Acceleration, 0, "1", c64::new(5.0, 0.0)),
                channel(Quantity::Displacement, 1, "2", c64::new(5.0, 0.0)),
                channel(Quantity::Force, 1, "2", c64::new(1.0, 0.0)),
            ],
        };
        let loads = vec![(0, "1".to_owned(), 3.0), (1, "2".to_owned(), 3.0)];
        let base = Base { label: "x".into(), loads, along: vec![0, 1] };
        let result = driven(fit.clone(), std::slice::from_ref(&base), true);
        let value = |k: usize| result.channels[k].amplitudes[0];
        assert_eq!(result.channels.len(), 4);
        assert!((value(0) - (c64::new(5.0, 0.0) - a)).norm() < 1e-15);
        assert!((value(1) - (c64::new(5.0, 0.0) + a / 100.0)).norm() < 1e-15);
        assert!((value(2) - (c64::new(1.0, 0.0) - a * 3.0)).norm() < 1e-15);
        assert!((value(3) + a * 3.0).norm() < 1e-15);
        // Two equal loads: twice the variance of one.
        assert!((result.channels[3].covariance[(0, 0)] - 2.0 * 9.0 * 0.01).abs() < 1e-15);
        assert_eq!(driven(fit, &[base], false).channels[0].amplitudes[0], c64::new(5.0, 0.0));
    }
}
