//! Corrects harmonics for the known errors of their channels.
//!
//! Recorded = transfer x true (`effects/laws/delay.rs`, `gain.rs`), so every amplitude is divided by the transfer at its
//! harmonic, and the covariance turned and scaled alike.

use crate::effects::effect::Kind;
use crate::effects::{Place, Source};
use crate::measurement::{ChannelFit, HarmonicFit};
use faer::{Mat, c64};

/// Corrects every channel of `fit` for those of `sensors` that are at it.
pub fn correct(fit: &mut HarmonicFit, sensors: &[Source]) {
    let omega = fit.omega;
    for channel in &mut fit.channels {
        let name = channel.channel.to_string();
        for sensor in sensors {
            let (Place::Channel(at), Kind::Channel(law)) = (&sensor.place, sensor.effect.kind()) else { continue };
            if *at == name {
                let value = sensor.parameters[0];
                divide(channel, |h| law.transfer(value, h as f64 * omega));
                // Offset, slope and noise see the gain alone: a transfer at zero frequency.
                let gain = law.transfer(value, 0.0).re;
                channel.offset /= gain;
                channel.slope /= gain;
                channel.noise /= gain.abs();
            }
        }
    }
}

/// Divides harmonic `h` by `transfer(h)`.
fn divide(channel: &mut ChannelFit, transfer: impl Fn(usize) -> c64) {
    let factors: Vec<c64> = (1..=channel.amplitudes.len()).map(|h| c64::new(1.0, 0.0) / transfer(h)).collect();
    for (amplitude, factor) in channel.amplitudes.iter_mut().zip(&factors) {
        *amplitude *= *factor;
    }
    // (Re, Im) of z Y is [[a, -b], [b, a]] (Re, Im) of Y for z = a + i b.
    let size = 2 * factors.len();
    let turn = Mat::from_fn(size, size, |i, j| {
        let z = factors[i / 2];
        match (i / 2 == j / 2, i % 2, j % 2) {
            (false, _, _) => 0.0,
            (true, 0, 1) => -z.im,
            (true, 1, 0) => z.im,
            _ => z.re,
        }
    });
    if channel.covariance.nrows() == size {
        channel.covariance = &turn * &channel.covariance * turn.transpose();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::Effect;
    use crate::measurement::{Channel, Quantity};

    #[test]
    fn a_late_loud_channel_is_put_right() {
        let truth = [c64::new(1.0, -2.0), c64::new(0.3, 0.1)];
        let (omega, delay, gain) = (50.0, 2e-3, 1.25);
        // What a channel that is late by the delay records of exp(i w t) is exp(i w (t - delay)).
        let recorded = |h: usize| truth[h - 1] * gain * c64::from_polar(1.0, -(h as f64) * omega * delay);
        let channel = Channel { quantity: Quantity::Acceleration, dof: 0, label: "7".into() };
        let mut covariance = Mat::zeros(4, 4);
        covariance[(0, 0)] = 4.0;
        covariance[(1, 1)] = 1.0;
        let fit = ChannelFit {
            channel,
            offset: 2.5,
            slope: 0.0,
            amplitudes: vec![recorded(1), recorded(2)],
            covariance,
            noise: 1.0,
        };
        let other = ChannelFit { channel: Channel { dof: 1, label: "8".into(), ..fit.channel.clone() }, ..fit.clone() };
        let mut fit = HarmonicFit { omega, omega_deviation: 0.0, channels: vec![fit, other.clone()] };
        let at = Place::Channel("acc@7".into());
        correct(
            &mut fit,
            &[Source::known(Effect::Delay, at.clone(), &[delay]), Source::known(Effect::Gain, at, &[gain])],
        );
        for (found, expected) in fit.channels[0].amplitudes.iter().zip(truth) {
            assert!((found - expected).norm() < 1e-14);
        }
        let c = &fit.channels[0].covariance;
        assert!((c[(0, 0)] + c[(1, 1)] - 5.0 / gain / gain).abs() < 1e-14, "the total variance scales with the gain");
        let determinant = c[(0, 0)] * c[(1, 1)] - c[(0, 1)] * c[(1, 0)];
        assert!((determinant - 4.0 / gain.powi(4)).abs() < 1e-14, "turning keeps the area of the ellipse");
        assert_eq!(fit.channels[0].offset, 2.0);
        assert_eq!(fit.channels[1], other);
    }
}
