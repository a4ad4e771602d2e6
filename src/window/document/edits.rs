//! Changes in terms of what is on the screen, said in the words of the session.

use crate::effects::{Effect, Family, Place, Source, State};
use crate::session::{Command, SourceAt, SourceSpec};
use crate::structure::Structure;
use std::collections::BTreeMap;

/// A change of the document in terms of what is on the screen: DOF rows and indices of sources.
#[derive(Debug, Clone, PartialEq)]
pub enum Edit {
    /// A candidate of a law on DOFs: one to the ground, two between, more a chain.
    Draw(Effect, Vec<usize>),
    /// A candidate of a law of the whole structure.
    DrawWhole(Effect),
    /// Candidates of a law at all places of a family.
    DrawFamily(Effect, Family),
    /// Candidate, forced, known, off, candidate.
    Cycle(usize),
    /// A state.
    SetState(usize, State),
    /// A parameter of a source.
    SetParameter(usize, usize, f64),
    /// Take a source away.
    Remove(usize),
    /// Take all candidates away.
    ClearCandidates,
    /// Force these sources, and let the search choose the other ones that were forced again.
    Force(Vec<usize>),
    /// Use a run, by its name, or leave it out.
    UseRun(String, bool),
    /// Any other change, in the words of the session.
    Do(Command),
    /// Several such changes, undone together.
    All(Vec<Command>),
}

impl Edit {
    /// The commands of the session that do it, undone together.
    ///
    /// # Errors
    /// One sentence that says what is not there.
    pub fn commands(&self, structure: &Structure, sources: &[Source]) -> Result<Vec<Command>, String> {
        let on = Shown { structure, sources };
        let one = match self {
            Self::Draw(law, dofs) => Command::AddSource(on.spec(*law, dofs)?),
            Self::DrawWhole(law) => Command::AddSource(on.spec(*law, &[])?),
            Self::DrawFamily(law, family) => {
                Command::AddCandidates { law: *law, family: *family, parameters: BTreeMap::new() }
            }
            Self::Cycle(i) => Command::SetSourceState { source: on.at(*i)?, state: next(on.source(*i)?.state) },
            Self::SetState(i, state) => Command::SetSourceState { source: on.at(*i)?, state: *state },
            Self::SetParameter(i, k, value) => on.parameter(*i, *k, *value)?,
            Self::Remove(i) => Command::RemoveSource(on.at(*i)?),
            Self::UseRun(file, enabled) => Command::SetRunUse { file: file.clone(), enabled: *enabled },
            Self::Do(command) => command.clone(),
            Self::All(commands) => return Ok(commands.clone()),
            Self::Force(chosen) => return on.force(chosen),
            Self::ClearCandidates => {
                let candidates = (0..sources.len()).filter(|&i| sources[i].state == State::Candidate);
                return candidates.map(|i| Ok(Command::RemoveSource(on.at(i)?))).collect();
            }
        };
        Ok(vec![one])
    }

    /// The source that was drawn, by its index in what the document holds now.
    pub fn drawn(&self, sources: &[Source]) -> Option<usize> {
        let (law, place) = match self {
            Self::Draw(law, dofs) => (law, Place::Dofs(dofs.clone())),
            Self::DrawWhole(law) => (law, Place::Whole(None)),
            _ => return None,
        };
        let wanted = Source::candidate(*law, place);
        sources.iter().position(|s| s.state == State::Candidate && s.is_same(&wanted))
    }
}

/// What is on the screen.
struct Shown<'a> {
    structure: &'a Structure,
    sources: &'a [Source],
}

impl Shown<'_> {
    fn source(&self, i: usize) -> Result<&Source, String> {
        let all = self.sources;
        all.get(i).ok_or_else(|| format!("there is no source {} of {}", i + 1, all.len()))
    }

    fn spec(&self, law: Effect, dofs: &[usize]) -> Result<SourceSpec, String> {
        let dofs = self.labels(dofs)?;
        Ok(SourceSpec { law, dofs, elements: None, state: State::Candidate, parameters: BTreeMap::new() })
    }

    fn at(&self, i: usize) -> Result<SourceAt, String> {
        Ok(SourceAt::of(self.source(i)?, self.structure))
    }

    fn labels(&self, dofs: &[usize]) -> Result<Vec<String>, String> {
        let label = |&d: &usize| {
            let dof = self.structure.dofs().get(d);
            dof.map(|d| d.label.clone()).ok_or_else(|| format!("there is no DOF in row {}", d + 1))
        };
        dofs.iter().map(label).collect()
    }

    fn parameter(&self, i: usize, k: usize, value: f64) -> Result<Command, String> {
        let name = self.source(i)?.effect.parameters().get(k).map(|p| p.name);
        let name = name.ok_or_else(|| format!("there is no parameter {}", k + 1))?;
        Ok(Command::SetSourceParameters { source: self.at(i)?, parameters: BTreeMap::from([(name.into(), value)]) })
    }

    fn force(&self, chosen: &[usize]) -> Result<Vec<Command>, String> {
        let set_state = |i: usize, state: State| Ok(Command::SetSourceState { source: self.at(i)?, state });
        let sources = self.sources.iter().enumerate();
        let released = sources.filter(|(i, s)| s.state == State::Forced && !chosen.contains(i)).map(|(i, _)| i);
        let forced = chosen.iter().filter(|&&i| self.sources.get(i).is_some_and(|s| s.state != State::Forced));
        released.map(|i| set_state(i, State::Candidate)).chain(forced.map(|&i| set_state(i, State::Forced))).collect()
    }
}

