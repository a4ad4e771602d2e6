//! `dashpot contents`: what is in measurement files, before anything is decided.

use super::arguments::Contents as Arguments;
use crate::exchange::importing::files::listed;
use crate::exchange::mapping::stepped;
use crate::math::numerals::compact;
use anyhow::ensure;
use dashpot_datafiles::{Channel, DataFile, Note, Number, Set, open};
use serde_json::{Map, Value, json};

/// Digits of the first values and of the sampling rate.
const DIGITS: usize = 6;
/// Most channels of a set in a listing for people.
const MOST_LISTED: usize = 40;

pub(super) fn run(arguments: &Arguments) -> anyhow::Result<String> {
    let files = listed(&arguments.files)?;
    ensure!(!files.is_empty(), "{}: the folder has no file", arguments.files[0].display());
    // One file alone must be readable; of several those that are not are told in their place.
    let alone = files.len() == 1 && !arguments.files[0].is_dir();
    let (mut entries, mut text) = (Vec::new(), String::new());
    for path in &files {
        match open(path) {
            Ok(file) => {
                text.push_str(&tree(&file));
                entries.push(entry(&file));
            }
            Err(error) if alone => return Err(error.into()),
            Err(error) => {
                text.push_str(&format!("{error}\n"));
                entries.push(json!({"file": path.display().to_string(), "error": error.to_string()}));
            }
        }
    }
    if !arguments.json {
        return Ok(text);
    }
    let document = if alone { entries.remove(0) } else { json!({ "files": entries }) };
    Ok(serde_json::to_string_pretty(&document)? + "\n")
}

fn entry(file: &DataFile) -> Value {
    let contents = file.contents();
    json!({
        "file": file.path().display().to_string(),
        "format": contents.format.word(),
        "sets": contents.sets.iter().map(set).collect::<Vec<_>>(),
        "notes": texts(&contents.notes),
        "looks_like": looks_like(file),
    })
}

/// What a table looks like where its columns say it: a stepped-sine test.
fn looks_like(file: &DataFile) -> Option<String> {
    stepped(file).map(|table| table.words())
}

fn set(set: &Set) -> Value {
    json!({
        "name": set.name,
        "kind": set.kind.word(),
        "axis_unit": set.axis_unit,
        "channels": set.channels.iter().map(channel).collect::<Vec<_>>(),
        "notes": texts(&set.notes),
    })
}

fn texts(notes: &[Note]) -> Vec<&str> {
    notes.iter().map(|note| note.text.as_str()).collect()
}

fn channel(channel: &Channel) -> Value {
    let attributes: Map<String, Value> =
        channel.attributes.iter().map(|(word, value)| (word.clone(), json!(value))).collect();
    json!({
        "name": channel.name,
        "unit": channel.unit,
        "count": channel.count,
        "step": channel.axis.step(),
        "complex": channel.complex,
        "first": channel.first.iter().map(number).collect::<Vec<_>>(),
        "attributes": attributes,
    })
}

/// A number; those that are not finite are null.
fn number(number: &Number) -> Value {
    match number {
        Number::Real(value) => json!(value),
        Number::Complex(parts) => json!(parts),
    }
}

/// A file as a tree for people.
fn tree(file: &DataFile) -> String {
    let contents = file.contents();
    let mut text = format!("{} ({})\n", file.path().display(), contents.format.word());
    if let Some(what) = looks_like(file) {
        text.push_str(&format!("  looks like: {what}\n"));
    }
    for note in &contents.notes {
        text.push_str(&format!("  note: {note}\n"));
    }
    for set in &contents.sets {
        let name = if set.name.is_empty() { "(set)" } else { set.name.as_str() };
        text.push_str(&format!("  {name}: {}\n", set.kind.word()));
        let width =
            set.channels.iter().take(MOST_LISTED).map(|channel| channel.name.chars().count()).max().unwrap_or(0);
        for channel in set.channels.iter().take(MOST_LISTED) {
            text.push_str(&format!("    {}\n", line(channel, &set.axis_unit, width.min(48))));
        }
        if set.channels.len() > MOST_LISTED {
            text.push_str(&format!("    … and {} more channels\n", set.channels.len() - MOST_LISTED));
        }
        for note in set.notes.iter().take(8) {
            text.push_str(&format!("    note: {note}\n"));
        }
    }
    text
}

fn line(channel: &Channel, axis_unit: &str, width: usize) -> String {
    let unit = if channel.unit.is_empty() { String::new() } else { format!("[{}]", channel.unit) };
    let step = match channel.axis.step() {
        Some(step) if axis_unit == "s" => format!(", step {step} s ({} Hz)", compact(1.0 / step, DIGITS)),
        Some(step) => format!(", step {step} {axis_unit}"),
        None => String::new(),
    };
    let first: Vec<String> = channel
        .first
        .iter()
        .map(|number| match number {
            Number::Real(value) => compact(*value, DIGITS),
            Number::Complex(parts) => {
                let [re, im] = parts.map(|part| compact(part, DIGITS));
                format!("{re}{}{im}i", if im.starts_with('-') { "" } else { "+" })
            }
        })
        .collect();
    let dots = if channel.count > channel.first.len() as u64 { ", …" } else { "" };
    format!("{:width$}  {unit:8} {} values{step}: {}{dots}", channel.name, channel.count, first.join(", "))
}
