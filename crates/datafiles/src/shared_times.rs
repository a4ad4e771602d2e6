//! Times that lie in a part of their own, beside the channels that they are of: `X` and `Y` of a recording of dSPACE.

use crate::axis::{ascending, even_step, kind_of};
use crate::contents::{Axis, Channel, Contents, Format, Kind, Set};
use crate::error::Read;
use crate::gathered::parent;
use crate::source::Source;
use crate::tree::MOST_CHECKED;
use uff::Values;

/// The contents in which channels without times have those of a set beside theirs that is nothing but times, as long as they are
/// and the only one.
pub(crate) fn beside(mut contents: Contents, source: Box<dyn Source>) -> Read<(Contents, Box<dyn Source>)> {
    let holds_groups = matches!(contents.format, Format::Mat | Format::Hdf5 | Format::Tdms);
    if !holds_groups || contents.sets.len() < 2 {
        return Ok((contents, source));
    }
    let mut times = vec![None; contents.sets.len()];
    for s in 0..contents.sets.len() {
        let set = &contents.sets[s];
        let bare = |channel: &Channel| channel.axis == Axis::None && !channel.complex && channel.count > 1;
        if set.kind != Kind::Table || !set.channels.iter().all(bare) || abscissa(set).is_some() {
            continue;
        }
        let Some(count) = set.channels.first().map(|channel| channel.count) else { continue };
        let near = |other: &Set| parent(contents.format, &other.name) == parent(contents.format, &set.name);
        let gives_times = |other: &Set| near(other) && abscissa(other).is_some_and(|channel| channel.count == count);
        let mut found = (0..contents.sets.len()).filter(|&t| t != s && gives_times(&contents.sets[t]));
        if let (Some(t), None) = (found.next(), found.next())
            && set.channels.iter().all(|channel| channel.count == count)
            && count <= MOST_CHECKED
            && let Values::Real(values) = source.read(t, 0)?
            && ascending(&values)
        {
            times[s] = Some((t, even_step(&values)));
        }
    }
    if times.iter().all(Option::is_none) {
        return Ok((contents, source));
    }
    for (s, (t, step)) in times.iter().enumerate().filter_map(|(s, found)| Some((s, (*found)?))) {
        let (name, channel) = (contents.sets[t].name.clone(), contents.sets[t].channels[0].clone());
        let set = &mut contents.sets[s];
        set.kind = kind_of(&channel.name, &channel.unit).unwrap_or(Kind::Time);
        set.axis_unit = match (channel.unit.as_str(), set.kind) {
            ("", Kind::Time) => "s".to_owned(),
            ("", _) => "Hz".to_owned(),
            (unit, _) => unit.to_owned(),
        };
        set.channels.iter_mut().for_each(|channel| channel.axis = Axis::Stored { step });
        set.notes.insert(0, format!("its times are \"{}\" of {name}", channel.name).into());
    }
    let used: Vec<usize> = times.iter().flatten().map(|(t, _)| *t).collect();
    let kept: Vec<usize> = (0..contents.sets.len()).filter(|t| !used.contains(t)).collect();
    contents.sets = kept.iter().map(|&s| contents.sets[s].clone()).collect();
    let places = kept.into_iter().map(|s| (s, times[s].map(|(t, _)| t))).collect();
    Ok((contents, Box::new(WithTimes { below: source, places })))
}

/// The only channel of a set that is nothing but an abscissa.
fn abscissa(set: &Set) -> Option<&Channel> {
    let [channel] = &set.channels[..] else { return None };
    let own = channel.axis == Axis::None && !channel.complex;
    (own && kind_of(&channel.name, &channel.unit).is_some()).then_some(channel)
}

struct WithTimes {
    below: Box<dyn Source>,
    /// Each set below, and the set of its times.
    places: Vec<(usize, Option<usize>)>,
}

impl Source for WithTimes {
    fn read(&self, set: usize, channel: usize) -> Read<Values> {
        self.below.read(self.places[set].0, channel)
    }

    fn together(&self, set: usize, channels: &[usize]) -> Option<Read<Vec<Values>>> {
        self.below.together(self.places[set].0, channels)
    }

    fn axis(&self, set: usize, channel: usize) -> Read<Vec<f64>> {
        let (own, times) = self.places[set];
        let Some(times) = times else { return self.below.axis(own, channel) };
        match self.below.read(times, 0)? {
            Values::Real(values) => Ok(values),
            Values::Complex(_) => self.below.axis(own, channel),
        }
    }
}
