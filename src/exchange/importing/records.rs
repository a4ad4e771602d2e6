//! Import of time records: a mapping of their channels, one run a file or set, of the kind that its record looks like.

use super::driven;
use super::error::{ImportError, Result};
use super::looks::{Looks, look};
use super::model::head;
use super::names::proposed;
use super::numbers::placed;
use super::refusal::{cut_short, refusal, unsampled};
use super::request::{Imported, Request};
use super::roving;
use super::run_source::{RunSource, kinds};
use super::single_mode::{SingleMode, single_mode};
use super::text::{comment, named, points};
use crate::control::Control;
use crate::exchange::mapping::{ChannelTable, Proposal, runs_of};
use crate::exchange::project::plan;
use crate::math::numerals::counted;
use crate::measurement::channel::parse_name;
use crate::measurement::{Kind, Quantity, Record};
use dashpot_datafiles::open;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Fewest samples of a run.
const FEWEST: usize = 32;

/// The project of records by their mapping.
pub(super) fn import(request: &Request, mapping: Proposal, out: &Path, control: &Control) -> Result<Imported> {
    let mut mapping = usable(request, mapping)?;
    if request.kept.is_some() && request.channels.is_none() {
        mapping = placed(mapping, &head(request, out, "", 0.0)?, out)?;
    }
    if mapping.needs_sampling && request.sampling_hz.is_none() {
        return Err(ImportError::of(&request.files[0], unsampled(open(&request.files[0])?.contents())));
    }
    let mut sources = sources(request, &mapping)?;
    rove(request, &mut mapping, &mut sources)?;
    let (first, mut looks, powers) = looks_of(request, &mapping, &sources, out, control)?;
    driven::place(&mut mapping, &powers);
    let forced = mapping.channels.iter().any(|table| matches!(table.quantity, Quantity::Force | Quantity::Base));
    let alone = !forced && !request.has_model() && request.channels.is_none();
    let single = if alone { first.as_ref().and_then(|first| single_mode(first, &mut mapping)) } else { None };
    // Records may be as large as memory: none is kept while others are read.
    drop(first);
    if single.is_some() {
        looks = looks_of(request, &mapping, &sources, out, control)?.1;
    }
    let head = project_head(request, &mapping, out, &looks, single.as_ref())?;
    let tables = tables(request, &mapping, &sources, out, &looks)?;
    // The project must open before it is there.
    plan(&format!("{head}{tables}"), out).and_then(|plan| plan.load(control)).map_err(ImportError::Unwritten)?;
    let summary = summary(request, &mapping, &sources, &looks, single.as_ref(), out);
    Ok(Imported { head, tables, summary, remarks: Vec::new() })
}

/// Says of every run where a roving hammer hit, where the names of the runs and a model tell it.
fn rove(request: &Request, mapping: &mut Proposal, sources: &mut [RunSource]) -> Result<()> {
    let Some(kept) = request.kept.as_ref().filter(|_| request.channels.is_none()) else { return Ok(()) };
    let names: Vec<String> = sources.iter().map(RunSource::own_name).collect();
    if let Some((channel, labels)) = roving::places(mapping, &names, &kept.structure()?) {
        for (source, label) in sources.iter_mut().zip(labels) {
            source.force = Some((channel.clone(), label));
        }
    }
    Ok(())
}

/// The mapping as text for a template; what is not mapped in comments.
pub(super) fn template(request: &Request, mapping: Proposal, out: &Path) -> Result<String> {
    let mut mapping = usable(request, mapping)?;
    if request.kept.is_some() && request.channels.is_none() {
        mapping = placed(mapping, &head(request, out, "", 0.0)?, out)?;
    }
    let mut text = format!("# Mapping of the channels of {}\n", request.files[0].display());
    if mapping.needs_sampling {
        text.push_str("# the file does not say the time between samples: give it by --sampling-hz\n");
    }
    text.push('\n');
    Ok(text + &channels(&mapping) + &unused(&mapping))
}

