//! Forms and units of frequency responses: what a number in the file is in SI.

use crate::exchange::mapping::units::LabUnit;
use crate::measurement::Quantity;
use serde::{Deserialize, Serialize};

/// What a function relates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
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

    /// The form that a name speaks of, such as `Accelerance 7/19`.
    pub fn spoken(name: &str) -> Option<Self> {
        const SPOKEN: [(&[&str], Form); 6] = [
            (&["accelerance", "inertance", "accelerability"], Form::Accelerance),
            (&["mobility", "mobilität", "mobilité", "mobilita"], Form::Mobility),
            (&["receptance", "compliance", "admittance"], Form::Receptance),
            (&["dynamic stiffness", "dynamic-stiffness", "dynamische steifigkeit"], Form::DynamicStiffness),
            (&["impedance", "impedanz"], Form::Impedance),
            (&["apparent mass", "apparent-mass", "dynamic mass"], Form::ApparentMass),
        ];
        let name = name.to_lowercase();
        SPOKEN.iter().find(|(words, _)| words.iter().any(|word| name.contains(word))).map(|(_, form)| *form)
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
    /// Whether no unit is said, so that SI is assumed.
    pub assumed: bool,
}

/// How the unit of functions is given.
pub(super) const GIVE: &str =
    "give `form` and `scale` (file times scale is SI) in the [[frf]], of import by --form and --scale";

/// Whether a text says no unit, as programs write that.
pub(super) fn is_bare(unit: &str) -> bool {
    matches!(unit.trim().to_lowercase().as_str(), "" | "-" | "eu" | "none" | "unknown" | "n/a" | "?")
}

/// Factor to SI of functions of `form` whose axes name no unit, by the units of the file (factors to divide by), and whether
/// it is assumed for want of those.
pub(super) fn of_form(form: Form, units: Option<&uff::Units>) -> (f64, bool) {
    let to_si = units.map_or(1.0, |units| units.force / units.length);
    (if form.is_inverse() { 1.0 / to_si } else { to_si }, units.is_none())
}

/// Whether the axes of a function name no unit.
pub(super) fn names_no_unit(header: &uff::FunctionHeader) -> bool {
    is_bare(&header.ordinate.unit) && is_bare(&header.denominator.unit)
}

/// What the axes of a function say, with the units of the file (factors to divide by) where they name none.
pub(super) fn ratio(header: &uff::FunctionHeader, units: Option<&uff::Units>) -> Result<Ratio, String> {
    let (over, under) = unit_texts(header);
    let top = side(&over, header.ordinate.quantity, units)?;
    let bottom = side(&under, header.denominator.quantity, units)?;
    of_sides(top, bottom)
        .map(|ratio| Ratio { assumed: units.is_none() && names_no_unit(header), ..ratio })
        .ok_or_else(|| format!("\"{over}\" over \"{under}\" is no motion over a force; {GIVE}"))
}

/// Units over and under the line; some programs write both into the ordinate, such as `(m/s^2)/N`.
fn unit_texts(header: &uff::FunctionHeader) -> (String, String) {
    let (over, under) = (header.ordinate.unit.trim(), header.denominator.unit.trim());
    let (over, under) = alike(over, under).unwrap_or((over, under));
    if is_bare(under)
        && LabUnit::from_name(over).is_none()
        && let Some(both) = split(over)
    {
        return both;
    }
    (over.to_string(), under.to_string())
}

/// Units of which both sides are root mean squares or both are peaks, without the word for it, which cancels: `g rms` over `N rms`.
fn alike<'a>(over: &'a str, under: &'a str) -> Option<(&'a str, &'a str)> {
    ["rms", "peak", "pk", "pp"].into_iter().find_map(|word| {
        let without = |text: &'a str| {
            let cut = text.len().checked_sub(word.len())?;
            let (unit, end) = (text.get(..cut)?, text.get(cut..)?);
            let apart = |c: char| c.is_whitespace() || matches!(c, '_' | '(' | ')');
            let alone = end.eq_ignore_ascii_case(word) && unit.ends_with(apart);
            alone.then(|| unit.trim_end_matches(apart))
        };
        Some((without(over)?, without(under)?))
    })
}

/// Motion over force, or the inverse, of one unit, such as `(m/s^2)/N`, `g/lbf`, `(1/N)*(m/s^2)`, `1/kg`.
pub(super) fn ratio_of_unit(unit: &str) -> Result<Ratio, String> {
    let unknown = || format!("the unit \"{unit}\" is no motion over a force; {GIVE}");
    let plain: String = unit.chars().filter(|c| !c.is_whitespace()).collect();
    if let Some(form) = form_of_base_units(&plain) {
        return Ok(Ratio { form, to_si: 1.0, assumed: false });
    }
    let (over, under) = split(&plain).ok_or_else(unknown)?;
    let (top, bottom) =
        (LabUnit::from_name(&over).ok_or_else(unknown)?, LabUnit::from_name(&under).ok_or_else(unknown)?);
    of_sides((top.quantity, top.to_si), (bottom.quantity, bottom.to_si)).ok_or_else(unknown)
}

