//! A damping ratio that was measured by itself: from the width of a peak, a circle, a decay, or somebody else's report.

/// A damping ratio of one mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredRatio {
    /// Circular frequency of the mode, rad/s.
    pub omega: f64,
    /// Damping ratio.
    pub ratio: f64,
    /// Its standard deviation; 0 where it is exact.
    pub deviation: f64,
}
