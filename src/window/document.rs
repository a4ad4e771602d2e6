//! The project that is open: a session (commands, undo, saving) and beside it the records that were read and fitted.

use crate::control::Control;
use crate::effects::{Effect, Family, Place, Source, State};
use crate::exchange::{self, Project};
use crate::session::history::Gesture;
use crate::session::{Command, Session, SourceAt, SourceSpec};
use std::collections::BTreeMap;
use std::path::Path;

/// A change of the document in terms of what is on the screen: DOF rows and indices of sources and runs.
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
    /// Use a run or leave it out.
    UseRun(usize, bool),
    /// Any other change, in the words of the session.
    Do(Command),
}

/// The open project.
#[derive(Debug, Clone)]
pub struct Document {
    session: Session,
    /// As it stands, with its records.
    pub project: Project,
    gestures: u64,
}

impl Document {
    /// Reads a project and its records; long work. Changes that a crash left behind are recovered; then the second value is
    /// true.
    ///
    /// # Errors
    /// One line: file, line, what is wrong and how to mend it.
    pub fn open(path: &Path, control: &Control) -> Result<(Self, bool), String> {
        let mut session = Session::open(path).map_err(|e| e.to_string())?;
        let project = exchange::project::load(path, control).map_err(|e| e.to_string())?;
        // What was left behind may be damaged; the file itself is in order then.
        let recovered = session.recover().unwrap_or(false);
        let mut document = Self { session, project, gestures: 0 };
        document.refresh();
        Ok((document, recovered))
    }

    /// The session under it.
    pub fn session(&self) -> &Session {
        &self.session
    }

    /// Grows with every change; what is derived from the project remembers it.
    pub fn revision(&self) -> u64 {
        self.session.revisions().any
    }

    /// Applies an edit; gives back the source that it drew.
    ///
    /// # Errors
    /// One sentence that says why it cannot be done; the document is then unchanged.
    pub fn apply(&mut self, edit: &Edit) -> Result<Option<usize>, String> {
        let commands = self.commands(edit)?;
        let gesture = self.gesture(edit);
        for command in &commands {
            self.session.apply_in(command, gesture).map_err(|e| e.to_string())?;
        }
        self.refresh();
        Ok(self.drawn(edit))
    }

    /// The words of the session for an edit.
    fn commands(&self, edit: &Edit) -> Result<Vec<Command>, String> {
        let one = match edit {
            Edit::Draw(law, dofs) => Command::AddSource(self.spec(*law, dofs)?),
            Edit::DrawWhole(law) => Command::AddSource(self.spec(*law, &[])?),
            Edit::DrawFamily(law, family) => {
                Command::AddCandidates { law: *law, family: *family, parameters: BTreeMap::new() }
            }
            Edit::Cycle(i) => Command::SetSourceState { source: self.at(*i)?, state: next(self.source(*i)?.state) },
            Edit::SetState(i, state) => Command::SetSourceState { source: self.at(*i)?, state: *state },
            Edit::SetParameter(i, k, value) => {
                let name = self.source(*i)?.effect.parameters().get(*k).map(|p| p.name);
                let name = name.ok_or_else(|| format!("there is no parameter {}", k + 1))?;
                Command::SetSourceParameters {
                    source: self.at(*i)?,
                    parameters: BTreeMap::from([(name.into(), *value)]),
                }
            }
            Edit::Remove(i) => Command::RemoveSource(self.at(*i)?),
            Edit::UseRun(run, on) => {
                let run = self.project.runs.get(*run).ok_or_else(|| format!("there is no run {}", run + 1))?;
                Command::SetRunUse { file: run.file.clone(), enabled: *on }
            }
            Edit::Do(command) => command.clone(),
            Edit::Force(chosen) => return self.force(chosen),
            Edit::ClearCandidates => {
                let candidates =
                    (0..self.project.sources.len()).filter(|&i| self.project.sources[i].state == State::Candidate);
                return candidates.map(|i| Ok(Command::RemoveSource(self.at(i)?))).collect();
            }
        };
        Ok(vec![one])
    }

    fn force(&self, chosen: &[usize]) -> Result<Vec<Command>, String> {
        let to = |i: usize, state: State| Ok(Command::SetSourceState { source: self.at(i)?, state });
        let sources = self.project.sources.iter().enumerate();
        let released = sources.filter(|(i, s)| s.state == State::Forced && !chosen.contains(i)).map(|(i, _)| i);
        let forced = chosen.iter().filter(|&&i| self.project.sources.get(i).is_some_and(|s| s.state != State::Forced));
        released.map(|i| to(i, State::Candidate)).chain(forced.map(|&i| to(i, State::Forced))).collect()
    }

    /// Edits that belong together are undone together: all values of one drag, all candidates that are cleared.
    fn gesture(&mut self, edit: &Edit) -> Option<Gesture> {
        match edit {
            Edit::SetParameter(i, k, _) => Some(Gesture(((*i as u64) << 8) | *k as u64)),
            Edit::ClearCandidates | Edit::Force(_) => {
                self.gestures += 1;
                Some(Gesture((1 << 60) | self.gestures))
            }
            _ => None,
        }
    }

    fn source(&self, i: usize) -> Result<&Source, String> {
        self.project
            .sources
            .get(i)
            .ok_or_else(|| format!("there is no source {} of {}", i + 1, self.project.sources.len()))
    }

    fn spec(&self, law: Effect, dofs: &[usize]) -> Result<SourceSpec, String> {
        let dofs = self.labels(dofs)?;
        Ok(SourceSpec { law, dofs, elements: None, state: State::Candidate, parameters: BTreeMap::new() })
    }

