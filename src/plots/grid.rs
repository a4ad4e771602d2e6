//! Lines of a grid and round steps between them.

/// What of an axis is in sight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridInput {
    /// First and last place.
    pub bounds: (f64, f64),
    /// Length that stands for eight points.
    pub base_step_size: f64,
}

/// A line of the grid: its place, and the step that it belongs to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridMark {
    /// Place along the axis.
    pub value: f64,
    /// Step of the lines that it is one of; lines of long steps stand out.
    pub step_size: f64,
}

/// A step of 1, 2 or 5 times a power of ten that divides `span` into about `parts`.
pub(crate) fn round_step(span: f64, parts: f64) -> f64 {
    let raw = span / parts;
    let power = 10f64.powf(raw.log10().floor());
    let lead = raw / power;
    power
        * if lead < 1.5 {
            1.0
        } else if lead < 3.5 {
            2.0
        } else if lead < 7.5 {
            5.0
        } else {
            10.0
        }
}
