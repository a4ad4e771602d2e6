//! A roving hammer whose force is always the same channel: its place is the number by which the names of the files or sets
//! differ, such as `hit_P3.csv`, `hit_P6.csv` or the groups `Hit 1 P8`, `Hit 2 P3`.

use crate::exchange::mapping::{FORCE_WITHOUT_PLACE, Proposal};
use crate::measurement::Quantity;
use crate::structure::Structure;

/// Name of the channel of the force in the files, and the label of its DOF in each run, where the names of the runs say it and
/// nothing else does: the assumption of the mapping then says so.
pub(super) fn places(mapping: &mut Proposal, runs: &[String], structure: &Structure) -> Option<(String, Vec<String>)> {
    let tables = mapping.channels.iter().filter(|table| table.quantity == Quantity::Force);
    let [force] = tables.collect::<Vec<_>>()[..] else { return None };
    let (channel, name) = (force.channel(), force.name.clone());
    let guessed = |(known, what): &&mut (String, String)| *known == channel && what.starts_with(FORCE_WITHOUT_PLACE);
    let sensors = mapping.channels.iter().filter(|table| table.quantity != Quantity::Force);
    let directions: Vec<&str> =
        sensors.map(|table| table.dof.trim_start_matches(|c: char| c.is_ascii_digit())).collect();
    let direction = *directions.first().filter(|first| directions.iter().all(|other| other == *first))?;
    let numbers = differing(runs)?;
    let labels: Vec<String> = numbers.iter().map(|number| format!("{number}{direction}")).collect();
    if labels.iter().any(|label| structure.dof(label).is_none()) {
        return None;
    }
    let assumed = mapping.assumed.iter_mut().find(guessed)?;
    assumed.1 =
        format!("the file says no DOF: by the numbers in the names of the runs it acts at {}", labels.join(", "));
    Some((name, labels))
}

/// The number by which names differ that are the same otherwise: one that does not merely count them, where there are several.
fn differing(names: &[String]) -> Option<Vec<u64>> {
    let split: Vec<(String, Vec<u64>)> = names.iter().map(|name| numbers(name)).collect::<Option<_>>()?;
    let (first, others) = split.split_first()?;
    if others.is_empty() || others.iter().any(|(text, _)| *text != first.0) {
        return None;
    }
    let column = |k: usize| split.iter().map(|(_, numbers)| numbers[k]).collect::<Vec<u64>>();
    let counts = |column: &Vec<u64>| column.windows(2).all(|pair| pair[1] == pair[0] + 1);
    let segments: Vec<&str> = first.0.split('#').collect();
    let mut differ: Vec<Vec<u64>> = (0..first.1.len()).filter(|&k| !is_of_run(segments[k])).map(column).collect();
    differ.retain(|column| column.iter().any(|number| *number != column[0]));
    if differ.len() > 1 {
        differ.retain(|column| !counts(column));
    }
    let [one] = &differ[..] else { return None };
    Some(one.clone())
}

/// Words in front of numbers of runs and levels, which are no places.
const OF_RUNS: [&str; 24] = [
    "level",
    "levels",
    "lev",
    "lvl",
    "run",
    "test",
    "trial",
    "take",
    "rep",
    "repeat",
    "repetition",
    "rec",
    "record",
    "meas",
    "measurement",
    "data",
    "day",
    "amp",
    "amplitude",
    "rms",
    "stufe",
    "pegel",
    "messung",
    "versuch",
];

/// Whether the number behind a text is that of a run or of a level.
fn is_of_run(text: &str) -> bool {
    let text = text.trim_end_matches(|c: char| !c.is_alphabetic()).to_lowercase();
    OF_RUNS.contains(&text.rsplit(|c: char| !c.is_alphabetic()).next().unwrap_or_default())
}

/// A name with its numbers taken out, and these.
fn numbers(name: &str) -> Option<(String, Vec<u64>)> {
    let (mut text, mut found) = (String::new(), Vec::new());
    let mut rest = name;
    while let Some(from) = rest.find(|c: char| c.is_ascii_digit()) {
        let end = rest[from..].find(|c: char| !c.is_ascii_digit()).map_or(rest.len(), |length| from + length);
        text.push_str(&rest[..from]);
        text.push('#');
        found.push(rest[from..end].parse().ok()?);
        rest = &rest[end..];
    }
    text.push_str(rest);
    Some((text, found))
}

#[cfg(test)]
mod tests {
    use super::differing;

    #[test]
    fn the_place_is_the_number_that_differs_and_does_not_count() {
        let found = |names: &[&str]| differing(&names.iter().map(|&name| name.to_owned()).collect::<Vec<_>>());
        assert_eq!(found(&["hit_P3", "hit_P6", "hit_P8"]), Some(vec![3, 6, 8]));
        assert_eq!(found(&["Hit 1 P8", "Hit 2 P8", "Hit 3 P3"]), Some(vec![8, 8, 3]));
        assert_eq!(found(&["a 07 x", "a 12 x"]), Some(vec![7, 12]));
        for other in [&["hit 3", "tap 6"][..], &["hit 3"], &["hit 3", "hit 3"], &["4 3 1", "9 7 5"]] {
            assert_eq!(found(other), None, "{other:?}");
        }
        assert_eq!((found(&["beam_level1", "beam_level2"]), found(&["Run 3", "Run 5"])), (None, None));
        assert_eq!(found(&["Run 1 P4", "Run 2 P6"]), Some(vec![4, 6]));
        // Both columns differ and neither counts.
        assert_eq!(found(&["3 of 9", "8 of 2"]), None);
    }
}