    fn at(&self, i: usize) -> Result<SourceAt, String> {
        let source = self.source(i)?;
        let (dofs, elements) = match &source.place {
            Place::Dofs(dofs) => (self.labels(dofs)?, None),
            Place::Whole(range) => (Vec::new(), range.map(|r| r.map(|e| e as i64 + 1))),
            Place::Channel(_) => return Err("an error of a channel is not a source".to_owned()),
        };
        Ok(SourceAt { law: source.effect, dofs, elements, state: Some(source.state) })
    }

    fn labels(&self, dofs: &[usize]) -> Result<Vec<String>, String> {
        let label = |&d: &usize| {
            let dof = self.project.structure.dofs().get(d);
            dof.map(|d| d.label.clone()).ok_or_else(|| format!("there is no DOF in row {}", d + 1))
        };
        dofs.iter().map(label).collect()
    }

    fn drawn(&self, edit: &Edit) -> Option<usize> {
        let place = match edit {
            Edit::Draw(_, dofs) => Place::Dofs(dofs.clone()),
            Edit::DrawWhole(_) => Place::Whole(None),
            _ => return None,
        };
        let (Edit::Draw(law, _) | Edit::DrawWhole(law)) = edit else { return None };
        let wanted = Source::candidate(*law, place);
        self.project.sources.iter().position(|s| s.state == State::Candidate && s.is_same(&wanted))
    }

    /// Takes sources and use of runs over from the session.
    fn refresh(&mut self) {
        let document = self.session.document();
        self.project.sources = document.sources().as_ref().clone();
        for run in &mut self.project.runs {
            if let Some(table) = document.file().run.iter().find(|t| t.file == run.file) {
                run.enabled = table.enabled;
            }
        }
    }

    /// Takes back the last edit; its name, where there is one.
    pub fn undo(&mut self) -> Option<String> {
        let label = self.session.undo();
        self.refresh();
        label
    }

    /// Repeats the edit taken back last; its name, where there is one.
    pub fn redo(&mut self) -> Option<String> {
        let label = self.session.redo();
        self.refresh();
        label
    }

    /// Saves to the project's file.
    ///
    /// # Errors
    /// One line; the file is then as it was.
    pub fn save(&mut self) -> Result<(), String> {
        self.session.save().map_err(|e| e.to_string())
    }

    /// Keeps unsaved changes beside the file, for the case of a crash.
    ///
    /// # Errors
    /// One line.
    pub fn autosave(&mut self) -> Result<bool, String> {
        self.session.autosave().map_err(|e| e.to_string())
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
    use super::{Document, Edit};
    use crate::control::Control;
    use crate::effects::{Effect, Family, State};

    const CHAIN: &str = "[project]\nformat = 1\ntitle = \"Chain\"\n[structure]\nkind = \"chain\"\nmasses = [1.0, 2.0, 1.0]\n\
                         ground_stiffness = [100.0, 0.0, 0.0]\ncoupling_stiffness = [50.0, 80.0]\n";

    fn document() -> (tempfile::TempDir, Document) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("project.toml");
        std::fs::write(&path, CHAIN).unwrap();
        let (document, recovered) = Document::open(&path, &Control::unattended()).unwrap();
        assert!(!recovered);
        (folder, document)
    }

    #[test]
    fn a_source_drawn_twice_is_refused_with_a_reason() {
        let (_folder, mut d) = document();
        assert_eq!(d.apply(&Edit::Draw(Effect::Viscous, vec![2])), Ok(Some(0)));
        let error = d.apply(&Edit::Draw(Effect::Viscous, vec![2])).unwrap_err();
        assert!(error.contains("already drawn"), "{error}");
        assert_eq!(d.project.sources.len(), 1);
    }

    #[test]
    fn edits_can_be_taken_back_to_the_start_and_repeated_to_the_end() {
        let (_folder, mut d) = document();
        let edits = [
            Edit::DrawFamily(Effect::Viscous, Family::EachTranslation),
            Edit::Cycle(1),
            Edit::Remove(0),
            Edit::Draw(Effect::Coulomb, vec![0, 2]),
            Edit::ClearCandidates,
        ];
        let mut states = vec![d.project.sources.clone()];
        for edit in &edits {
            d.apply(edit).unwrap();
            states.push(d.project.sources.clone());
        }
        assert_eq!(d.project.sources.len(), 1);
        assert_eq!(d.project.sources[0].state, State::Forced);
        for state in states.iter().rev().skip(1) {
            assert!(d.undo().is_some());
            assert_eq!(&d.project.sources, state);
        }
        assert!(d.undo().is_none());
        assert!(!d.session().is_dirty(), "back at the start nothing is unsaved");
        for state in &states[1..] {
            assert!(d.redo().is_some());
            assert_eq!(&d.project.sources, state);
        }
        assert!(d.redo().is_none());
        assert!(d.session().is_dirty());
    }

    #[test]
    fn what_is_not_there_is_refused_and_nothing_changes() {
        let (_folder, mut d) = document();
        for edit in [Edit::Cycle(7), Edit::Remove(0), Edit::UseRun(0, false), Edit::Draw(Effect::Viscous, vec![99])] {
            assert!(d.apply(&edit).is_err(), "{edit:?}");
        }
        assert_eq!(d.revision(), 0);
    }

    #[test]
    fn what_was_drawn_is_there_after_saving_and_opening() {
        let (folder, mut d) = document();
        d.apply(&Edit::Draw(Effect::Coulomb, vec![0, 1])).unwrap();
        d.save().unwrap();
        let (again, _) = Document::open(&folder.path().join("project.toml"), &Control::unattended()).unwrap();
        assert_eq!(again.project.sources, d.project.sources);
    }
}
