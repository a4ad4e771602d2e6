//! `dashpot diagnose`: which effect is missing, ranked, with evidence.

use super::arguments::Diagnose;
use super::corrected::{corrected, correction, is_telling, listed};
use super::mended_first::mended_first;
use super::run_flags::{self, flags};
use super::table::{number, table, with_deviation};
use super::{channel_faults, identified, run_differences, run_faults, source_json};
use crate::control::Control;
use crate::diagnosis::result::{CommonFactor, Diagnosis, Suggestion, TestKind};
use crate::diagnosis::updating::correction::as_force_gain;
use crate::display::findings;
use crate::effects::Source;
use crate::exchange::Project;
use crate::exchange::project::load;
use crate::session::adoption::Adoption;
use crate::session::save::text_after;
use crate::session::time_limit::answer_within;
use crate::session::validation::{diagnosed, only_records, problem};
use crate::session::workers::Threads;
use crate::session::{Document, Session};
use crate::structure::{Coupled, Structure};
use anyhow::Context;
use serde_json::{Value, json};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

/// Most pairs that a sentence lists.
const MOST_PAIRS: usize = 16;

/// Diagnoses, prints, and writes the project with the best suggestion where asked.
pub(super) fn run(arguments: &Diagnose) -> anyhow::Result<String> {
    let control = Control::unattended().with_workers(Arc::new(Threads));
    let mut project = load(&arguments.file, &control)?;
    super::remarks::tell_remarks(&project);
    if !only_records(&project) {
        run_flags::check(&project, &arguments.file)?;
    }
    let (mut taken, mut mended) = (Vec::new(), None);
    if identified::is_needed(&project, arguments.identified, &control) {
        (project, mended) = mended_first(project, &arguments.file, &control)?;
        taken = identified::identify_known(&mut project, arguments.identified, &arguments.file, &control)?;
    }
    if project.runs.iter().any(|run| run.is_used() && run.per_unit_force) {
        eprintln!("{}", channel_faults::NO_AMPLITUDE);
    }
    let early = |found: &[Suggestion]| eprint!("{}", first_words(&project.structure, found));
    if let Some(seconds) = arguments.seconds {
        answer_within(&control, &project, Duration::from_secs_f64(seconds));
    }
    let mut diagnosis = diagnosed(&project, &control, &early).with_context(|| arguments.file.display().to_string())?;
    let differences = run_differences::sentences(&project, &diagnosis, &control);
    let mut left_in_file = None;
    if let Some(out) = &arguments.apply {
        let document = match &mended {
            Some(mended) => mended.document.clone(),
            None => {
                Session::open(&arguments.file).with_context(|| arguments.file.display().to_string())?.document().clone()
            }
        };
        let written = Written { project: &project, document, taken: &taken };
        if !apply(&arguments.file, out, &written, &diagnosis)? {
            left_in_file = error_of(out, &control);
        }
    }
    if let Some(mended) = mended {
        mended.before(&project.sources, &mut diagnosis, &control)?;
    }
    let alternative = if taken.is_empty() { identified::Alternative::of(&project, &diagnosis, &control) } else { None };
    if arguments.json {
        let mut document = document(&project, &diagnosis);
        document["error_applied"] = json!(left_in_file);
        document["run_differences"] = json!(differences);
        document["identify_explains"] = json!(alternative.map(|alternative| alternative.document(&project)));
        if !taken.is_empty() {
            document["identified"] = identified::document(&project, &taken);
        }
        return Ok(format!("{}\n", serde_json::to_string_pretty(&document)?));
    }
    let written = arguments.apply.as_ref().map_or_else(String::new, |out| format!("\nWritten: {}.\n", out.display()));
    let alternative = alternative.map_or_else(String::new, |alternative| alternative.words(&project));
    let differences = run_differences::text(&differences);
    Ok(format!("{}{differences}{alternative}{}{written}", text(&project, &diagnosis), run_flags::text(&project)))
}

/// A project, and what was identified and taken as known beside what its file says.
struct Written<'a> {
    project: &'a Project,
    /// Its file.
    document: Document,
    taken: &'a [Source],
}

/// The first suggestions while the search goes on.
fn first_words(structure: &Structure, found: &[Suggestion]) -> String {
    let line = |s: &Suggestion| {
        format!("looking into {}: error {} %\n", s.added.source.title(structure), number(100.0 * s.error_after))
    };
    found.iter().take(3).map(line).collect()
}

