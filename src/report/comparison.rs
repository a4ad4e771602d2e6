//! Chapters of the model against the measurement: errors, error map, suggestions with their evidence, ledger, next test.

use super::content::{Content, told_in_full};
use super::figures::{figure, sheet};
use super::page::Page;
use super::section::Section;
use crate::control::Control;
use crate::diagnosis::candidates::restoring_force::RestoringForce;
use crate::diagnosis::result::{Suggestion, Verdict};
use crate::diagnosis::updating::correction::Correction;
use crate::diagnosis::{Comparison, Diagnosis};
use crate::display::format::{chance, in_words, polished};
use crate::display::{findings, format, words};
use crate::effects::Parameter;
use crate::plots::channel_response::ChannelResponse;
use crate::plots::error_map::{ENERGY, Grid, Scale};
use crate::plots::response_curve::{curves, levels, neighbourhood};
use crate::plots::style::Palette;
use crate::plots::{fingerprint, restoring_force, samples};
use crate::session::validation::{only_records, problem};
use crate::structure::Structure;

/// Suggestions in the table.
const MOST_SUGGESTIONS: usize = 12;
/// Suggestions that are told in full.
const MOST_TOLD: usize = 6;

/// Adds them.
pub(super) fn chapters(page: &mut Page, content: &Content<'_>, control: &Control) {
    super::unsteady::chapter(page, content);
    if content.project.runs.is_empty() && content.records.is_none() {
        return;
    }
    if !only_records(content.project) {
        steady(page, content, control);
    }
    if let Some(diagnosis) = &content.diagnosis {
        page.chapter(Section::Missing, "What is missing?");
        match diagnosis {
            Ok(found) => missing(page, content, found),
            Err(reason) => page.sentence(reason),
        }
    }
    ledger(page, content);
}

/// The steady runs.
fn steady(page: &mut Page, content: &Content<'_>, control: &Control) {
    page.chapter(Section::Comparison, "Model of the known sources against the measurement");
    if let Some((_, taken)) = &content.with_identified {
        let structure = &content.project.structure;
        let names: Vec<String> = taken.iter().map(|s| s.title(structure)).collect();
        page.sentence(&format!(
            "The project states no damping that limits its resonances; what was identified is taken as known here: {}.",
            names.join("; ")
        ));
    }
    match &content.comparison {
        Ok(found) => agreement(page, content, found, control),
        Err(reason) => page.warning(reason),
    }
}

fn agreement(page: &mut Page, content: &Content<'_>, found: &Comparison, control: &Control) {
    page.sentence(&format!(
        "Error of the responses {}, of the energies {}; noise alone would leave {}.",
        in_words(found.error),
        in_words(found.energy_error),
        format::percent(found.noise_floor)
    ));
    for run in &found.unpredicted {
        page.warning(&format!("{}: not predicted, left out: {}", content.project.runs[run.index].file, run.reason));
    }
    let grid = Grid::new(found, false);
    let errors = grid.cells.iter().flatten().flatten().map(|c| c.error);
    let scale = Scale::new(found.noise_floor, errors.fold(0.0, f64::max));
    page.drawing(&grid.draw(&scale, "Error map, channels by runs", Palette::light()), &grid.table());
    let worst = Grid::new(found, true);
    let (Some(&run), Some(channel)) = (worst.runs.first(), worst.channels.first()) else { return };
    if channel != ENERGY {
        worst_channel(page, content, found, run, channel, control);
    }
}

/// Measured on modelled where the model is worst.
fn worst_channel(
    page: &mut Page,
    content: &Content<'_>,
    found: &Comparison,
    run: usize,
    channel: &str,
    control: &Control,
) {
    let p = content.compared();
    let list = samples::samples(p, found, None, channel);
    let near = neighbourhood(p, run).map(|n| n.0).unwrap_or_default();
    let lines =
        if p.structure.matrices().is_some() { curves(p, &[], run, control).unwrap_or_default() } else { Vec::new() };
    let response = ChannelResponse {
        name: channel,
        samples: &list,
        run,
        levels: &levels(p, &near),
        channel: samples::index(p, run, channel).unwrap_or(0),
        unit: samples::unit(p, run, channel),
        curves: &lines,
        trial: &[],
    };
    if list.len() > 1 {
        let figures = response.over_frequency(Palette::light()).into_iter().map(|f| f.0).collect();
        sheet(page, &format!("{channel} where the model is worst: near run {}", run + 1), figures);
    }
}

