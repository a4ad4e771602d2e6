//! Words that files of arrays use for sampling rates, steps, units and names.

use super::{Array, Entry, Node};
use crate::contents::Number;

fn plain(name: &str) -> String {
    name.chars().filter(|c| c.is_alphanumeric()).collect::<String>().to_lowercase()
}

/// What a scalar says of the abscissa.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Sampling {
    Step(f64),
    Start(f64),
}

/// A sampling rate or step by the name of a scalar or an attribute.
pub(crate) fn sampling(name: &str, value: f64) -> Option<Sampling> {
    let usable = value.is_finite() && value > 0.0;
    match plain(name).as_str() {
        "fs" | "fsamp" | "fsample" | "fsampling" | "sr" | "samplerate" | "samplingrate" | "samplefrequency"
        | "samplingfrequency" | "fshz" | "sampleratehz" | "samplingratehz" | "samplinghz" | "samplingfreq"
        | "samplefreq"
            if usable =>
        {
            Some(Sampling::Step(1.0 / value))
        }
        "dt" | "ts" | "deltat" | "dts" | "step" | "timestep" | "sampleinterval" | "samplinginterval"
        | "sampleperiod" | "samplingperiod" | "wfincrement" | "xincrement" | "xinc" | "increment" | "dx" | "deltax"
        | "xdelta" | "xstep" | "xspacing" | "tinterval" | "tstep" | "timeinterval" | "timeincrement" | "sampletime"
        | "samplingtime" | "interval"
            if usable =>
        {
            Some(Sampling::Step(value))
        }
        "t0" | "x0" | "startvalue" | "xstart" | "xorg" | "tstart" | "start" | "starttime" if value.is_finite() => {
            Some(Sampling::Start(value))
        }
        _ => None,
    }
}

/// Whether a word names a unit.
pub(super) fn is_unit_word(name: &str) -> bool {
    matches!(
        plain(name).as_str(),
        "unit"
            | "units"
            | "unitstring"
            | "variableunits"
            | "unitlist"
            | "unitlabel"
            | "yunit"
            | "yunits"
            | "yunitlabel"
            | "channelunits"
            | "channelunit"
            | "sensorunits"
            | "signalunits"
            | "engineeringunits"
            | "eu"
    )
}

/// Whether a word names the names of channels.
pub(super) fn is_names_word(name: &str) -> bool {
    matches!(
        plain(name).as_str(),
        "names"
            | "labels"
            | "channels"
            | "channel"
            | "sensor"
            | "channelnames"
            | "channellabels"
            | "channelname"
            | "signals"
            | "signalnames"
            | "sensors"
            | "chnames"
            | "label"
            | "variablenames"
            | "columns"
            | "columnnames"
            | "varnames"
            | "fields"
            | "dofs"
            | "points"
            | "pointids"
    )
}

/// A scalar beside whole numbers that says what one of them is worth, such as `scale` or `lsb`.
pub(super) fn scale_beside(entries: &[Entry], first: &[Number]) -> Option<f64> {
    let whole = |number: &Number| matches!(number, Number::Real(value) if value.fract() == 0.0);
    if first.is_empty() || !first.iter().all(whole) {
        return None;
    }
    let named = |entry: &&Entry| {
        matches!(
            plain(&entry.name).as_str(),
            "scale" | "scalefactor" | "scaling" | "slope" | "lsb" | "conversionfactor"
        )
    };
    let scalar = |entry: &Entry| match &entry.node {
        Node::Array(array) => array.scalar(),
        _ => None,
    };
    entries.iter().filter(named).find_map(scalar).filter(|scale| scale.is_finite() && *scale != 0.0)
}

/// The unit among attributes.
pub(super) fn unit_of(attributes: &[(String, String)]) -> Option<&str> {
    attributes.iter().find(|(name, _)| is_unit_word(name)).map(|(_, value)| value.as_str())
}

/// The first text found under a path of names in a group.
pub(super) fn text_at<'a>(entries: &'a [Entry], path: &[&str]) -> Option<&'a str> {
    match &entry_at(entries, path)?.node {
        Node::Text(texts) => texts.first().map(String::as_str),
        _ => None,
    }
}

/// All texts found under a path of names in a group.
pub(super) fn texts_at<'a>(entries: &'a [Entry], path: &[&str]) -> &'a [String] {
    match entry_at(entries, path).map(|entry| &entry.node) {
        Some(Node::Text(texts)) => texts,
        _ => &[],
    }
}

/// Whether frequencies called `name` are in radians a second: by a text beside them, or by their own name.
pub(super) fn radians_beside(entries: &[Entry], name: &str) -> bool {
    let own = plain(name);
    let unit = [format!("{own}unit"), format!("{own}units"), "frequencyunit".to_owned()];
    let beside = entries.iter().find(|entry| unit.contains(&plain(&entry.name)));
    match beside.map(|entry| &entry.node) {
        Some(Node::Text(texts)) => texts.first().is_some_and(|text| text.to_lowercase().starts_with("rad")),
        _ => own.starts_with("omega") || name.trim() == "ω",
    }
}

/// The scalar under a path of names in a group.
pub(super) fn scalar_at(entries: &[Entry], path: &[&str]) -> Option<f64> {
    array_at(entries, path)?.scalar()
}

/// The array under a path of names in a group.
pub(super) fn array_at<'a>(entries: &'a [Entry], path: &[&str]) -> Option<&'a Array> {
    match &entry_at(entries, path)?.node {
        Node::Array(array) => Some(array),
        _ => None,
    }
}

fn entry_at<'a>(entries: &'a [Entry], path: &[&str]) -> Option<&'a Entry> {
    let (last, groups) = path.split_last()?;
    let mut entries = entries;
    for name in groups {
        match &entries.iter().find(|entry| entry.name == *name)?.node {
            Node::Group(inner) => entries = inner,
            _ => return None,
        }
    }
    entries.iter().find(|entry| entry.name == *last)
}

/// Adds what a group says of its only channel, such as its point, to what the channel itself says.
pub(super) fn add_missing(own: &mut Vec<(String, String)>, of_group: &[(String, String)]) {
    let known: Vec<String> = own.iter().map(|(name, _)| name.clone()).collect();
    own.extend(of_group.iter().filter(|(name, _)| !known.contains(name)).cloned());
}
