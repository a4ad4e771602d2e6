//! Instantaneous frequency and damping ratio against amplitude, by a decaying sinusoid fitted to a sliding window.
//!
//! ```text
//! y(t) = e^(-delta t) (a cos theta + b sin theta) + harmonics 2, 3 of theta + c_0 + c_1 t,    theta = omega t + r t^2 / 2
//! A = sqrt(a^2 + b^2),   f = omega / 2 pi,   zeta = -(dA/dt) / (omega A) = delta / omega
//! ```
//!
//! with `t` from the middle of the window, by Gauss and Newton; the covariance follows from what the fit leaves. Slopes of
//! `ln zeta` over `ln A`: dry friction -1, viscous 0, `|v|^(p-1)`: p - 1 (drag 1), microslip `chi + 1`; the square of the
//! frequency is linear in `A^2` for a cubic spring. The same estimator reads the model's record: its bias cancels.

use crate::math::least_squares::LeastSquares;
use crate::math::spectrum::Spectrum;
use crate::math::statistics::mean;
use crate::math::zero_phase::{Extension, filtered};
use dashpot_numerics::{EquilibratedCholesky, dot};
use faer::Mat;
use std::f64::consts::TAU;

/// Periods in a window.
const PERIODS: f64 = 4.0;
/// Iterations of a window.
const ITERATIONS: usize = 30;
/// Columns of the linear part: a, b, c_0, c_1 and two harmonics; of the fit: delta, omega and r besides.
const LINEAR: usize = 8;
const COLUMNS: usize = LINEAR + 3;

/// One window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AmplitudePoint {
    /// Middle of the window, s.
    pub time_s: f64,
    /// Amplitude there, in the unit of the signal.
    pub amplitude: f64,
    /// Instantaneous frequency, Hz.
    pub frequency_hz: f64,
    /// Damping ratio.
    pub damping_ratio: f64,
    /// Standard deviation of the amplitude.
    pub amplitude_deviation: f64,
    /// Standard deviation of the frequency, Hz.
    pub frequency_deviation_hz: f64,
    /// Standard deviation of the damping ratio.
    pub damping_deviation: f64,
}

/// Two coefficients of a straight line `y = offset + slope x` with their standard deviations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Value at zero.
    pub offset: f64,
    /// Slope.
    pub slope: f64,
    /// Standard deviations of both.
    pub deviations: [f64; 2],
}

/// The mode of a signal whose curve is wanted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// Frequency near which it lies, Hz.
    pub frequency_hz: f64,
    /// Share of the frequency that belongs to it on either side; 0 leaves the signal as it is.
    pub width: f64,
}

/// The amplitude curve of a signal at equal steps (s); `first_s` is the time of the first sample. Windows in which no decaying
/// sinusoid stands above the rest are left out.
pub fn amplitude_curve(signal: &[f64], step: f64, first_s: f64, band: Band) -> Vec<AmplitudePoint> {
    let filtered;
    let signal = if band.width > 0.0 {
        filtered = band_pass(signal, step, band);
        &filtered
    } else {
        signal
    };
    let length = (PERIODS / (band.frequency_hz * step)).round() as usize;
    let mut points = Vec::new();
    if length < 2 * COLUMNS || signal.len() < length {
        return points;
    }
    let mut omega = TAU * band.frequency_hz;
    let margin = if band.width > 0.0 { length / 2 } else { 0 };
    let mut begin = margin;
    while begin + length + margin <= signal.len() {
        let window = &signal[begin..begin + length];
        let middle = (begin as f64 + 0.5 * (length - 1) as f64) * step;
        if let Some(point) = fit(window, step, omega, first_s + middle) {
            let near = (point.frequency_hz / band.frequency_hz).ln().abs() < 0.5;
            if near && point.amplitude > 4.0 * point.amplitude_deviation {
                omega = TAU * point.frequency_hz;
                points.push(point);
            }
        }
        begin += (length / 2).max(1);
    }
    points
}

/// Frequencies (Hz) at which a signal has a mode: peaks of its spectrum above a share of the highest, at most `most`.
pub fn peaks(signal: &[f64], step: f64, share: f64, most: usize) -> Vec<f64> {
    let mean = signal.iter().sum::<f64>() / signal.len().max(1) as f64;
    let centred: Vec<f64> = signal.iter().map(|y| y - mean).collect();
    let Some(spectrum) = Spectrum::new(&centred, step) else { return Vec::new() };
    let mut peaks = spectrum.peaks(share);
    peaks.sort_by(|a, b| b.amplitude.total_cmp(&a.amplitude));
    let mut found: Vec<f64> = Vec::new();
    for peak in peaks {
        let apart = found.iter().all(|f| (peak.frequency_hz / f).ln().abs() > 0.15);
        if apart && peak.frequency_hz * step < 0.25 && found.len() < most {
            found.push(peak.frequency_hz);
        }
    }
    found
}

/// Weighted straight line through points `[x, y, deviation of y]`; the scatter about it counts where it is greater.
pub fn line(points: &[[f64; 3]]) -> Option<Line> {
    if points.len() < 3 {
        return None;
    }
    let floor = points.iter().map(|p| p[2]).fold(0.0, f64::max) * 0.1;
    let weight = |p: &[f64; 3]| 1.0 / p[2].hypot(floor).max(1e-300);
    let a = Mat::from_fn(points.len(), 2, |i, j| weight(&points[i]) * if j == 0 { 1.0 } else { points[i][0] });
    let b: Vec<f64> = points.iter().map(|p| weight(p) * p[1]).collect();
    let fit = LeastSquares::new(a.as_ref()).ok()?;
    let solution = fit.solve(&b).ok()?;
    let left = (0..points.len()).map(|i| b[i] - a[(i, 0)] * solution.x[0] - a[(i, 1)] * solution.x[1]);
    let variance = left.map(|r| r * r).sum::<f64>() / (points.len() - 2) as f64;
    let deviations = fit.standard_deviations(variance.max(1.0));
    Some(Line { offset: solution.x[0], slope: solution.x[1], deviations: [deviations[0], deviations[1]] })
}

