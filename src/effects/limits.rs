//! Special cases: parameters at which a law is a simpler one, and which laws contain which.

use super::range::Range;
use super::{Effect, Source};

/// Relative distance from a limit within which a law is taken for the simpler one there.
pub const CLOSE: f64 = 0.03;

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
pub fn alike(a: f64, b: f64) -> bool {
    (a - b).abs() < CLOSE * a.abs().max(b.abs())
}

/// Whether a pure number is within [`CLOSE`] of `value`.
pub fn near(p: f64, value: f64) -> bool {
    (p - value).abs() < CLOSE
}

impl Effect {
    /// Simpler laws that this one contains as limits of its parameters.
    pub fn limits(self) -> impl Iterator<Item = Self> {
        self.description().limits.iter().map(|limit| limit.law)
    }

    /// Whether `simple` is a limit of this law.
    pub fn contains(self, simple: Self) -> bool {
        self.limits().any(|limit| limit == simple)
    }

    /// Laws of several parameters that this one may have been taken for: those that contain it or one of its limits, and
    /// itself if it has several parameters.
    pub fn wider(self) -> Vec<Self> {
        let common = |other: Self| other.limits().any(|limit| limit == self || self.contains(limit));
        let kept = |&other: &Self| other.parameters().len() > 1 && (other == self || common(other));
        Self::ALL.into_iter().filter(kept).collect()
    }
}

impl Source {
    /// The simpler law at this place that the source is all but on motions of this range ([`Range::UNKNOWN`]: on any
    /// motion); none if it is no such.
    pub fn simpler(&self, range: &Range) -> Option<Self> {
        let limit = self.effect.description().limits.iter().find(|limit| (limit.holds)(&self.parameters, range))?;
        Some(Self { effect: limit.law, parameters: (limit.parameters)(&self.parameters), ..self.clone() })
    }

    /// The simpler laws at this place that the law contains, with the parameters that this source has of them.
    pub fn limits(&self) -> impl Iterator<Item = Self> {
        let limits = self.effect.description().limits.iter();
        limits.map(|limit| Self { effect: limit.law, parameters: (limit.parameters)(&self.parameters), ..self.clone() })
    }

    /// Whether the source is a simpler law by another name that is looked at beside it anyway: a force that knows no
    /// speed, or friction that does not fall from rest to sliding.
    pub fn is_disguised(&self) -> bool {
        (self.effect.description().disguised)(&self.parameters)
    }
}
