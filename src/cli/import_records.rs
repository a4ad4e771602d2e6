//! `dashpot import` of time records: a mapping of their channels, one run a file, of the kind that its record looks like.

use super::arguments_import::Import;
use super::import::{comment, head, named, points, project_file, write};
use super::import_refusal::refusal;
use super::import_single_mode::{SingleMode, single_mode};
use crate::control::Control;
use crate::exchange::mapping::{ChannelTable, Proposal, propose};
use crate::exchange::project::{plan, template};
use crate::measurement::{Kind, Part, Quantity, Record, frequency, proposal, steady_part};
use anyhow::{Context, bail, ensure};
use dashpot_datafiles::open;
use serde::Serialize;
use std::path::Path;

/// Fewest samples of a run.
const FEWEST: usize = 32;
/// Share of its largest size that a motion without a force keeps to the end where it is no decay.
const KEPT: f64 = 0.7;
/// Harmonics by which the steady part of a record is found.
const HARMONICS: usize = 3;

/// A table of a mapping, as it stands in a template or a project.
#[derive(Serialize)]
struct Mapping<'a> {
    channel: [&'a ChannelTable; 1],
}

/// What a record of the project looks like.
struct Looks {
    kind: Kind,
    part: Part,
    reason: String,
}

pub(super) fn run(arguments: &Import) -> anyhow::Result<String> {
    let mut mapping = mapping(arguments)?;
    if mapping.channels.is_empty() {
        mapping.channels = std::mem::take(&mut mapping.uncalibrated);
    }
    if mapping.channels.is_empty() {
        bail!("{}: {}", arguments.files[0].display(), refusal(open(&arguments.files[0])?.contents(), &mapping.left));
    }
    if arguments.propose {
        return proposal_text(&arguments.files[0], &mapping);
    }
    let first = arguments.files[0].display();
    ensure!(
        !mapping.needs_sampling || arguments.sampling_hz.is_some(),
        "{first}: the file does not say the time between samples; give it by --sampling-hz"
    );
    let out = project_file(arguments)?;
    let mut looks = looks_of(arguments, &mapping, &out)?;
    let forced = mapping.channels.iter().any(|table| matches!(table.quantity, Quantity::Force | Quantity::Base));
    let alone = !forced && arguments.mass.is_none() && arguments.map.is_none();
    let single = if alone { single_mode(&looks[0].0, &mut mapping) } else { None };
    if single.is_some() {
        looks = looks_of(arguments, &mapping, &out)?;
    }
    let text = project(arguments, &mapping, &out, &looks, single.as_ref())?;
    // The project must open before it is there.
    plan(&text, &out)?.load(&Control::unattended())?;
    write(&out, &text)?;
    Ok(summary(arguments, &mapping, &looks, single.as_ref(), &out))
}

fn mapping(arguments: &Import) -> anyhow::Result<Proposal> {
    let Some(path) = &arguments.map else { return Ok(propose(open(&arguments.files[0])?.contents())) };
    let name = path.display().to_string();
    let text = std::fs::read_to_string(path).with_context(|| format!("{name}: the template cannot be read"))?;
    Ok(Proposal { channels: template(&text, &name)?, ..Proposal::default() })
}

/// Every record by the mapping, and what it looks like.
fn looks_of(arguments: &Import, mapping: &Proposal, out: &Path) -> anyhow::Result<Vec<(Record, Looks)>> {
    let mut text = head(arguments, out, &points(&labels(mapping)), 0.5 * highest_rate(arguments)?)?;
    text.push_str(&channels(mapping)?);
    for file in &arguments.files {
        text.push_str(&run_table(arguments, &named(file, out)?));
    }
    let planned = plan(&text, out)?;
    let mut found = Vec::new();
    for index in 0..planned.runs.len() {
        let record = planned.record(index, &Control::unattended())?;
        let file = arguments.files[index].display();
        ensure!(
            record.len() >= FEWEST,
            "{file}: has {} samples, and a run needs {FEWEST}; export the whole record",
            record.len()
        );
        let looks = look(&record);
        found.push((record, looks));
    }
    Ok(found)
}