fn suggestion(structure: &Structure, suggestion: &Suggestion) -> Value {
    let mut map = source_json::added(&suggestion.added, structure);
    let alike: Vec<Value> =
        suggestion.indistinguishable_from.iter().map(|s| Value::Object(source_json::of_effect(s, structure))).collect();
    map.insert("error_after".into(), json!(suggestion.error_after));
    map.insert("held_out_error_after".into(), json!(suggestion.held_out_error_after));
    map.insert("probability".into(), json!(suggestion.probability));
    map.insert("evidence".into(), json!(suggestion.evidence));
    map.insert("indistinguishable_from".into(), json!(alike));
    Value::Object(map)
}

fn document(project: &Project, diagnosis: &Diagnosis) -> Value {
    let structure = &project.structure;
    let run = |run: &crate::measurement::Run| {
        json!({"file": run.file, "frequency_hz": run.fit.omega / std::f64::consts::TAU, "flags": flags(run),
        "findings": run_flags::findings(&run.findings)})
    };
    let step = |step: &crate::diagnosis::result::Step| {
        let added: Vec<Value> = step.added.iter().map(|a| Value::Object(source_json::added(a, structure))).collect();
        json!({"added": added, "error": step.error, "misfit": step.misfit})
    };
    let test = |test: &crate::diagnosis::result::NextTest| {
        let displacement_m = match test.kind {
            TestKind::Release { displacement_m } => Some(displacement_m),
            _ => None,
        };
        let (base_times, driven) = match test.kind {
            TestKind::Base { times } => (Some(times), false),
            _ => (None, true),
        };
        json!({"kind": test.kind.word(), "frequency_hz": test.frequency_hz, "displacement_m": displacement_m,
               "force_dof": driven.then(|| structure.label(test.force_dof)), "force_n": driven.then_some(test.force),
               "base_times": base_times, "why": test.why})
    };
    let neighbours = structure.coupled().map(|coupled| neighbours(structure, &coupled));
    json!({
        "title": project.title,
        "neighbours": neighbours,
        "error_before": diagnosis.error_before,
        "noise_floor": diagnosis.noise_floor,
        "verdict": diagnosis.verdict.word(),
        "complete": diagnosis.complete,
        "searched_runs": (!diagnosis.runs.is_empty()).then_some(&diagnosis.runs),
        "runs": project.runs.iter().map(run).collect::<Vec<_>>(),
    "records": diagnosis.records.map(|r| json!({"error_before": r.error_before, "error_after": r.error_after,
            "noise_floor": r.noise_floor})),
        "test_errors": diagnosis.test_errors.map(|t| json!({"frequency_scatter": t.frequency_scatter, "error_left": t.error_left})),
        "record_findings": run_flags::records(project),
        "suggestions": channel_faults::suggestions(&diagnosis.channel_faults)
            .chain(diagnosis.suggestions.iter().map(|s| suggestion(structure, s)))
            .collect::<Vec<_>>(),
        "common_factors": diagnosis.common_factors.iter().map(common_factor).collect::<Vec<_>>(),
        "channel_faults": diagnosis.channel_faults.iter().map(channel_faults::document).collect::<Vec<_>>(),
        "run_faults": diagnosis.run_faults.iter().map(|fault| run_faults::document(fault, &project.runs)).collect::<Vec<_>>(),
        "not_looked_for": project.runs.iter().any(|run| run.is_used() && run.per_unit_force)
            .then_some(channel_faults::NO_AMPLITUDE),
        "steps": diagnosis.steps.iter().map(step).collect::<Vec<_>>(),
        "corrections": diagnosis.corrections.iter().map(|c| correction(project, c)).collect::<Vec<_>>(),
        "next_test": diagnosis.next_test.iter().map(test).collect::<Vec<_>>(),
    })
}

/// What all motions have in common against the corrected model at a frequency.
fn common_factor(factor: &CommonFactor) -> Value {
    json!({"frequency_hz": factor.frequency_hz, "gain": factor.gain, "lead_deg": factor.lead_deg})
}

/// Where no lines say which DOFs are neighbours: the pairs that were looked at, and where they come from.
fn neighbours(structure: &Structure, coupled: &Coupled) -> Value {
    let pairs: Vec<[&str; 2]> = coupled.pairs.iter().map(|pair| pair.map(|i| structure.label(i))).collect();
    json!({"from": if coupled.strongest_only { "strongest stiffness" } else { "stiffness" }, "pairs": pairs})
}

