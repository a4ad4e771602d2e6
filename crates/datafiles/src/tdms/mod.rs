//! TDMS files of LabVIEW and NI-DAQmx: segments with metadata and raw data.
//!
//! Source: "TDMS File Format Internal Structure", National Instruments. Only metadata and a few values are read to make the
//! tree; a channel is read piece by piece from where its segments lie.

mod input;
mod objects;
mod scale;
mod segment;

use crate::bytes::room;
use crate::contents::{Axis, Channel, Contents, FIRST, Format, Kind, Set, first_numbers};
use crate::error::{Fault, Read};
use crate::source::Source;
use crate::tree::{Sampling, sampling};
use objects::{Object, Property, Run};
use scale::Scaling;
use std::fs::File;
use std::io::{BufReader, Read as _, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use uff::Values;

/// Bytes that are read at once from interleaved data.
const PIECE: u64 = 1 << 20;

struct Tdms {
    path: PathBuf,
    sets: Vec<Vec<Place>>,
}

/// A channel's data and what turns them into its numbers.
struct Place {
    runs: Vec<Run>,
    scaling: Scaling,
    complex: bool,
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
        set.notes.extend(group.properties.iter().take(30).map(|(name, value)| format!("{name}: {value}")));
        let mut places = Vec::new();
        for object in objects.iter().filter(|object| object.path.len() == 2 && object.path[0] == group.path[0]) {
            if let Some(why) = &object.skipped {
                set.notes.push(format!("\"{}\" is not read: {why}", object.path[1]));
                continue;
            }
            let scaling = [&object.properties[..], &group.properties, root]
                .iter()
                .find_map(|properties| Scaling::read(properties));
            let scaling = match scaling.unwrap_or(Ok(Scaling::default())) {
                Ok(scaling) => scaling,
                Err(what) => {
                    set.notes.push(format!("\"{}\" is not read: {what}", object.path[1]));
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
    channel.first = first_numbers(&read(path, place, FIRST as u64)?);
    Ok(channel)
}

/// The first `most` values of a channel.
fn read(path: &Path, place: &Place, most: u64) -> Read<Values> {
    let mut file = BufReader::new(File::open(path)?);
    let parts = if place.complex { 2 } else { 1 };
    let count: u64 = place.runs.iter().map(Run::total).fold(0, u64::saturating_add).min(most);
    let mut raw = room(count.saturating_mul(parts))?;
    for run in &place.runs {
        for chunk in 0..run.chunks {
            let left = most.saturating_sub(raw.len() as u64 / parts);
            if left == 0 {
                break;
            }
            let count = run.count_in(chunk).min(left);
            piece(&mut file, run, run.start + chunk * run.chunk, count, &mut raw)?;
        }
    }
    if place.complex {
        return Ok(Values::Complex(raw.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect()));
    }
    place.scaling.apply(&mut raw);
    Ok(Values::Real(raw))
}

/// `count` values from a byte on.
fn piece(file: &mut BufReader<File>, run: &Run, at: u64, count: u64, raw: &mut Vec<f64>) -> Read<()> {
    let (size, stride) = (run.size(), run.stride.max(1));
    file.seek(SeekFrom::Start(at))?;
    let rows = (PIECE / stride).max(1);
    let mut bytes = Vec::new();
    let mut done = 0;
    while done < count {
        let rows = rows.min(count - done);
        // The last row ends with the value, which may be the last of the file.
        let wanted = (rows - 1) * stride + size;
        bytes.clear();
        file.by_ref().take(wanted).read_to_end(&mut bytes)?;
        if (bytes.len() as u64) < wanted {
            return Err(Fault::byte(at, "the data end before their count does; the file was cut short: copy it again"));
        }
        if done + rows < count {
            file.seek_relative((stride - size) as i64)?;
        }
        for row in bytes.chunks(stride as usize) {
            run.value(&row[..size as usize], raw);
        }
        done += rows;
    }
    Ok(())
}

impl Source for Tdms {
    fn read(&self, set: usize, channel: usize) -> Read<Values> {
        let place = self.sets.get(set).and_then(|set| set.get(channel));
        read(&self.path, place.ok_or_else(|| Fault::new("there is no such channel"))?, u64::MAX)
    }
}
