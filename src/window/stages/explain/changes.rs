//! What a request of the stage changes in the project, and what is said of it.

use super::cards;
use super::request::Request;
use super::scene::Scene;
use crate::effects::{Source, State};
use crate::identify::Outcome;
use crate::session::corrections::adopt;
use crate::session::{Command, mending, suggestions};
use crate::window::cache::Cached;
use crate::window::derived::Derived;
use crate::window::document::Document;
use crate::window::edits::Edit;

/// A change of the project and the sentence that says it once it is made.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Change {
    /// The change.
    pub edit: Edit,
    /// What is said of it.
    pub said: String,
}

impl Change {
    fn new(edit: Edit, done: &str) -> Self {
        Self { edit, said: format!("{done} Undo takes it back.") }
    }
}

/// What a request changes in the project; nothing where it only changes what is looked at or searched.
///
/// # Errors
/// One sentence that says why it cannot be done.
pub(crate) fn change(request: &Request, document: &Document, derived: &Derived) -> Result<Option<Change>, String> {
    let scene = &Scene { document, explained: &derived.explained };
    match request {
        Request::Add(source) => add(scene, source),
        Request::Exclude(source) => Ok(Some(rule_out(document, source))),
        Request::Restore(source) => Ok(Some(allow(document, source))),
        Request::TakeOver => take_over(document, derived.known_outcome(document)),
        Request::Correct => Ok(correct(scene)),
        Request::CorrectOne(k) => Ok(correct_one(scene, *k)),
        Request::CorrectSensor { channel, gain, delay } => Ok(Some(correct_sensor(document, channel, [*gain, *delay]))),
        Request::Mend(k) => mend(scene, *k),
        Request::Try(_)
        | Request::Stop
        | Request::Return(_)
        | Request::Retry
        | Request::Hurry
        | Request::Limit(_)
        | Request::SearchOn
        | Request::Search => Ok(None),
    }
}

/// `Coulomb friction at DOF 7`.
fn named(document: &Document, source: &Source) -> String {
    source.phrase(&document.project.structure)
}

/// Puts an effect into the model.
fn add(scene: &Scene<'_>, source: &Source) -> Result<Option<Change>, String> {
    let commands = with_corrections(scene, source)?;
    let beside = if commands.len() > 1 { ", with what else the search found and corrected" } else { "" };
    Ok(Some(Change::new(Edit::All(commands), &format!("Added: {}{beside}.", named(scene.document, source)))))
}

/// What adds a suggested effect as it was promised: the corrections that were fitted beside it, and the rest of its set.
fn with_corrections(scene: &Scene<'_>, source: &Source) -> Result<Vec<Command>, String> {
    let document = scene.document.session().document();
    let Some(Ok(diagnosis)) = scene.explained.diagnosis(scene.document) else {
        return Ok(vec![suggestions::add(source, document)?]);
    };
    let mut commands = Vec::new();
    if diagnosis.is_promised_with_its_set(source) {
        commands.extend(cards::adopted(scene, diagnosis).commands);
    }
    for one in diagnosis.added_with(source) {
        commands.push(suggestions::add(&one, document)?);
    }
    Ok(commands)
}

/// Rules an effect out at its place; the search for others follows by itself.
fn rule_out(document: &Document, source: &Source) -> Change {
    let command = Command::RuleOut(suggestions::effect_at(source, &document.project.structure));
    Change::new(Edit::Do(command), &format!("Ruled out: {}.", named(document, source)))
}

/// Lets an effect that was ruled out be searched for again.
fn allow(document: &Document, source: &Source) -> Change {
    let command = Command::Allow(suggestions::effect_at(source, &document.project.structure));
    Change::new(Edit::Do(command), &format!("Allowed again: {}.", named(document, source)))
}

/// What the search corrected is corrected in the project too.
fn correct(scene: &Scene<'_>) -> Option<Change> {
    let Some(Ok(diagnosis)) = scene.explained.diagnosis(scene.document) else { return None };
    Some(Change::new(Edit::All(cards::adopted(scene, diagnosis).commands), "The model is corrected."))
}

/// One correction becomes a number of the project.
fn correct_one(scene: &Scene<'_>, k: usize) -> Option<Change> {
    let Some(Ok(diagnosis)) = scene.explained.diagnosis(scene.document) else { return None };
    let correction = diagnosis.corrections.get(k)?;
    let name = cards::corrected(scene, &correction.parameter);
    let known = |index: usize| scene.explained.known(scene.document, index);
    let adopted = adopt(std::slice::from_ref(correction), &known, scene.document.session().document());
    Some(Change::new(Edit::All(adopted.commands), &format!("Corrected: {name}.")))
}

/// A channel that was found to read wrongly is mended in its mapping; the search with the channel as it is then follows by itself.
fn mend(scene: &Scene<'_>, k: usize) -> Result<Option<Change>, String> {
    let Some(Ok(diagnosis)) = scene.explained.diagnosis(scene.document) else { return Ok(None) };
    let Some(fault) = diagnosis.channel_faults.get(k) else { return Ok(None) };
    let command = mending::command(fault, &scene.document.project)?;
    Ok(Some(Change::new(Edit::Do(command), &format!("Mended: {}.", fault.words()))))
}

/// A channel that reads `gain` too large, or `delay` (s) late, beyond what the project states of it.
fn correct_sensor(document: &Document, channel: &str, [gain, delay]: [f64; 2]) -> Change {
    let file = document.session().document().file();
    let table = file.sensor.iter().find(|t| t.channel == channel);
    let [old_delay, old_gain] = [table.and_then(|t| t.delay), table.and_then(|t| t.gain)];
    let delay = old_delay.unwrap_or(0.0) + delay;
    let gain = old_gain.unwrap_or(1.0) * (1.0 + gain);
    let command = Command::SetSensor {
        channel: channel.to_owned(),
        delay: (delay != 0.0).then_some(delay),
        gain: (gain != 1.0).then_some(gain),
    };
    Change::new(Edit::Do(command), &format!("Corrected: what {channel} reads."))
}

/// What the identification found becomes known.
fn take_over(document: &Document, found: Option<Cached<Outcome>>) -> Result<Option<Change>, String> {
    let found = match found {
        Some(Ok(outcome)) => sought(&document.project.sources, &outcome),
        Some(Err(error)) => return Err(format!("Nothing was identified: {error}")),
        None => return Err("Identification is still running; ask again when it has ended.".to_owned()),
    };
    let said = match found.len() {
        0 => return Err("No source was identified: draw other candidates in the stage Pattern.".to_owned()),
        1 => "Known now: 1 identified source. Undo takes it back.".to_owned(),
        many => format!("Known now: {many} identified sources. Undo takes them back."),
    };
    let commands = suggestions::take_over(&found, document.session().document())?;
    Ok(Some(Change { edit: Edit::All(commands), said }))
}

/// Sources that were sought and identified, with their coefficients.
fn sought(sources: &[Source], outcome: &Outcome) -> Vec<(usize, f64)> {
    let sought = |s: usize| sources.get(s).is_some_and(|s| matches!(s.state, State::Candidate | State::Forced));
    let found = outcome.sources.iter().filter(|e| sought(e.source) && e.coefficient > 0.0);
    found.map(|e| (e.source, e.coefficient)).collect()
}
