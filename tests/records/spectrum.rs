//! The Fourier integral of a record that is not periodic against its closed form.

use dashpot::diagnosis::records::spectrum::fourier_integral;
use faer::c64;
use std::f64::consts::TAU;

#[test]
fn a_decay_has_its_integral() {
    let (rate, omega, step, count) = (0.7, 9.0, 0.01, 700);
    let pole = c64::new(-rate, omega);
    let signal: Vec<f64> = (0..count).map(|n| (pole * (step * f64::from(n))).exp().re).collect();
    let lines = fourier_integral(&signal, step);
    let length = step * f64::from(count - 1);
    for (k, line) in lines.iter().enumerate().take(60) {
        let w = c64::new(0.0, TAU * k as f64 / length);
        let part = |p: c64| ((p * length).exp() - 1.0) / (p - w);
        let exact = 0.5 * (part(pole) + part(pole.conj()));
        assert!((line - exact).norm() < 1e-6, "line {k}: {line} against {exact}");
    }
}
