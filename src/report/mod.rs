//! A report of a project in one file, HTML or PDF: what was measured, what was identified and how well, where the model disagrees
//! with the measurement and what it may lack, with its plots. It holds what there is: what could not be computed is said with
//! its reason.

mod comparison;
mod content;
mod figures;
mod html;
mod identification;
mod page;
mod pdf;
mod unsteady;

pub use content::{Content, Known, LedgerRow};

use crate::control::Control;
use crate::display::{format, words};
use crate::effects::{Parameter, Source, State};
use crate::exchange::Project;
use crate::exchange::atomic::write_atomically;
use crate::plots::response_curve;
use figures::MOST_MODES;
use page::{Page, Part};
use std::path::Path;

/// Reads a project, computes all that a report holds and writes it; blocks.
///
/// # Errors
/// One line: the project or the file.
pub fn report(file: &Path, out: &Path, control: &Control) -> Result<String, String> {
    let project = crate::exchange::project::load(file, control).map_err(|e| e.to_string())?;
    write(&project, Known::default(), out, control)
}

/// Writes the report of a project, of which some results may be known already; says what was written.
///
/// # Errors
/// One line: the file.
pub fn write(project: &Project, known: Known, out: &Path, control: &Control) -> Result<String, String> {
    let content = Content::complete(project, known, control);
    let (title, parts) = (&project.title, parts(&content, control));
    let as_pdf = out.extension().is_some_and(|e| e.eq_ignore_ascii_case("pdf"));
    let bytes = if as_pdf {
        pdf::document(title, &parts).map_err(|e| e.to_string())?
    } else {
        html::document(title, &parts).into_bytes()
    };
    write_atomically(out, &bytes).map_err(|e| format!("{}: cannot be written ({e})", out.display()))?;
    Ok(format!("Written: {}.", out.display()))
}

/// All parts of the report.
fn parts(content: &Content<'_>, control: &Control) -> Vec<Part> {
    let project = content.project;
    let mut page = Page::default();
    if !project.notes.is_empty() {
        page.sentence(&project.notes);
    }
    page.remark(&format!(
        "Dashpot {}. All values in SI units; amplitudes are peak values; ± is one standard deviation.",
        env!("CARGO_PKG_VERSION")
    ));
    structure(&mut page, project);
    runs(&mut page, project);
    identification::chapters(&mut page, content, control);
    comparison::chapters(&mut page, content, control);
    settings(&mut page, project);
    page.finish()
}

fn structure(page: &mut Page, p: &Project) {
    page.chapter("Structure");
    page.sentence(&format!(
        "{}, {} degrees of freedom.",
        words::capital(words::kind(p.structure.kind())),
        p.structure.len()
    ));
    if let Ok(modes) = p.structure.modes() {
        let row = |r: usize| vec![(r + 1).to_string(), format::with_unit(modes.frequency_hz(r), "Hz")];
        let rows: Vec<Vec<String>> = (0..modes.len().min(MOST_MODES)).map(row).collect();
        page.table(&["Mode", "Natural frequency|"], &rows);
    }
    let known: Vec<Vec<String>> =
        p.sources.iter().filter(|s| s.state == State::Known).map(|s| source_row(p, s)).collect();
    if !known.is_empty() {
        page.sentence("Known sources of the model:");
        page.table(&["Law", "Place", "Size"], &known);
    }
}

fn source_row(p: &Project, s: &Source) -> Vec<String> {
    let value = |(p, v): (&Parameter, &f64)| format!("{} {}", words::parameter(p.name), format::with_unit(*v, p.unit));
    let sizes: Vec<String> = s.effect.parameters().iter().zip(&s.parameters).map(value).collect();
    vec![words::capital(words::effect(s.effect)), words::place(&p.structure, &s.place), sizes.join(", ")]
}

fn runs(page: &mut Page, p: &Project) {
    page.chapter("Measurements");
    if p.runs.is_empty() && p.transient_runs.is_empty() {
        return page.sentence("The project holds no measurements.");
    }
    let records = p.transient_runs.iter().enumerate().map(|(k, run)| unsteady::row(p.runs.len() + k + 1, run));
    let rows: Vec<Vec<String>> = (0..p.runs.len()).map(|k| run_row(p, k)).chain(records).collect();
    page.table(&["Run|", "File", "Frequency|", "Force|", "Level|", "Noise|", "Remarks"], &rows);
}

fn run_row(p: &Project, k: usize) -> Vec<String> {
    let run = &p.runs[k];
    let level = run.level.map_or_else(String::new, |l| l.to_string());
    let flags: Vec<&str> = run.findings.iter().map(|f| f.reason.as_str()).collect();
    let used = if run.enabled { flags.join("; ") } else { "not used".to_owned() };
    let force = response_curve::force(p, k).map_or_else(String::new, |f| format::with_unit(f.1.norm(), "N"));
    let frequency = format::with_unit(run.frequency_hz(), "Hz");
    vec![(k + 1).to_string(), run.file.clone(), frequency, force, level, words::noise(run), used]
}

/// What is needed to compute the same again.
fn settings(page: &mut Page, p: &Project) {
    page.chapter("Settings");
    let s = &p.settings;
    let rows = [
        ("Expansion to all degrees of freedom", words::expansion(s.expansion).to_owned()),
        ("Weights of the energy equation", words::weights(s.weights).to_owned()),
        ("Most sources", s.max_sources.to_string()),
        ("Angle at which the selection stops", format!("{}°", format::significant(s.stop_angle_deg, 3))),
        ("Program", format!("Dashpot {}", env!("CARGO_PKG_VERSION"))),
    ];
    page.table(&["Setting", "Value"], &rows.map(|(name, value)| vec![name.to_owned(), value]));
}
