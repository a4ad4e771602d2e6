//! Explain: where the model fails (error map), what is missing (suggestions), the way so far (ledger).

mod card;
mod cards;
pub(crate) mod changes;
mod channels;
pub(crate) mod corrections;
mod detail;
mod fingerprint;
mod force;
mod gauge;
mod ledger;
mod limit;
pub mod look;
mod map;
pub(crate) mod panes;
mod ranking;
mod record;
pub(crate) mod request;
mod runs;
mod scene;
mod schematic;
pub(crate) mod switches;

use crate::diagnosis::result::Verdict;
use crate::display::findings::{RunSpread, is_detuned, is_stuck, spread_of_runs};
use crate::display::format;
use crate::session::validation::only_records;
use crate::window::app::view::{Stage, View};
use crate::window::document::Document;
use crate::window::explained::ledger::Ledger;
use crate::window::explained::model::Key;
use crate::window::explained::{Explained, Shown, Standing, Wanted};
use crate::window::frame::top::StageStatus;
use request::Request;
use scene::is_undamped;
pub use schematic::{Errors, errors};
use std::time::Duration;

/// What is to be computed for what is looked at.
pub fn wanted(document: &Document, view: &View, explained: &Explained) -> Wanted {
    if view.stage != Stage::Explain {
        return Wanted::default();
    }
    let look = &view.explain;
    let open = ranking::open(document, explained, look).filter(|(_, standing)| *standing == Standing::Final);
    let named = open.map(|(s, _)| s.added.source.clone());
    // Fingerprints and curves over frequency are those of steady runs.
    let steady = !document.project.runs.is_empty();
    let curve = (steady && look.tab == look::Tab::Frequency).then_some(view.run);
    let unexplained = || {
        let found = explained.diagnosis(document).and_then(|d| d.as_ref().ok());
        found.is_some_and(|d| d.verdict == Verdict::Unexplained)
    };
    let force = named.is_some() || unexplained();
    Wanted {
        diagnosis: look.anyway || !is_undamped(document),
        anyway: look.anyway,
        trial: look.trial.clone(),
        named,
        print: steady,
        force,
        record: (!steady).then(|| record_shown(document, view)),
        scatter: steady && (look.scatter || left_by_runs(document, explained)),
        limit: view.limit_s.map(Duration::from_secs_f64),
        curve,
    }
}

/// The record that is not steady that is looked at, and its channel: of those that are used, the first unless one is chosen.
fn record_shown(document: &Document, view: &View) -> Shown {
    let records = &document.project.transient_runs;
    let chosen = records.get(view.run).filter(|r| r.enabled).map(|_| view.run);
    let index = chosen.or_else(|| records.iter().position(|r| r.enabled));
    (index.unwrap_or(0), view.explain.record.clone())
}

/// Whether what is left may be scatter of the runs, which has to be looked at before it is called unexplained.
fn left_by_runs(document: &Document, explained: &Explained) -> bool {
    explained.diagnosis(document).and_then(|d| d.as_ref().ok()).is_some_and(|d| is_stuck(d))
}

/// How much the runs differ, where that is known and more than chance.
fn spread(document: &Document, explained: &Explained) -> Option<RunSpread> {
    let scatter = explained.scatter(document)?.as_ref().ok()?;
    spread_of_runs(scatter.as_ref().as_ref()?)
}

/// An effect on trial takes the sizes of its suggestion, which a search corrects on its way.
pub fn keep_up(look: &mut look::Look, document: &Document, explained: &Explained) {
    look.scatter = std::mem::take(&mut look.scatter_shown);
    let Some(trial) = &mut look.trial else { return };
    let (suggestions, _) = explained.suggestions(document);
    if let Some(found) = suggestions.iter().find(|s| s.added.source.is_same(trial)) {
        trial.clone_from(&found.added.source);
    }
}

/// What a request changes of what is looked at and searched; what it changes in the project says `changes::change`.
pub fn look_on(request: Request, view: &mut View, explained: &mut Explained) {
    let look = &mut view.explain;
    match request {
        Request::Try(source) => look.trial = Some(source),
        Request::Stop => look.trial = None,
        Request::Add(_) | Request::Return(_) => (look.trial, look.open) = (None, None),
        Request::Exclude(source) => {
            look.trial = look.trial.take().filter(|t| !t.is_same(&source));
            look.open = look.open.take().filter(|t| !t.is_same(&source));
        }
        Request::Retry => explained.retry(),
        Request::Hurry => explained.hurry(),
        Request::Limit(limit) => view.limit_s = limit,
        Request::SearchOn => {
            view.limit_s = None;
            explained.retry();
        }
        Request::Search => look.anyway = true,
        Request::Restore(_)
        | Request::TakeOver
        | Request::Correct
        | Request::CorrectOne(_)
        | Request::CorrectSensor { .. }
        | Request::Mend(_)
        | Request::LeaveOut(_) => {}
    }
}

/// Takes the document to a step of the ledger; whether there is such a step.
pub fn go_back(document: &mut Document, ledger: &Ledger, step: usize) -> bool {
    let Some(there) = ledger.steps().get(step) else { return false };
    document.go_to(&there.document, &format!("go to step {step}"), |d| Key::new(d) == there.key);
    true
}

/// Where the model stands against the data, in one line.
pub fn status(document: &Document, explained: &Explained) -> StageStatus {
    if document.project.runs.is_empty() && !only_records(&document.project) {
        return StageStatus::empty("No runs to compare the model with.");
    }
    let comparison = match explained.comparison(document) {
        None => return StageStatus::empty("The comparison of model and measurement is running."),
        Some(Err(error)) => return StageStatus::attention(error),
        Some(Ok(comparison)) => comparison,
    };
    let (error, floor) = (format::in_words(comparison.error), format::percent(comparison.noise_floor));
    match explained.diagnosis(document) {
        None if is_undamped(document) => {
            StageStatus::attention("The model has no damping yet: add the identified sources, then see what is left.")
        }
        Some(Ok(d)) if is_stuck(d) => {
            let left = match spread(document, explained) {
                Some(_) => "what is left is scatter from run to run",
                None => "nothing known here explains what is left",
            };
            StageStatus::attention(&format!("Error {error}, noise floor {floor}: {left}."))
        }
        Some(Ok(d)) if is_detuned(d) => StageStatus::attention(&format!(
            "The model is detuned: error {error}, noise floor {floor}. No effect is missing."
        )),
        Some(Ok(d)) if matches!(d.verdict, Verdict::Adequate | Verdict::Detuned) => {
            StageStatus::done(&format!("The model explains the data: error {error}, noise floor {floor}."))
        }
        None | Some(Err(_)) if comparison.error <= 1.2 * comparison.noise_floor => {
            StageStatus::done(&format!("Error {error}, at the noise floor {floor}."))
        }
        _ => StageStatus::attention(&format!(
            "The model is wrong by {error}, noise floor {floor}.{}",
            best_guess(document, explained)
        )),
    }
}

/// The first suggestion, as a sentence after another one.
fn best_guess(document: &Document, explained: &Explained) -> String {
    let (suggestions, standing) = ranking::ranked(document, explained);
    let Some(source) = suggestions.first().map(|(s, _)| &s.added.source) else { return String::new() };
    let so_far = if standing == Standing::Final { "" } else { " so far" };
    format!(" Best guess{so_far}: {}.", source.phrase(&document.project.structure))
}
