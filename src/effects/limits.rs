//! Special cases: parameters at which a law is a simpler one.

use super::effect::Effect;
use super::range::Range;

/// Relative distance from a limit within which a law is taken for the simpler one there.
pub(crate) const CLOSE: f64 = 0.03;

/// A simpler law that a law becomes where its parameters tend to an end of their range.
#[derive(Debug, Clone, Copy)]
pub struct Limit {
    /// The simpler law.
    pub law: Effect,
    /// Whether the parameters are so near to the limit that on motions of this range the two are the same.
    pub holds: fn(&[f64], &Range) -> bool,
    /// The simpler law's parameters.
    pub parameters: fn(&[f64]) -> Vec<f64>,
}

/// Whether two values of one unit are the same within [`CLOSE`] of the larger.
pub(crate) fn alike(a: f64, b: f64) -> bool {
    (a - b).abs() < CLOSE * a.abs().max(b.abs())
}

/// Whether a pure number is within [`CLOSE`] of `value`.
pub(crate) fn near(p: f64, value: f64) -> bool {
    (p - value).abs() < CLOSE
}
