//! Modal motion of a record in its band, displacements and velocities integrated in the frequency domain, and the noise of it.

use super::band::{Band, FLAT, line_omega};
use super::window_rows::WindowError;
use crate::control::Control;
use crate::measurement::TransientRun;
use crate::structure::modes::Modes;
use dashpot_numerics::RealTransform;
use faer::c64;
use std::f64::consts::{LN_2, TAU};
use std::ops::Range;

/// Samples at the end of a record from which the noise is read.
const NOISE_SAMPLES: usize = 16_384;
/// Least share of the lines up to Nyquist's that shows noise by itself.
const NOISE_BAND: f64 = 0.08;
/// Ratio of a quiet end's root mean square to the largest sample.
const QUIET: f64 = 0.003;

/// Motion of the kept modes at every sample that is used.
#[derive(Debug, Clone)]
pub(crate) struct Motion {
    pub band: Band,
    /// Time between samples, s.
    pub step: f64,
    /// Modal displacement, one list a mode.
    pub q: Vec<Vec<f64>>,
    /// Modal velocity.
    pub v: Vec<Vec<f64>>,
    /// Spectrum of each modal displacement over the padded record.
    pub lines: Vec<Vec<c64>>,
    /// Length of the padded record.
    pub padded: usize,
    /// Filtered forces: DOF and samples, N.
    pub forces: Vec<(usize, Vec<f64>)>,
    /// Samples that no end spoils.
    pub usable: Range<usize>,
    /// Sensors: derivatives of the displacement, and variance of a sample.
    pub sensors: Vec<(i32, f64)>,
    /// Variance of a sample of each force channel.
    pub force_variance: Vec<f64>,
}

impl Motion {
    /// Of the part of a run that is used.
    pub(crate) fn new(modes: &Modes, run: &TransientRun, control: &Control) -> Result<Self, WindowError> {
        let numbers = run.response_channels();
        let band = Band::new(modes, run, &numbers)?;
        let (n, step) = (run.len(), run.step());
        let memory = band.memory(step);
        let padded = smooth_length(n + memory);
        let transform = RealTransform::new(padded);
        let spectrum = |c: usize| {
            let mut signal = run.samples(c).to_vec();
            let mean = if is_quiet_start(run.samples(c)) { 0.0 } else { signal.iter().sum::<f64>() / n as f64 };
            signal.iter_mut().for_each(|y| *y -= mean);
            signal.resize(padded, 0.0);
            transform.forward(&mut signal)
        };
        let measured: Vec<Vec<c64>> = control.map(numbers.len(), |s| spectrum(numbers[s]));
        let orders: Vec<i32> = numbers.iter().map(|&c| run.channels()[c].quantity.derivatives().unwrap_or(0)).collect();
        let gains: Vec<f64> = (0..=padded / 2).map(|k| band.gain(k as f64 * line_omega(padded, step) / TAU)).collect();
        let made = control.map(band.omega.len(), |r| {
            let lines = modal_lines(&band, &measured, &orders, &gains, r, line_omega(padded, step));
            let rate = |(k, z): (usize, &c64)| z * c64::new(0.0, k as f64 * line_omega(padded, step));
            let velocity: Vec<c64> = lines.iter().enumerate().map(rate).collect();
            let [q, v] = [lines.clone(), velocity].map(|lines| in_time(&transform, lines, n));
            (q, v, lines)
        });
        let force_numbers = run.force_channels();
        let forces = force_numbers
            .iter()
            .map(|&c| {
                let lines = spectrum(c).iter().zip(&gains).map(|(z, g)| z * *g).collect();
                (run.channels()[c].dof, in_time(&transform, lines, n))
            })
            .collect();
        let variances = numbers.iter().map(|&c| noise_variance(run, c, band.omega[band.omega.len() - 1] / TAU));
        let sensors = orders.iter().copied().zip(variances).collect();
        let force_variance = force_numbers.iter().map(|&c| difference_variance(run.samples(c))).collect();
        let quiet = |end: &dyn Fn(&[f64]) -> bool| numbers.iter().chain(&force_numbers).all(|&c| end(run.samples(c)));
        let first = if quiet(&is_quiet_start) { 0 } else { memory };
        let last =
            if quiet(&|y| is_quiet(&y[y.len() - (y.len() / 50).max(8)..], y)) { n } else { n.saturating_sub(memory) };
        if last < first + 16 {
            let (needed_s, found_s) = ((2 * memory + 16) as f64 * step, n as f64 * step);
            return Err(WindowError::TooShort { file: run.file.clone(), needed_s, found_s });
        }
        let (mut q, mut v, mut lines) = (Vec::new(), Vec::new(), Vec::new());
        for (displacement, velocity, spectrum) in made {
            q.push(displacement);
            v.push(velocity);
            lines.push(spectrum);
        }
        Ok(Self { band, step, q, v, lines, padded, forces, usable: first..last, sensors, force_variance })
    }

    /// Energy of the kept modes at a sample, J: `sum (v^2 + omega^2 q^2) / 2`.
    pub(crate) fn energy(&self, n: usize) -> f64 {
        (0..self.q.len()).map(|r| self.mode_energy(r, n)).sum()
    }

