//! What names, units and types of channels stand for.

use crate::measurement::Quantity;

/// Words in names that say what a channel measures.
const WORDS: [(&[&str], Quantity); 4] = [
    (&["force", "forza", "kraft", "load", "effort", "hammer", "shaker", "exc", "frc", "impact"], Quantity::Force),
    (
        &["acc", "accel", "acceleration", "accelerazione", "accélération", "beschleunigung", "beschl", "icp"],
        Quantity::Acceleration,
    ),
    (&["vel", "velocity", "speed", "geschwindigkeit", "vitesse", "velocità", "ldv", "vibrometer"], Quantity::Velocity),
    (
        &[
            "disp",
            "displacement",
            "weg",
            "auslenkung",
            "spostamento",
            "déplacement",
            "laser",
            "lvdt",
            "position",
            "pos",
        ],
        Quantity::Displacement,
    ),
];

/// Names of angles.
const ANGLES: [&str; 9] = ["phi", "theta", "psi", "roll", "pitch", "yaw", "angle", "winkel", "heel"];

/// Units of sensors that may measure a motion: strain gauges, amplifiers, converters.
const SENSORS: [&str; 13] =
    ["v", "mv", "uv", "volt", "volts", "strain", "ustrain", "microstrain", "ue", "um/m", "counts", "ma", "mv/v"];

/// Types of ordinates in Universal Files.
pub(super) fn quantity_of_type(number: &str) -> Option<Quantity> {
    match number {
        "8" => Some(Quantity::Displacement),
        "9" | "13" => Some(Quantity::Force),
        "11" => Some(Quantity::Velocity),
        "12" => Some(Quantity::Acceleration),
        _ => None,
    }
}

fn words(name: &str) -> Vec<String> {
    let name = name.to_lowercase();
    name.split(|c: char| !c.is_alphabetic()).filter(|word| !word.is_empty()).map(str::to_owned).collect()
}

/// Quantity by a word of the name.
pub(super) fn spoken(name: &str) -> Option<Quantity> {
    let words = words(name);
    WORDS.iter().find(|(known, _)| words.iter().any(|word| known.contains(&word.as_str()))).map(|(_, q)| *q)
}

/// Quantity by the symbol that is the whole name but for a number: `F`, `a2`, `v`, `x_1`.
pub(super) fn symbol(name: &str) -> Option<Quantity> {
    let mut letters = name.trim().chars();
    let quantity = match letters.next()?.to_ascii_lowercase() {
        'f' => Quantity::Force,
        'a' => Quantity::Acceleration,
        'v' => Quantity::Velocity,
        'x' | 'd' => Quantity::Displacement,
        _ => return None,
    };
    let rest = letters.as_str().strip_suffix(['x', 'y', 'z', 'X', 'Y', 'Z']).unwrap_or(letters.as_str());
    rest.chars().all(|c| c.is_ascii_digit() || matches!(c, '_' | ' ' | '[' | ']')).then_some(quantity)
}

/// Whether a name is that of an acceleration in g as telephones have it: `gFx`.
pub(super) fn in_g(name: &str) -> bool {
    matches!(name.trim(), "gFx" | "gFy" | "gFz")
}

/// Whether the names are, among others, those of the three directions alone.
pub(super) fn are_directions<'a>(names: impl Iterator<Item = &'a str> + Clone) -> bool {
    ["x", "y", "z"].iter().all(|axis| names.clone().any(|name| name.trim().eq_ignore_ascii_case(axis)))
}

/// Force of an input, displacement of an output, by names as system identification has them: `u` and `y`, `u[2]`, `uval` and `yval`.
/// Both must be among `names`.
pub(super) fn of_identification(name: &str, names: &[&str]) -> Option<Quantity> {
    let parts = |name: &str| {
        let lower = name.trim().to_lowercase();
        let stem = lower.split_once('[').map_or(lower.as_str(), |(stem, _)| stem).to_owned();
        stem.strip_prefix(['u', 'y']).map(|rest| (stem.starts_with('u'), rest.to_owned()))
    };
    let (input, rest) = parts(name)?;
    let other = names.iter().filter_map(|name| parts(name)).any(|(side, own)| side != input && own == rest);
    other.then_some(if input { Quantity::Force } else { Quantity::Displacement })
}

/// Whether a name is that of the moving base: a shaker table, the ground.
pub(super) fn of_base(name: &str) -> bool {
    const BASES: [&str; 9] = ["base", "table", "ground", "platform", "basis", "tisch", "boden", "tavola", "sol"];
    words(name).iter().any(|word| BASES.contains(&word.as_str()))
}

/// Whether a name is that of a moment.
pub(super) fn of_moment(name: &str) -> bool {
    const MOMENTS: [&str; 6] = ["moment", "torque", "drehmoment", "couple", "momento", "coppia"];
    words(name).iter().any(|word| MOMENTS.contains(&word.as_str()))
}

/// Direction `x`, `y` or `z` at the end of a name, such as `Table Z`.
pub(super) fn direction_of(name: &str) -> Option<String> {
    let last = words(name).pop()?;
    matches!(last.as_str(), "x" | "y" | "z").then_some(last)
}

