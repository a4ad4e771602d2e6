//! `dashpot compare`: model against measurement, error per run, channel and harmonic.

use super::arguments::Analysis;
use super::corrected::{correction, listed};
use super::records::compared;
use super::run_flags::{self, flags};
use super::table::{number, table};
use super::{identified, reduction};
use crate::control::Control;
use crate::diagnosis::compare::Unpredicted;
use crate::diagnosis::records::RecordComparison;
use crate::diagnosis::residual::branch::Branch;
use crate::diagnosis::residual::breakdown::Group;
use crate::diagnosis::residual::comparison::{ChannelComparison, HarmonicComparison, RunComparison};
use crate::diagnosis::residual::whiteness::Whiteness;
use crate::diagnosis::updating::detuning::{Detuning, detuning};
use crate::diagnosis::{Comparison, DiagnosisError, Problem, compare};
use crate::exchange::{Project, project::load};
use crate::session::validation::{only_records, problem};
use crate::session::workers::Threads;
use crate::structure::Structure;
use anyhow::Context;
use faer::c64;
use serde_json::{Value, json};
use std::path::Path;
use std::sync::Arc;

/// Probability of chance below which a dependence is called one.
const SIGNIFICANT: f64 = 0.001;

/// Compares and prints.
pub(super) fn run(arguments: &Analysis) -> anyhow::Result<String> {
    let control = Control::unattended().with_workers(Arc::new(Threads));
    let mut project = load(&arguments.file, &control)?;
    super::remarks::tell_remarks(&project);
    reduction::warn(&project.structure);
    let records = compared(&project, &arguments.file, &control)?;
    if let Some(records) = records.as_ref().filter(|_| only_records(&project)) {
        return of_records(&project, records, arguments.json);
    }
    run_flags::check(&project, &arguments.file)?;
    let taken = identified::take_over(&mut project, arguments.identified, &arguments.file, &control)?;
    let comparison =
        compare(&problem(&project), &[], &control).with_context(|| arguments.file.display().to_string())?;
    let reading = reading(&project, &comparison, &control).with_context(|| arguments.file.display().to_string())?;
    if arguments.json {
        let mut document = document(&project, &comparison);
        document["reduction"] = reduction::document(&project.structure);
        if let Some(reading) = &reading {
            document["reading"] = read(&project, reading);
            if drowned(&comparison, reading) {
                document["reading"]["word"] = json!("noise");
            }
        }
        if !taken.is_empty() {
            document["identified"] = identified::document(&project, &taken);
        }
        if let Some(records) = &records {
            document["records"] = json!(super::records::document(&project, records));
        }
        document["record_findings"] = json!(run_flags::records(&project));
        return Ok(format!("{}\n", serde_json::to_string_pretty(&document)?));
    }
    let words = match &reading {
        Some(reading) if drowned(&comparison, reading) => DROWNED.to_owned(),
        Some(reading) => in_words(&project, reading),
        None => String::new(),
    };
    let records = records.map_or_else(String::new, |r| super::records::text(&project, &r));
    let reduced = reduction::text(&project.structure);
    Ok(format!("{}{reduced}{words}{}{records}", text(&project, &comparison), run_flags::text(&project)))
}

/// The error of a project of `file`, as its table says it.
pub(super) fn error(project: &Project, file: &Path, control: &Control) -> anyhow::Result<f64> {
    let records = if only_records(project) { compared(project, file, control)? } else { None };
    Ok(match records {
        Some(records) => records.error,
        None => compare(&problem(project), &[], control)?.error,
    })
}

/// Whether the model is detuned, told by the runs that it predicts.
fn reading(project: &Project, comparison: &Comparison, control: &Control) -> Result<Option<Detuning>, DiagnosisError> {
    let mut runs = project.runs.clone();
    comparison.unpredicted.iter().for_each(|run| runs[run.index].enabled = false);
    let found = detuning(&Problem { runs: &runs, ..problem(project) }, control)?;
    Ok(found.map(|reading| reading.beside(comparison.error, comparison.noise_floor)))
}