/// The mapping that is given, else what the first file proposes.
pub(super) fn mapping(request: &Request) -> Result<Proposal> {
    if let Some(channels) = &request.channels {
        return Ok(Proposal { channels: channels.clone(), ..Proposal::default() });
    }
    let proposal = of_all_files(request)?;
    Ok(if request.has_model() { proposal } else { without_base(proposal) })
}

/// What the first file proposes; where some of its channels move from file to file (a hammer that is named by its place), what
/// all files propose, with those that some lack as optional.
fn of_all_files(request: &Request) -> Result<Proposal> {
    let own = |file: &PathBuf| proposed(request, file);
    let mut all = own(&request.files[0])?;
    let further = request.files[1..].iter().map(own).collect::<Result<Vec<Proposal>>>()?;
    let has = |proposal: &Proposal, name: &String| proposal.channels.iter().any(|table| table.name == *name);
    let everywhere = |name: &String| further.iter().all(|proposal| has(proposal, name));
    let fits = all.channels.iter().any(|table| everywhere(&table.name)) && all.further_runs.is_empty();
    if !fits || all.channels.iter().any(|table| table.set.is_some()) {
        return Ok(all);
    }
    for table in &mut all.channels {
        table.optional = !everywhere(&table.name);
    }
    for proposal in further {
        let fresh: Vec<ChannelTable> = proposal.channels.into_iter().filter(|table| !has(&all, &table.name)).collect();
        for table in fresh {
            let name = table.channel();
            all.assumed.extend(proposal.assumed.iter().filter(|(channel, _)| *channel == name).cloned());
            all.channels.push(ChannelTable { optional: true, ..table });
        }
    }
    Ok(all)
}

/// The proposal with a base that was told by its name as a sensor like others: without mass its motion loads nothing.
fn without_base(mut proposal: Proposal) -> Proposal {
    let told = |table: &&mut ChannelTable| table.quantity == Quantity::Base && parse_name(&table.name).is_err();
    for table in proposal.channels.iter_mut().filter(told) {
        let old = table.channel();
        (table.quantity, table.dof) = (Quantity::Acceleration, "base".to_owned());
        let name = table.channel();
        proposal.assumed.retain(|(channel, _)| *channel != old);
        let why = "by its name the motion of the base; its force is known with a model: give one by --mass, or by --map a project \
                   with a structure";
        proposal.assumed.push((name, why.to_owned()));
    }
    proposal
}

/// The mapping where something of it is mapped; channels in the unit of their sensor where nothing else moves.
pub(super) fn usable(request: &Request, mut mapping: Proposal) -> Result<Proposal> {
    if mapping.channels.is_empty() {
        mapping.channels = std::mem::take(&mut mapping.uncalibrated);
    }
    if mapping.channels.is_empty() {
        let why = refusal(open(&request.files[0])?.contents(), &mapping.left);
        return Err(ImportError::of(&request.files[0], why));
    }
    if let Some(cut) = cut_short(open(&request.files[0])?.contents(), &mapping) {
        return Err(ImportError::of(&request.files[0], cut));
    }
    if let Some((name, why)) = mapping.motion_of_another_rate() {
        let force = &mapping.channels[0].name;
        let problem = format!(
            "\"{name}\" and the force \"{force}\" are not recorded together: {why}; record or export all channels at one rate, \
             filtered before samples are left out"
        );
        return Err(ImportError::of(&request.files[0], problem));
    }
    Ok(mapping)
}

/// What becomes a run, in order.
pub(super) fn sources(request: &Request, mapping: &Proposal) -> Result<Vec<RunSource>> {
    let mut sources = Vec::new();
    for file in &request.files {
        let sets = runs_of(open(file)?.contents(), &mapping.channels);
        let part = |set| RunSource::new(file, set, Vec::new());
        match sets.len() {
            0 | 1 => sources.push(part(None)),
            _ => sources.extend(sets.into_iter().map(|set| part(Some(set)))),
        }
        for sets in further_runs(request, mapping, file)? {
            sources.push(RunSource::new(file, None, sets));
        }
    }
    Ok(sources)
}

