//! What of a diagnosis is taken over into a project: the corrections of its model, its suggestions, its faults of channels and runs. Each
//! step is made on the document as the steps before leave it. The command line and the window adopt by the same steps.

use super::command::{Command, SourceAt, SourceSpec};
use super::corrections::{Adopted, adopt, adopt_all};
use super::document::Document;
use super::identified::known;
use super::mending;
use super::refusal::Refusal;
use super::sensors::further;
use crate::diagnosis::channels::{ChannelFault, Fault};
use crate::diagnosis::result::Diagnosis;
use crate::diagnosis::run_fault::RunFault;
use crate::diagnosis::updating::correction::Correction;
use crate::effects::{Place, Source, State};
use crate::exchange::Project;
use std::collections::BTreeMap;

/// What was taken over, and what could not be written.
#[derive(Debug)]
pub struct Adoption {
    /// The document with all of it.
    pub document: Document,
    /// The commands that led there, to be undone together.
    pub commands: Vec<Command>,
    /// Which corrections the project has no number for, by their place in the list.
    pub left: Vec<usize>,
    /// The correction that no model needs, for which none was taken over: they were fitted together.
    pub impossible: Option<usize>,
    /// Faults of channels that are left as they are, by their place in the list, and why.
    pub unmended: Vec<(usize, Refusal)>,
    /// Runs that do not fit the others and are kept, by their place in the list, and why.
    pub kept: Vec<(usize, Refusal)>,
}

impl Adoption {
    /// Nothing taken over yet.
    pub fn new(document: &Document) -> Self {
        let document = document.clone();
        let (commands, left, unmended, kept) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Self { document, commands, left, impossible: None, unmended, kept }
    }

    /// Whether all that was to be taken over is written.
    pub fn is_complete(&self) -> bool {
        self.left.is_empty() && self.impossible.is_none() && self.unmended.is_empty() && self.kept.is_empty()
    }

    fn make(&mut self, command: Command) -> Result<(), Refusal> {
        self.document = self.document.after(&command)?;
        self.commands.push(command);
        Ok(())
    }

    /// The whole of a diagnosis: corrections, the first suggestion with its set, faults of channels and runs. `known` are the sources that
    /// act in the model, `project` is what was diagnosed.
    ///
    /// # Errors
    /// [`Refusal`] of a correction or a suggestion.
    pub fn diagnosis(&mut self, diagnosis: &Diagnosis, known: &[Source], project: &Project) -> Result<(), Refusal> {
        self.corrections(diagnosis, known)?;
        if let Some(first) = diagnosis.suggestions.first() {
            self.set_of(&first.added.source, diagnosis)?;
        }
        for (k, fault) in diagnosis.channel_faults.iter().enumerate() {
            if matches!(fault.fault, Fault::Unreliable(_)) {
                continue;
            }
            if let Err(refusal) = self.fault(fault, project) {
                self.unmended.push((k, refusal));
            }
        }
        for (k, fault) in diagnosis.run_faults.iter().enumerate() {
            if let Err(refusal) = self.without_run(fault, project) {
                self.kept.push((k, refusal));
            }
        }
        Ok(())
    }

    /// All corrections of the model.
    ///
    /// # Errors
    /// [`Refusal`] of a number that does not hold.
    pub fn corrections(&mut self, diagnosis: &Diagnosis, known: &[Source]) -> Result<(), Refusal> {
        let adopted = adopt_all(&diagnosis.corrections, diagnosis.verdict, known, &self.document);
        self.adopted(adopted)
    }

    /// One correction of the model.
    ///
    /// # Errors
    /// [`Refusal`] of a number that does not hold.
    pub fn correction(&mut self, correction: &Correction, known: &[Source]) -> Result<(), Refusal> {
        let adopted = adopt(std::slice::from_ref(correction), known, &self.document);
        self.adopted(adopted)
    }

    fn adopted(&mut self, adopted: Adopted) -> Result<(), Refusal> {
        (self.left, self.impossible) = (adopted.left, adopted.impossible);
        adopted.commands.into_iter().try_for_each(|command| self.make(command))
    }