fn look(record: &Record) -> Looks {
    let proposal::Proposal { kind, mut part, mut reason } = proposal::propose(record);
    let forced = record.channels().iter().any(|channel| channel.quantity == Quantity::Force);
    if kind == Kind::Transient || kind == Kind::Decay && (forced || !keeps(record)) {
        return Looks { kind, part, reason };
    }
    if kind == Kind::Decay {
        // Blocks shorter than a period rise and fall with it.
        (part, reason) = (Part::default(), "no force is measured, and the motion keeps its size to the end".to_owned());
    }
    let found = frequency::estimate(record, HARMONICS);
    match found.and_then(|found| crate::measurement::fit(record, found.omega, HARMONICS)) {
        Ok(fit) => {
            if let Some(steady) = steady_part(record, &fit) {
                part = steady;
                reason = format!("{reason}; what is run up or down is left out");
            }
            Looks { kind: Kind::Steady, part, reason }
        }
        Err(error) => {
            Looks { kind: Kind::Transient, part: Part::default(), reason: format!("it is not steady: {error}") }
        }
    }
}

/// Whether every channel is nearly as large in the last eighth of a record as at its largest, by root mean squares about the mean.
fn keeps(record: &Record) -> bool {
    let size = |values: &[f64]| {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        (values.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / values.len() as f64).sqrt()
    };
    (0..record.channels().len()).all(|c| {
        let parts: Vec<f64> = record.samples(c).chunks(record.len().div_ceil(8)).map(size).collect();
        let most = parts.iter().copied().fold(0.0, f64::max);
        parts.last().is_none_or(|last| *last >= KEPT * most)
    })
}

/// Labels of the DOFs of a mapping.
fn labels(mapping: &Proposal) -> Vec<String> {
    let mut labels: Vec<String> = Vec::new();
    for table in &mapping.channels {
        if !labels.contains(&table.dof) && table.quantity != Quantity::Base {
            labels.push(table.dof.clone());
        }
    }
    labels
}

/// The tables `[[channel]]`, what was assumed above each.
fn channels(mapping: &Proposal) -> anyhow::Result<String> {
    let mut text = String::new();
    for table in &mapping.channels {
        for (_, what) in mapping.assumed.iter().filter(|(name, _)| *name == table.channel()) {
            text.push_str(&comment(&format!("Assumed: {what}.")));
        }
        text.push_str(&toml::to_string(&Mapping { channel: [table] })?);
        text.push('\n');
    }
    Ok(text)
}

/// Channels that are not used, as comments that become tables where their marks are taken away.
fn unused(mapping: &Proposal) -> anyhow::Result<String> {
    let mut text = String::new();
    for table in &mapping.uncalibrated {
        text.push_str(
            "# Not used, as nothing says what it measures; fill in quantity, dof, unit and factor (units a number):\n",
        );
        for line in toml::to_string(&Mapping { channel: [table] })?.lines() {
            text.push_str(&format!("# {line}\n"));
        }
        text.push('\n');
    }
    for (name, why) in &mapping.left {
        text.push_str(&comment(&format!("Not mapped: \"{name}\": {why}.")));
    }
    if !mapping.left.is_empty() {
        text.push('\n');
    }
    Ok(text)
}

fn run_table(arguments: &Import, file: &str) -> String {
    let mut text = format!("[[run]]\nfile = {}\n", toml::Value::from(file));
    if let Some(rate) = arguments.sampling_hz {
        text.push_str(&format!("sampling_hz = {rate:?}\n"));
    }
    text
}