/// The same in a sentence.
fn neighbours_in_words(structure: &Structure, coupled: &Coupled) -> String {
    let pairs: Vec<String> = coupled
        .pairs
        .iter()
        .take(MOST_PAIRS)
        .map(|&[i, j]| format!("{}-{}", structure.label(i), structure.label(j)))
        .collect();
    let more = coupled.pairs.len().saturating_sub(MOST_PAIRS);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let what = if coupled.strongest_only {
        "the matrices couple nearly everything, and the strongest of each DOF are taken for"
    } else {
        "the pairs that the stiffness couples are taken for"
    };
    format!("\nno lines are given: {what} neighbours: {}{more}\n", pairs.join(", "))
}

fn text(project: &Project, diagnosis: &Diagnosis) -> String {
    let structure = &project.structure;
    let mut lines = format!(
        "{}\n\nerror {} %, noise floor {} %: {}\n",
        project.title,
        number(100.0 * diagnosis.error_before),
        number(100.0 * diagnosis.noise_floor),
        diagnosis.verdict.word()
    );
    lines.extend(findings::searched_runs(diagnosis).map(|sentence| sentence + "\n"));
    if !diagnosis.common_factors.is_empty() {
        lines.push_str(&format!("{}\n", findings::sentence(diagnosis)));
    }
    lines.push_str(&channel_faults::text(&diagnosis.channel_faults));
    lines.push_str(&run_faults::text(&diagnosis.run_faults, &project.runs));
    lines.push_str(&suggestions_in_words(structure, diagnosis));
    if !diagnosis.corrections.is_empty() {
        let detuned = diagnosis.corrections.iter().any(is_telling);
        lines.push_str(if detuned { "\nthe model is detuned; corrected beside that\n" } else { "\n" });
        lines.push_str(&listed(project, &diagnosis.corrections));
        lines.push_str(&force_gain(diagnosis));
    }
    if let Some(coupled) = structure.coupled() {
        lines.push_str(&neighbours_in_words(structure, &coupled));
    }
    lines + &steps_in_words(structure, diagnosis) + &records_in_words(diagnosis)
}

/// A table of the suggestions, with the evidence of the first.
fn suggestions_in_words(structure: &Structure, diagnosis: &Diagnosis) -> String {
    let Some(first) = diagnosis.suggestions.first() else { return String::new() };
    let mut rows = vec![["missing", "probability %", "error after %", "parameters"].map(str::to_owned).to_vec()];
    for s in &diagnosis.suggestions {
        let list = s.added.source.effect.parameters().iter().zip(&s.added.source.parameters);
        let values: Vec<String> =
            list.map(|(p, v)| format!("{} {} {}", p.name, number(*v), p.unit).trim_end().to_owned()).collect();
        let [probability, error] = [s.probability, s.error_after].map(|x| number(100.0 * x));
        rows.push(vec![s.added.source.title(structure), probability, error, values.join(", ")]);
    }
    let evidence: String = first.evidence.iter().map(|sentence| format!("  {sentence}\n")).collect();
    format!("\n{}{evidence}", table(&rows))
}

/// The error after each step, and what to test next.
fn steps_in_words(structure: &Structure, diagnosis: &Diagnosis) -> String {
    let mut lines = "\nsteps\n".to_owned();
    for (k, step) in diagnosis.steps.iter().enumerate() {
        let names: Vec<String> = step.added.iter().map(|a| a.source.title(structure)).collect();
        let without = if k == 0 { "the model as it is" } else { "the model corrected" };
        let what = if names.is_empty() { without.to_owned() } else { names.join(", ") };
        lines.push_str(&format!("  {} %  {what}\n", number(100.0 * step.error)));
    }
    if let Some(test) = diagnosis.test_errors {
        let [left, scatter] = [test.error_left, test.frequency_scatter].map(|x| number(100.0 * x));
        lines.push_str(&format!(
            "  {left} %  the same, every record with frequencies of its own, which differ by {scatter} %, every sensor with a gain\n"
        ));
    }
    for test in &diagnosis.next_test {
        lines.push_str(&format!("\nnext test: {}: {}\n", findings::next_test(structure, test), test.why));
    }
    lines
}