/// The sets of further runs of a file, where its own mapping is that of all files.
fn further_runs(request: &Request, mapping: &Proposal, file: &Path) -> Result<Vec<Vec<String>>> {
    if request.files.first().is_some_and(|first| first == file) && request.channels.is_none() {
        return Ok(mapping.further_runs.clone());
    }
    let own = proposed(request, file)?;
    let place = |table: &ChannelTable| (table.name.clone(), table.set.clone(), table.channel());
    let alike = own.channels.len() == mapping.channels.len()
        && own.channels.iter().zip(&mapping.channels).all(|(own, table)| place(own) == place(table));
    Ok(if alike { own.further_runs } else { Vec::new() })
}

/// Powers of a force over the motions of a record, by the names of these.
type Powers = Vec<(String, f64)>;

/// The first record by the mapping, what every record looks like, and which motions take power in from its force.
fn looks_of(
    request: &Request,
    mapping: &Proposal,
    sources: &[RunSource],
    out: &Path,
    control: &Control,
) -> Result<(Option<Record>, Vec<Looks>, Vec<Powers>)> {
    let mut text = head(request, out, &points(&labels(mapping)), 0.5 * highest_rate(request)?)?;
    text.push_str(&channels(mapping));
    for source in sources {
        text.push_str(&run_table(request, source, out)?);
    }
    let planned = plan(&text, out).map_err(ImportError::Unwritten)?;
    let (mut first, mut found, mut powers) = (None, Vec::new(), Vec::new());
    for (index, source) in sources.iter().enumerate() {
        let record = planned.record(index, control).map_err(ImportError::Unwritten)?;
        if record.len() < FEWEST {
            let problem = format!("has {} samples, and a run needs {FEWEST}; export the whole record", record.len());
            return Err(ImportError::of(&source.file, problem));
        }
        found.push(look(&record));
        powers.push(driven::powers(&record));
        if index == 0 {
            first = Some(record);
        }
    }
    Ok((first, found, powers))
}

/// Labels of the DOFs of a mapping.
pub(super) fn labels(mapping: &Proposal) -> Vec<String> {
    let mut labels: Vec<String> = Vec::new();
    for table in &mapping.channels {
        if !labels.contains(&table.dof) && table.quantity != Quantity::Base {
            labels.push(table.dof.clone());
        }
    }
    labels
}

/// The tables `[[channel]]`, what was assumed above each.
pub(super) fn channels(mapping: &Proposal) -> String {
    let mut text = String::new();
    for table in &mapping.channels {
        for (_, what) in mapping.assumed.iter().filter(|(name, _)| *name == table.channel()) {
            text.push_str(&comment(&format!("Assumed: {what}.")));
        }
        text.push_str(&toml_of(table));
        text.push('\n');
    }
    text
}

fn toml_of(table: &ChannelTable) -> String {
    // A table of words and numbers always is TOML.
    toml::to_string(&BTreeMap::from([("channel", [table])])).unwrap_or_default()
}

