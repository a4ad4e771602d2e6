//! What the columns of a stepped-sine table are, by their names: `frequency_hz`, `force_n`, `Acceleration [g]`, `phase_rad`.

use crate::exchange::mapping::units::LabUnit;
use crate::measurement::Quantity;

/// What a column holds.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Role {
    /// Frequency of the run; factor to Hz.
    Frequency(f64),
    /// Number of the level.
    Level,
    /// Name of the session.
    Session,
    /// Amplitude of the force, with its unit where the name says it.
    Force(Option<String>),
    /// Amplitude of a response: what it measures and its unit, where the name says so.
    Response(Option<Quantity>, Option<String>),
    /// Phase: radians of its unit, and what stands behind it: the channel that it belongs to, or nothing.
    Phase(f64, String),
    /// Something else.
    Other,
}

const PHASES: [&str; 4] = ["phase", "phi", "arg", "winkel"];
const FORCES: [&str; 5] = ["force", "kraft", "load", "excitation", "forcing"];
const ANY_RESPONSE: [&str; 5] = ["amplitude", "amp", "response", "magnitude", "motion"];
const RESPONSES: [(&[&str], Quantity); 3] = [
    (&["acceleration", "accel", "acc", "beschleunigung"], Quantity::Acceleration),
    (&["velocity", "vel", "geschwindigkeit"], Quantity::Velocity),
    (&["displacement", "disp", "weg", "auslenkung"], Quantity::Displacement),
];

/// What a column of that name holds; channels of the project's own form, such as `acc@7 [g]`, are [`Role::Other`].
pub(crate) fn role(name: &str) -> Role {
    let name = name.trim();
    if let Some((radians, of)) = phase(name) {
        return Role::Phase(radians, of);
    }
    if name.contains('@') {
        return Role::Other;
    }
    let (word, unit) = word_and_unit(name);
    let named = |words: &[&str]| words.contains(&word.as_str());
    let lab = unit.as_deref().and_then(LabUnit::from_name);
    let forces = lab.is_some_and(|unit| unit.quantity == Quantity::Force);
    match unit.as_deref().map(str::to_lowercase).as_deref() {
        _ if word == "level" => return Role::Level,
        _ if word == "session" => return Role::Session,
        unit if word.starts_with("freq") || word == "hz" || word == "f" && !forces => {
            return match unit {
                None | Some("hz") => Role::Frequency(1.0),
                Some("khz") => Role::Frequency(1e3),
                Some("rad/s") => Role::Frequency(1.0 / std::f64::consts::TAU),
                _ => Role::Other,
            };
        }
        _ => {}
    }
    if named(&FORCES) || word == "f" {
        return if lab.is_none_or(|unit| unit.quantity == Quantity::Force) { Role::Force(unit) } else { Role::Other };
    }
    let spoken = RESPONSES.iter().find(|(words, _)| named(words)).map(|(_, quantity)| *quantity);
    if spoken.is_none() && !named(&ANY_RESPONSE) {
        return Role::Other;
    }
    match lab.map(|unit| unit.quantity) {
        Some(Quantity::Force) => Role::Other,
        Some(measured) if spoken.is_some_and(|spoken| spoken != measured) => Role::Other,
        measured => Role::Response(spoken.or(measured), unit),
    }
}

/// Radians of the unit of a phase column and what stands behind it.
fn phase(name: &str) -> Option<(f64, String)> {
    let lower = name.to_lowercase();
    let word = PHASES.iter().find(|word| lower.starts_with(**word))?;
    let rest = name.get(word.len()..)?.trim_start_matches(['_', ' ', '-', '[', '(']);
    let lower = rest.to_lowercase();
    let degree = 1.0_f64.to_radians();
    let units = [("degrees", degree), ("deg", degree), ("°", degree), ("radians", 1.0), ("rad", 1.0)];
    let (unit, radians) = units.iter().find(|(unit, _)| lower.starts_with(unit))?;
    let of = rest.get(unit.len()..)?.trim_start_matches([']', ')', ' ', '@', '_']).trim();
    Some((*radians, of.to_owned()))
}

/// The first word of a name in lower case and the unit behind it: in brackets, or by what follows the word (`_m_s2`).
fn word_and_unit(name: &str) -> (String, Option<String>) {
    let (plain, bracketed) = dashpot_datafiles::units::split(name);
    let (word, rest) = plain.split_once(['_', ' ']).unwrap_or((&plain, ""));
    let word = word.to_lowercase();
    if !bracketed.is_empty() {
        return (word, Some(bracketed));
    }
    let rest = rest.trim().to_lowercase().replace([' ', '-'], "_");
    let unit = match rest.as_str() {
        "m_s2" | "ms2" | "m_s_2" | "mps2" => "m/s^2",
        "mm_s2" => "mm/s^2",
        "m_s" | "mps" => "m/s",
        "mm_s" => "mm/s",
        "rad_s" => "rad/s",
        "n" => "N",
        "kn" => "kN",
        // Names in small letters say moments so, not nanometres.
        "nm" => "Nm",
        other => other,
    };
    let known = LabUnit::from_name(unit).is_some() || matches!(unit, "hz" | "khz" | "rad/s");
    (word, known.then(|| unit.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_of_controllers_are_told_by_their_names() {
        let unit = |text: &str| Some(text.to_owned());
        assert_eq!(role("frequency_hz"), Role::Frequency(1.0));
        assert_eq!(role("Frequency [kHz]"), Role::Frequency(1e3));
        assert_eq!(role("force_n"), Role::Force(unit("N")));
        assert_eq!(role("Force [lbf]"), Role::Force(unit("lbf")));
        assert_eq!((role("f [N]"), role("f")), (Role::Force(unit("N")), Role::Frequency(1.0)));
        assert_eq!(role("force"), Role::Force(None));
        assert_eq!(role("acceleration_m_s2"), Role::Response(Some(Quantity::Acceleration), unit("m/s^2")));
        assert_eq!(role("amplitude (mm)"), Role::Response(Some(Quantity::Displacement), unit("mm")));
        assert_eq!(role("amplitude"), Role::Response(None, None));
        assert_eq!(role("phase_rad"), Role::Phase(1.0, String::new()));
        assert_eq!(role("Phase [deg]"), Role::Phase(1.0_f64.to_radians(), String::new()));
        assert_eq!(role("phase_deg acc@7"), Role::Phase(1.0_f64.to_radians(), "acc@7".into()));
        assert_eq!((role("acc@7 [g]"), role("phase"), role("temperature")), (Role::Other, Role::Other, Role::Other));
        assert_eq!(role("velocity_m_s2"), Role::Other);
    }
}
