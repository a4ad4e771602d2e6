//! One channel of a record with its residual and its spectrum, ready to be drawn at any zoom.

use super::pyramid::Pyramid;
use crate::control::Control;
use crate::math::spectrum::Spectrum;
use crate::measurement::{self, ChannelFit, Quantity, Record};
use faer::c64;
use std::f64::consts::TAU;
use std::sync::Arc;

/// One channel of a record, ready to be drawn.
#[derive(Debug, Clone)]
pub struct Trace {
    /// The harmonics of what was recorded: on a moving base those before its motion is taken off.
    pub fit: ChannelFit,
    /// The record.
    pub record: Arc<Pyramid>,
    /// Record minus fit, at every sample.
    pub residual: Arc<Pyramid>,
    /// Its spectrum up to a little above the highest harmonic; `None` where it is too short.
    pub spectrum: Option<Arc<Pyramid>>,
}

/// Computes a trace; `None` where the channel is not in the record, or cancelled.
pub(crate) fn trace(record: &Arc<Record>, fit: &ChannelFit, omega: f64, control: &Control) -> Option<Trace> {
    let row = record.channels().iter().position(|c| *c == fit.channel)?;
    let (time, samples) = (record.time(), record.samples(row));
    let own = as_recorded(record, row, fit, omega)?;
    let fit = &own;
    let (first, last) = (*time.first()?, *time.last()?);
    let middle = 0.5 * (first + last);
    let residual: Vec<f64> = time.iter().zip(samples).map(|(&t, y)| y - fitted(fit, omega, middle, t)).collect();
    control.report(0.4);
    control.check().ok()?;
    let whole = Pyramid::of_record(Arc::clone(record), row);
    let residual = Pyramid::beside(Arc::clone(record), residual);
    control.report(0.7);
    control.check().ok()?;
    let step = (last - first) / (time.len().max(2) - 1) as f64;
    let spectrum = Spectrum::new(samples, step).map(|s| Arc::new(lines(&s, fit, omega)));
    Some(Trace { record: Arc::new(whole), residual: Arc::new(residual), spectrum, fit: own })
}

/// The fit of a channel as it was recorded: where the base moves, that of the run is relative to it.
fn as_recorded(record: &Record, row: usize, fit: &ChannelFit, omega: f64) -> Option<ChannelFit> {
    if record.channels().iter().all(|c| c.quantity != Quantity::Base) {
        return Some(fit.clone());
    }
    measurement::fit(record, omega, fit.amplitudes.len()).ok()?.channels.into_iter().nth(row)
}

/// Lines of a spectrum up to a little above the highest harmonic; what lies far below the highest is drawn at a floor.
fn lines(spectrum: &Spectrum, fit: &ChannelFit, omega: f64) -> Pyramid {
    let last = omega / TAU * (fit.amplitudes.len() as f64 + 1.5);
    let shown = spectrum.amplitude.len().min((last / spectrum.resolution_hz).ceil() as usize + 2).max(2);
    let floor = 1e-7 * spectrum.amplitude.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let frequency: Vec<f64> = (1..shown).map(|k| spectrum.frequency_hz(k)).collect();
    let amplitude: Vec<f64> = (1..shown).map(|k| spectrum.amplitude.get(k).map_or(floor, |a| a.max(floor))).collect();
    Pyramid::new(&frequency, &amplitude)
}

/// `offset + slope (t - t_mid) + Re sum_h Y_h exp(i h omega t)`.
pub(crate) fn fitted(fit: &ChannelFit, omega: f64, middle: f64, t: f64) -> f64 {
    let turn = c64::new((omega * t).cos(), (omega * t).sin());
    let mut power = c64::new(1.0, 0.0);
    let mut sum = fit.offset + fit.slope * (t - middle);
    for y in &fit.amplitudes {
        power *= turn;
        sum += y.re * power.re - y.im * power.im;
    }
    sum
}
