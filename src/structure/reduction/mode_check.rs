//! How well a reduced model keeps one mode of the whole.

/// One mode in the band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModeCheck {
    /// Frequency of the whole model, Hz.
    pub full_hz: f64,
    /// Frequency of the reduced model, Hz.
    pub reduced_hz: f64,
    /// Modal assurance criterion of the two shapes at the kept degrees of freedom.
    pub mac: f64,
}

impl ModeCheck {
    /// Reduced over whole, less 1; 0 for a rigid mode.
    pub fn frequency_error(&self) -> f64 {
        if self.full_hz > 0.0 { self.reduced_hz / self.full_hz - 1.0 } else { 0.0 }
    }
}
