//! Displacement and force harmonics of one run: `X_h = Y_h / (i h omega)^d` (6.5, 6.6), `d` = 0 displacement, 1 velocity,
//! 2 acceleration.
//!
//! The covariance of a complex amplitude is taken as circular (equal variances of real and imaginary part, harmonics
//! independent), which is exact for records of whole periods and good for records of many.

use super::error::BalanceError;
use crate::measurement::{ChannelFit, Quantity, Run};
use crate::structure::Structure;
use faer::{Mat, c64};

/// Deviation relative to a channel's amplitude below which a run counts as free of noise.
pub(crate) const NOISE_FREE: f64 = 1e-8;
/// Deviation relative to the amplitude that stands in where none is known or the run is free of noise.
pub(crate) const NOMINAL: f64 = 1e-9;
/// A harmonic counts when its squared amplitude over twice its variance exceeds this in some channel (p < 1e-6).
const SIGNIFICANT: f64 = 14.0;
/// Part of the channel's largest amplitude below which a harmonic is rounding.
const ROUNDING: f64 = 1e-11;

/// Complex amplitudes at a number of places with the standard deviation of their real (and imaginary) parts.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredAmplitudes {
    /// DOF row of each place.
    pub dofs: Vec<usize>,
    /// Places x kept harmonics; m or N.
    pub values: Mat<c64>,
    /// Standard deviation of the real part of each value, positive.
    pub deviations: Mat<f64>,
}

impl MeasuredAmplitudes {
    /// Number of places.
    pub fn len(&self) -> usize {
        self.dofs.len()
    }

    /// Whether there is no place.
    pub fn is_empty(&self) -> bool {
        self.dofs.is_empty()
    }
}

/// What one run measured, as displacements and forces.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Name of the run, for messages.
    pub file: String,
    /// Fundamental circular frequency, rad/s.
    pub omega: f64,
    /// Harmonics that stand out of the noise in at least one channel; 1 is always among them.
    pub numbers: Vec<usize>,
    /// Displacement of the sensors, m.
    pub sensors: MeasuredAmplitudes,
    /// Forces of the exciters, N.
    pub forces: MeasuredAmplitudes,
    /// Whether the deviations come from the data; if not they are nominal.
    pub noisy: bool,
}

impl Measured {
    /// Takes the harmonics of a run that stand out of the noise.
    ///
    /// # Errors
    /// [`BalanceError::NoForce`], [`BalanceError::NoSensor`] and [`BalanceError::ZeroForce`].
    pub fn new(run: &Run) -> Result<Self, BalanceError> {
        let (forces, sensors): (Vec<&ChannelFit>, Vec<&ChannelFit>) =
            run.fit.channels.iter().partition(|c| c.channel.quantity == Quantity::Force);
        let file = run.file.clone();
        if forces.is_empty() {
            return Err(BalanceError::NoForce { file });
        }
        if sensors.is_empty() {
            return Err(BalanceError::NoSensor { file });
        }
        if forces.iter().all(|f| f.amplitudes.iter().all(|a| a.norm() == 0.0)) {
            return Err(BalanceError::ZeroForce { file, frequency_hz: run.fit.omega / std::f64::consts::TAU });
        }
        let noisy = run.fit.channels.iter().any(is_noisy);
        let numbers: Vec<usize> = (1..=run.fit.harmonics())
            .filter(|&h| h == 1 || run.fit.channels.iter().any(|c| stands_out(c, h, noisy)))
            .collect();
        let omega = run.fit.omega;
        let sensors = amplitudes(&sensors, omega, &numbers);
        let forces = amplitudes(&forces, omega, &numbers);
        Ok(Self { file, omega, numbers, sensors, forces, noisy })
    }

