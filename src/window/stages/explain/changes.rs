//! What a deed of the stage changes in the project, and what is said of it.

use super::cards;
use super::deed::Deed;
use super::scene::Scene;
use crate::diagnosis::Diagnosis;
use crate::diagnosis::channels::ChannelFault;
use crate::diagnosis::updating::correction::Correction;
use crate::display::words;
use crate::display::words::at;
use crate::effects::{Effect, Place, Source};
use crate::identify::Outcome;
use crate::session::adoption::Adoption;
use crate::session::{Command, EffectAt, identified};
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

    fn adopting(adoption: Adoption, done: &str) -> Self {
        Self::new(Edit::All(adoption.commands), done)
    }
}

/// What a deed changes in the project; nothing where it only changes what is looked at or searched.
///
/// # Errors
/// One sentence that says why it cannot be done.
pub(crate) fn change(deed: &Deed, document: &Document, derived: &Derived) -> Result<Option<Change>, String> {
    let scene = &Scene { document, explained: &derived.explained };
    let found = scene.diagnosis();
    match deed {
        Deed::Add(source) => add(scene, source).map(Some),
        Deed::Exclude(source) => Ok(Some(rule_out(document, source))),
        Deed::Restore(source) => Ok(Some(allow(document, source))),
        Deed::TakeOver => take_over(scene, derived.known_outcome(document)).map(Some),
        Deed::Correct => found.map(|found| correct(scene, found)).transpose(),
        Deed::CorrectOne(k) => {
            found.and_then(|found| found.corrections.get(*k)).map(|one| correct_one(scene, one)).transpose()
        }
        Deed::CorrectSensor { channel, gain, delay } => correct_sensor(scene, channel, [*gain, *delay]).map(Some),
        Deed::Mend(k) => {
            found.and_then(|found| found.channel_faults.get(*k)).map(|fault| mend(scene, fault)).transpose()
        }
        Deed::Try(_)
        | Deed::Stop
        | Deed::Return(_)
        | Deed::Retry
        | Deed::Hurry
        | Deed::Limit(_)
        | Deed::SearchOn
        | Deed::Search => Ok(None),
    }
}

/// `Coulomb friction at DOF 7`.
fn named(document: &Document, source: &Source) -> String {
    format!("{} {}", words::effect(source.effect), at(&document.project.structure, &source.place))
}

/// Puts an effect into the model, as it was promised where it was suggested.
fn add(scene: &Scene<'_>, source: &Source) -> Result<Change, String> {
    let mut adoption = scene.adoption();
    let added = match scene.diagnosis() {
        Some(diagnosis) => adoption.suggestion(source, diagnosis, &scene.known()),
        None => adoption.effect(source),
    };
    added.map_err(|refusal| refusal.to_string())?;
    let beside = if adoption.commands.len() > 1 { ", with what else the search found and corrected" } else { "" };
    Ok(Change::adopting(adoption, &format!("Added: {}{beside}.", named(scene.document, source))))
}

/// Rules an effect out at its place; the search for others follows by itself.
fn rule_out(document: &Document, source: &Source) -> Change {
    let command = Command::RuleOut(EffectAt::of(source, &document.project.structure));
    Change::new(Edit::Do(command), &format!("Ruled out: {}.", named(document, source)))
}

/// Lets an effect that was ruled out be searched for again.
fn allow(document: &Document, source: &Source) -> Change {
    let command = Command::Allow(EffectAt::of(source, &document.project.structure));
    Change::new(Edit::Do(command), &format!("Allowed again: {}.", named(document, source)))
}

/// What the search corrected is corrected in the project too.
fn correct(scene: &Scene<'_>, diagnosis: &Diagnosis) -> Result<Change, String> {
    let mut adoption = scene.adoption();
    adoption.corrections(diagnosis, &scene.known()).map_err(|refusal| refusal.to_string())?;
    Ok(Change::adopting(adoption, "The model is corrected."))
}

/// One correction becomes a number of the project.
fn correct_one(scene: &Scene<'_>, correction: &Correction) -> Result<Change, String> {
    let name = cards::corrected(scene, &correction.parameter);
    let mut adoption = scene.adoption();
    adoption.correction(correction, &scene.known()).map_err(|refusal| refusal.to_string())?;
    Ok(Change::adopting(adoption, &format!("Corrected: {name}.")))
}

/// A channel that was found to read wrongly is mended in its mapping; the search with the channel as it is then follows by itself.
fn mend(scene: &Scene<'_>, fault: &ChannelFault) -> Result<Change, String> {
    let mut adoption = scene.adoption();
    adoption.fault(fault, &scene.document.project).map_err(|refusal| refusal.to_string())?;
    Ok(Change::adopting(adoption, &format!("Mended: {}.", fault.words())))
}

/// A channel that reads `gain` too large, or `delay` (s) late, beyond what the project states of it.
fn correct_sensor(scene: &Scene<'_>, channel: &str, [gain, delay]: [f64; 2]) -> Result<Change, String> {
    let mut adoption = scene.adoption();
    for (effect, value, neutral) in [(Effect::Gain, 1.0 + gain, 1.0), (Effect::Delay, delay, 0.0)] {
        if value != neutral {
            let error = Source::known(effect, Place::Channel(channel.to_owned()), &[value]);
            adoption.effect(&error).map_err(|refusal| refusal.to_string())?;
        }
    }
    Ok(Change::adopting(adoption, &format!("Corrected: what {channel} reads.")))
}

/// What the identification found becomes known.
fn take_over(scene: &Scene<'_>, outcome: Option<Cached<Outcome>>) -> Result<Change, String> {
    let found: Vec<(usize, f64)> = match outcome {
        Some(Ok(outcome)) => identified::found(&scene.document.project.sources, &outcome).collect(),
        Some(Err(error)) => return Err(format!("Nothing was identified: {error}")),
        None => return Err("Identification is still running; ask again when it has ended.".to_owned()),
    };
    let said = match found.len() {
        0 => return Err("No source was identified: draw other candidates in the stage Pattern.".to_owned()),
        1 => "Known now: 1 identified source. Undo takes it back.".to_owned(),
        many => format!("Known now: {many} identified sources. Undo takes them back."),
    };
    let mut adoption = scene.adoption();
    adoption.identified(&found).map_err(|refusal| refusal.to_string())?;
    Ok(Change { edit: Edit::All(adoption.commands), said })
}
