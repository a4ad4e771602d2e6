//! A measuring channel: what it measures, where, and in which unit its file gives it.

use serde::{Deserialize, Serialize};
use std::fmt;

/// What a channel measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Quantity {
    Force,
    Acceleration,
    Velocity,
    Displacement,
}

impl Quantity {
    /// Word in channel names.
    pub fn word(self) -> &'static str {
        match self {
            Self::Force => "force",
            Self::Acceleration => "acc",
            Self::Velocity => "vel",
            Self::Displacement => "disp",
        }
    }

    /// The quantity of that word.
    pub fn from_word(word: &str) -> Option<Self> {
        [Self::Force, Self::Acceleration, Self::Velocity, Self::Displacement].into_iter().find(|q| q.word() == word)
    }

    /// How many times the displacement is differentiated to give this quantity; `None` for a force.
    pub fn derivatives(self) -> Option<i32> {
        match self {
            Self::Force => None,
            Self::Displacement => Some(0),
            Self::Velocity => Some(1),
            Self::Acceleration => Some(2),
        }
    }
}

/// A unit of a file and what it is in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// Name in files.
    pub name: &'static str,
    /// Factor from this unit to SI.
    pub to_si: f64,
    /// Quantity that is measured in it.
    pub quantity: Quantity,
    /// Whether it is a unit of rotation.
    pub rotation: bool,
}

/// A measuring channel.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Channel {
    /// What it measures.
    pub quantity: Quantity,
    /// Row of the DOF it is at.
    pub dof: usize,
    /// Label of that DOF.
    pub label: String,
}

impl fmt::Display for Channel {
    /// Writes the channel's name in files without its unit, such as `acc@7`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}@{}", self.quantity.word(), self.label)
    }
}
