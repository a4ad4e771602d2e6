//! Modes that a record shows for a moment only: one that is damped by some percent rings for a few milliseconds after a blow, no peak in
//! the spectrum of the whole record, yet far above the noise while it lasts. Motion of modes beyond the last that is modelled counts as
//! noise, which would hide all effects.

use super::data::RecordData;
use super::weights::{in_band, local};
use crate::structure::modes::Modes;
use std::f64::consts::TAU;

/// Motion of a mode over the noise in its band from which on it is observable: of some thousand neighbourhoods of noise alone the
/// largest has a mean square of about five.
const PLAIN: f64 = 9.0;
/// Half width of a neighbourhood in periods of the mode.
const NEIGHBOURS: f64 = 2.0;
/// Periods of the mode about the largest sample that are looked at.
const LOUD: f64 = 32.0;
/// Highest frequency, over the sampling rate, of a mode that a record can hold.
const HELD: f64 = 0.4;

impl RecordData {
    /// Number of modes up to the highest that is observable in the record, of those from number `from` to `to`, in a decay up to
    /// `most_hz`; 0 where none of them is.
    pub(super) fn observable_modes(&self, modes: &Modes, from: usize, to: usize, most_hz: f64) -> usize {
        let most = if self.forces.is_empty() { TAU * most_hz } else { f64::INFINITY };
        let mut numbers = (from..to.min(modes.len())).rev().filter(|&r| modes.omega[r] <= most);
        numbers.find(|&r| is_observable(self, modes, r)).map_or(0, |r| r + 1)
    }
}

/// Whether a channel moves in the band about mode `r`, up to the middle between it and its neighbours, well above its noise.
fn is_observable(record: &RecordData, modes: &Modes, r: usize) -> bool {
    let frequency_hz = |k: usize| modes.omega[k] / TAU;
    let own = frequency_hz(r);
    if own <= 0.0 || own * record.step > HELD {
        return false;
    }
    let low = if r > 0 { (frequency_hz(r - 1) * own).sqrt().max(own / 2.0) } else { own / 2.0 };
    let high = if r + 1 < modes.len() { (own * frequency_hz(r + 1)).sqrt().min(2.0 * own) } else { 2.0 * own };
    let share = 2.0 * record.step * (high.min(0.5 / record.step) - low);
    let half = ((NEIGHBOURS / (own * record.step)).ceil() as usize).max(4);
    let length = ((LOUD / (own * record.step)).ceil() as usize).max(256).min(record.len());
    if share <= 0.0 || length < 8 * half {
        return false;
    }
    let stands_out = |(y, noise): (&Vec<f64>, &f64)| {
        let loudest = (0..y.len()).max_by(|&a, &b| y[a].abs().total_cmp(&y[b].abs())).unwrap_or(0);
        let from = loudest.saturating_sub(length / 4).min(y.len() - length);
        let motion = local(&in_band(&y[from..from + length], record.step, [low, high]), half);
        // The mirror at the ends has a kink.
        let inner = &motion[2 * half..motion.len() - 2 * half];
        inner.iter().fold(0.0_f64, |m, x| m.max(*x)).powi(2) > PLAIN * share * noise * noise
    };
    record.samples.iter().zip(&record.noise).any(stands_out)
}