/// Keeps the lines about a frequency, with smooth edges.
fn band_pass(signal: &[f64], step: f64, band: Band) -> Vec<f64> {
    let mean = mean(signal);
    let about_mean: Vec<f64> = signal.iter().map(|y| y - mean).collect();
    let gain = |hz: f64| {
        let off = (hz / band.frequency_hz - 1.0).abs() / band.width;
        if off < 0.5 { 1.0 } else { 0.5 + 0.5 * (std::f64::consts::PI * (2.0 * off - 1.0).min(1.0)).cos() }
    };
    filtered(&about_mean, step, Extension::Periodic, gain)
}

/// One window.
fn fit(window: &[f64], step: f64, omega: f64, time_s: f64) -> Option<AmplitudePoint> {
    let half = 0.5 * (window.len() - 1) as f64 * step;
    // Scaled by the half window: delta, omega and r / 2 in radians over it.
    let time: Vec<f64> = (0..window.len()).map(|n| (n as f64 * step - half) / half).collect();
    let mut shape = [0.0, omega * half, 0.0];
    let mut last = f64::INFINITY;
    for _ in 0..ITERATIONS {
        let mut columns = linear_columns(&time, &shape);
        let x = normal_equations(&columns)?.solve(&products(&columns, window));
        let left: Vec<f64> =
            (0..window.len()).map(|n| window[n] - (0..LINEAR).map(|j| columns[j][n] * x[j]).sum::<f64>()).collect();
        let square = dot(&left, &left);
        let derivatives = derivatives(&time, &columns, [x[0], x[1]]);
        columns.extend(derivatives);
        let equations = normal_equations(&columns)?;
        let change = equations.solve(&products(&columns, &left));
        let small = (LINEAR..COLUMNS).all(|j| change[j].abs() < 1e-9);
        if small || (square <= last && last - square < 1e-14 * square) {
            let noise = (square / (window.len() - COLUMNS) as f64).sqrt();
            let d: Vec<f64> = equations.deviations().into_iter().map(|d| d * noise).collect();
            let (rate, w) = (shape[0] / half, shape[1] / half);
            let zeta = rate / w;
            let [by_rate, by_w] = [d[LINEAR] / half, d[LINEAR + 1] / half];
            return Some(AmplitudePoint {
                time_s,
                amplitude: x[0].hypot(x[1]),
                frequency_hz: w / TAU,
                damping_ratio: zeta,
                amplitude_deviation: d[0].hypot(d[1]) / std::f64::consts::SQRT_2,
                frequency_deviation_hz: by_w / TAU,
                damping_deviation: (by_rate / w).hypot(zeta * by_w / w),
            });
        }
        last = square;
        shape.iter_mut().zip(&change[LINEAR..]).for_each(|(s, c)| *s += c.clamp(-0.5, 0.5));
        if shape[1] <= 0.0 || !shape.iter().all(|x| x.is_finite()) {
            return None;
        }
    }
    None
}

/// Columns of the linear part at a shape: the sinusoid, a straight line, two harmonics.
fn linear_columns(time: &[f64], shape: &[f64; 3]) -> Vec<Vec<f64>> {
    let mut columns: Vec<Vec<f64>> = (0..LINEAR).map(|_| Vec::with_capacity(time.len())).collect();
    for &t in time {
        let decay = (-shape[0] * t).exp();
        let (sin, cos) = (shape[1] * t + shape[2] * t * t).sin_cos();
        let (cos_2, sin_2) = (2.0 * cos * cos - 1.0, 2.0 * sin * cos);
        let (cos_3, sin_3) = (cos_2 * cos - sin_2 * sin, sin_2 * cos + cos_2 * sin);
        let row = [decay * cos, decay * sin, 1.0, t, cos_2, sin_2, cos_3, sin_3];
        columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
    }
    columns
}

/// Derivatives of the sinusoid `a cos + b sin` of the first two columns by `delta`, `omega` and `r / 2`.
fn derivatives(time: &[f64], columns: &[Vec<f64>], [a, b]: [f64; 2]) -> [Vec<f64>; 3] {
    let along = |n: usize, u: f64, v: f64| u * columns[0][n] + v * columns[1][n];
    let by = |f: &dyn Fn(usize) -> f64| (0..time.len()).map(f).collect();
    [
        by(&|n| -time[n] * along(n, a, b)),
        by(&|n| time[n] * along(n, b, -a)),
        by(&|n| time[n] * time[n] * along(n, b, -a)),
    ]
}

/// Normal equations of columns: sinusoids over some periods are far from alike.
fn normal_equations(columns: &[Vec<f64>]) -> Option<EquilibratedCholesky> {
    let matrix = Mat::from_fn(columns.len(), columns.len(), |i, j| dot(&columns[i], &columns[j]));
    EquilibratedCholesky::new(matrix.as_ref(), 0.0)
}

/// Products of columns with a signal.
fn products(columns: &[Vec<f64>], signal: &[f64]) -> Vec<f64> {
    columns.iter().map(|column| dot(column, signal)).collect()
}
