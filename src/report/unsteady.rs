//! Records that are not steady, and components in a testing machine, in a report: their error, their loops or the damping
//! ratio over amplitude, and the search for what their model lacks.

use super::content::Content;
use super::figures::sheet;
use super::page::Page;
use super::section::Section;
use crate::diagnosis::component::Loops;
use crate::diagnosis::records::RecordComparison;
use crate::diagnosis::records::compare::OneRecord;
use crate::display::format;
use crate::display::format::in_words;
use crate::exchange::Project;
use crate::measurement::TransientRun;
use crate::plots::amplitude_curve::{figures, told};
use crate::plots::component_loops;
use crate::plots::style::Palette;
use crate::session::validation::is_component;

/// Records whose loops or amplitude curves are drawn.
const MOST_DRAWN: usize = 4;

/// The records in the table of measurements: as many columns as steady runs have.
pub(super) fn row(number: usize, run: &TransientRun) -> Vec<String> {
    let flags: Vec<&str> = run.findings.iter().map(|f| f.reason.as_str()).collect();
    let time = run.time();
    let lasts = time.last().zip(time.first()).map_or(0.0, |(b, a)| b - a);
    vec![
        number.to_string(),
        run.file.clone(),
        format!("{}, {}", run.kind.name(), format::with_unit(lasts, "s")),
        String::new(),
        run.level.map_or_else(String::new, |l| l.to_string()),
        String::new(),
        if run.enabled { flags.join("; ") } else { "not used".to_owned() },
    ]
}

/// The chapter of the records against the model.
pub(super) fn chapter(page: &mut Page, content: &Content<'_>) {
    let Some(found) = &content.records else { return };
    page.chapter(Section::Comparison, "Model of the known sources against the records");
    let found = match found {
        Ok(found) => found,
        Err(reason) => return page.warning(reason),
    };
    page.sentence(&format!(
        "Error of the records {}; noise alone would leave {}.",
        in_words(found.error),
        format::percent(found.noise_floor)
    ));
    let p = content.project;
    let row = |r: &OneRecord| {
        let worst = r.channels.iter().max_by(|a, b| a.1[0].total_cmp(&b.1[0]));
        let worst = worst.map_or_else(String::new, |(name, [e, _])| format!("{name}, {}", in_words(*e)));
        let run = &p.transient_runs[r.index];
        vec![run.file.clone(), run.kind.name().to_owned(), in_words(r.error), format::percent(r.noise_floor), worst]
    };
    let rows: Vec<Vec<String>> = found.records.iter().map(row).collect();
    page.table("Error of every record", &["Record", "Kind", "Error|", "Noise floor|", "Worst channel|"], &rows);
    if is_component(p) {
        loops(page, p, found);
    } else {
        found.records.iter().take(MOST_DRAWN).for_each(|r| curves(page, &p.transient_runs[r.index].file, r));
    }
}

/// Force over displacement of the first records of a component.
fn loops(page: &mut Page, p: &Project, found: &RecordComparison) {
    let Ok(loops) = Loops::new(&p.structure, &p.sources, &p.transient_runs) else { return };
    for (one, record) in loops.list.iter().zip(&found.records).take(MOST_DRAWN) {
        if let Some(model) = record.model.first() {
            let title = format!("Loop of {}", one.file);
            sheet(page, &title, vec![component_loops::figure(Palette::light(), one, model)]);
        }
    }
}

/// Damping ratio and frequency over amplitude of the modes that stand out of a record.
fn curves(page: &mut Page, file: &str, record: &OneRecord) {
    for curve in told(&record.curves) {
        let near = format::with_unit(curve.frequency_hz, "Hz");
        let title = format!("{file}: damping ratio and frequency over amplitude, {} near {near}", curve.channel);
        sheet(page, &title, figures(&[curve], Palette::light()));
    }
}
