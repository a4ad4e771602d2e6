//! Sets of one channel each that are one record: arrays of structs in MATLAB (`rec(1).name`, `rec(1).data`, ...), files with a
//! group a channel, texts with a block a channel. Their channels become one set, called as what they lie in.
//!
//! Groups of one channel may also be runs of one sensor. They are channels of one record only where they share their times and
//! where something tells them apart as channels: names that the file gives them, units, or words such as `Channel`.

use crate::axis::kind_of;
use crate::contents::{Axis, Channel, Contents, Format, Kind, Set};
use crate::error::Read;
use crate::source::Source;
use crate::tree::{MOST_CHECKED, is_plain};
use std::collections::HashSet;
use uff::Values;

/// Most notes of a set.
const MOST_NOTES: usize = 64;
/// Attribute of a channel with the name of the set that it has alone in the file.
const SET: &str = "set";

/// The contents with sets of one channel each gathered, and the source of them.
pub(crate) fn one_channel_each(mut contents: Contents, source: Box<dyn Source>) -> Read<(Contents, Box<dyn Source>)> {
    let gathers =
        matches!(contents.format, Format::Mat | Format::Hdf5 | Format::Tdms | Format::Csv | Format::Txt | Format::Xlsx);
    if !gathers || contents.sets.len() < 2 {
        return Ok((contents, source));
    }
    let whole = |s: usize, set: &Set| (0..set.channels.len()).map(|c| (s, c)).collect::<Vec<_>>();
    let mut places: Vec<Vec<Place>> = contents.sets.iter().enumerate().map(|(s, set)| whole(s, set)).collect();
    let mut parents: Vec<String> = Vec::new();
    for set in &contents.sets {
        let parent = parent(contents.format, &set.name);
        if !parents.iter().any(|known| known == parent) {
            parents.push(parent.to_owned());
        }
    }
    for parent in parents {
        let of_parent = |set: &Set| self::parent(contents.format, &set.name) == parent && set.name != parent;
        let own: Vec<usize> = (0..contents.sets.len()).filter(|&s| of_parent(&contents.sets[s])).collect();
        let taken = contents.sets.iter().any(|set| set.name == parent && !set.channels.is_empty());
        let sets: Vec<&Set> = own.iter().map(|&s| &contents.sets[s]).collect();
        if !taken
            && let Some(names) = names(&sets)
            && same_times(&sets, &own, &places, &*source)?
        {
            gather(&mut contents.sets, &mut places, &own, parent, names);
        }
    }
    Ok((contents, Box::new(Gathered { below: source, places })))
}

/// Set and channel in the file below.
type Place = (usize, usize);

struct Gathered {
    below: Box<dyn Source>,
    places: Vec<Vec<Place>>,
}

impl Source for Gathered {
    fn read(&self, set: usize, channel: usize) -> Read<Values> {
        let (set, channel) = self.places[set][channel];
        self.below.read(set, channel)
    }

    fn together(&self, set: usize, channels: &[usize]) -> Option<Read<Vec<Values>>> {
        let below: Vec<Place> = channels.iter().map(|&channel| self.places[set][channel]).collect();
        let first = below.first()?.0;
        let inside: Vec<usize> = below.iter().map(|&(_, channel)| channel).collect();
        if below.iter().all(|&(set, _)| set == first) { self.below.together(first, &inside) } else { None }
    }

    fn axis(&self, set: usize, channel: usize) -> Read<Vec<f64>> {
        let (set, channel) = self.places[set][channel];
        self.below.axis(set, channel)
    }
}

/// What a set lies in. Groups of TDMS, blocks of a text and sheets lie in the file, and their names may hold strokes.
pub(crate) fn parent(format: Format, name: &str) -> &str {
    if matches!(format, Format::Tdms | Format::Csv | Format::Txt | Format::Xlsx) {
        ""
    } else {
        name.rsplit_once('/').map_or("", |(above, _)| above)
    }
}

/// Place of the only channel of a set that is no abscissa.
fn only(set: &Set) -> Option<usize> {
    let is_axis = |channel: &Channel| kind_of(&channel.name, &channel.unit).is_some();
    let mut found = set.channels.iter().enumerate().filter(|(_, channel)| !is_axis(channel)).map(|(c, _)| c);
    found.next().filter(|_| found.next().is_none())
}

/// Names of the channels as those of one record; none where the sets may as well be runs.
fn names(sets: &[&Set]) -> Option<Vec<String>> {
    let timed = |set: &&Set| matches!(set.kind, Kind::Time | Kind::Table);
    if sets.len() < 2 || !sets.iter().all(timed) {
        return None;
    }
    let channels: Vec<&Channel> = sets.iter().map(|set| only(set).map(|c| &set.channels[c])).collect::<Option<_>>()?;
    let group = |set: &Set| set.name.rsplit('/').next().unwrap_or_default().to_owned();
    let groups: Vec<String> = sets.iter().map(|set| group(set)).collect();
    let own: Vec<String> = channels.iter().map(|channel| channel.name.clone()).collect();
    let units: HashSet<&str> = channels.iter().map(|c| c.unit.trim()).filter(|unit| !unit.is_empty()).collect();
    let of_channels = |names: &[String]| units.len() > 1 || names.iter().all(|name| has_word(name, &CHANNELS));
    // Names that are those of the groups may be those of runs; names of their own that differ in words are of channels.
    let told = of_channels(&own) || own != groups && stems(&own) > 1;
    if distinct(&own) && !of_runs(&own) && told {
        return Some(own);
    }
    let alike = own.iter().all(|name| *name == own[0]);
    if !alike || !distinct(&groups) || of_runs(&groups) || !of_channels(&groups) {
        return None;
    }
    let named = |(group, own): (&String, &String)| if is_plain(own) { group.clone() } else { format!("{group} {own}") };
    Some(groups.iter().zip(&own).map(named).collect())
}