/// Channels that are not used, as comments that become tables where their marks are taken away.
pub(super) fn unused(mapping: &Proposal) -> String {
    let mut text = String::new();
    for table in &mapping.uncalibrated {
        text.push_str(
            "# Not used, as nothing says what it measures; fill in quantity, dof, unit and factor (units a number):\n",
        );
        for line in toml_of(table).lines() {
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
    text
}

pub(super) fn run_table(request: &Request, source: &RunSource, out: &Path) -> Result<String> {
    let quoted = |text: &str| toml::Value::from(text).to_string();
    let mut text = format!("[[run]]\nfile = {}\n", quoted(&named(&source.file, out)?));
    if let Some(set) = &source.set {
        text.push_str(&format!("set = {}\n", quoted(set)));
    }
    if !source.sets.is_empty() {
        let sets: Vec<String> = source.sets.iter().map(|set| quoted(set)).collect();
        text.push_str(&format!("sets = [{}]\n", sets.join(", ")));
    }
    if let Some((channel, label)) = &source.force {
        text.push_str(&format!("dofs = {{ {} = {} }}\n", quoted(channel), quoted(label)));
    }
    if let Some(rate) = request.sampling_hz {
        text.push_str(&format!("sampling_hz = {rate:?}\n"));
    }
    Ok(text)
}

/// What else a force and a displacement at one point may be.
const COMPONENT: &str = "If this is one component in a testing machine, its displacement imposed and its force measured, write kind = \
                         \"component\" in place of both lines: `diagnose` then tries every law on whole loops.";

/// Whether nothing but one force and one displacement is measured, both at one point.
fn is_component_like(mapping: &Proposal) -> bool {
    let [a, b] = &mapping.channels[..] else { return false };
    let quantities = [a.quantity, b.quantity];
    a.dof == b.dof && quantities.contains(&Quantity::Force) && quantities.contains(&Quantity::Displacement)
}

fn project_head(
    request: &Request,
    mapping: &Proposal,
    out: &Path,
    looks: &[Looks],
    single: Option<&SingleMode>,
) -> Result<String> {
    let transient = looks.iter().any(|looks| looks.kind != Kind::Steady);
    let structure = match single {
        Some(single) => single.structure(),
        None if transient && !request.has_model() => format!(
            "{}{}",
            comment(
                "Decays and transients need mass and stiffness: give a finite-element model by --mass and --stiffness, or write \
                 a structure of kind \"beam\", \"chain\" or \"matrices\" in place of these points."
            ),
            points(&labels(mapping))
        ),
        None if is_component_like(mapping) => format!("{}{}", comment(COMPONENT), points(&labels(mapping))),
        None => points(&labels(mapping)),
    };
    head(request, out, &structure, 0.5 * highest_rate(request)?)
}

/// The mapping and the runs.
fn tables(request: &Request, mapping: &Proposal, sources: &[RunSource], out: &Path, looks: &[Looks]) -> Result<String> {
    let mut text = channels(mapping) + &unused(mapping);
    for (source, looks) in sources.iter().zip(looks) {
        text.push_str(&comment(&format!("Kind {}: {}.", looks.kind.name(), looks.reason)));
        text.push_str(&run_table(request, source, out)?);
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
    request: &Request,
    mapping: &Proposal,
    sources: &[RunSource],
    looks: &[Looks],
    single: Option<&SingleMode>,
    out: &Path,
) -> String {
    let mut text = String::new();
    let used = |name: &String| mapping.channels.iter().any(|table| table.channel() == *name);
    for (name, what) in mapping.assumed.iter().filter(|(name, _)| used(name)) {
        text.push_str(&format!("assumed: {name}: {what}\n"));
    }
    for (name, why) in &mapping.left {
        text.push_str(&format!("not mapped: \"{name}\" ({why})\n"));
    }
    text.push_str(&kinds(sources, looks));
    let steady = looks.iter().any(|looks| looks.kind == Kind::Steady);
    let model = request.has_model() || single.is_some();
    let forced = mapping.channels.iter().any(|table| matches!(table.quantity, Quantity::Force | Quantity::Base));
    if let Some(single) = single {
        text.push_str(&format!("{}\n", single.words()));
    } else if !model && looks.iter().any(|looks| looks.kind != Kind::Steady) {
        text.push_str(
            "decays and transients need mass and stiffness: give a model by --mass, or fill in [structure]\n",
        );
    }
    if steady && !forced {
        text.push_str(
            "no force is measured: steady runs without one say nothing of energies; map the channel of the force\n",
        );
    }
    let (runs, channels) = (counted(sources.len(), "run"), counted(mapping.channels.len(), "channel"));
    let are = if sources.len() == 1 { "is" } else { "are" };
    format!("{text}{runs} of {channels} {are} in {}\n", out.display())
}

/// Sampling rate of the first file, Hz.
fn highest_rate(request: &Request) -> Result<f64> {
    let file = open(&request.files[0])?;
    let steps = file.contents().sets.iter().flat_map(|set| &set.channels).filter_map(|channel| channel.axis.step());
    let least = steps.filter(|step| *step > 0.0).fold(f64::INFINITY, f64::min);
    Ok(request.sampling_hz.unwrap_or(if least.is_finite() { 1.0 / least } else { 2000.0 }))
}
