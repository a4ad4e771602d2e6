//! Frequency responses as two real columns, real and imaginary part or magnitude and phase, become complex channels.
//!
//! ```text
//! H = re + i im,    H = A exp(i phi),    H = 10^(L / 20) exp(i phi) for L in dB
//! ```
//!
//! Columns belong together by their names ([`words`]); where these say nothing, the user says by [`Pairing`] that they
//! follow each other two by two. Phases without a unit are in radians where none is above 2 pi, else in degrees.

mod abscissa;
mod pairs;
mod source;
pub(crate) mod words;

pub(crate) use abscissa::among_channels;
use source::Joined;

use crate::axis::ascending;
use crate::contents::{Axis, Channel, Contents, FIRST, Kind, Number, Set};
use crate::error::Read;
use crate::source::Source;
use crate::units::{is_unit, reference_of_decibel};
use pairs::{Form, Pair};
use source::{Column, Conversion};
use std::f64::consts::{PI, TAU};
use uff::Values;
use words::{Said, Scale};

/// Columns that follow each other two by two, for files whose names do not say it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pairing {
    /// Real and imaginary part.
    RealImaginary,
    /// Magnitude and phase in degrees.
    MagnitudeDegrees,
    /// Magnitude and phase in radians.
    MagnitudeRadians,
    /// Level `20 log10` of the magnitude in dB and phase in degrees.
    DecibelDegrees,
    /// The same with the phase in radians.
    DecibelRadians,
}

impl Pairing {
    /// Words in projects, in the order of the variants.
    pub const WORDS: [&'static str; 5] = ["real-imag", "magnitude-deg", "magnitude-rad", "db-deg", "db-rad"];

    /// The pairing of a word.
    pub fn from_word(word: &str) -> Option<Self> {
        let all = [
            Self::RealImaginary,
            Self::MagnitudeDegrees,
            Self::MagnitudeRadians,
            Self::DecibelDegrees,
            Self::DecibelRadians,
        ];
        Self::WORDS.iter().position(|&known| known == word).map(|i| all[i])
    }

    /// Its word.
    pub fn word(self) -> &'static str {
        Self::WORDS[self as usize]
    }

    fn conversion(self) -> Conversion {
        let degrees = matches!(self, Self::MagnitudeDegrees | Self::DecibelDegrees);
        let to_radians = if degrees { PI / 180.0 } else { 1.0 };
        match self {
            Self::RealImaginary => Conversion::Cartesian,
            Self::MagnitudeDegrees | Self::MagnitudeRadians => Conversion::Polar { decibel: None, to_radians },
            Self::DecibelDegrees | Self::DecibelRadians => Conversion::Polar { decibel: Some(1.0), to_radians },
        }
    }
}

/// Joins the columns whose names say that they are parts of complex numbers.
pub(crate) fn by_name(mut contents: Contents, source: Box<dyn Source>) -> Read<(Contents, Box<dyn Source>)> {
    let mut columns = Vec::new();
    let mut any = false;
    for (s, set) in contents.sets.iter_mut().enumerate() {
        let names = if usable(set) { pairs::names(set) } else { Vec::new() };
        let mut found = if names.is_empty() { Vec::new() } else { pairs::by_name(set, &names) };
        // Without frequencies only columns that say both parts are taken.
        found.retain(|pair| set.kind == Kind::Spectrum || pair.columns.iter().all(|&c| names[c].part.is_some()));
        let mut conversions = Vec::new();
        for pair in &found {
            conversions.push(conversion(s, set, *pair, &names, source.as_ref())?);
        }
        if let (true, Some(assumed)) = (!found.is_empty(), assumed_phase(&found, set, &names, &conversions)) {
            set.notes.push(assumed.into());
        }
        any |= !found.is_empty();
        columns.push(joined(set, &found, &names, &conversions));
    }
    if !any {
        return Ok((contents, source));
    }
    Ok((contents, Box::new(Joined::new(source, columns))))
}

