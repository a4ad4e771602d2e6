//! `dashpot import`: a project out of laboratory files where they lie, by a mapping that is proposed or given.

use super::arguments::Import;
use super::{import_model, import_responses};
use crate::control::Control;
use crate::exchange::atomic::write_atomically;
use crate::exchange::mapping::{ChannelTable, Proposal, propose};
use crate::exchange::project::relocate::{canonical, renamed};
use crate::exchange::project::{plan, template};
use crate::measurement::Quantity;
use anyhow::{Context, bail, ensure};
use dashpot_datafiles::open;
use serde::Serialize;
use std::path::Path;

/// The tables of a mapping, as they stand in a template or a project.
#[derive(Serialize)]
struct Mapping<'a> {
    channel: &'a [ChannelTable],
}

pub(super) fn run(arguments: &Import) -> anyhow::Result<String> {
    if arguments.map.is_none() && import_responses::has_responses(&arguments.files[0])? {
        return import_responses::run(arguments);
    }
    let mapping = match &arguments.map {
        Some(path) => {
            let name = path.display().to_string();
            let text = std::fs::read_to_string(path).with_context(|| format!("{name}: the template cannot be read"))?;
            Proposal { channels: template(&text, &name)?, ..Proposal::default() }
        }
        None => propose(open(&arguments.files[0])?.contents()),
    };
    if arguments.propose {
        return proposal(&arguments.files[0], &mapping);
    }
    let Some(out) = &arguments.out else {
        bail!("name the project to write by --out project.toml, or see the mapping by --propose");
    };
    let first = arguments.files[0].display();
    ensure!(
        !mapping.channels.is_empty(),
        "{first}: no channel says by its name and unit what it measures; write a template by hand and give it by --map"
    );
    ensure!(
        !mapping.needs_sampling || arguments.sampling_hz.is_some(),
        "{first}: the file does not say the time between samples; give it by --sampling-hz"
    );
    let text = project(arguments, &mapping, out)?;
    // Every run must read before the project is there.
    let planned = plan(&text, out)?;
    for index in 0..planned.runs.len() {
        planned.record(index, &Control::unattended())?;
    }
    write(out, &text)?;
    let left = mapping.left.iter().map(|(name, why)| format!("not mapped: \"{name}\" ({why})\n")).collect::<String>();
    let (runs, channels) = (arguments.files.len(), mapping.channels.len());
    Ok(format!("{left}{runs} runs of {channels} channels are in {}\n", out.display()))
}

/// Writes the project.
pub(super) fn write(out: &Path, text: &str) -> anyhow::Result<()> {
    write_atomically(out, text.as_bytes()).with_context(|| format!("{}: the project cannot be written", out.display()))
}

/// Head of a project, its structure and candidates.
pub(super) fn head(arguments: &Import, out: &Path, labels: &[String], up_to_hz: f64) -> anyhow::Result<String> {
    let title = arguments.files[0].file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    let structure = if let Some(structure) = import_model::structure(arguments, out, up_to_hz)? {
        structure
    } else {
        let quoted: Vec<String> = labels.iter().map(|label| toml::Value::from(label.as_str()).to_string()).collect();
        format!("[structure]\nkind = \"points\"\ndofs = [{}]\n", quoted.join(", "))
    };
    Ok(format!(
        "[project]\nformat = 1\ntitle = {}\n\n{structure}\n[[candidates]]\nlaw = \"viscous\"\nwhere = \"each-translation\"\n\n",
        toml::Value::from(title)
    ))
}

/// Name of a file as the project at `out` refers to it.
pub(super) fn named(file: &Path, out: &Path) -> anyhow::Result<String> {
    if file.is_absolute() {
        return Ok(file.display().to_string());
    }
    let folder = out.parent().unwrap_or(Path::new(""));
    let to = canonical(folder).with_context(|| format!("{}: the folder is not there", folder.display()))?;
    let here = canonical(file.parent().unwrap_or(Path::new("")))?;
    let name = file.file_name().with_context(|| format!("{}: names no file", file.display()))?.to_string_lossy();
    Ok(renamed(&name, &here, &to))
}

/// The mapping as text for a template; what is not mapped in comments.
fn proposal(file: &Path, mapping: &Proposal) -> anyhow::Result<String> {
    let mut text = format!("# Mapping of the channels of {}\n", file.display());
    for (name, why) in &mapping.left {
        text.push_str(&format!("# not mapped: \"{name}\": {why}\n"));
    }
    if mapping.needs_sampling {
        text.push_str("# the file does not say the time between samples: give it by --sampling-hz\n");
    }
    Ok(text + "\n" + &toml::to_string(&Mapping { channel: &mapping.channels })?)
}

fn project(arguments: &Import, mapping: &Proposal, out: &Path) -> anyhow::Result<String> {
    let mut labels: Vec<String> = Vec::new();
    for table in &mapping.channels {
        if !labels.contains(&table.dof) && table.quantity != Quantity::Base {
            labels.push(table.dof.clone());
        }
    }
    let mut text = head(arguments, out, &labels, 0.5 * highest_rate(arguments)?)?;
    text.push_str(&toml::to_string(&Mapping { channel: &mapping.channels })?);
    for file in &arguments.files {
        text.push_str(&format!("\n[[run]]\nfile = {}\n", toml::Value::from(named(file, out)?)));
        if let Some(rate) = arguments.sampling_hz {
            text.push_str(&format!("sampling_hz = {rate:?}\n"));
        }
    }
    Ok(text)
}

/// Sampling rate of the first file, Hz.
fn highest_rate(arguments: &Import) -> anyhow::Result<f64> {
    let file = open(&arguments.files[0])?;
    let steps = file.contents().sets.iter().flat_map(|set| &set.channels).filter_map(|channel| channel.axis.step());
    let least = steps.filter(|step| *step > 0.0).fold(f64::INFINITY, f64::min);
    Ok(arguments.sampling_hz.unwrap_or(if least.is_finite() { 1.0 / least } else { 2000.0 }))
}
