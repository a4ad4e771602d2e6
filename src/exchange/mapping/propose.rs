//! Proposals for a mapping from names and metadata: `acc@7`, `12:+Z`, `Acc 7`, nodes and directions of Universal Files.

use super::table::ChannelTable;
use super::units::LabUnit;
use crate::measurement::Quantity;
use crate::measurement::channel::parse_name;
use dashpot_datafiles::{Channel, Contents, Kind};

/// What is proposed for a file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Proposal {
    /// Channels that are mapped.
    pub channels: Vec<ChannelTable>,
    /// Channels that are not, each with the reason.
    pub left: Vec<(String, String)>,
    /// Whether the file does not say the time between samples.
    pub needs_sampling: bool,
}

/// Words in names that say what a channel measures.
const WORDS: [(&[&str], Quantity); 4] = [
    (&["force", "kraft", "load", "hammer", "shaker", "exc", "frc"], Quantity::Force),
    (&["acc", "accel", "acceleration", "beschleunigung", "icp"], Quantity::Acceleration),
    (&["vel", "velocity", "speed", "geschwindigkeit", "ldv", "vibrometer"], Quantity::Velocity),
    (&["disp", "displacement", "weg", "laser", "lvdt", "position", "pos"], Quantity::Displacement),
];

/// Types of ordinates in Universal Files.
fn quantity_of_type(number: &str) -> Option<Quantity> {
    match number {
        "8" => Some(Quantity::Displacement),
        "9" | "13" => Some(Quantity::Force),
        "11" => Some(Quantity::Velocity),
        "12" => Some(Quantity::Acceleration),
        _ => None,
    }
}

/// Proposes a mapping for the time records of a file. `set` is stated where a name stands in several sets.
pub fn propose(contents: &Contents) -> Proposal {
    let mut proposal = Proposal::default();
    for set in contents.sets.iter().filter(|set| matches!(set.kind, Kind::Time | Kind::Table)) {
        for channel in &set.channels {
            let same = |other: &&Channel| other.name == channel.name;
            let everywhere = contents.sets.iter().flat_map(|set| &set.channels).filter(same).count();
            let within = set.channels.iter().filter(same).count();
            let stated = (everywhere > within).then(|| set.name.clone());
            match one(channel, stated) {
                _ if within > 1 => proposal.leave(channel, "two channels of the set have that name"),
                _ if channel.count == 0 => proposal.leave(channel, "it has 0 samples"),
                _ if channel.complex => proposal.leave(channel, "it is complex"),
                Err(reason) => proposal.leave(channel, reason),
                Ok(table) => proposal.take(channel, table),
            }
        }
    }
    proposal
}

impl Proposal {
    fn leave(&mut self, channel: &Channel, reason: &str) {
        self.left.push((channel.name.clone(), reason.to_owned()));
    }

    fn take(&mut self, channel: &Channel, table: ChannelTable) {
        if self.channels.iter().any(|other| other.channel() == table.channel()) {
            let reason = format!("{} is proposed for another channel already", table.channel());
            self.left.push((channel.name.clone(), reason));
            return;
        }
        self.needs_sampling |= channel.axis.step().is_none() && channel.axis == dashpot_datafiles::Axis::None;
        self.channels.push(table);
    }
}

/// The table of a channel that is named as in the project's own files.
pub(super) fn own_name(set: &str, channel: &Channel) -> Option<ChannelTable> {
    let (quantity, label) = parse_name(&channel.name).ok()?;
    let unit = LabUnit::from_name(&channel.unit)?;
    (unit.quantity == quantity)
        .then(|| ChannelTable { set: Some(set.to_owned()), ..table(channel, None, quantity, label) })
}

fn table(channel: &Channel, set: Option<String>, quantity: Quantity, label: String) -> ChannelTable {
    ChannelTable {
        name: channel.name.clone(),
        set,
        quantity,
        dof: label,
        unit: None,
        sign: None,
        factor: None,
        delay: None,
    }
}

fn one(channel: &Channel, set: Option<String>) -> Result<ChannelTable, &'static str> {
    if let Ok((quantity, label)) = parse_name(&channel.name) {
        return Ok(table(channel, set, quantity, label));
    }
    let unit = LabUnit::from_name(&channel.unit).map(|unit| unit.quantity);
    let typed = channel.attribute("quantity").and_then(quantity_of_type);
    let quantity = unit.or(typed).or_else(|| spoken(&channel.name));
    let quantity = quantity.ok_or("neither its unit nor its name says what it measures")?;
    let place = channel.attribute("response").unwrap_or(&channel.name);
    let (label, sign) = place_of(place).ok_or("its name says no DOF")?;
    Ok(ChannelTable { sign, ..table(channel, set, quantity, label) })
}

/// Quantity by a word of the name.
fn spoken(name: &str) -> Option<Quantity> {
    let name = name.to_lowercase();
    let words: Vec<&str> = name.split(|c: char| !c.is_alphabetic()).filter(|word| !word.is_empty()).collect();
    WORDS.iter().find(|(known, _)| words.iter().any(|word| known.contains(word))).map(|(_, quantity)| *quantity)
}

/// Label and sign out of `12:+Z`, `12-Z`, `Acc 7`: the last number of the name and the direction behind it. The positive
/// direction X of a node that is written alone keeps the number as its label.
fn place_of(text: &str) -> Option<(String, Option<i64>)> {
    let text = text.trim();
    let end = text.rfind(|c: char| c.is_ascii_digit())? + 1;
    let start = text[..end]
        .rfind(|c: char| !c.is_ascii_digit())
        .map_or(0, |at| at + text[at..].chars().next().map_or(1, char::len_utf8));
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
        assert_eq!(place("Force"), None);
        assert_eq!(place("7 left"), None);
    }

    #[test]
    fn words_say_the_quantity() {
        assert_eq!(spoken("Acc 7"), Some(Quantity::Acceleration));
        assert_eq!(spoken("Kraft_1"), Some(Quantity::Force));
        assert_eq!(spoken("Channel 1"), None);
    }
}