/// Joins the columns of every set two by two; an abscissa that is not said to be one is the first column, in Hz.
pub(crate) fn in_turn(
    mut contents: Contents,
    source: Box<dyn Source>,
    pairing: Pairing,
) -> Read<(Contents, Box<dyn Source>)> {
    let form = if pairing == Pairing::RealImaginary { Form::RealImaginary } else { Form::MagnitudePhase };
    let mut columns = Vec::new();
    for (s, set) in contents.sets.iter_mut().enumerate() {
        let mut real: Vec<usize> = (0..set.channels.len()).filter(|&c| !set.channels[c].complex).collect();
        let mut axis = None;
        if matches!(set.kind, Kind::Table | Kind::Time) {
            let named = set.kind == Kind::Time && set.channels.iter().any(|channel| channel.axis != Axis::None);
            if !named && real.len() % 2 == 1 && rises(s, real[0], source.as_ref())? {
                axis = Some(real.remove(0));
            }
            set.kind = if named || axis.is_some() { Kind::Spectrum } else { Kind::Table };
            if set.kind == Kind::Spectrum {
                "Hz".clone_into(&mut set.axis_unit);
            }
        }
        if !matches!(set.kind, Kind::Spectrum | Kind::Table) {
            real.clear();
        }
        let names: Vec<Said> = set.channels.iter().map(|channel| words::said(&channel.name)).collect();
        real.retain(|&c| !names[c].coherence);
        let found = pairs::in_turn(&real, form);
        let conversions = vec![pairing.conversion(); found.len()];
        let mut made = joined(set, &found, &names, &conversions);
        if let Some(axis) = axis {
            take_axis(set, &mut made, axis);
        }
        columns.push(made);
    }
    Ok((contents, Box::new(Joined::new(source, columns))))
}

fn rises(set: usize, channel: usize, source: &dyn Source) -> Read<bool> {
    Ok(matches!(source.read(set, channel)?, Values::Real(values) if values.len() > 1 && ascending(&values)))
}

/// Makes a channel the abscissa of those of its set.
fn take_axis(set: &mut Set, columns: &mut Vec<Column>, axis: usize) {
    let Some(at) = columns.iter().position(|column| *column == Column::Plain(axis)) else { return };
    columns.remove(at);
    let count = set.channels.remove(at).count;
    for (channel, column) in set.channels.iter_mut().zip(columns.iter_mut()) {
        if channel.count == count {
            channel.axis = Axis::Stored { step: None };
            *column = Column::WithAxis(Box::new(column.clone()), axis);
        }
    }
}

fn usable(set: &Set) -> bool {
    matches!(set.kind, Kind::Spectrum | Kind::Table)
        && set.channels.len() > 1
        && set.channels.iter().all(|channel| !channel.complex)
}

/// How the numbers of a pair become complex.
fn conversion(s: usize, set: &Set, pair: Pair, names: &[Said], source: &dyn Source) -> Read<Conversion> {
    if pair.form == Form::RealImaginary {
        return Ok(Conversion::Cartesian);
    }
    let unit = |c: usize| names[c].unit.clone().unwrap_or_else(|| set.channels[c].unit.clone());
    let [size, phase] = pair.columns;
    let real = |c: usize| -> Read<Vec<f64>> {
        Ok(match source.read(s, c)? {
            Values::Real(values) => values,
            Values::Complex(values) => values.into_iter().map(|[re, _]| re).collect(),
        })
    };
    let stated = reference_of_decibel(&unit(size)).map(|(_, reference)| reference);
    let decibel = match stated {
        Some(reference) => Some(reference),
        None if names[size].scale == Some(Scale::Decibel) => Some(1.0),
        // No magnitude is below zero.
        None => real(size)?.iter().any(|value| *value < 0.0).then_some(1.0),
    };
    let said = match unit(phase).trim().to_lowercase().as_str() {
        "rad" | "radian" | "radians" => Some(Scale::Radians),
        "" | "-" | "eu" => names[phase].scale.filter(|scale| *scale != Scale::Decibel),
        _ => Some(Scale::Degrees),
    };
    let radians = match said {
        Some(scale) => scale == Scale::Radians,
        None => real(phase)?.iter().all(|value| value.is_nan() || value.abs() <= TAU),
    };
    Ok(Conversion::Polar { decibel, to_radians: if radians { 1.0 } else { PI / 180.0 } })
}

