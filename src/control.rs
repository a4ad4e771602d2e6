//! Progress and cancellation of a long computation, passed down to every function that may take more than a frame.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

/// The computation was asked to stop and did.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

/// A handle shared by whoever waits and whoever works. Cloning shares the same state.
#[derive(Debug, Clone, Default)]
pub struct Control {
    cancelled: Arc<AtomicBool>,
    parts_per_million: Arc<AtomicU32>,
}

impl Control {
    /// A control that nobody watches and nobody cancels.
    pub fn unattended() -> Self {
        Self::default()
    }

    /// States the share of the work that is done, 0 to 1.
    pub fn report(&self, fraction: f64) {
        let ppm = (fraction.clamp(0.0, 1.0) * 1e6) as u32;
        self.parts_per_million.store(ppm, Ordering::Relaxed);
    }

    /// The share of the work that is done, 0 to 1.
    pub fn progress(&self) -> f64 {
        f64::from(self.parts_per_million.load(Ordering::Relaxed)) * 1e-6
    }

    /// Asks the computation to stop at its next check.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// Fails with [`Cancelled`] once [`Control::cancel`] was called; call it in every outer loop.
    pub fn check(&self) -> Result<(), Cancelled> {
        if self.cancelled.load(Ordering::Relaxed) { Err(Cancelled) } else { Ok(()) }
    }
}
