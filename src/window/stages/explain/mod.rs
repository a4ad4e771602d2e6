//! Explain: where the model fails (error map), what is missing (suggestions), the way so far (ledger).

mod card;
mod cards;
mod channels;
pub mod corrections;
mod decay;
pub mod deed;
mod detail;
mod fingerprint;
mod force;
mod gauge;
mod ledger;
mod limit;
pub mod look;
mod map;
pub mod panes;
mod ranking;
mod scene;
mod schematic;
pub mod switches;

use crate::diagnosis::diagnose::Verdict;
use crate::display::findings::{is_detuned, is_stuck};
use crate::display::format;
use crate::display::words;
use crate::display::words::at;
use crate::effects::{Source, State};
use crate::identify::Outcome;
use crate::session::corrections::adopt;
use crate::session::validation::only_records;
use crate::session::{Command, suggestions};
use crate::window::app::App;
use crate::window::document::Document;
use crate::window::edits::Edit;
use crate::window::explained::model::Key;
use crate::window::explained::{Explained, Standing, Wanted};
use crate::window::frame::top::StageStatus;
use crate::window::view::{Stage, View};
use deed::Deed;
use egui::Context;
use scene::{Scene, is_undamped};
pub use schematic::{Errors, errors};
use std::time::Duration;

/// What is to be computed for what is looked at.
pub fn wanted(document: &Document, view: &View, explained: &Explained) -> Wanted {
    if view.stage != Stage::Explain {
        return Wanted::default();
    }
    let look = &view.explain;
    let open = ranking::open(document, explained, look).filter(|(_, standing)| *standing == Standing::Final);
    // Fingerprints, forces and curves over frequency are those of steady runs.
    let steady = !document.project.runs.is_empty();
    let print = open.filter(|_| steady).map(|(s, _)| s.added.source.clone());
    let curve = (steady && look.tab == look::Tab::Frequency).then_some(view.run);
    let named = print.is_some();
    let unexplained = || {
        let found = explained.diagnosis(document).and_then(|d| d.as_ref().ok());
        found.is_some_and(|d| d.verdict == Verdict::Unexplained)
    };
    let force = steady && (named || unexplained());
    Wanted {
        diagnosis: look.anyway || !is_undamped(document),
        anyway: look.anyway,
        trial: look.trial.clone(),
        print,
        force,
        scatter: steady && look.scatter,
        limit: view.limit_s.map(Duration::from_secs_f64),
        curve,
    }
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

/// Does what was asked for.
pub fn answer(app: &mut App, ctx: &Context, deed: Deed) {
    match deed {
        Deed::Try(source) => app.view.explain.trial = Some(source),
        Deed::Stop => app.view.explain.trial = None,
        Deed::Add(source) => {
            app.view.explain.trial = None;
            app.view.explain.open = None;
            add(app, ctx, &source);
        }
        Deed::Exclude(source) => {
            let look = &mut app.view.explain;
            look.trial = look.trial.take().filter(|t| !t.is_same(&source));
            look.open = look.open.take().filter(|t| !t.is_same(&source));
            rule_out(app, ctx, &source);
        }
        Deed::Restore(source) => {
            let Some(document) = &app.document else { return };
            let at = suggestions::effect_at(&source, &document.project.structure);
            app.edit(ctx, &Edit::Do(Command::Allow(at)));
        }
        Deed::Return(step) => go_back(app, step),
        Deed::TakeOver => take_over(app, ctx),
        Deed::Correct => correct(app, ctx),
        Deed::CorrectOne(k) => correct_one(app, ctx, k),
        Deed::CorrectSensor { channel, gain, delay } => correct_sensor(app, ctx, channel, [gain, delay]),
        Deed::Mend(k) => channels::mend(app, ctx, k),
        Deed::Retry => app.derived.explained.retry(),
        Deed::Hurry => app.derived.explained.hurry(),
        Deed::Limit(limit) => app.view.limit_s = limit,
        Deed::SearchOn => {
            app.view.limit_s = None;
            app.derived.explained.retry();
        }
        Deed::Search => app.view.explain.anyway = true,
    }
}

fn go_back(app: &mut App, step: usize) {
    let (Some(document), Some(step_there)) = (&mut app.document, app.derived.explained.ledger.steps().get(step)) else {
        return;
    };
    document.go_to(&step_there.document, &format!("go to step {step}"), |d| Key::new(d) == step_there.key);
    app.view.explain.trial = None;
    app.view.explain.open = None;
    app.view.source = None;
}

/// Puts an effect into the model and says so.
fn add(app: &mut App, ctx: &Context, source: &Source) {
    let Some(document) = &app.document else { return };
    let place = at(&document.project.structure, &source.place);
    let scene = Scene { document, explained: &app.derived.explained };
    match with_corrections(&scene, source) {
        Ok(commands) => {
            let beside = if commands.len() > 1 { ", with what else the search found and corrected" } else { "" };
            app.edit(ctx, &Edit::All(commands));
            if app.message.as_ref().is_none_or(|m| !m.failed) {
                app.say(format!("Added: {} {place}{beside}. Undo takes it back.", words::effect(source.effect)));
            }
        }
        Err(error) => app.fail(error),
    }
}

/// What adds a suggested effect as it was promised: the corrections that were fitted beside it, and the rest of its set.
fn with_corrections(scene: &Scene<'_>, source: &Source) -> Result<Vec<Command>, String> {
    let document = scene.document.session().document();
    let Some(Ok(diagnosis)) = scene.explained.diagnosis(scene.document) else {
        return Ok(vec![suggestions::add(source, document)?]);
    };
    let mut commands = Vec::new();
    if diagnosis.is_corrected_beside(source) {
        commands.extend(cards::adopted(scene, diagnosis).commands);
    }
    for one in diagnosis.added_with(source) {
        commands.push(suggestions::add(&one, document)?);
    }
    Ok(commands)
}

/// Rules an effect out at its place and says so; the search for others follows by itself.
fn rule_out(app: &mut App, ctx: &Context, source: &Source) {
    let Some(document) = &app.document else { return };
    let structure = &document.project.structure;
    let said =
        format!("Ruled out: {} {}. Undo takes it back.", words::effect(source.effect), at(structure, &source.place));
    let command = Command::RuleOut(suggestions::effect_at(source, structure));
    app.edit(ctx, &Edit::Do(command));
    if app.message.as_ref().is_none_or(|m| !m.failed) {
        app.say(said);
    }
}

/// What the search corrected is corrected in the project too.
fn correct(app: &mut App, ctx: &Context) {
    let Some(document) = &app.document else { return };
    let scene = Scene { document, explained: &app.derived.explained };
    let Some(Ok(diagnosis)) = scene.explained.diagnosis(document) else { return };
    let commands = cards::adopted(&scene, diagnosis).commands;
    app.edit(ctx, &Edit::All(commands));
    if app.message.as_ref().is_none_or(|m| !m.failed) {
        app.say("The model is corrected. Undo takes it back.".to_owned());
    }
}

/// One correction becomes a number of the project.
fn correct_one(app: &mut App, ctx: &Context, k: usize) {
    let Some(document) = &app.document else { return };
    let scene = Scene { document, explained: &app.derived.explained };
    let Some(Ok(diagnosis)) = scene.explained.diagnosis(document) else { return };
    let Some(correction) = diagnosis.corrections.get(k) else { return };
    let name = cards::corrected(&scene, &correction.parameter);
    let known = |index: usize| scene.explained.known(document, index);
    let adopted = adopt(std::slice::from_ref(correction), &known, document.session().document());
    app.edit(ctx, &Edit::All(adopted.commands));
    if app.message.as_ref().is_none_or(|m| !m.failed) {
        app.say(format!("Corrected: {name}. Undo takes it back."));
    }
}

/// A channel that reads `gain` too large, or `delay` (s) late, beyond what the project states of it.
fn correct_sensor(app: &mut App, ctx: &Context, channel: String, [gain, delay]: [f64; 2]) {
    let Some(document) = &app.document else { return };
    let file = document.session().document().file();
    let table = file.sensor.iter().find(|t| t.channel == channel);
    let stated = |value: Option<f64>, none: f64| value.unwrap_or(none);
    let old = table.map_or((None, None), |t| (t.delay, t.gain));
    let delay = stated(old.0, 0.0) + delay;
    let gain = stated(old.1, 1.0) * (1.0 + gain);
    let said = format!("Corrected: what {channel} reads. Undo takes it back.");
    let command =
        Command::SetSensor { channel, delay: (delay != 0.0).then_some(delay), gain: (gain != 1.0).then_some(gain) };
    app.edit(ctx, &Edit::Do(command));
    if app.message.as_ref().is_none_or(|m| !m.failed) {
        app.say(said);
    }
}

/// What the identification found becomes known.
fn take_over(app: &mut App, ctx: &Context) {
    let Some(document) = &app.document else { return };
    let found = match app.derived.known_outcome(document) {
        Some(Ok(outcome)) => sought(&document.project.sources, outcome),
        Some(Err(error)) => return app.fail(format!("Nothing was identified: {error}")),
        None => return app.fail("Identification is still running; ask again when it has ended.".to_owned()),
    };
    let said = match found.len() {
        0 => return app.fail("No source was identified: draw other candidates in the stage Pattern.".to_owned()),
        1 => "Known now: 1 identified source. Undo takes it back.".to_owned(),
        many => format!("Known now: {many} identified sources. Undo takes them back."),
    };
    match suggestions::take_over(&found, document.session().document()) {
        Ok(commands) => {
            app.edit(ctx, &Edit::All(commands));
            if app.message.as_ref().is_none_or(|m| !m.failed) {
                app.say(said);
            }
        }
        Err(error) => app.fail(error),
    }
}

/// Sources that were sought and identified, with their coefficients.
fn sought(sources: &[Source], outcome: &Outcome) -> Vec<(usize, f64)> {
    let sought = |s: usize| sources.get(s).is_some_and(|s| matches!(s.state, State::Candidate | State::Forced));
    let found = outcome.sources.iter().filter(|e| sought(e.source) && e.coefficient > 0.0);
    found.map(|e| (e.source, e.coefficient)).collect()
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
        None if is_undamped(document) => StageStatus::attention(
            "The model has no damping yet: take over what was identified, then see what is left.",
        ),
        Some(Ok(d)) if is_stuck(d) => StageStatus::attention(&format!(
            "Error {error}, noise floor {floor}: nothing known here explains what is left."
        )),
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
    format!(" Best guess{so_far}: {} {}.", words::effect(source.effect), at(&document.project.structure, &source.place))
}
