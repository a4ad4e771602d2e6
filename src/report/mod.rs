//! A report of a project in one file, HTML or PDF: what was measured, what was identified and how well, where the model disagrees
//! with the measurement and what it may lack, with its plots, a title page, the methods with their sources and all that is needed
//! to compute it again. It holds what there is: what could not be computed is said with its reason. Its tables and the values of
//! its figures stand beside it as CSV in a ZIP file.

mod archive;
mod comparison;
mod content;
mod date;
mod figures;
mod front;
mod html;
mod identification;
mod logo;
mod methods;
mod page;
mod pdf;
mod request;
mod section;
mod settings;
mod unsteady;

pub use content::{Content, Known, LedgerRow};
pub use request::{Origin, Request, SEARCH_S, Tables};
pub use section::Section;

use crate::control::Control;
use crate::display::{format, words};
use crate::effects::{Parameter, Source, State};
use crate::exchange::Project;
use crate::exchange::atomic::write_atomically;
use crate::plots::response_curve;
use figures::MOST_MODES;
use front::front;
use logo::Logo;
use page::{Page, Part};
use std::path::Path;
use std::sync::Arc;

/// Reads a project, computes all that a report holds and writes it; blocks.
///
/// # Errors
/// One line: the project, the logo or a file that cannot be written.
pub fn report(file: &Path, request: &Request, out: &Path, control: &Control) -> Result<String, String> {
    let plan = crate::exchange::project::open(file).map_err(|e| e.to_string())?;
    let origin = Origin {
        path: Some(file.to_owned()),
        folder: file.parent().unwrap_or(Path::new("")).to_owned(),
        file: Arc::new(plan.file.clone()),
    };
    let request = Request { origin: Some(origin), ..request.clone() };
    let project = plan.load(control).map_err(|e| e.to_string())?;
    write(&project, Known::default(), &request, out, control)
}

/// Writes the report of a project, of which some results may be known already; says what was written.
///
/// # Errors
/// One line: the logo or a file that cannot be written.
pub fn write(
    project: &Project,
    known: Known,
    request: &Request,
    out: &Path,
    control: &Control,
) -> Result<String, String> {
    let heading = request.title_page();
    // Before the long work: a logo that cannot be read is no reason to wait.
    let logo = heading.logo.as_deref().map(|path| Logo::read(Path::new(path))).transpose()?;
    let content = Content::complete(project, known, request, control);
    let front = front(&content, request, heading, logo);
    let parts = parts(&content, request, control);
    let as_pdf = out.extension().is_some_and(|e| e.eq_ignore_ascii_case("pdf"));
    let bytes = if as_pdf {
        pdf::document(&front, &parts).map_err(|e| e.to_string())?
    } else {
        html::document(&front, &parts).into_bytes()
    };
    let written = |path: &Path, bytes: &[u8]| {
        write_atomically(path, bytes).map_err(|e| format!("{}: cannot be written ({e})", path.display()))
    };
    written(out, &bytes)?;
    let Some(tables) = request.tables.path(out) else { return Ok(format!("Written: {}.", out.display())) };
    written(&tables, &archive::zipped(&archive::files(&parts, &content))?)?;
    Ok(format!("Written: {}, {}.", out.display(), tables.display()))
}

/// All parts of the report.
fn parts(content: &Content<'_>, request: &Request, control: &Control) -> Vec<Part> {
    let project = content.project;
    let mut page = Page::of(&request.sections);
    if !project.notes.is_empty() {
        page.sentence(&project.notes);
    }
    page.remark("All values in SI units; amplitudes are peak values; ± is one standard deviation.");
    structure(&mut page, project);
    runs(&mut page, project);
    identification::chapters(&mut page, content, control);
    comparison::chapters(&mut page, content, control);
    methods::chapter(&mut page, content);
    settings::chapter(&mut page, project, request);
    page.finish()
}

fn structure(page: &mut Page, p: &Project) {
    page.chapter(Section::Structure, "Structure");
    page.sentence(&format!(
        "{}, {} of freedom.",
        words::capital(words::kind(p.structure.kind())),
        words::counted(p.structure.len(), "degree")
    ));
    if let Ok(modes) = p.structure.modes() {
        let row = |r: usize| vec![(r + 1).to_string(), format::with_unit(modes.frequency_hz(r), "Hz")];
        let rows: Vec<Vec<String>> = (0..modes.len().min(MOST_MODES)).map(row).collect();
        page.table("Natural frequencies", &["Mode", "Natural frequency|"], &rows);
    }
    let known: Vec<Vec<String>> =
        p.sources.iter().filter(|s| s.state == State::Known).map(|s| source_row(p, s)).collect();
    if !known.is_empty() {
        page.sentence("Known sources of the model:");
        page.table("Known sources", &["Law", "Place", "Size"], &known);
    }
}

fn source_row(p: &Project, s: &Source) -> Vec<String> {
    let value = |(p, v): (&Parameter, &f64)| format!("{} {}", words::parameter(p.name), format::with_unit(*v, p.unit));
    let sizes: Vec<String> = s.effect.parameters().iter().zip(&s.parameters).map(value).collect();
    vec![s.effect.title().to_owned(), s.place.cell(&p.structure), sizes.join(", ")]
}

fn runs(page: &mut Page, p: &Project) {
    page.chapter(Section::Measurements, "Measurements");
    if p.runs.is_empty() && p.transient_runs.is_empty() {
        return page.sentence("The project holds no measurements.");
    }
    let records = p.transient_runs.iter().enumerate().map(|(k, run)| unsteady::row(p.runs.len() + k + 1, run));
    let rows: Vec<Vec<String>> = (0..p.runs.len()).map(|k| run_row(p, k)).chain(records).collect();
    page.table(
        "Runs and records",
        &["Run|", "File", "Frequency|", "Force (peak)|", "Level|", "Noise|", "Remarks"],
        &rows,
    );
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