fn project(
    arguments: &Import,
    mapping: &Proposal,
    out: &Path,
    looks: &[(Record, Looks)],
    single: Option<&SingleMode>,
) -> anyhow::Result<String> {
    let transient = looks.iter().any(|(_, looks)| looks.kind != Kind::Steady);
    let structure = match single {
        Some(single) => single.structure(),
        None if transient && arguments.mass.is_none() => format!(
            "{}{}",
            comment(
                "Decays and transients need mass and stiffness: give a finite-element model by --mass and --stiffness, or write \
                 a structure of kind \"beam\", \"chain\" or \"matrices\" in place of these points."
            ),
            points(&labels(mapping))
        ),
        None => points(&labels(mapping)),
    };
    let mut text = head(arguments, out, &structure, 0.5 * highest_rate(arguments)?)?;
    text.push_str(&channels(mapping)?);
    text.push_str(&unused(mapping)?);
    for (file, (_, looks)) in arguments.files.iter().zip(looks) {
        text.push_str(&comment(&format!("Kind {}: {}.", looks.kind.name(), looks.reason)));
        text.push_str(&run_table(arguments, &named(file, out)?));
        if looks.kind != Kind::Steady {
            text.push_str(&format!("kind = \"{}\"\n", looks.kind.name()));
        }
        for (key, time) in [("start_s", looks.part.start_s), ("end_s", looks.part.end_s)] {
            if let Some(time) = time {
                text.push_str(&format!("{key} = {:?}\n", (1e6 * time).round() / 1e6));
            }
        }
        text.push('\n');
    }
    Ok(text)
}

/// What was made of the files, for the user.
fn summary(
    arguments: &Import,
    mapping: &Proposal,
    looks: &[(Record, Looks)],
    single: Option<&SingleMode>,
    out: &Path,
) -> String {
    let mut text = String::new();
    for (name, what) in &mapping.assumed {
        text.push_str(&format!("assumed: {name}: {what}\n"));
    }
    for (name, why) in &mapping.left {
        text.push_str(&format!("not mapped: \"{name}\" ({why})\n"));
    }
    for (file, (_, looks)) in arguments.files.iter().zip(looks) {
        text.push_str(&format!("{}: {}: {}\n", file.display(), looks.kind.name(), looks.reason));
    }
    let steady = looks.iter().any(|(_, looks)| looks.kind == Kind::Steady);
    let model = arguments.mass.is_some() || single.is_some();
    let forced = mapping.channels.iter().any(|table| matches!(table.quantity, Quantity::Force | Quantity::Base));
    if let Some(single) = single {
        text.push_str(&format!("{}\n", single.words()));
    } else if !model && looks.iter().any(|(_, looks)| looks.kind != Kind::Steady) {
        text.push_str(
            "decays and transients need mass and stiffness: give a model by --mass, or fill in [structure]\n",
        );
    }
    if steady && !forced {
        text.push_str(
            "no force is measured: steady runs without one say nothing of energies; map the channel of the force\n",
        );
    }
    let count = |n: usize, what: &str| if n == 1 { format!("1 {what}") } else { format!("{n} {what}s") };
    let (runs, channels) = (count(arguments.files.len(), "run"), count(mapping.channels.len(), "channel"));
    format!("{text}{runs} of {channels} are in {}\n", out.display())
}

/// The mapping as text for a template; what is not mapped in comments.
fn proposal_text(file: &Path, mapping: &Proposal) -> anyhow::Result<String> {
    let mut text = format!("# Mapping of the channels of {}\n", file.display());
    if mapping.needs_sampling {
        text.push_str("# the file does not say the time between samples: give it by --sampling-hz\n");
    }
    text.push('\n');
    Ok(text + &channels(mapping)? + &unused(mapping)?)
}

/// Sampling rate of the first file, Hz.
fn highest_rate(arguments: &Import) -> anyhow::Result<f64> {
    let file = open(&arguments.files[0])?;
    let steps = file.contents().sets.iter().flat_map(|set| &set.channels).filter_map(|channel| channel.axis.step());
    let least = steps.filter(|step| *step > 0.0).fold(f64::INFINITY, f64::min);
    Ok(arguments.sampling_hz.unwrap_or(if least.is_finite() { 1.0 / least } else { 2000.0 }))
}