    /// A suggested effect as it was promised: with the corrections that were fitted beside it, and the rest of its set.
    ///
    /// # Errors
    /// As [`Self::corrections`] and [`Self::effect`].
    pub fn suggestion(&mut self, source: &Source, diagnosis: &Diagnosis, known: &[Source]) -> Result<(), Refusal> {
        if diagnosis.is_told_with_its_set(source) {
            self.corrections(diagnosis, known)?;
        }
        self.set_of(source, diagnosis)
    }

    fn set_of(&mut self, source: &Source, diagnosis: &Diagnosis) -> Result<(), Refusal> {
        diagnosis.added_with(source).iter().try_for_each(|source| self.effect(source))
    }

    /// An effect at its values: a known source, a larger coefficient of one that is there, or a correction of a channel.
    ///
    /// # Errors
    /// [`Refusal`]: the effect does not exist here, or is there already and two of it are not one.
    pub fn effect(&mut self, source: &Source) -> Result<(), Refusal> {
        let command = added(source, &self.document)?;
        self.make(command)
    }

    /// A fault of a channel: its mapping is mended.
    ///
    /// # Errors
    /// [`Refusal`] of a fault that no mapping can mend.
    pub fn fault(&mut self, fault: &ChannelFault, project: &Project) -> Result<(), Refusal> {
        self.make(mending::command(fault, project)?)
    }

    /// A run that does not fit the others: it is not used.
    ///
    /// # Errors
    /// [`Refusal`] of a run that the project does not list by itself.
    pub fn without_run(&mut self, fault: &RunFault, project: &Project) -> Result<(), Refusal> {
        let file = project.runs.get(fault.run).map(|run| run.file.clone()).unwrap_or_default();
        self.make(Command::SetRunUse { file, enabled: false })
    }

    /// What was identified becomes known, as `identified::known` says; `found` are sources of the document at their coefficients.
    ///
    /// # Errors
    /// [`Refusal`]: a law without a coefficient.
    pub fn identified(&mut self, found: &[Source]) -> Result<(), Refusal> {
        let sources = self.document.sources().clone();
        for (index, Source { effect, state, parameters, .. }) in known(&sources, found) {
            let k = effect.coefficient().ok_or(Refusal::NoCoefficient { law: effect.title() })?;
            let source = SourceAt::of(&sources[index], self.document.structure());
            if state != sources[index].state {
                self.make(Command::SetSourceState { source: source.clone(), state })?;
            }
            if state == State::Known {
                let parameters = BTreeMap::from([(effect.parameters()[k].name.to_owned(), parameters[k])]);
                let source = SourceAt { state: Some(state), ..source };
                self.make(Command::SetSourceParameters { source, parameters })?;
            }
        }
        Ok(())
    }
}

/// The command that adds an effect at its values.
fn added(source: &Source, document: &Document) -> Result<Command, Refusal> {
    if let Place::Channel(channel) = &source.place {
        let [delay, gain] = further(document.file(), channel, source);
        return Ok(Command::SetSensor { channel: channel.clone(), delay, gain });
    }
    source.check_on(document.structure())?;
    let known = Source { state: State::Known, ..source.clone() };
    let at = SourceAt::of(&known, document.structure());
    let Some(there) = known_there(source, document) else {
        let names = source.effect.parameters().iter().map(|parameter| parameter.name.to_owned());
        let parameters = names.zip(source.parameters.iter().copied()).collect();
        let SourceAt { law, dofs, elements, .. } = at;
        return Ok(Command::AddSource(SourceSpec { law, dofs, elements, state: State::Known, parameters }));
    };
    Ok(Command::SetSourceParameters { source: at, parameters: BTreeMap::from([together(there, source)?]) })
}

/// The known source of the same law at the same place.
fn known_there<'a>(source: &Source, document: &'a Document) -> Option<&'a Source> {
    document.sources().iter().find(|s| s.state == State::Known && s.is_same(source))
}

