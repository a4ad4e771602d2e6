//! An axis of a plot: what it shows, its unit, how values lie along it.

use crate::display::{units, words};
use std::sync::Arc;

/// How values lie along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    Linear,
    /// By their logarithm; values that are not positive are left out.
    Log,
}

/// Where an axis has lines.
#[derive(Debug, Clone, PartialEq)]
pub enum Ticks {
    /// Round numbers, or decades.
    Auto,
    /// Decades with 2 and 5 between, as frequencies are read; round numbers where the range is short.
    OneTwoFive,
    /// Whole numbers.
    Whole,
    /// Multiples of 90.
    RightAngles,
    /// Names at 0, 1, 2, ...
    Names(Arc<[String]>),
}

/// An axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// What it shows.
    pub name: String,
    /// Unit as it is shown; empty for a pure number.
    pub unit: String,
    /// How values lie.
    pub scale: Scale,
    /// Where lines stand.
    pub ticks: Ticks,
    /// Values that are always in sight.
    pub include: Vec<f64>,
    /// What the values of the series are multiplied by to be in the unit.
    pub factor: f64,
}

impl Axis {
    /// A linear axis.
    pub fn new(name: &str, unit: &str) -> Self {
        let (name, unit, include) = (name.into(), unit.into(), Vec::new());
        Self { name, unit, scale: Scale::Linear, ticks: Ticks::Auto, include, factor: 1.0 }
    }

    /// A logarithmic axis.
    pub fn log(name: &str, unit: &str) -> Self {
        Self { scale: Scale::Log, ..Self::new(name, unit) }
    }

    /// From a quantity and its unit in one text: `Force, N`.
    pub fn of(text: &str) -> Self {
        let (name, unit) = text.split_once(", ").unwrap_or((text, ""));
        Self::new(name, unit)
    }

    /// Of amplitudes of sines: its name says that they are peak values.
    #[must_use]
    pub fn peak(mut self) -> Self {
        self.name = words::peak(&self.name);
        self
    }

    /// In the units that are shown on the screen.
    #[must_use]
    pub(super) fn displayed(mut self) -> Self {
        let (factor, unit) = units::shown(&self.unit);
        (self.factor, self.unit) = (self.factor * factor, unit);
        self
    }

    /// With lines elsewhere.
    #[must_use]
    pub fn ticks(mut self, ticks: Ticks) -> Self {
        self.ticks = ticks;
        self
    }

    /// With values that are always in sight.
    #[must_use]
    pub fn include(mut self, values: &[f64]) -> Self {
        self.include.extend(values);
        self
    }

    /// Name and unit: `Force, N`.
    pub fn label(&self) -> String {
        if self.unit.is_empty() { self.name.clone() } else { format!("{}, {}", self.name, self.unit) }
    }

    /// Where a value lies along the axis; `None` for what has no place on it.
    pub fn place(&self, value: f64) -> Option<f64> {
        let value = self.factor * value;
        match self.scale {
            Scale::Linear => value.is_finite().then_some(value),
            Scale::Log => (value > 0.0 && value.is_finite()).then(|| value.log10()),
        }
    }

    /// The value of the series at a place.
    pub fn value(&self, place: f64) -> f64 {
        self.read(place) / self.factor
    }

    /// What is read at a place, in the unit of the axis.
    pub fn read(&self, place: f64) -> f64 {
        match self.scale {
            Scale::Linear => place,
            Scale::Log => 10f64.powf(place),
        }
    }
}
