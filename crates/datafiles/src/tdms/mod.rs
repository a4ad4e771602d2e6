//! TDMS files of LabVIEW and NI-DAQmx: segments with metadata and raw data.
//!
//! Source: "TDMS File Format Internal Structure", National Instruments. Only metadata and a few values are read to make the
//! tree; a channel is read piece by piece from where its segments lie.

mod input;
mod objects;
mod scale;
mod segment;
mod values;

use crate::contents::{Axis, Channel, Contents, FIRST, Format, Kind, Set, first_numbers};
use crate::error::{Fault, Read};
use crate::note::not_read;
use crate::source::Source;
use crate::tree::{Sampling, sampling};
use objects::{Object, Property};
use scale::Scaling;
use std::path::{Path, PathBuf};
use uff::Values;
use values::Place;

struct Tdms {
    path: PathBuf,
    sets: Vec<Vec<Place>>,
}

/// Opens a TDMS file.
pub(crate) fn open(path: &Path) -> Read<(Contents, Box<dyn Source>)> {
    let (objects, notes) = segment::objects(path)?;
    let mut contents = Contents::new(Format::Tdms);
    contents.notes = notes;
    let mut tdms = Tdms { path: path.to_owned(), sets: Vec::new() };
    let root = objects
        .iter()
        .find(|object| object.path.is_empty())
        .map(|object| object.properties.as_slice())
        .unwrap_or_default();
    for group in objects.iter().filter(|object| object.path.len() == 1) {
        let mut set = Set::new(group.path[0].clone(), Kind::Table);
        set.notes.extend(group.properties.iter().take(30).map(|(name, value)| format!("{name}: {value}").into()));
        let mut places = Vec::new();
        for object in objects.iter().filter(|object| object.path.len() == 2 && object.path[0] == group.path[0]) {
            if let Some(why) = &object.skipped {
                set.notes.push(not_read(&object.path[1], why));
                continue;
            }
            let scaling = [&object.properties[..], &group.properties, root]
                .iter()
                .find_map(|properties| Scaling::read(properties));
            let scaling = match scaling.unwrap_or(Ok(Scaling::default())) {
                Ok(scaling) => scaling,
                Err(what) => {
                    set.notes.push(not_read(&object.path[1], &what));
                    continue;
                }
            };
            let place = Place { runs: object.runs.clone(), scaling, complex: object.complex };
            let mut channel = channel(object, &place, path)?;
            if channel.axis == Axis::None && channel.count > 1 {
                channel.axis = rate(&[&object.properties, &group.properties, root]);
            }
            set.channels.push(channel);
            places.push(place);
        }
        if set.channels.iter().any(|channel| channel.axis != Axis::None) {
            set.kind = if set.axis_unit_is_hertz() { Kind::Spectrum } else { Kind::Time };
            set.axis_unit = if set.kind == Kind::Time { "s" } else { "Hz" }.to_owned();
        }
        if set.kind == Kind::Spectrum && set.channels.iter().any(|channel| channel.complex) {
            set.kind = Kind::Frf;
        }
        contents.sets.push(set);
        tdms.sets.push(places);
    }
    Ok((contents, Box::new(tdms)))
}

/// The abscissa that a property such as `Sample Rate` says, that of the channel before that of the group and of the file.
fn rate(properties: &[&[(String, Property)]]) -> Axis {
    let said = |(name, value): &(String, Property)| {
        let value = match value {
            Property::Text(text) => text.trim().parse().ok(),
            other => other.number(),
        };
        match sampling(name, value?) {
            Some(Sampling::Step(step)) => Some(Axis::Even { start: 0.0, step }),
            _ => None,
        }
    };
    properties.iter().find_map(|list| list.iter().find_map(said)).unwrap_or(Axis::None)
}

impl Set {
    fn axis_unit_is_hertz(&self) -> bool {
        self.channels
            .iter()
            .any(|channel| channel.attribute("wf_xunit_string").is_some_and(|unit| unit.eq_ignore_ascii_case("hz")))
    }
}

fn channel(object: &Object, place: &Place, path: &Path) -> Read<Channel> {
    let text = |word: &str| match object.property(word) {
        Some(Property::Text(text)) => Some(text.clone()),
        _ => None,
    };
    let number = |word: &str| object.property(word).and_then(Property::number);
    let unit = text("unit_string").or_else(|| text("NI_UnitDescription")).unwrap_or_default();
    let mut channel = Channel::new(object.path[1].clone(), unit, object.count());
    channel.complex = object.complex;
    if let Some(step) = number("wf_increment").filter(|step| *step > 0.0 && step.is_finite()) {
        channel.axis = Axis::Even { start: number("wf_start_offset").unwrap_or(0.0), step };
    }
    channel.attributes.extend(object.properties.iter().take(60).map(|(name, value)| (name.clone(), value.to_string())));
    channel.first = first_numbers(&values::first(path, place, FIRST as u64)?);
    Ok(channel)
}

impl Source for Tdms {
    fn read(&self, set: usize, channel: usize) -> Read<Values> {
        let place = self.place(set, channel).ok_or_else(|| Fault::new("there is no such channel"))?;
        values::first(&self.path, place, u64::MAX)
    }

    fn together(&self, set: usize, channels: &[usize]) -> Option<Read<Vec<Values>>> {
        let places: Vec<&Place> = channels.iter().map(|&channel| self.place(set, channel)).collect::<Option<_>>()?;
        values::interleaved(&places).then(|| values::all(&self.path, &places))
    }
}

impl Tdms {
    fn place(&self, set: usize, channel: usize) -> Option<&Place> {
        self.sets.get(set).and_then(|set| set.get(channel))
    }
}