    /// Takes no sensor as better than `part` of the largest motion of its kind, translation or rotation, at the same
    /// harmonic. Runs whose noise is not known stay as they are.
    pub fn limit_range(&mut self, part: f64, structure: &Structure) {
        if !self.noisy {
            return;
        }
        let turns = |dof: &usize| structure.dofs()[*dof].direction.is_rotation();
        let is_rotation: Vec<bool> = self.sensors.dofs.iter().map(turns).collect();
        for k in 0..self.harmonics() {
            for kind in [false, true] {
                let places: Vec<usize> = (0..self.sensors.len()).filter(|&s| is_rotation[s] == kind).collect();
                let largest = places.iter().fold(0.0_f64, |most, &s| most.max(self.sensors.values[(s, k)].norm()));
                for s in places {
                    let deviation = &mut self.sensors.deviations[(s, k)];
                    *deviation = deviation.hypot(part * largest);
                }
            }
        }
    }

    /// Number of kept harmonics.
    pub fn harmonics(&self) -> usize {
        self.numbers.len()
    }

    /// Circular frequency of kept harmonic number `k` (an index), rad/s.
    pub fn frequency(&self, k: usize) -> f64 {
        self.numbers[k] as f64 * self.omega
    }

    /// Sensors at a DOF.
    pub fn sensors_at(&self, dof: usize) -> impl Iterator<Item = usize> + '_ {
        (0..self.sensors.len()).filter(move |&s| self.sensors.dofs[s] == dof)
    }

    /// Weights with which the sensors at a DOF are averaged, inverse to their variances; empty without a sensor there.
    pub fn average_at(&self, dof: usize, k: usize) -> Vec<(usize, f64)> {
        let mut list: Vec<(usize, f64)> =
            self.sensors_at(dof).map(|s| (s, self.sensors.deviations[(s, k)].powi(-2))).collect();
        let sum: f64 = list.iter().map(|(_, w)| w).sum();
        for (_, weight) in &mut list {
            *weight /= sum;
        }
        list
    }
}

fn largest(fit: &ChannelFit) -> f64 {
    fit.amplitudes.iter().fold(0.0, |m, a| a.norm().max(m))
}

fn is_noisy(fit: &ChannelFit) -> bool {
    let deviation = fit.deviation(1);
    deviation > NOISE_FREE * largest(fit) && deviation > 0.0
}

fn stands_out(fit: &ChannelFit, h: usize, noisy: bool) -> bool {
    let amplitude = fit.amplitudes[h - 1].norm();
    let deviation = fit.deviation(h);
    amplitude > ROUNDING * largest(fit)
        && if noisy { amplitude.powi(2) > 2.0 * SIGNIFICANT * deviation.powi(2) } else { amplitude > 10.0 * deviation }
}

fn amplitudes(fits: &[&ChannelFit], omega: f64, numbers: &[usize]) -> MeasuredAmplitudes {
    let order = |fit: &ChannelFit| fit.channel.quantity.derivatives().unwrap_or(0);
    let factor = |fit: &ChannelFit, k: usize| c64::new(0.0, numbers[k] as f64 * omega).powi(-order(fit));
    // A channel that reads nothing at all borrows the floor of its neighbours.
    let loudest = fits.iter().fold(0.0_f64, |m, f| m.max(largest(f) * factor(f, 0).norm()));
    let values =
        Mat::from_fn(fits.len(), numbers.len(), |s, k| fits[s].amplitudes[numbers[k] - 1] * factor(fits[s], k));
    let deviations = Mat::from_fn(fits.len(), numbers.len(), |s, k| {
        let (fit, scale) = (fits[s], factor(fits[s], k).norm());
        let own = largest(fit) * scale;
        let floor = if own > 0.0 { NOMINAL * own } else { NOMINAL * loudest };
        (fit.deviation(numbers[k]) * scale).max(floor).max(f64::MIN_POSITIVE.sqrt())
    });
    MeasuredAmplitudes { dofs: fits.iter().map(|f| f.channel.dof).collect(), values, deviations }
}
