//! Fourier transforms of real signals.

use faer::c64;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use std::fmt;
use std::sync::Arc;

/// Both transforms of `n` real samples, neither scaled: to `n / 2 + 1` complex lines and back.
#[derive(Clone)]
pub struct RealTransform {
    samples: usize,
    forward: Arc<dyn RealToComplex<f64>>,
    backward: Arc<dyn ComplexToReal<f64>>,
}

impl fmt::Debug for RealTransform {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "RealTransform of {} samples", self.samples)
    }
}

impl RealTransform {
    /// Plans the transforms of `samples` samples.
    pub fn new(samples: usize) -> Self {
        let mut planner = RealFftPlanner::new();
        let (forward, backward) = (planner.plan_fft_forward(samples), planner.plan_fft_inverse(samples));
        Self { samples, forward, backward }
    }

    /// `sum_n y_n exp(-2 pi i k n / N)` for k = 0 to N / 2. Spoils `signal`, which must have the planned length.
    pub fn forward(&self, signal: &mut [f64]) -> Vec<c64> {
        let mut lines = vec![c64::new(0.0, 0.0); self.samples / 2 + 1];
        let done = self.forward.process(signal, &mut lines);
        debug_assert!(done.is_ok(), "the signal has the planned length");
        lines
    }

    /// Samples of the signal with these lines, N times what [`Self::forward`] would take. Spoils `lines`.
    pub fn backward(&self, lines: &mut [c64], signal: &mut [f64]) {
        let done = self.backward.process(lines, signal);
        debug_assert!(done.is_ok(), "lines and signal have the planned lengths");
    }
}
