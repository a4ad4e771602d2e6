//! What a request of the stage changes in the project, and what is said of it.

use super::cards;
use super::request::Request;
use super::scene::Scene;
use crate::diagnosis::channels::ChannelFault;
use crate::diagnosis::run_fault::RunFault;
use crate::diagnosis::updating::correction::Correction;
use crate::effects::{Effect, Place, Source};
use crate::exchange::project::ruled_out::RuledOutTable;
use crate::identify::Outcome;
use crate::session::adoption::Adoption;
use crate::session::{Command, Refusal, identified};
use crate::window::background::cache::Cached;
use crate::window::background::derived::Derived;
use crate::window::document::Document;
use crate::window::document::edits::Edit;

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

    /// A change that takes over what `step` does.
    fn adopting(
        scene: &Scene<'_>,
        done: &str,
        step: impl FnOnce(&mut Adoption) -> Result<(), Refusal>,
    ) -> Result<Self, String> {
        Ok(Self::new(Edit::All(scene.commands(step)?), done))
    }
}

/// What a request changes in the project; nothing where it only changes what is looked at or searched.
///
/// # Errors
/// One sentence that says why it cannot be done.
pub(crate) fn change(request: &Request, document: &Document, derived: &Derived) -> Result<Option<Change>, String> {
    let scene = &Scene { document, explained: &derived.explained };
    let known = || scene.known();
    let found = scene.diagnosis();
    match request {
        Request::Add(source) => add(scene, source).map(Some),
        Request::Exclude(source) => Ok(Some(rule_out(document, source))),
        Request::Restore(source) => Ok(Some(allow(document, source))),
        Request::TakeOver => take_over(scene, derived.known_outcome(document)).map(Some),
        Request::Correct => {
            let all = |found| Change::adopting(scene, "The model is corrected.", |a| a.corrections(found, &known()));
            found.map(all).transpose()
        }
        Request::CorrectOne(k) => {
            let single = |found: &Correction| {
                let done = format!("Corrected: {}.", cards::corrected(scene, &found.parameter));
                Change::adopting(scene, &done, |a| a.correction(found, &known()))
            };
            found.and_then(|found| found.corrections.get(*k)).map(single).transpose()
        }
        Request::CorrectSensor { channel, gain, delay } => correct_sensor(scene, channel, [*gain, *delay]).map(Some),
        Request::Mend(k) => {
            let mended = |fault: &ChannelFault| {
                let done = format!("Mended: {}.", fault.words());
                Change::adopting(scene, &done, |a| a.fault(fault, &document.project))
            };
            found.and_then(|found| found.channel_faults.get(*k)).map(mended).transpose()
        }
        Request::LeaveOut(k) => {
            let left_out = |fault: &RunFault| {
                let runs = &document.project.runs;
                let name = runs.get(fault.run).map_or("", |run| run.file.as_str());
                let done = format!("Left out: {name}.");
                Change::adopting(scene, &done, |a| a.without_run(fault, &document.project))
            };
            found.and_then(|found| found.run_faults.get(*k)).map(left_out).transpose()
        }
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

/// Puts an effect into the model, as it was promised where it was suggested.
fn add(scene: &Scene<'_>, source: &Source) -> Result<Change, String> {
    let commands = scene.commands(|adoption| match scene.diagnosis() {
        Some(diagnosis) => adoption.suggestion(source, diagnosis, &scene.known()),
        None => adoption.effect(source),
    })?;
    let beside = if commands.len() > 1 { ", with what else the search found and corrected" } else { "" };
    Ok(Change::new(Edit::All(commands), &format!("Added: {}{beside}.", named(scene.document, source))))
}

/// Rules an effect out at its place; the search for others follows by itself.
fn rule_out(document: &Document, source: &Source) -> Change {
    let command = Command::RuleOut(RuledOutTable::of(source, &document.project.structure));
    Change::new(Edit::Do(command), &format!("Ruled out: {}.", named(document, source)))
}

/// Lets an effect that was ruled out be searched for again.
fn allow(document: &Document, source: &Source) -> Change {
    let command = Command::Allow(RuledOutTable::of(source, &document.project.structure));
    Change::new(Edit::Do(command), &format!("Allowed again: {}.", named(document, source)))
}

/// A channel that reads `gain` too large, or `delay` (s) late, beyond what the project states of it.
fn correct_sensor(scene: &Scene<'_>, channel: &str, [gain, delay]: [f64; 2]) -> Result<Change, String> {
    let error = |(effect, value)| Source::known(effect, Place::Channel(channel.to_owned()), &[value]);
    let errors = [(Effect::Gain, 1.0 + gain), (Effect::Delay, delay)].map(error);
    Change::adopting(scene, &format!("Corrected: what {channel} reads."), |adoption| {
        errors.iter().try_for_each(|error| adoption.effect(error))
    })
}

/// What the identification found becomes known.
fn take_over(scene: &Scene<'_>, outcome: Option<Cached<Outcome>>) -> Result<Change, String> {
    let found = match outcome {
        Some(Ok(outcome)) => identified::found(&scene.document.project.sources, &outcome),
        Some(Err(error)) => return Err(format!("Nothing was identified: {error}")),
        None => return Err("Identification is still running; ask again when it has ended.".to_owned()),
    };
    let said = match found.len() {
        0 => return Err("No source was identified: draw other candidates in the stage Pattern.".to_owned()),
        1 => "Known now: 1 identified source. Undo takes it back.".to_owned(),
        many => format!("Known now: {many} identified sources. Undo takes them back."),
    };
    Ok(Change { edit: Edit::All(scene.commands(|adoption| adoption.identified(&found))?), said })
}