fn missing(page: &mut Page, content: &Content<'_>, found: &Diagnosis) {
    page.sentence(&findings::sentence(found));
    if !found.complete {
        page.warning("The search was ended before its time: this is the best so far.");
    }
    if let Some(runs) = findings::searched_runs(found) {
        page.sentence(&runs);
    }
    corrections(page, content, found);
    suggestions(page, &content.project.structure, &found.suggestions);
    for s in told_in_full(found).take(MOST_TOLD) {
        evidence(page, content, s);
    }
    if let Some((_, force)) = content.forces.iter().find(|(source, _)| source.is_none()) {
        page.sentence(
            "The force that would explain most, at the place where one force explains most, whatever its law:",
        );
        missing_force(page, content, force);
    }
    next_tests(page, content, found);
}

fn corrections(page: &mut Page, content: &Content<'_>, found: &Diagnosis) {
    if found.corrections.is_empty() {
        return;
    }
    let known = problem(content.compared()).known();
    page.sentence("The model states these wrongly; they were corrected in the search:");
    let row = |c: &Correction| {
        vec![findings::corrected(&content.project.structure, &known, &c.parameter), findings::change(c)]
    };
    page.table(
        "Corrections of the model",
        &["What", "Correction|"],
        &found.corrections.iter().map(row).collect::<Vec<_>>(),
    );
}

fn suggestions(page: &mut Page, structure: &Structure, list: &[Suggestion]) {
    let row = |s: &Suggestion| {
        let sizes = s.added.source.effect.parameters().iter().zip(&s.added.source.parameters).zip(&s.added.deviations);
        let size = |((p, v), d): ((&Parameter, &f64), &f64)| {
            format!("{} {}", words::parameter(p.name), format::with_deviation(*v, *d, p.unit))
        };
        vec![
            s.added.source.title(structure),
            sizes.map(size).collect::<Vec<_>>().join(", "),
            chance(s.probability),
            in_words(s.error_after),
            in_words(s.held_out_error_after),
        ]
    };
    let rows: Vec<Vec<String>> = list.iter().take(MOST_SUGGESTIONS).map(row).collect();
    if !rows.is_empty() {
        page.table(
            "Suggestions",
            &["Suggestion", "Size", "Probability|", "Error with it|", "On left-out runs|"],
            &rows,
        );
    }
}

fn evidence(page: &mut Page, content: &Content<'_>, s: &Suggestion) {
    let structure = &content.project.structure;
    let title = s.added.source.title(structure);
    page.section(&title);
    s.evidence.iter().for_each(|sentence| page.sentence(&polished(sentence)));
    if !s.indistinguishable_from.is_empty() {
        let others: Vec<String> = s.indistinguishable_from.iter().map(|o| o.title(structure)).collect();
        page.sentence(&format!("These data cannot tell it from: {}.", others.join("; ")));
    }
    if let Some((_, print)) = content.fingerprints.iter().find(|(source, _)| source.is_same(&s.added.source)) {
        figure(page, fingerprint::figure(print, Palette::light()));
    }
    let is_suggested =
        |source: &Option<crate::effects::Source>| source.as_ref().is_some_and(|o| o.is_same(&s.added.source));
    if let Some((_, force)) = content.forces.iter().find(|(source, _)| is_suggested(source)) {
        missing_force(page, content, force);
    }
}

/// The missing force over displacement and velocity.
fn missing_force(page: &mut Page, content: &Content<'_>, force: &RestoringForce) {
    let sheet = restoring_force::sheet(force, &content.project.structure, Palette::light());
    page.drawing(&sheet.drawing(sheet.paper(), Palette::light()), &restoring_force::table(force));
    page.remark(&format!("{}.", words::capital(&restoring_force::caption(force))));
}

fn next_tests(page: &mut Page, content: &Content<'_>, found: &Diagnosis) {
    if matches!(found.verdict, Verdict::Adequate | Verdict::Detuned) || found.next_test.is_empty() {
        return;
    }
    page.chapter(Section::NextTest, "Next test");
    for test in &found.next_test {
        let what = findings::next_test(&content.project.structure, test);
        page.sentence(&format!("{}: {}.", words::capital(&what), polished(test.why.trim_end_matches('.'))));
    }
}

/// The models that were looked at, and where the suggestions would lead.
fn ledger(page: &mut Page, content: &Content<'_>) {
    let mut rows: Vec<Vec<String>> = Vec::new();
    for row in &content.ledger {
        rows.push(vec![row.label.clone(), in_words(row.error), format::percent(row.noise_floor)]);
    }
    if let Some(Ok(found)) = &content.diagnosis {
        let structure = &content.project.structure;
        for step in found.steps.iter().skip(1) {
            let names: Vec<String> = step.added.iter().map(|a| a.source.title(structure)).collect();
            let what = if names.is_empty() { "the corrections".to_owned() } else { names.join(", ") };
            rows.push(vec![
                format!("with {what}, as suggested"),
                in_words(step.error),
                format::percent(found.noise_floor),
            ]);
        }
    }
    if !rows.is_empty() {
        page.chapter(Section::Ledger, "Ledger");
        page.table("Models and their errors", &["Model", "Error|", "Noise floor|"], &rows);
    }
}