/// Name and value of the coefficient of two sources of one law at one place, where they act as one.
fn together(there: &Source, more: &Source) -> Result<(String, f64), Refusal> {
    let parameters = there.effect.parameters();
    let alike = |k: usize| parameters[k].linear || there.parameters[k] == more.parameters[k];
    match there.effect.coefficient() {
        Some(k) if (0..parameters.len()).all(alike) => {
            Ok((parameters[k].name.to_owned(), there.parameters[k] + more.parameters[k]))
        }
        _ => Err(Refusal::NotOne { law: there.effect.title() }),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::diagnosis::result::{Added, Step, Verdict};
    use crate::diagnosis::updating::parameters::UpdatingParameter;
    use crate::effects::Effect;
    use crate::exchange::project::ProjectFile;
    use std::path::Path;

    const TEXT: &str = "[project]\nformat = 1\ntitle = \"t\"\n[structure]\nkind = \"chain\"\nmasses = [1.0, 2.0]\n\
        ground_stiffness = [100.0, 0.0]\ncoupling_stiffness = [50.0]\n\
        [[source]]\nlaw = \"viscous\"\ndofs = [2, 1]\nstate = \"known\"\nc = 2\n\
        [[source]]\nlaw = \"elastic_slider\"\ndofs = [2]\nstate = \"known\"\nstiffness = 10.0\nforce = 1.0\n\
        [[sensor]]\nchannel = \"acc@2\"\ngain = 1.1\n";

    fn document() -> Document {
        Document::new(ProjectFile::parse(TEXT, "p.toml").unwrap().0, Path::new("")).unwrap()
    }

    fn at(effect: Effect, dofs: &[usize], parameters: &[f64]) -> Source {
        Source::known(effect, Place::Dofs(dofs.to_vec()), parameters)
    }

    fn channel(effect: Effect, value: f64) -> Source {
        Source::known(effect, Place::Channel("acc@2".into()), &[value])
    }

    #[test]
    fn what_is_added_to_what_is_there_has_the_sum() {
        let mut adoption = Adoption::new(&document());
        let more = [at(Effect::Viscous, &[0, 1], &[0.5]), at(Effect::Coulomb, &[1], &[3.0])];
        for source in more.iter().chain(&[channel(Effect::Gain, 2.0), channel(Effect::Delay, 1e-3)]) {
            adoption.effect(source).unwrap();
        }
        let d = adoption.document;
        let found = |wanted: &Source| d.sources().iter().find(|s| s.is_same(wanted)).unwrap().parameters.clone();
        assert_eq!((found(&more[0]), found(&more[1])), (vec![2.5], vec![3.0]));
        let [sensor] = &d.file().sensor[..] else { panic!("{:?}", d.file().sensor) };
        assert_eq!((sensor.gain, sensor.delay), (Some(2.2), Some(1e-3)));
    }

    #[test]
    fn two_sliders_at_one_place_are_not_one() {
        let said = Adoption::new(&document()).effect(&at(Effect::ElasticSlider, &[1], &[20.0, 1.0])).unwrap_err();
        assert!(said.to_string().contains("two of it with other parameters are not one"), "{said}");
    }
    /// A known damper that is corrected and to which more is added has the sum of both, not one of them.
    #[test]
    fn a_suggestion_is_added_to_what_its_corrections_leave() {
        let more = at(Effect::Viscous, &[0, 1], &[0.5]);
        let step =
            Step { added: vec![Added { source: more.clone(), deviations: vec![0.1] }], error: 0.03, misfit: 1.0 };
        let parameter = UpdatingParameter::Known(0);
        let diagnosis = Diagnosis {
            verdict: Verdict::Missing,
            corrections: vec![Correction { parameter, factor: 1.5, deviation: 0.1 }],
            ..Diagnosis::adequate(step, 0.01)
        };
        let d = document();
        let mut adoption = Adoption::new(&d);
        adoption.suggestion(&more, &diagnosis, d.sources()).unwrap();
        assert_eq!(adoption.document.sources()[0].parameters, [3.5]);
        assert!(adoption.is_complete() && adoption.commands.len() == 2);
    }
}
