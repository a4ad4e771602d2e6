//! Forms and units of frequency responses: what a number in the file is in SI.

use crate::measurement::Quantity;
use crate::measurement::channel::Unit;
use serde::Serialize;

/// What a function relates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Form {
    /// Displacement over force, m/N.
    Receptance,
    /// Velocity over force, m/(N s).
    Mobility,
    /// Acceleration over force, m/(N s^2).
    Accelerance,
    /// Force over displacement at the same DOF, N/m.
    DynamicStiffness,
    /// Force over velocity at the same DOF, N s/m.
    Impedance,
    /// Force over acceleration at the same DOF, kg.
    ApparentMass,
}

impl Form {
    /// Words in projects.
    pub const WORDS: [&'static str; 6] =
        ["receptance", "mobility", "accelerance", "dynamic-stiffness", "impedance", "apparent-mass"];

    /// The form of a word.
    pub fn from_word(word: &str) -> Option<Self> {
        let forms = [
            Self::Receptance,
            Self::Mobility,
            Self::Accelerance,
            Self::DynamicStiffness,
            Self::Impedance,
            Self::ApparentMass,
        ];
        Self::WORDS.iter().position(|&known| known == word).map(|i| forms[i])
    }

    /// What moves.
    pub fn quantity(self) -> Quantity {
        match self {
            Self::Receptance | Self::DynamicStiffness => Quantity::Displacement,
            Self::Mobility | Self::Impedance => Quantity::Velocity,
            Self::Accelerance | Self::ApparentMass => Quantity::Acceleration,
        }
    }

    /// Whether force stands over motion. The inverse of an element of the response matrix is not an element of its
    /// inverse: only at the driving point of a single force are they the same.
    pub fn is_inverse(self) -> bool {
        matches!(self, Self::DynamicStiffness | Self::Impedance | Self::ApparentMass)
    }

    /// The form of a motion over a force.
    pub fn of(quantity: Quantity) -> Option<Self> {
        match quantity {
            Quantity::Force | Quantity::Base => None,
            Quantity::Displacement => Some(Self::Receptance),
            Quantity::Velocity => Some(Self::Mobility),
            Quantity::Acceleration => Some(Self::Accelerance),
        }
    }
}

/// Motion and force of a function: unit factors to SI.
pub(super) struct Ratio {
    pub form: Form,
    pub to_si: f64,
}

/// What the axes of a function say, with the units of the file (factors to divide by) where they name none.
pub(super) fn ratio(header: &uff::FunctionHeader, units: Option<&uff::Units>) -> Result<Ratio, String> {
    let (over, under) = unit_texts(header);
    let top = side(&over, header.ordinate.quantity, units)?;
    let bottom = side(&under, header.denominator.quantity, units)?;
    let (form, to_si) = match (top, bottom) {
        ((Quantity::Force, force), (motion, factor)) if motion != Quantity::Force => {
            let inverse = match motion {
                Quantity::Displacement => Form::DynamicStiffness,
                Quantity::Velocity => Form::Impedance,
                _ => Form::ApparentMass,
            };
            (inverse, force / factor)
        }
        ((motion, factor), (Quantity::Force, force)) if motion != Quantity::Force => {
            (Form::of(motion).unwrap_or(Form::Receptance), factor / force)
        }
        _ => return Err(format!("\"{over}\" over \"{under}\" is no motion over a force; give `form` and `scale`")),
    };
    Ok(Ratio { form, to_si })
}

/// Units over and under the line; some programs write both into the ordinate, such as `(m/s^2)/N`.
fn unit_texts(header: &uff::FunctionHeader) -> (String, String) {
    let (over, under) = (header.ordinate.unit.trim(), header.denominator.unit.trim());
    if under.is_empty()
        && let Some((a, b)) = over.rsplit_once('/')
        && Unit::from_name(over).is_none()
    {
        let plain = |text: &str| text.trim().trim_start_matches('(').trim_end_matches(')').trim().to_string();
        return (plain(a), plain(b));
    }
    (over.to_string(), under.to_string())
}

/// Quantity of one side and the factor to SI.
fn side(text: &str, code: i64, units: Option<&uff::Units>) -> Result<(Quantity, f64), String> {
    let quantity = match code {
        8 => Some(Quantity::Displacement),
        11 => Some(Quantity::Velocity),
        12 => Some(Quantity::Acceleration),
        9 | 13 => Some(Quantity::Force),
        _ => None,
    };
    if let Some(unit) = Unit::from_name(text) {
        if quantity.is_some_and(|quantity| quantity != unit.quantity) {
            return Err(format!("the unit \"{text}\" does not belong to data type {code}; give `form` and `scale`"));
        }
        return Ok((unit.quantity, unit.to_si));
    }
    match (quantity, units) {
        (Some(quantity), Some(units)) if text.is_empty() => {
            let factor = if quantity == Quantity::Force { units.force } else { units.length };
            Ok((quantity, 1.0 / factor))
        }
        _ => Err(format!("the unit \"{text}\" is not understood; give `form` and `scale` (file times scale is SI)")),
    }
}
