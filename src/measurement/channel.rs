//! A measuring channel: what it measures, where, and in which unit its file gives it.

use serde::{Deserialize, Serialize};
use std::fmt;

/// Standard acceleration of gravity, m/s^2.
pub(crate) const STANDARD_GRAVITY: f64 = 9.806_65;

/// Newtons in a pound-force.
pub(crate) const POUND_FORCE: f64 = 4.448_221_615_260_5;

/// What a channel measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Quantity {
    Force,
    Acceleration,
    Velocity,
    Displacement,
    /// Acceleration of the base that the structure stands on.
    Base,
}

impl Quantity {
    /// Word in channel names.
    pub fn word(self) -> &'static str {
        match self {
            Self::Force => "force",
            Self::Acceleration => "acc",
            Self::Velocity => "vel",
            Self::Displacement => "disp",
            Self::Base => "base",
        }
    }

    /// The quantity of that word.
    pub fn from_word(word: &str) -> Option<Self> {
        let all = [Self::Force, Self::Acceleration, Self::Velocity, Self::Displacement, Self::Base];
        all.into_iter().find(|q| q.word() == word)
    }

    /// Name of its SI unit in files; a force on a rotation is a moment.
    pub fn si_unit(self, rotation: bool) -> &'static str {
        match (self, rotation) {
            (Self::Force, false) => "N",
            (Self::Force, true) => "N m",
            (Self::Acceleration, false) | (Self::Base, _) => "m/s^2",
            (Self::Acceleration, true) => "rad/s^2",
            (Self::Velocity, false) => "m/s",
            (Self::Velocity, true) => "rad/s",
            (Self::Displacement, false) => "m",
            (Self::Displacement, true) => "rad",
        }
    }

    /// How many times the displacement is differentiated to give this quantity; `None` for a force.
    pub fn derivatives(self) -> Option<i32> {
        match self {
            Self::Force => None,
            Self::Displacement => Some(0),
            Self::Velocity => Some(1),
            Self::Acceleration | Self::Base => Some(2),
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

/// Every unit that files may use.
pub(crate) const UNITS: [Unit; 14] = [
    unit("N", 1.0, Quantity::Force, false),
    unit("kN", 1e3, Quantity::Force, false),
    unit("lbf", POUND_FORCE, Quantity::Force, false),
    unit("N m", 1.0, Quantity::Force, true),
    unit("m/s^2", 1.0, Quantity::Acceleration, false),
    unit("g", STANDARD_GRAVITY, Quantity::Acceleration, false),
    unit("rad/s^2", 1.0, Quantity::Acceleration, true),
    unit("m/s", 1.0, Quantity::Velocity, false),
    unit("mm/s", 1e-3, Quantity::Velocity, false),
    unit("rad/s", 1.0, Quantity::Velocity, true),
    unit("m", 1.0, Quantity::Displacement, false),
    unit("mm", 1e-3, Quantity::Displacement, false),
    unit("um", 1e-6, Quantity::Displacement, false),
    unit("rad", 1.0, Quantity::Displacement, true),
];

const fn unit(name: &'static str, to_si: f64, quantity: Quantity, rotation: bool) -> Unit {
    Unit { name, to_si, quantity, rotation }
}

impl Unit {
    /// The unit of that name; other spellings of powers, micro and moments are understood.
    pub fn from_name(name: &str) -> Option<&'static Self> {
        let plain = match name.trim() {
            "m/s2" | "m/s²" | "m/s**2" => "m/s^2",
            "rad/s2" | "rad/s²" | "rad/s**2" => "rad/s^2",
            "µm" | "μm" => "um",
            "Nm" | "N*m" | "N·m" => "N m",
            other => other,
        };
        UNITS.iter().find(|unit| unit.name == plain)
    }

    /// Whether a DOF of that kind can be measured in it. `N` at a rotation is read as N m, the only unit of a force
    /// that the format names.
    pub fn suits(&self, rotation: bool) -> bool {
        self.rotation == rotation || self.name == "N"
    }

    /// Names of the units of a quantity, separated by commas.
    pub fn names_of(quantity: Quantity) -> String {
        if quantity == Quantity::Base {
            return "m/s^2, g".to_owned();
        }
        let names: Vec<&str> = UNITS.iter().filter(|unit| unit.quantity == quantity).map(|unit| unit.name).collect();
        names.join(", ")
    }
}

/// A channel's name in a file, such as `acc@7 [m/s^2]`.
#[derive(Debug, Clone, PartialEq)]
pub struct ChannelName {
    /// What it measures.
    pub quantity: Quantity,
    /// Label of the DOF it is at.
    pub label: String,
    /// Unit of its numbers.
    pub unit: &'static Unit,
}

/// What is wrong with a channel's name.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ChannelError {
    #[error("\"{text}\" is not a channel; write QUANTITY@DOF [UNIT], such as acc@7 [m/s^2]")]
    NotAChannel { text: String },
    #[error("\"{word}\" is not a quantity; use force, acc, vel, disp or base")]
    UnknownQuantity { word: String },
    #[error("\"{text}\" names no DOF; write its label after the @, such as {quantity}@7")]
    NoLabel { text: String, quantity: &'static str },
    #[error("\"{text}\" has no unit; add one in brackets: {units}")]
    NoUnit { text: String, units: String },
    #[error("\"{unit}\" is not a unit; those of {quantity} are {units}")]
    UnknownUnit { unit: String, quantity: &'static str, units: String },
    #[error("{unit} is not a unit of {quantity}; those are {units}")]
    WrongUnit { unit: &'static str, quantity: &'static str, units: String },
}

impl ChannelName {
    /// Reads `QUANTITY@DOF [UNIT]`. Spaces and the case of QUANTITY do not matter.
    pub fn parse(text: &str) -> Result<Self, ChannelError> {
        let text = text.trim();
        let bracket = text.ends_with(']').then(|| text.rfind('[')).flatten();
        let (name, unit_name) = match bracket {
            Some(at) => (&text[..at], Some(text[at + 1..text.len() - 1].trim())),
            None => (text, None),
        };
        let (quantity, label) = parse_name(name)?;
        let units = Unit::names_of(quantity);
        let Some(unit_name) = unit_name else { return Err(ChannelError::NoUnit { text: text.to_owned(), units }) };
        let Some(unit) = Unit::from_name(unit_name) else {
            return Err(ChannelError::UnknownUnit { unit: unit_name.to_owned(), quantity: quantity.word(), units });
        };
        let measured = if quantity == Quantity::Base { Quantity::Acceleration } else { quantity };
        if unit.quantity != measured || (quantity == Quantity::Base && unit.rotation) {
            return Err(ChannelError::WrongUnit { unit: unit.name, quantity: quantity.word(), units });
        }
        Ok(Self { quantity, label, unit })
    }
}

/// Reads `QUANTITY@DOF`, the name of a channel without its unit.
pub(crate) fn parse_name(text: &str) -> Result<(Quantity, String), ChannelError> {
    let text = text.trim();
    let (word, label) = text.split_once('@').ok_or_else(|| ChannelError::NotAChannel { text: text.to_owned() })?;
    let quantity = Quantity::from_word(&word.trim().to_lowercase())
        .ok_or_else(|| ChannelError::UnknownQuantity { word: word.trim().to_owned() })?;
    let label = label.trim();
    if label.is_empty() {
        return Err(ChannelError::NoLabel { text: text.to_owned(), quantity: quantity.word() });
    }
    Ok((quantity, label.to_owned()))
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn names_are_read_with_their_units() {
        let name = ChannelName::parse(" Acc @ 7 [ g ] ").unwrap();
        assert_eq!((name.quantity, name.label.as_str(), name.unit.to_si), (Quantity::Acceleration, "7", 9.806_65));
        let odd = ChannelName::parse("disp@wing [tip] [µm]").unwrap();
        assert_eq!((odd.label.as_str(), odd.unit.name), ("wing [tip]", "um"));
    }

    #[test]
    fn every_unit_is_understood_by_its_own_quantity_only() {
        for unit in &UNITS {
            for quantity in [Quantity::Force, Quantity::Acceleration, Quantity::Velocity, Quantity::Displacement] {
                let text = format!("{}@1 [{}]", quantity.word(), unit.name);
                assert_eq!(ChannelName::parse(&text).is_ok(), unit.quantity == quantity, "{text}");
            }
        }
    }

    #[test]
    fn bad_names_say_what_is_wrong() {
        let message = |text: &str| ChannelName::parse(text).unwrap_err().to_string();
        assert_eq!(message("pressure@3 [Pa]"), "\"pressure\" is not a quantity; use force, acc, vel, disp or base");
        assert_eq!(message("acc@7"), "\"acc@7\" has no unit; add one in brackets: m/s^2, g, rad/s^2");
        assert_eq!(message("acc@7 [mm/s]"), "mm/s is not a unit of acc; those are m/s^2, g, rad/s^2");
        assert_eq!(message("acc@ [g]"), "\"acc@\" names no DOF; write its label after the @, such as acc@7");
    }
}