/// Forms whose SI units are written over one line: `1/kg`, `m/(N s^2)`, `s/kg`, `m/Ns`, `s^2/kg`, `kg/s`.
fn form_of_base_units(unit: &str) -> Option<Form> {
    let plain: String = unit.to_lowercase().replace('²', "2").replace(['(', ')', '^', '*', '·', '.'], "");
    Some(match plain.as_str() {
        "1/kg" | "kg-1" | "m/ns2" | "m/n/s2" => Form::Accelerance,
        "s/kg" | "m/ns" | "m/n/s" => Form::Mobility,
        "s2/kg" => Form::Receptance,
        "kg" | "ns2/m" => Form::ApparentMass,
        "kg/s" | "ns/m" => Form::Impedance,
        "kg/s2" => Form::DynamicStiffness,
        _ => return None,
    })
}

/// Quantity and factor to SI of the unit of a motion alone, such as `g`.
pub(super) fn motion_of_unit(unit: &str) -> Option<(Quantity, f64)> {
    let unit = LabUnit::from_name(unit.trim().trim_start_matches('(').trim_end_matches(')'))?;
    (unit.quantity != Quantity::Force).then_some((unit.quantity, unit.to_si))
}

/// What stands over and under the last line of a unit; `(1/B)*(A)` is `A` over `B`.
fn split(text: &str) -> Option<(String, String)> {
    let plain = |text: &str| text.trim().trim_start_matches('(').trim_end_matches(')').trim().to_string();
    let inverse = text.trim().strip_prefix("(1/").or_else(|| text.trim().strip_prefix("1/"));
    if let Some((under, over)) = inverse.and_then(|rest| rest.split_once(['*', '·'])) {
        return Some((plain(over), plain(under)));
    }
    let (over, under) = text.rsplit_once('/')?;
    Some((plain(over), plain(under)))
}

/// The form of two sides and the factor to SI.
fn of_sides(top: (Quantity, f64), bottom: (Quantity, f64)) -> Option<Ratio> {
    match (top, bottom) {
        ((Quantity::Force, force), (motion, factor)) if motion != Quantity::Force => {
            let form = match motion {
                Quantity::Displacement => Form::DynamicStiffness,
                Quantity::Velocity => Form::Impedance,
                _ => Form::ApparentMass,
            };
            Some(Ratio { form, to_si: force / factor, assumed: false })
        }
        ((motion, factor), (Quantity::Force, force)) if motion != Quantity::Force => {
            Some(Ratio { form: Form::of(motion)?, to_si: factor / force, assumed: false })
        }
        _ => None,
    }
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
    if let Some(unit) = LabUnit::from_name(text) {
        if quantity.is_some_and(|quantity| quantity != unit.quantity) {
            return Err(format!("the unit \"{text}\" does not belong to data type {code}; {GIVE}"));
        }
        return Ok((unit.quantity, unit.to_si));
    }
    match quantity {
        Some(quantity) if is_bare(text) => {
            let factor = |units: &uff::Units| if quantity == Quantity::Force { units.force } else { units.length };
            Ok((quantity, 1.0 / units.map_or(1.0, factor)))
        }
        _ if is_bare(text) => Err(format!("the file says neither what is measured nor its unit; {GIVE}")),
        _ => Err(format!("the unit \"{text}\" is not understood; {GIVE}")),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn units_of_responses_in_the_spellings_of_programs() {
        let read = |unit: &str| ratio_of_unit(unit).map(|ratio| (ratio.form, ratio.to_si)).ok();
        assert_eq!(read("(m/s^2)/(N)"), Some((Form::Accelerance, 1.0)));
        assert_eq!(read("m/s²/N"), Some((Form::Accelerance, 1.0)));
        assert_eq!(read("(1/N)*(m/s²)"), Some((Form::Accelerance, 1.0)));
        assert_eq!(read("g/N"), Some((Form::Accelerance, 9.806_65)));
        assert_eq!(read("mm/N"), Some((Form::Receptance, 1e-3)));
        assert_eq!(read("(m/s)/N"), Some((Form::Mobility, 1.0)));
        assert_eq!(read("N/m"), Some((Form::DynamicStiffness, 1.0)));
        assert_eq!(read("1/kg"), Some((Form::Accelerance, 1.0)));
        assert_eq!(read("m/(N·s²)"), Some((Form::Accelerance, 1.0)));
        assert_eq!(read("m/(N s)"), Some((Form::Mobility, 1.0)));
        assert_eq!(read("N s/m"), Some((Form::Impedance, 1.0)));
        assert_eq!((read("V/N"), read("m/s^2"), read("")), (None, None, None));
        assert_eq!((alike("g rms", "N rms"), alike("g rms", "N"), alike("m/s^2", "N")), (Some(("g", "N")), None, None));
    }
}
