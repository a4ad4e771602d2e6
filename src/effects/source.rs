//! A source: a law at a place, what is known of it, and whether it may be selected.

use super::{Effect, Place};
use serde::{Deserialize, Serialize};

/// What identification may do with a source.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum State {
    /// In the model at its value.
    Known,
    /// May be selected.
    Candidate,
    /// Always selected, its value identified.
    Forced,
    /// Ignored.
    Off,
    /// Never used, only shown beside the result (a known truth).
    Reference,
}

/// A law at a place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Source {
    /// The law.
    pub effect: Effect,
    /// Where it acts.
    pub place: Place,
    /// What identification may do with it.
    pub state: State,
    /// Values in the order of [`Effect::parameters`]; a candidate's linear coefficient is 1.
    pub parameters: Vec<f64>,
}

impl Source {
    /// A candidate of unit coefficient, its other parameters at their typical values.
    pub fn candidate(effect: Effect, place: Place) -> Self {
        let parameters = effect.parameters().iter().map(|p| p.typical).collect();
        Self { effect, place, state: State::Candidate, parameters }
    }

    /// A source in the model at its values.
    pub fn known(effect: Effect, place: Place, parameters: &[f64]) -> Self {
        Self { effect, place, state: State::Known, parameters: parameters.to_vec() }
    }

    /// The linear coefficient; 0 for a law that has none.
    pub fn coefficient(&self) -> f64 {
        self.effect.coefficient().map_or(0.0, |k| self.parameters[k])
    }

    /// The same source with another value of its linear coefficient.
    pub fn with_coefficient(&self, value: f64) -> Self {
        let mut source = self.clone();
        if let Some(k) = self.effect.coefficient() {
            source.parameters[k] = value;
        }
        source
    }
}