/// Place by what a file says beside a channel: `node` or `point` with a `direction`, or `dof`.
pub(super) fn place_beside(attributes: &[(String, String)]) -> Option<(String, Option<i64>)> {
    let said = |words: &[&str]| {
        let plain = |name: &str| name.chars().filter(char::is_ascii_alphanumeric).collect::<String>().to_lowercase();
        attributes.iter().find(|(name, _)| words.contains(&plain(name).as_str())).map(|(_, value)| value.trim())
    };
    let point = said(&["dof", "node", "nodeid", "nodenumber", "point", "pointid", "pointnumber"])?;
    let direction = said(&["direction", "dir", "axis", "pointdirection"]).unwrap_or_default();
    place_of(&format!("{point}{direction}")).or_else(|| place_of(point))
}

/// Whether a name is that of an angle.
pub(super) fn angle(name: &str) -> bool {
    words(name).iter().any(|word| ANGLES.contains(&word.as_str()))
}

/// Whether a unit is that of a sensor whose calibration the file does not say.
pub(super) fn is_sensor_unit(unit: &str) -> bool {
    let plain: String = unit.chars().filter(|c| !c.is_whitespace()).collect::<String>().to_lowercase();
    SENSORS.contains(&plain.replace(['µ', 'μ'], "u").as_str())
}

/// Label and sign out of `12:+Z`, `12-Z`, `Acc 7`: the last number of the name and the direction behind it. The positive
/// direction X of a node that is written alone keeps the number as its label; so does the scalar direction `S` of Universal
/// Files.
pub(super) fn place_of(text: &str) -> Option<(String, Option<i64>)> {
    let text = text.trim();
    let end = text.rfind(|c: char| c.is_ascii_digit())? + 1;
    let start = text[..end]
        .rfind(|c: char| !c.is_ascii_digit())
        .map_or(0, |at| at + text[at..].chars().next().map_or(1, char::len_utf8));
    if words(&text[..start]).last().is_some_and(|word| word == "ai") {
        // An analogue input is a place in the amplifier, not on the structure.
        return None;
    }
    let number = text[start..end].trim_start_matches('0');
    let number = if number.is_empty() { "0" } else { number };
    let behind: String =
        text[end..].chars().filter(|c| !c.is_whitespace() && !matches!(c, ':' | '_' | ')' | ']')).collect();
    let (sign, axis) = match behind.chars().next() {
        Some('-') => (Some(-1), &behind[1..]),
        Some('+') => (None, &behind[1..]),
        _ => (None, behind.as_str()),
    };
    let axis = axis.to_lowercase();
    match axis.as_str() {
        "" => Some((number.to_owned(), sign)),
        "s" if number != "0" => Some((number.to_owned(), sign)),
        "x" | "y" | "z" | "rx" | "ry" | "rz" => Some((format!("{number}{axis}"), sign)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_out_of_names() {
        let place = |text: &str| place_of(text).map(|(label, sign)| (label, sign.unwrap_or(1)));
        assert_eq!(place("12:+Z"), Some(("12z".into(), 1)));
        assert_eq!(place("12:-Z"), Some(("12z".into(), -1)));
        assert_eq!(place("Acc 7"), Some(("7".into(), 1)));
        assert_eq!(place("acc_07_x"), Some(("7x".into(), 1)));
        assert_eq!(place("sine 1:S"), Some(("1".into(), 1)));
        assert_eq!((place("Force"), place("7 left"), place("0:S")), (None, None, None));
        assert_eq!((place("Acc/AI 2"), place("Acc/AI2 ")), (None, None));
    }

    #[test]
    fn places_beside_a_channel() {
        let beside = |pairs: &[(&str, &str)]| {
            let pairs: Vec<_> = pairs.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
            place_beside(&pairs)
        };
        assert_eq!(beside(&[("node", "10"), ("direction", "-Z")]), Some(("10z".into(), Some(-1))));
        assert_eq!(beside(&[("Point ID", "7")]), Some(("7".into(), None)));
        assert_eq!(beside(&[("dof", "7:+X"), ("unit", "N")]), Some(("7x".into(), None)));
        assert_eq!((beside(&[("unit", "N")]), beside(&[("node", "left")])), (None, None));
    }

    #[test]
    fn words_say_the_quantity() {
        assert_eq!(spoken("Acc 7"), Some(Quantity::Acceleration));
        assert_eq!(spoken("Kraft_1"), Some(Quantity::Force));
        assert_eq!((spoken("Channel 1"), symbol("y"), symbol("fan")), (None, None, None));
        assert_eq!(
            (symbol("F"), symbol("x_2"), spoken("Beschl.")),
            (Some(Quantity::Force), Some(Quantity::Displacement), Some(Quantity::Acceleration))
        );
        let names = ["uval", "yval[1]", "yval[2]", "u", "x"];
        let quantity = |name: &str| of_identification(name, &names);
        assert_eq!((quantity("uval"), quantity("yval[2]")), (Some(Quantity::Force), Some(Quantity::Displacement)));
        assert_eq!((quantity("u"), quantity("x")), (None, None));
        assert_eq!((symbol("ax"), symbol("az2"), symbol("max")), (Some(Quantity::Acceleration), None, None));
        assert!(
            in_g("gFz")
                && are_directions(["time", "z", "Y", "x"].into_iter())
                && !are_directions(["x", "y"].into_iter())
        );
        assert!(of_base("Shaker table [g]") && of_base("base_z") && !of_base("acc 7") && !of_base("baseline 1"));
        assert_eq!((direction_of("Table Z").as_deref(), direction_of("Table")), (Some("z"), None));
        assert!(angle("phi") && angle("Roll angle") && !angle("phase"));
        assert!(is_sensor_unit("Volts") && is_sensor_unit("µm/m") && !is_sensor_unit("Pa"));
    }
}
