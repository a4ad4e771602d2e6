//! The spectrum of a record that is not periodic, exactly: its Fourier integral over `[0, T]` on the lines `w_k = 2 pi k / T`.
//!
//! ```text
//! Y(w) = int_0^T y e^(-i w t) dt = trapezoids - h^2/12 [f'] + h^4/720 [f'''],    f = y e^(-i w t)
//! ```
//!
//! (Euler and Maclaurin), with the derivatives of `y` at both ends by polynomials through six samples. No window, no leakage:
//! what does not close over the record enters the equations by its end differences (see `super::localisation`).

use dashpot_numerics::RealTransform;
use faer::c64;
use std::f64::consts::TAU;

/// One-sided differences of six samples for the first three derivatives, times the step to that power.
const DIFFERENCES: [[f64; 6]; 3] = [
    [-137.0 / 60.0, 5.0, -5.0, 10.0 / 3.0, -1.25, 0.2],
    [3.75, -77.0 / 6.0, 107.0 / 6.0, -13.0, 61.0 / 12.0, -5.0 / 6.0],
    [-4.25, 17.75, -29.5, 24.5, -10.25, 1.75],
];

/// The Fourier integral of a signal on lines 0 to `N / 2`.
pub fn fourier_integral(signal: &[f64], step: f64) -> Vec<c64> {
    let count = signal.len() - 1;
    let mut closed = signal[..count].to_vec();
    closed[0] = 0.5 * (signal[0] + signal[count]);
    let mut lines = RealTransform::new(count).forward(&mut closed);
    let jump = |order: usize| -> f64 {
        let mirrored = if order == 2 { 1.0 } else { -1.0 };
        let end_difference = |j: usize| DIFFERENCES[order - 1][j] * (mirrored * signal[count - j] - signal[j]);
        (0..6.min(signal.len())).map(end_difference).sum::<f64>() / step.powi(order as i32)
    };
    let ends = [signal[count] - signal[0], jump(1), jump(2), jump(3)];
    for (k, line) in lines.iter_mut().enumerate() {
        let w = TAU * k as f64 / (count as f64 * step);
        let i = c64::new(0.0, 1.0);
        let first = ends[1] - i * w * ends[0];
        let third = ends[3] - i * 3.0 * w * ends[2] - 3.0 * w * w * ends[1] + i * w.powi(3) * ends[0];
        *line = *line * step - first * (step * step / 12.0) + third * (step.powi(4) / 720.0);
    }
    lines
}
