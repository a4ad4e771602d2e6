//! The title page: what was tested, by whom, when, and in one paragraph what was found.

use super::content::Content;
use super::date;
use super::logo::Logo;
use super::request::Request;
use crate::display::{findings, format, words};
use crate::exchange::project::file::ReportTable;
use crate::identify::Outcome;

/// What kind of document it is.
pub(super) const KIND: &str = "Report of a vibration test";
/// Who signs, and with what.
pub(super) const SIGNATURES: [&str; 4] =
    ["Tested by: place and date", "Signature", "Checked by: place and date", "Signature"];

/// What stands on the title page before the contents.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Front {
    /// Title.
    pub title: String,
    /// Logo.
    pub logo: Option<Logo>,
    /// Names and values.
    pub rows: Vec<(&'static str, String)>,
    /// What was found, in one paragraph.
    pub summary: String,
}

/// The title page of a report.
pub(super) fn front(content: &Content<'_>, request: &Request, heading: ReportTable, logo: Option<Logo>) -> Front {
    let project = content.project;
    let file = request.origin.as_ref().and_then(|origin| origin.path.as_ref());
    let rows = [
        ("Test object", heading.object),
        ("Tested by", heading.tester),
        ("Organisation", heading.organisation),
        ("Date of the report", request.made_s.map(|made| format!("{} (UTC)", date::day(made)))),
        ("Project", (!project.title.is_empty() && heading.title.is_some()).then(|| project.title.clone())),
        ("Project file", file.map(|path| path.display().to_string())),
        ("Evaluated by", Some(format!("Dashpot {}", env!("CARGO_PKG_VERSION")))),
    ];
    Front {
        title: heading.title.unwrap_or_else(|| project.title.clone()),
        logo,
        rows: rows.into_iter().filter_map(|(name, value)| Some((name, value?))).collect(),
        summary: summary(content),
    }
}

/// What was measured, identified and missed, in one paragraph.
fn summary(content: &Content<'_>) -> String {
    let p = content.project;
    let used = p.runs.iter().filter(|r| r.enabled).count() + p.transient_runs.iter().filter(|r| r.enabled).count();
    let mut said = vec![format!(
        "{} with {} of freedom, {} used.",
        words::capital(words::kind(p.structure.kind())),
        words::counted(p.structure.len(), "degree"),
        words::counted(used, "measurement"),
    )];
    said.extend(content.outcome.as_ref().ok().map(|outcome| identified(content, outcome)));
    match &content.diagnosis {
        Some(Ok(found)) => {
            said.push(findings::sentence(found));
            said.extend(found.suggestions.first().map(|s| {
                let name = s.added.source.title(&p.structure);
                format!(
                    "Most likely missing: {name}, probability {}; with it the error is {}.",
                    format::chance(s.probability),
                    format::in_words(s.error_after)
                )
            }));
            said.extend((!found.complete).then(|| "The search was ended at its time limit.".to_owned()));
        }
        _ => said.extend(content.comparison.as_ref().ok().map(|found| {
            let (error, floor) = (format::in_words(found.error), format::percent(found.noise_floor));
            format!("The model of the known sources is wrong by {error}; noise alone would leave {floor}.")
        })),
    }
    said.join(" ")
}

fn identified(content: &Content<'_>, outcome: &Outcome) -> String {
    let (p, step) = (content.project, outcome.accepted_step());
    let verb = if step.count == 1 { "explains" } else { "explain" };
    let most = outcome.sources.iter().max_by(|a, b| a.energy_percent.total_cmp(&b.energy_percent));
    let largest = most.and_then(|e| {
        let share = format::percent(0.01 * e.energy_percent);
        Some(format!("; the largest share is that of {}, {share}", p.sources.get(e.source)?.title(&p.structure)))
    });
    format!(
        "{} {verb} the dissipated energy to {}{}.",
        words::counted(step.count, "source"),
        format::percent(step.relative_error),
        largest.unwrap_or_default()
    )
}