/// A project that holds nothing but records that are not steady.
fn of_records(project: &Project, records: &RecordComparison, json: bool) -> anyhow::Result<String> {
    if !json {
        let flags = run_flags::text(project);
        return Ok(format!("{}\n{}{flags}", project.title, super::records::text(project, records)));
    }
    let empty: [Value; 0] = [];
    let document = json!({
        "title": project.title, "of": measure(&project.structure), "error": records.error,
        "noise_floor": records.noise_floor, "energy_error": null, "runs": empty, "levels": empty, "channels": empty,
        "harmonics": empty, "whiteness": empty, "records": super::records::document(project, records), "record_findings": run_flags::records(project),
    });
    Ok(format!("{}\n", serde_json::to_string_pretty(&document)?))
}

/// Error from which on a model that is within the noise of its data says nothing of either.
const MOST_OF_IT: f64 = 0.5;
const DROWNED: &str = "the noise is as large as the signal: whether the model agrees cannot be said\n";

/// Whether an agreement is only that of a model with noise.
fn drowned(comparison: &Comparison, reading: &Detuning) -> bool {
    matches!(reading.reading.word(), "agrees" | "detuned") && comparison.error.min(comparison.noise_floor) > MOST_OF_IT
}

/// Whether the model is detuned or lacks an effect.
fn read(project: &Project, reading: &Detuning) -> Value {
    let corrections: Vec<Value> = reading.corrections.iter().map(|c| correction(project, c)).collect();
    json!({"word": reading.reading.word(), "share": reading.share, "error_after": reading.error_after,
           "corrections": corrections})
}

fn in_words(project: &Project, reading: &Detuning) -> String {
    let mut lines = format!("{}\n", reading.reading.sentence());
    if !reading.corrections.is_empty() {
        let [share, after] = [reading.share, reading.error_after].map(|x| number(100.0 * x));
        lines
            .push_str(&format!("corrections explain {share} % of the squared difference, error with them {after} %\n"));
        lines.push_str(&listed(project, &reading.corrections));
    }
    lines
}

/// What is compared and explained of a project.
/// The `[cos, sin]` parts of a complex amplitude.
fn parts(amplitude: c64) -> Value {
    json!([amplitude.re, -amplitude.im])
}

fn channel_document(channel: &ChannelComparison) -> Value {
    let harmonic = |h: &HarmonicComparison| {
        json!({"harmonic": h.harmonic, "measured": parts(h.measured), "model": parts(h.model),
               "standard_deviation": h.deviation})
    };
    let harmonics: Vec<Value> = channel.harmonics.iter().map(harmonic).collect();
    json!({"channel": channel.channel, "error": channel.error, "noise_floor": channel.noise_floor,
           "harmonics": harmonics})
}

fn run_document(project: &Project, run: &RunComparison) -> Value {
    let source = &project.runs[run.index];
    let mut entry = json!({
        "file": source.file,
        "frequency_hz": source.fit.omega / std::f64::consts::TAU,
        "level": source.level,
        "flags": flags(source),
        "findings": run_flags::findings(&source.findings),
        "session": source.session,
        "used": run.used,
        "error": run.error,
        "noise_floor": run.noise_floor,
        "energy_error": run.energy_error,
        "channels": run.channels.iter().map(channel_document).collect::<Vec<_>>(),
    });
    if let Some(branch) = run.branch {
        entry["branch"] = json!({
            "name": branch.name(), "stable": branch.stable, "all": branch.all, "unstable": branch.held
        });
    }
    entry
}

fn document(project: &Project, comparison: &Comparison) -> Value {
    let runs: Vec<Value> = comparison.runs.iter().map(|run| run_document(project, run)).collect();
    json!({
        "title": project.title,
        "of": measure(&project.structure),
        "error": comparison.error,
        "noise_floor": comparison.noise_floor,
        "energy_error": comparison.energy_error,
        "runs": runs,
        "unpredicted": comparison.unpredicted.iter().map(|run| named(project, run)).collect::<Vec<_>>(),
        "levels": groups("level", &comparison.levels),
        "channels": groups("channel", &comparison.channels),
        "harmonics": groups("harmonic", &comparison.harmonics),
        "whiteness": comparison.whiteness.iter().map(whiteness).collect::<Vec<_>>(),
    })
}

fn named(project: &Project, run: &Unpredicted) -> Value {
    json!({"file": project.runs[run.index].file, "reason": run.reason})
}