/// Words for channels, and for what they measure.
const CHANNELS: [&str; 19] = [
    "channel",
    "chan",
    "ch",
    "kanal",
    "canal",
    "sensor",
    "acc",
    "accel",
    "acceleration",
    "beschleunigung",
    "beschl",
    "force",
    "kraft",
    "vel",
    "velocity",
    "disp",
    "displacement",
    "weg",
    "accelerometer",
];
/// Words for runs.
const RUNS: [&str; 17] = [
    "run",
    "hit",
    "test",
    "trial",
    "take",
    "shot",
    "decay",
    "level",
    "record",
    "messung",
    "versuch",
    "lauf",
    "measurement",
    "meas",
    "impact",
    "experiment",
    "sweep",
];
fn words(name: &str) -> impl Iterator<Item = String> + '_ {
    name.split(|c: char| !c.is_alphabetic()).filter(|word| !word.is_empty()).map(str::to_lowercase)
}

fn has_word(name: &str, list: &[&str]) -> bool {
    words(name).any(|word| list.contains(&word.as_str()))
}

/// Whether names count runs: one of the words for them in each.
fn of_runs(names: &[String]) -> bool {
    names.iter().all(|name| has_word(name, &RUNS))
}

fn distinct(names: &[String]) -> bool {
    names.iter().collect::<HashSet<_>>().len() == names.len()
}

/// Number of names that differ in more than their figures.
fn stems(names: &[String]) -> usize {
    names.iter().map(|name| words(name).collect::<Vec<_>>()).collect::<HashSet<_>>().len()
}

/// Whether the only channels of all sets have the same times, and began together where that is stated.
fn same_times(sets: &[&Set], own: &[usize], places: &[Vec<Place>], source: &dyn Source) -> Read<bool> {
    let channel_and_place = |i: usize| only(sets[i]).map(|c| (&sets[i].channels[c], places[own[i]][c]));
    let Some((first, place)) = channel_and_place(0) else { return Ok(false) };
    let mut times = None;
    for i in 1..sets.len() {
        let Some((other, at)) = channel_and_place(i) else { return Ok(false) };
        if other.count != first.count || other.complex || first.complex || !begins_with(first, other) {
            return Ok(false);
        }
        match (&first.axis, &other.axis) {
            (Axis::None, Axis::None) => {}
            (Axis::Even { start, step }, Axis::Even { start: begin, step: other }) => {
                if (step - other).abs() > 1e-9 * step || (start - begin).abs() > 0.01 * step {
                    return Ok(false);
                }
            }
            (Axis::Stored { step }, Axis::Stored { step: other_step }) => {
                if step.zip(*other_step).is_some_and(|(a, b)| (a - b).abs() > 1e-6 * a.abs())
                    || step.is_some() != other_step.is_some()
                {
                    return Ok(false);
                }
                if first.count <= MOST_CHECKED {
                    if times.is_none() {
                        times = Some(source.axis(place.0, place.1)?);
                    }
                    let (a, b) = (times.as_deref().unwrap_or_default(), source.axis(at.0, at.1)?);
                    if !near(a, &b) {
                        return Ok(false);
                    }
                }
            }
            _ => return Ok(false),
        }
    }
    Ok(true)
}

/// Whether two lists of times are one, to a hundredth of a step.
fn near(a: &[f64], b: &[f64]) -> bool {
    let step = (a.last().unwrap_or(&0.0) - a.first().unwrap_or(&0.0)) / a.len().max(2) as f64;
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 0.01 * step.abs())
}

/// Whether two channels began at the same time of the day, to a step, where both say it.
fn begins_with(a: &Channel, b: &Channel) -> bool {
    let begin = |channel: &Channel| {
        channel.attribute("wf_start_time").and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok())
    };
    let step = a.axis.step().unwrap_or(0.0);
    begin(a).zip(begin(b)).is_none_or(|(a, b)| (a - b).abs() <= step)
}

/// Puts the channels of the sets `own` into the first of them, which is called `name`.
fn gather(sets: &mut Vec<Set>, places: &mut Vec<Vec<Place>>, own: &[usize], name: String, names: Vec<String>) {
    let into = own[0];
    let (mut channels, mut found, mut notes) = (Vec::new(), Vec::new(), Vec::new());
    for (k, (&s, channel_name)) in own.iter().zip(names).enumerate() {
        let Some(one) = only(&sets[s]) else { continue };
        for (c, channel) in sets[s].channels.iter().enumerate() {
            // The times are the same in all sets.
            if c != one && k > 0 {
                continue;
            }
            let mut channel = channel.clone();
            channel.attributes.push((SET.to_owned(), sets[s].name.clone()));
            if c == one {
                channel_name.clone_into(&mut channel.name);
            }
            channels.push(channel);
            found.push(places[s][c]);
        }
        for note in &sets[s].notes {
            if !notes.contains(note) {
                notes.push(note.clone());
            }
        }
    }
    notes.insert(0, format!("{} sets of one channel each, of the same times, are one record", own.len()).into());
    notes.truncate(MOST_NOTES);
    let set = &mut sets[into];
    (set.name, set.channels, set.notes) = (name, channels, notes);
    places[into] = found;
    for &s in own[1..].iter().rev() {
        sets.remove(s);
        places.remove(s);
    }
}