/// What was assumed of phases without a unit.
fn assumed_phase(pairs: &[Pair], set: &Set, names: &[Said], conversions: &[Conversion]) -> Option<String> {
    let bare = |pair: &Pair| {
        let phase = pair.columns[1];
        pair.form == Form::MagnitudePhase
            && set.channels[phase].unit.is_empty()
            && names[phase].unit.is_none()
            && names[phase].scale.is_none()
    };
    let (_, conversion) = pairs.iter().zip(conversions).find(|(pair, _)| bare(pair))?;
    let Conversion::Polar { to_radians, .. } = conversion else { return None };
    let unit = if *to_radians == 1.0 { "radians" } else { "degrees" };
    Some(format!("the phases have no unit: by their size they are taken in {unit}"))
}

/// Replaces the columns of each pair by one complex channel at the place of the first.
fn joined(set: &mut Set, pairs: &[Pair], names: &[Said], conversions: &[Conversion]) -> Vec<Column> {
    let old = std::mem::take(&mut set.channels);
    let mut columns = Vec::new();
    for (c, channel) in old.iter().enumerate() {
        match pairs.iter().position(|pair| pair.columns.contains(&c)) {
            None => {
                set.channels.push(channel.clone());
                columns.push(Column::Plain(c));
            }
            Some(p) if pairs[p].columns[0].min(pairs[p].columns[1]) == c => {
                let several = if pairs.len() > 1 { Some(p + 1) } else { None };
                set.channels.push(complex(&old, pairs[p], names, conversions[p], several));
                columns.push(Column::Pair(pairs[p].columns, conversions[p]));
            }
            Some(_) => {}
        }
    }
    // Complex numbers of the file itself are what it says that they are, such as a power spectrum.
    if !pairs.is_empty() && set.kind == Kind::Spectrum && set.channels.iter().any(|channel| channel.complex) {
        set.kind = Kind::Frf;
    }
    columns
}

/// The entry of a complex channel.
fn complex(old: &[Channel], pair: Pair, names: &[Said], conversion: Conversion, number: Option<usize>) -> Channel {
    let [a, b] = pair.columns.map(|c| &old[c]);
    let mut channel = a.clone();
    let rest = pair.columns.map(|c| names[c].rest.as_str()).into_iter().find(|rest| !rest.is_empty());
    channel.name = match (rest, number) {
        (Some(rest), _) => rest.to_owned(),
        (None, Some(number)) => format!("FRF {number}"),
        (None, None) => "FRF".to_owned(),
    };
    let unit = |c: usize| names[c].unit.clone().unwrap_or_else(|| old[c].unit.clone());
    channel.unit = match pair.form {
        Form::RealImaginary => {
            pair.columns.map(unit).into_iter().find(|unit| is_unit(unit)).unwrap_or_else(|| unit(pair.columns[0]))
        }
        Form::MagnitudePhase => {
            let own = unit(pair.columns[0]);
            reference_of_decibel(&own).map_or(own, |(unit, _)| unit)
        }
    };
    channel.complex = true;
    channel.attributes.push(("columns".to_owned(), format!("{}, {}", a.name, b.name)));
    let first = a.first.iter().zip(&b.first).take(FIRST).map(|(a, b)| Number::Complex(conversion.of(re(*a), re(*b))));
    channel.first = first.collect();
    channel
}

fn re(number: Number) -> f64 {
    match number {
        Number::Real(value) => value,
        Number::Complex([re, _]) => re,
    }
}

/// The unit of an array whose name says which part of frequency responses it holds, out of the one that is stated for all of
/// them: `dB re UNIT` of levels; none of phases, coherences, other arrays, or where there is no single unit over another.
pub(crate) fn unit_of_part(name: &str, stated: &[String]) -> Option<String> {
    let [unit] = stated else { return None };
    let said = words::said(name);
    if !unit.contains('/') || !is_unit(unit) {
        return None;
    }
    match (said.scale, said.part) {
        _ if said.coherence => Some(String::new()),
        (_, Some(words::Part::Phase)) => Some(String::new()),
        (Some(Scale::Decibel), _) => Some(format!("dB re {unit}")),
        (_, Some(_)) => Some(unit.clone()),
        _ => None,
    }
}

/// Whether the name of an array says that it holds a part of frequency responses, or coherences.
pub(crate) fn is_part(name: &str) -> bool {
    let said = words::said(name);
    said.part.is_some() || said.coherence
}

/// Whether a name is that of a coherence.
pub fn is_coherence(name: &str) -> bool {
    words::said(name).coherence
}

/// What a name says beside words for parts, responses and coherences, for comparing.
pub fn core_of(name: &str) -> String {
    words::said(name).core
}

#[cfg(test)]
mod tests;
