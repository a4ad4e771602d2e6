//! The band of a record: which modes its sensors can tell apart, and the filter that keeps them.
//!
//! ```text
//! q(f) = W(f) sum_s P_s (i omega)^-k_s y_s(f),     P = (S Phi)^+
//! ```
//!
//! `W` rises from 0 to 1 between 0.15 and 0.7 of the lowest natural frequency, so that integrals of accelerations cannot drift,
//! and falls between the highest mode kept and the next (or the limit of the sampling). Both flanks are infinitely smooth, so
//! that the filter forgets within a few periods. Force and motion pass the same filter, and with them the equation of motion
//! of the kept modes holds exactly, whatever the filter.

use super::window_rows::WindowError;
use crate::math::least_squares::{pseudo_inverse, thin_svd};
use crate::measurement::TransientRun;
use crate::structure::modes::Modes;
use faer::Mat;
use std::f64::consts::TAU;

/// Frequency, over the sampling rate, up to which filters against aliasing leave a signal as it is.
pub(super) const FLAT: f64 = 0.34;
/// Flank of the filter above all modes, over the sampling rate.
const TOP: [f64; 2] = [0.36, 0.45];
/// Lower flank, over the lowest natural frequency.
const LOWER: [f64; 2] = [0.15, 0.7];
/// Largest condition of the mode shapes at the sensors.
const CONDITION: f64 = 30.0;
/// Least ratio of the frequencies of the first mode left out and the last mode kept.
const GAP: f64 = 1.2;

/// Modes that are kept and the filter that keeps them.
#[derive(Debug, Clone)]
pub(crate) struct Band {
    /// Numbers of the modes, from 0.
    pub modes: Vec<usize>,
    /// Circular frequency of each, rad/s.
    pub omega: Vec<f64>,
    /// Shape of each at every DOF, n x m.
    pub shapes: Mat<f64>,
    /// `P`, m x sensors.
    pub expansion: Mat<f64>,
    /// Lower flank, Hz.
    pub low: [f64; 2],
    /// Upper flank, Hz.
    pub high: [f64; 2],
}

impl Band {
    /// The most modes that the sensors of a run tell apart; `sensors` are numbers of channels.
    pub(crate) fn new(modes: &Modes, run: &TransientRun, sensors: &[usize]) -> Result<Self, WindowError> {
        let rate = 1.0 / run.step();
        let flexible: Vec<usize> = (0..modes.len()).filter(|&r| modes.omega[r] > 0.0).collect();
        let within = flexible.iter().filter(|&&r| modes.frequency_hz(r) < FLAT * rate).count();
        let shape = |s: usize, r: usize| modes.shapes[(run.channels()[sensors[s]].dof, r)];
        for count in (1..=within.min(sensors.len())).rev() {
            let last = modes.frequency_hz(flexible[count - 1]);
            let next = flexible.get(count).map_or(f64::INFINITY, |&r| modes.frequency_hz(r));
            let shapes = Mat::from_fn(sensors.len(), count, |s, r| shape(s, flexible[r]));
            let (_, values, _) = thin_svd(shapes.as_ref()).map_err(|_| too_few(run, within, sensors.len()))?;
            if next < GAP * last || values[count - 1] * CONDITION < values[0] {
                continue;
            }
            let expansion = pseudo_inverse(shapes.as_ref(), 1e-9).map_err(|_| too_few(run, within, sensors.len()))?;
            let first = modes.frequency_hz(flexible[0]);
            let share = (next / last).min(1e3).powf(0.2);
            let high = if next > TOP[1] * rate {
                TOP.map(|share| share * rate)
            } else {
                [last * share, (next / share).min(TOP[1] * rate)]
            };
            let kept = flexible[..count].to_vec();
            return Ok(Self {
                omega: kept.iter().map(|&r| modes.omega[r]).collect(),
                shapes: Mat::from_fn(modes.shapes.nrows(), count, |i, r| modes.shapes[(i, kept[r])]),
                modes: kept,
                expansion,
                low: LOWER.map(|share| share * first),
                high,
            });
        }
        Err(too_few(run, within, sensors.len()))
    }

    /// `W` at a frequency in Hz.
    pub(crate) fn gain(&self, hz: f64) -> f64 {
        step(hz, self.low) * (1.0 - step(hz, self.high))
    }

    /// Samples of `step` s after which the filter, at the displacement of the lowest mode, has forgotten all but 1e-4.
    pub(crate) fn memory(&self, step: f64) -> usize {
        let slowest = 1.0 / (self.low[1] - self.low[0]);
        let steepest = 1.0 / (self.high[1] - self.high[0]);
        (MEMORY * slowest.max(steepest) / step).ceil() as usize
    }
}

/// Times the inverse width of the steepest flank after which the impulse response is below 1e-4 of its largest value
/// (`tests` below).
const MEMORY: f64 = 3.0;

/// From 0 to 1 between two frequencies, with all derivatives continuous.
fn step(hz: f64, [from, to]: [f64; 2]) -> f64 {
    let x = (hz - from) / (to - from);
    if x <= 0.0 {
        return 0.0;
    }
    if x >= 1.0 {
        return 1.0;
    }
    1.0 / (1.0 + (1.0 / x - 1.0 / (1.0 - x)).exp())
}

fn too_few(run: &TransientRun, modes: usize, sensors: usize) -> WindowError {
    WindowError::TooFewSensors { file: run.file.clone(), modes, sensors }
}

/// Circular frequency between lines of a transform of `length` samples, rad/s.
pub(crate) fn line_omega(length: usize, step: f64) -> f64 {
    TAU / (length as f64 * step)
}

#[cfg(test)]
mod tests {
    use super::step;
    use std::f64::consts::TAU;

    /// The impulse response of a flank of width 1 Hz, by a plain sum.
    #[test]
    fn a_flank_is_forgotten_after_three_times_its_inverse_width() {
        let response = |t: f64| {
            let lines = (0..20_000).map(|k| 0.001 * f64::from(k));
            lines.map(|f| step(f, [1.0, 2.0]) * (1.0 - step(f, [8.0, 14.0])) * (TAU * f * t).cos()).sum::<f64>()
        };
        let most = response(0.0);
        let tail = (0..200).map(|k| response(3.0 + 0.01 * f64::from(k)).abs()).fold(0.0, f64::max);
        assert!(tail < 3e-4 * most, "{}", tail / most);
    }
}