/// The state that a click leads to.
fn next(state: State) -> State {
    match state {
        State::Candidate => State::Forced,
        State::Forced => State::Known,
        State::Known => State::Off,
        State::Off | State::Reference => State::Candidate,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests")]
    use crate::control::Control;
    use crate::effects::{Effect, Place, Source};
    use crate::exchange::project::load;
    use crate::session::adoption::Adoption;
    use crate::window::document::edits::Edit;
    use crate::window::document::{Applied, Document};

    const CHAIN: &str = "[project]\nformat = 1\ntitle = \"Chain\"\n[structure]\nkind = \"chain\"\nmasses = [1.0, 2.0]\n\
                         ground_stiffness = [100.0, 0.0]\ncoupling_stiffness = [50.0]\n\
                         [[harmonics]]\nfile = \"h.csv\"\n";
    const HARMONICS: &str = "run,frequency_hz,channel,harmonic,cos,sin\na,2.0,force@1 [N],1,1.0,0.0\na,2.0,force@1 [N],2,0.0,0.0\n\
                             a,2.0,acc@2 [m/s^2],1,0.3,-0.4\na,2.0,acc@2 [m/s^2],2,0.01,0.02\n";

    fn document() -> (tempfile::TempDir, Document) {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("h.csv"), HARMONICS).unwrap();
        let path = folder.path().join("project.toml");
        std::fs::write(&path, CHAIN).unwrap();
        let document = Document::open(&path, &Control::unattended()).unwrap().0;
        (folder, document)
    }

    /// Adds an effect, and reads what that needs.
    fn add(d: &mut Document, source: &Source) -> Result<(), String> {
        let mut adoption = Adoption::new(d.session().document());
        adoption.effect(source).map_err(|refusal| refusal.to_string())?;
        match d.apply(&Edit::All(adoption.commands))? {
            Applied::Done(_) => Ok(()),
            Applied::Waits(waiting) => d.finish(waiting.read(&Control::unattended())?),
        }
    }

    fn channel(effect: Effect, value: f64) -> Source {
        Source::known(effect, Place::Channel("acc@2".to_owned()), &[value])
    }

    #[test]
    fn a_corrected_channel_is_that_of_the_saved_project_read_anew_and_undo_restores_it() {
        let (folder, mut d) = document();
        let before = d.project.runs.clone();
        for error in [channel(Effect::Delay, 2e-3), channel(Effect::Gain, 1.1), channel(Effect::Delay, 1e-3)] {
            add(&mut d, &error).unwrap();
        }
        d.save().unwrap();
        let again = load(&folder.path().join("project.toml"), &Control::unattended()).unwrap();
        for (now, read) in d.project.runs[0].fit.channels.iter().zip(&again.runs[0].fit.channels) {
            for (a, b) in now.amplitudes.iter().zip(&read.amplitudes) {
                assert!((a - b).norm() < 1e-14, "{a} is not {b}");
            }
        }
        assert_ne!(d.project.runs, before);
        while d.undo().is_some() {}
        assert_eq!(d.project.runs, before);
    }

    #[test]
    fn an_effect_that_is_there_already_grows_by_what_was_found() {
        let (_folder, mut d) = document();
        let damper = |c: f64| Source::known(Effect::Viscous, Place::Dofs(vec![0, 1]), &[c]);
        add(&mut d, &damper(2.0)).unwrap();
        add(&mut d, &damper(0.5)).unwrap();
        assert_eq!(d.project.sources.len(), 1);
        assert!((d.project.sources[0].parameters[0] - 2.5).abs() < 1e-15);
        let slider = |force: f64| Source::known(Effect::ElasticSlider, Place::Dofs(vec![1]), &[1000.0, force]);
        add(&mut d, &slider(1.0)).unwrap();
        assert!(add(&mut d, &slider(2.0)).unwrap_err().contains("already"));
        assert_eq!(d.undo().as_deref(), Some("add elastic slider"));
    }
}