    /// Energy of one mode at a sample, J.
    pub(crate) fn mode_energy(&self, r: usize, n: usize) -> f64 {
        0.5 * (self.v[r][n].powi(2) + (self.band.omega[r] * self.q[r][n]).powi(2))
    }

    /// Samples of a signal of these lines of the padded record.
    pub(crate) fn signal(&self, lines: Vec<c64>) -> Vec<f64> {
        in_time(&RealTransform::new(self.padded), lines, self.q[0].len())
    }
}

/// `W sum_s P_rs (i omega)^-k_s y_s` on every line.
fn modal_lines(
    band: &Band,
    measured: &[Vec<c64>],
    orders: &[i32],
    gains: &[f64],
    r: usize,
    resolution: f64,
) -> Vec<c64> {
    let mut lines = vec![c64::new(0.0, 0.0); gains.len()];
    for (s, (spectrum, &order)) in measured.iter().zip(orders).enumerate() {
        let weight = band.expansion[(r, s)];
        for (k, (line, z)) in lines.iter_mut().zip(spectrum).enumerate() {
            if gains[k] > 0.0 {
                *line += z * integrated(order, k as f64 * resolution) * (weight * gains[k]);
            }
        }
    }
    lines
}

/// `(i omega)^-k`: from a derivative of order `k` to the displacement.
fn integrated(order: i32, omega: f64) -> c64 {
    match order {
        0 => c64::new(1.0, 0.0),
        1 => c64::new(0.0, -1.0 / omega),
        _ => c64::new(-1.0 / (omega * omega), 0.0),
    }
}

/// The first `n` samples of the signal with these lines.
fn in_time(transform: &RealTransform, mut lines: Vec<c64>, n: usize) -> Vec<f64> {
    let padded = 2 * (lines.len() - 1);
    let mut signal = vec![0.0; padded];
    lines[0].im = 0.0;
    if let Some(last) = lines.last_mut() {
        last.im = 0.0;
    }
    transform.backward(&mut lines, &mut signal);
    signal.truncate(n);
    signal.iter_mut().for_each(|y| *y /= padded as f64);
    signal
}

/// An even length of small factors, at least `n`.
pub(crate) fn smooth_length(n: usize) -> usize {
    let mut best = n.next_power_of_two();
    for odd in [3, 5, 9, 15] {
        let mut length = 2 * odd;
        while length < n {
            length *= 2;
        }
        best = best.min(length);
    }
    best.max(32)
}

/// Whether the start is quiet beside the rest: the record begins before anything happens.
fn is_quiet_start(samples: &[f64]) -> bool {
    is_quiet(&samples[..(samples.len() / 200).max(8)], samples)
}

fn is_quiet(end: &[f64], all: &[f64]) -> bool {
    let most = all.iter().fold(0.0_f64, |most, y| most.max(y.abs()));
    let rms = (end.iter().map(|y| y * y).sum::<f64>() / end.len() as f64).sqrt();
    rms <= (QUIET * most).max(3.0 * difference_variance(all).sqrt().min(0.05 * most))
}

/// Variance of white noise on a channel: the median of its periodogram (Hann) above the modes that are kept, where no
/// resonance rises; over all lines where there is no room above.
fn noise_variance(run: &TransientRun, channel: usize, highest_hz: f64) -> f64 {
    let all = run.samples(channel);
    let part = &all[all.len() - all.len().min(NOISE_SAMPLES)..];
    let n = part.len();
    let mean = part.iter().sum::<f64>() / n as f64;
    let window = |k: usize| 0.5 - 0.5 * (TAU * k as f64 / n as f64).cos();
    let mut signal: Vec<f64> = part.iter().enumerate().map(|(k, y)| (y - mean) * window(k)).collect();
    if n % 2 == 1 {
        signal.pop();
    }
    let lines = RealTransform::new(signal.len()).forward(&mut signal);
    let rate = 1.0 / run.step();
    let hz = |k: usize| k as f64 * rate / n as f64;
    let above = |k: &usize| hz(*k) > 1.3 * highest_hz && hz(*k) < FLAT * rate;
    let mut powers: Vec<f64> = (1..lines.len()).filter(above).map(|k| lines[k].norm_sqr()).collect();
    if (powers.len() as f64) < NOISE_BAND * lines.len() as f64 {
        powers = (1..lines.len()).filter(|&k| hz(k) < FLAT * rate).map(|k| lines[k].norm_sqr()).collect();
    }
    let rounding = run.record.resolution(channel).powi(2) / 12.0;
    let median = crate::math::statistics::median(&powers);
    (median / (LN_2 * 0.375 * n as f64)).max(rounding)
}

/// Variance of white noise on a smooth signal: the quietest twentieth of its third differences.
fn difference_variance(samples: &[f64]) -> f64 {
    let differences: Vec<f64> = samples.windows(4).map(|w| w[3] - 3.0 * w[2] + 3.0 * w[1] - w[0]).collect();
    let block = (differences.len() / 20).max(4);
    let variance = |part: &[f64]| part.iter().map(|d| d * d).sum::<f64>() / (20.0 * part.len() as f64);
    let least = differences.chunks_exact(block).map(variance).fold(f64::INFINITY, f64::min);
    if least.is_finite() { least } else { 0.0 }
}
