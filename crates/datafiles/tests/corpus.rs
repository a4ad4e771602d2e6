//! Every file of the corpus is read to the last bit of what wrote it (scripts/interchange/make_corpus.py).
#![allow(clippy::unwrap_used, reason = "tests")]

use dashpot_datafiles::{DataFile, Number, Values, open};
use serde_json::Value;
use std::path::Path;

fn corpus() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus")
}

/// A hexadecimal number of Python, such as `-0x1.8p+1`.
fn hex(text: &str) -> f64 {
    let (sign, text) = text.strip_prefix('-').map_or((1.0, text), |text| (-1.0, text));
    let Some(text) = text.strip_prefix("0x") else { return text.parse().unwrap() };
    let (mantissa, exponent) = text.split_once('p').unwrap();
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits = u64::from_str_radix(&format!("{whole}{fraction}"), 16).unwrap();
    sign * digits as f64 * 2f64.powi(exponent.parse::<i32>().unwrap() - 4 * fraction.len() as i32)
}

fn expected(values: &Value) -> Vec<[f64; 2]> {
    let complex_value = |value: &Value| match value {
        Value::String(text) => [hex(text), 0.0],
        pair => [hex(pair[0].as_str().unwrap()), hex(pair[1].as_str().unwrap())],
    };
    values.as_array().unwrap().iter().map(complex_value).collect()
}

fn pairs(values: Values) -> Vec<[f64; 2]> {
    match values {
        Values::Real(values) => values.into_iter().map(|value| [value, 0.0]).collect(),
        Values::Complex(values) => values,
    }
}

#[allow(clippy::too_many_lines, reason = "one list of what every file of the corpus must hold")]
fn check(name: &str, file: &DataFile, entry: &Value) -> Vec<String> {
    let contents = file.contents();
    let mut wrong = Vec::new();
    if contents.format.word() != entry["format"].as_str().unwrap() {
        wrong.push(format!("{name}: format {} for {}", contents.format.word(), entry["format"]));
    }
    let channels = entry["channels"].as_array().unwrap();
    let listed: usize = contents
        .sets
        .iter()
        .map(|set| set.channels.iter().filter(|channel| channel.name != "t" && channel.name != "time").count())
        .sum();
    let extra = name == "v5.mat" || name == "v7.mat";
    if listed != channels.len() && !extra {
        let names: Vec<String> = contents
            .sets
            .iter()
            .flat_map(|set| set.channels.iter().map(|c| format!("{}|{}", set.name, c.name)))
            .collect();
        wrong.push(format!("{name}: {listed} channels for {}: {}", channels.len(), names.join(", ")));
    }
    for channel in channels {
        let text = |i: usize| channel[i].as_str().unwrap();
        let found = contents.sets.iter().enumerate().find_map(|(s, set)| {
            let c = set.channels.iter().position(|c| set.name == text(0) && c.name == text(1))?;
            Some((s, c))
        });
        let Some((s, c)) = found else {
            wrong.push(format!("{name}: no channel {} in {}", channel[1], channel[0]));
            continue;
        };
        let listed = &contents.sets[s].channels[c];
        if listed.unit != text(2) {
            wrong.push(format!("{name}: {}: unit \"{}\" for {}", text(1), listed.unit, channel[2]));
        }
        if listed.axis.step().map(|step| (step * 1e12).round()) != channel[3].as_f64().map(|step| (step * 1e12).round())
        {
            wrong.push(format!("{name}: {}: step {:?} for {}", text(1), listed.axis.step(), channel[3]));
        }
        let values = match file.read(s, c) {
            Ok(values) => pairs(values),
            Err(error) => {
                wrong.push(format!("{name}: {error}"));
                continue;
            }
        };
        if values != expected(&channel[4]) {
            wrong.push(format!("{name}: {}: values {values:?}", text(1)));
        }
        if listed.count != values.len() as u64 {
            wrong.push(format!("{name}: {}: count {} and {} values", text(1), listed.count, values.len()));
        }
        let first: Vec<[f64; 2]> = listed
            .first
            .iter()
            .map(|number| match number {
                Number::Real(value) => [*value, 0.0],
                Number::Complex(parts) => *parts,
            })
            .collect();
        if first[..] != values[..values.len().min(3)] {
            wrong.push(format!("{name}: {}: first {first:?}", text(1)));
        }
        match file.axis(s, c) {
            Ok(Some(axis)) if axis.len() != values.len() => {
                wrong.push(format!("{name}: {}: axis of {}", text(1), axis.len()));
            }
            Ok(_) => {}
            Err(error) => wrong.push(format!("{name}: {error}")),
        }
    }
    wrong
}

#[test]
fn every_file_reads_as_it_was_written() {
    let expected: Value =
        serde_json::from_str(&std::fs::read_to_string(corpus().join("expected.json")).unwrap()).unwrap();
    let mut wrong = Vec::new();
    for (name, entry) in expected.as_object().unwrap() {
        match open(&corpus().join(name)) {
            Ok(file) => wrong.extend(check(name, &file, entry)),
            Err(error) => wrong.push(error.to_string()),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn what_is_not_read_is_said() {
    let notes = |name: &str| {
        let file = open(&corpus().join(name)).unwrap();
        let sets = file.contents().sets.iter();
        sets.flat_map(|set| set.notes.clone())
            .chain(file.contents().notes.clone())
            .map(|note| note.text)
            .collect::<Vec<_>>()
            .join("\n")
    };
    assert!(notes("cells.mat").contains("\"s\" is not read: it is sparse"), "{}", notes("cells.mat"));
    // Single numbers among texts are words; so many that they are measured are refused.
    let mixed = notes("mixed-cells.mat");
    assert!(mixed.contains("sensors: force, acc, 12, 3, +Z, -Z"), "{mixed}");
    assert!(mixed.contains("\"log\" is not read: its 300 numbers"), "{mixed}");
    assert!(notes("plain.tdms").contains("\"words\" is not read: it is text"), "{}", notes("plain.tdms"));
    assert!(notes("broken-off.tdms").contains("broken off"), "{}", notes("broken-off.tdms"));
    assert!(notes("units-row-latin1.csv").contains("Prüfer: Müller"), "{}", notes("units-row-latin1.csv"));
}