/// Errors by level, channel or harmonic.
fn groups(key: &str, groups: &[Group]) -> Vec<Value> {
    let entry = |g: &Group| json!({key: g.name, "error": g.error, "noise_floor": g.noise_floor, "runs": g.runs});
    groups.iter().map(entry).collect()
}

fn whiteness(test: &Whiteness) -> Value {
    json!({"of": test.of.word(), "statistic": test.statistic, "freedom": test.freedom, "probability": test.probability})
}

/// What the errors are errors of.
fn measure(structure: &Structure) -> &'static str {
    if structure.matrices().is_some() { "response" } else { "energy" }
}

fn text(project: &Project, comparison: &Comparison) -> String {
    let mut rows = vec![["run", "Hz", "error %", "energy error %", "worst channel", ""].map(str::to_owned).to_vec()];
    for run in &comparison.runs {
        let source = &project.runs[run.index];
        let worst = run.channels.iter().max_by(|a, b| a.error.total_cmp(&b.error));
        let worst = worst.map_or_else(String::new, |c| format!("{} {}", c.channel, number(100.0 * c.error)));
        let mut note = if run.used { String::new() } else { "not used".to_owned() };
        if let Some(branch) = run.branch {
            note.push_str(&in_note(branch));
        }
        let frequency = number(source.fit.omega / std::f64::consts::TAU);
        let errors = [run.error, run.energy_error].map(|e| number(100.0 * e));
        rows.push(vec![source.file.clone(), frequency, errors[0].clone(), errors[1].clone(), worst, note]);
    }
    let parts = [("level", &comparison.levels), ("channel", &comparison.channels), ("harmonic", &comparison.harmonics)];
    let parts: String = parts.into_iter().map(|(name, groups)| part(name, groups)).collect();
    let without =
        |run: &Unpredicted| format!("{}: not predicted, left out: {}\n", project.runs[run.index].file, run.reason);
    let unpredicted: String = comparison.unpredicted.iter().map(without).collect();
    let lead = match project.structure.matrices() {
        Some(_) => "",
        None => "Without mass and stiffness no response can be predicted: energies are compared.\n",
    };
    format!(
        "{}\n{lead}\n{}{}{unpredicted}{parts}\nerror of the {} {} %, noise floor {} %, energy error {} %\n{}",
        project.title,
        table(&rows),
        held(comparison),
        measure(&project.structure),
        number(100.0 * comparison.error),
        number(100.0 * comparison.noise_floor),
        number(100.0 * comparison.energy_error),
        comparison.whiteness.iter().map(sentence).collect::<String>(),
    )
}

/// Which of several motions of the model a run was compared with.
fn in_note(branch: Branch) -> String {
    if branch.held {
        format!("{} of {} motions, unstable under a constant force", branch.name(), branch.all)
    } else {
        format!("{} of {} stable motions", branch.name(), branch.stable)
    }
}

/// What runs say of their exciter that were compared with a motion which is unstable under a constant force.
fn held(comparison: &Comparison) -> String {
    let is_held = |run: &&RunComparison| run.branch.is_some_and(|branch| branch.held);
    let runs = match comparison.runs.iter().filter(is_held).count() {
        0 => return String::new(),
        1 => "1 run is".to_owned(),
        count => format!("{count} runs are"),
    };
    format!(
        "{runs} of a motion of the model that is unstable under a constant force: an exciter that yields, or a controller of the phase, \
         held it\n"
    )
}

/// Table of the errors by level, channel or harmonic, where there is more than one.
fn part(name: &str, groups: &[Group]) -> String {
    if groups.len() < 2 {
        return String::new();
    }
    let mut rows = vec![[name, "error %", "noise floor %"].map(str::to_owned).to_vec()];
    rows.extend(groups.iter().map(|g| vec![g.name.clone(), number(100.0 * g.error), number(100.0 * g.noise_floor)]));
    format!("\n{}", table(&rows))
}

/// What a test of whiteness says.
fn sentence(test: &Whiteness) -> String {
    let verdict = if test.probability < SIGNIFICANT { "depends" } else { "does not depend" };
    let chance = number(100.0 * test.probability);
    format!("what is left {verdict} on {} (by chance: {chance} %)\n", test.of.word())
}