/// What equal factors on all mass and all stiffness are as well.
fn force_gain(diagnosis: &Diagnosis) -> String {
    as_force_gain(&diagnosis.corrections).filter(is_telling).map_or_else(String::new, |gain| {
        format!(
            "  one factor on all mass and all stiffness is as well a force channel that reads {} times the force: check its calibration\n",
            with_deviation(gain.factor, gain.deviation)
        )
    })
}

/// The errors of records beside steady runs.
fn records_in_words(diagnosis: &Diagnosis) -> String {
    let Some(records) = diagnosis.records else { return String::new() };
    let [before, after, floor] =
        [records.error_before, records.error_after, records.noise_floor].map(|x| number(100.0 * x));
    format!("\nrecords: error {before} % before, {after} % after, noise floor {floor} %\n")
}

/// What `compare` shows of a project that was written without all that was promised; said, for it is not the error that was told.
fn error_of(out: &Path, control: &Control) -> Option<f64> {
    let said = |why: String| eprintln!("{}: what it leaves is not known: {why}", out.display());
    let project = load(out, control).map_err(|error| said(error.to_string())).ok()?;
    let left = super::compare::error(&project, out, control).map_err(|error| said(error.to_string())).ok()?;
    eprintln!("{}: the project that was written, without that, leaves {} %", out.display(), number(100.0 * left));
    Some(left)
}

/// Writes the project with the best suggestion, or the set that it is of, added as `known`, and the corrections; comments
/// and everything else stay as they are. Whether all of it was written.
fn apply(file: &Path, out: &Path, written: &Written, diagnosis: &Diagnosis) -> anyhow::Result<bool> {
    let context = || file.display().to_string();
    let mut adoption = Adoption::new(&written.document);
    adoption.identified(written.taken).with_context(context)?;
    let known = problem(written.project).known();
    adoption.diagnosis(diagnosis, &known, written.project).with_context(context)?;
    tell_unwritten(&adoption, written.project, diagnosis);
    let folder = out.parent().unwrap_or(Path::new(""));
    let text = text_after(&adoption.document.file_in(folder)?, Some(file))?;
    crate::exchange::atomic::write_atomically(out, text.as_bytes()).with_context(|| out.display().to_string())?;
    Ok(adoption.is_complete())
}

/// Says what of a diagnosis was not written, and why.
fn tell_unwritten(adoption: &Adoption, project: &Project, diagnosis: &Diagnosis) {
    if let Some(k) = adoption.impossible {
        let said = corrected(project, &diagnosis.corrections[k]);
        eprintln!(
            "no correction is written: {} is no error of a model, and they were fitted together",
            said.trim_start()
        );
    }
    for &k in &adoption.left {
        eprintln!("not written, for want of a key for it:{}", corrected(project, &diagnosis.corrections[k]));
    }
    for (k, why) in &adoption.unmended {
        eprintln!("not written: {}: {why}", diagnosis.channel_faults[*k].words());
    }
    for (k, why) in &adoption.kept {
        eprintln!("not left out: {}: {why}", diagnosis.run_faults[*k].words(&project.runs));
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::diagnosis::result::{Step, Verdict};
    use crate::diagnosis::updating::correction::Correction;
    use crate::diagnosis::updating::parameters::UpdatingParameter;
    use crate::structure::Part;

    #[test]
    fn what_is_written_without_its_corrections_is_compared_anew() {
        let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("sample-data/five-masses-cubic/project.toml");
        let control = Control::unattended();
        let project = load(&sample, &control).unwrap();
        let document = || Session::open(&sample).unwrap().document().clone();
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out.toml");
        let found = |factor: f64| Diagnosis {
            verdict: Verdict::Unexplained,
            corrections: vec![Correction {
                parameter: UpdatingParameter::Structure(Part::Mass),
                factor,
                deviation: 0.1,
            }],
            ..Diagnosis::adequate(Step { added: Vec::new(), error: 0.01, misfit: 1.0 }, 0.001)
        };
        let written = |factor: f64| {
            let taken = Written { project: &project, document: document(), taken: &[] };
            apply(&sample, &out, &taken, &found(factor)).unwrap()
        };
        assert!(!written(8.0));
        let stated = super::super::compare::error(&project, &sample, &control).unwrap();
        let left = error_of(&out, &control).unwrap();
        assert!((left - stated).abs() < 1e-6 * stated, "{left} {stated}");
        assert!(written(1.1));
        assert!((error_of(&out, &control).unwrap() - stated).abs() > 1e-3 * stated);
        assert_eq!(error_of(&folder.path().join("none.toml"), &control), None);
    }
}
