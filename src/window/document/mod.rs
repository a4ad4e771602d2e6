//! The project that is open: a session (commands, undo, saving) and beside it the records that were read and fitted.
//!
//! A change whose records were read before is made at once. One that needs records that were not (an import, another
//! number of harmonics) is made once they are read in the background; when that fails or is cancelled, nothing has changed.

pub mod edits;
pub(crate) mod prepared_records;
pub(crate) mod records;
pub(crate) mod templates;

use crate::control::Control;
use crate::exchange::Project;
use crate::exchange::project::ProjectFile;
use crate::session::history::Gesture;
use crate::session::{self, Command, Session};
use crate::window::document::edits::Edit;
use crate::window::document::records::{Fitted, Missing, Records};
use std::path::Path;

/// The open project.
#[derive(Debug, Clone)]
pub struct Document {
    session: Session,
    records: Records,
    /// As it stands, with its records.
    pub project: Project,
    gestures: u64,
}

/// A change that waits for records.
#[derive(Debug)]
pub struct Waiting {
    commands: Vec<Command>,
    missing: Missing,
}

/// A change whose records are read.
#[derive(Debug)]
pub struct Ready {
    commands: Vec<Command>,
    fitted: Fitted,
}

/// What became of an edit.
#[derive(Debug)]
pub enum Applied {
    /// It is made; the source that it drew.
    Done(Option<usize>),
    /// Records are to be read first: [`Waiting::read`], then [`Document::finish`].
    Waits(Box<Waiting>),
}

impl Waiting {
    /// Reads what is missing; long work.
    ///
    /// # Errors
    /// One line: file, line, what is wrong and how to mend it; or cancelled.
    pub fn read(self, control: &Control) -> Result<Ready, String> {
        Ok(Ready { commands: self.commands, fitted: self.missing.read(control)? })
    }
}

impl Document {
    /// Reads a project and its records; long work. Changes that a crash left behind are recovered; then the second value is
    /// true.
    ///
    /// # Errors
    /// One line: file, line, what is wrong and how to mend it.
    pub fn open(path: &Path, control: &Control) -> Result<(Self, bool), String> {
        let mut session = Session::open(path).map_err(|e| e.to_string())?;
        let saved = session.document().clone();
        let mut records = Records::default();
        if let Some(missing) = records.missing(&saved) {
            records.take(missing.read(control)?);
        }
        // What was left behind may be damaged; the file itself is in order then.
        let mut recovered = session.recover().unwrap_or(false);
        if let Some(missing) = records.missing(session.document()) {
            match missing.read(control) {
                Ok(fitted) => records.take(fitted),
                Err(_) => recovered = session.undo().is_none(),
            }
        }
        Ok((Self::of(session, records), recovered))
    }

    /// A new project that has no file yet, from the text of a template.
    ///
    /// # Errors
    /// One line.
    pub fn new(template: &str) -> Result<Self, String> {
        let (file, _) = ProjectFile::parse(template, "template").map_err(|e| e.to_string())?;
        let document = session::Document::new(file, Path::new("")).map_err(|e| e.to_string())?;
        Ok(Self::of(Session::new(document), Records::default()))
    }

    fn of(session: Session, records: Records) -> Self {
        let project = project(session.document(), &records);
        Self { session, records, project, gestures: 0 }
    }

    /// The session under it.
    pub fn session(&self) -> &Session {
        &self.session
    }

    /// Grows with every change of structure, measurements, sources or settings; what is derived from the project remembers it.
    /// Neither its title nor what is ruled out matters to any of that.
    pub fn revision(&self) -> u64 {
        let r = self.session.revisions();
        r.structure + r.measurements + r.sources + r.settings
    }

    /// Applies an edit, or says what is to be read first.
    ///
    /// # Errors
    /// One sentence that says why it cannot be done; the document is then unchanged.
    pub fn apply(&mut self, edit: &Edit) -> Result<Applied, String> {
        let commands = edit.commands(&self.project.structure, &self.project.sources)?;
        let mut after = self.session.document().clone();
        for command in &commands {
            after = after.after(command).map_err(|e| e.to_string())?;
        }
        if let Some(missing) = self.records.missing(&after) {
            return Ok(Applied::Waits(Box::new(Waiting { commands, missing })));
        }
        self.make(&commands)?;
        Ok(Applied::Done(edit.drawn(&self.project.sources)))
    }

    /// Makes a change whose records were read.
    ///
    /// # Errors
    /// One sentence, where the document has changed in between so that it cannot be made any more.
    pub fn finish(&mut self, ready: Ready) -> Result<(), String> {
        self.records.take(ready.fitted);
        self.make(&ready.commands)
    }

    /// Commands of one edit are undone together.
    fn make(&mut self, commands: &[Command]) -> Result<(), String> {
        self.gestures += 1;
        let gesture = (commands.len() > 1).then_some(Gesture(self.gestures));
        for command in commands {
            self.session.apply_in(command, gesture).map_err(|e| e.to_string())?;
        }
        self.refresh();
        Ok(())
    }

    fn refresh(&mut self) {
        self.project = project(self.session.document(), &self.records);
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

    /// Goes to an earlier or later state: by undo or redo where these lead there, else as an action of its own.
    pub fn go_to(&mut self, target: &session::Document, label: &str, is_there: impl Fn(&session::Document) -> bool) {
        let way = [Session::undo, Session::redo].into_iter().find_map(|step| {
            let mut trial = self.session.clone();
            while step(&mut trial).is_some() {
                if is_there(trial.document()) {
                    return Some(trial);
                }
            }
            None
        });
        match way {
            Some(session) => self.session = session,
            None => self.session.return_to(target, label),
        }
        self.refresh();
    }

    /// Saves to the project's file.
    ///
    /// # Errors
    /// One line; the file is then as it was.
    pub fn save(&mut self) -> Result<(), String> {
        self.session.save().map_err(|e| e.to_string())
    }

    /// Saves under another name and goes on with that.
    ///
    /// # Errors
    /// One line; then it goes on with the old file.
    pub fn save_as(&mut self, path: &Path) -> Result<(), String> {
        self.session.save_as(path).map_err(|e| e.to_string())
    }

    /// Forgets what was kept beside the file for the case of a crash: the user does not want the changes.
    ///
    /// # Errors
    /// One line.
    pub fn forget(&self) -> Result<(), String> {
        let Some(path) = self.session.path() else { return Ok(()) };
        session::save::forget_autosave(path).map_err(|e| e.to_string())
    }

    /// Keeps unsaved changes beside the file, for the case of a crash.
    ///
    /// # Errors
    /// One line.
    pub fn autosave(&mut self) -> Result<bool, String> {
        self.session.autosave().map_err(|e| e.to_string())
    }
}

/// A state of the document with its records, as the engine takes it.
fn project(state: &session::Document, records: &Records) -> Project {
    let file = state.file();
    Project {
        title: file.project.title.clone(),
        notes: file.project.notes.clone(),
        structure: state.structure().as_ref().clone(),
        sources: state.sources().as_ref().clone(),
        ruled_out: state.ruled_out().as_ref().clone(),
        runs: records.runs(state),
        transient_runs: records.transient_runs(state),
        reference_shapes: state.reference_shapes().as_ref().clone(),
        settings: file.analysis.clone(),
        remarks: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests")]
    use super::{Applied, Document};
    use crate::control::Control;
    use crate::effects::{Effect, Family, State};
    use crate::session::Command;
    use crate::window::document::edits::Edit;

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
        assert!(matches!(d.apply(&Edit::Draw(Effect::Viscous, vec![2])), Ok(Applied::Done(Some(0)))));
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
        for edit in [
            Edit::Cycle(7),
            Edit::Remove(0),
            Edit::UseRun("run.csv".into(), false),
            Edit::Draw(Effect::Viscous, vec![99]),
        ] {
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

    const RECORD: &str = "time [s],force@1 [N],acc@2 [m/s^2]\n";

    fn record(folder: &tempfile::TempDir, name: &str, hertz: f64) -> String {
        let mut text = RECORD.to_owned();
        for k in 0..400 {
            let t = 0.01 * f64::from(k) / hertz;
            let phase = std::f64::consts::TAU * hertz * t;
            text += &format!("{t:.9},{:.9},{:.9}\n", phase.cos(), 0.2 * (phase - 0.3).cos());
        }
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.display().to_string()
    }

    fn import(d: &mut Document, paths: &[&str]) -> Result<(), String> {
        let command = Command::ImportRuns(paths.iter().map(|p| (*p).to_owned()).collect());
        match d.apply(&Edit::Do(command))? {
            Applied::Waits(waiting) => d.finish(waiting.read(&Control::unattended())?),
            Applied::Done(_) => Ok(()),
        }
    }

    #[test]
    fn imports_append_and_undo_and_redo_read_nothing_again() {
        let (folder, mut d) = document();
        let (one, two) = (record(&folder, "one.csv", 3.0), record(&folder, "two.csv", 5.0));
        import(&mut d, &[&one]).unwrap();
        import(&mut d, &[&two]).unwrap();
        assert_eq!(d.project.runs.iter().map(|r| r.file.as_str()).collect::<Vec<_>>(), ["one.csv", "two.csv"]);
        std::fs::remove_file(folder.path().join("one.csv")).unwrap();
        assert!(d.undo().is_some() && d.undo().is_some());
        assert!(d.project.runs.is_empty());
        assert!(d.redo().is_some() && d.redo().is_some());
        assert_eq!(d.project.runs.len(), 2);
    }

    #[test]
    fn a_wrong_file_is_refused_with_its_line_and_changes_nothing() {
        let (folder, mut d) = document();
        let good = record(&folder, "good.csv", 3.0);
        let bad = folder.path().join("bad.csv");
        std::fs::write(&bad, format!("{RECORD}0.0,1.0,0.1\n0.1,x,0.2\n")).unwrap();
        let error = import(&mut d, &[&good, &bad.display().to_string()]).unwrap_err();
        assert!(error.contains("bad.csv, line 3"), "{error}");
        assert!(d.project.runs.is_empty() && d.revision() == 0);
    }

    #[test]
    fn another_number_of_harmonics_fits_the_records_anew() {
        let (folder, mut d) = document();
        import(&mut d, &[&record(&folder, "one.csv", 3.0)]).unwrap();
        let before = d.project.runs[0].fit.harmonics();
        let edit = Edit::Do(Command::SetSetting(crate::session::Setting::Harmonics(before - 2)));
        let Applied::Waits(waiting) = d.apply(&edit).unwrap() else { panic!("nothing is to be fitted") };
        d.finish(waiting.read(&Control::unattended()).unwrap()).unwrap();
        assert_eq!(d.project.runs[0].fit.harmonics(), before - 2);
        d.undo();
        assert_eq!(d.project.runs[0].fit.harmonics(), before);
    }

    #[test]
    fn a_number_of_the_structure_changes_its_matrices() {
        let (_folder, mut d) = document();
        let mass = |d: &Document| d.project.structure.matrices().unwrap().mass[(1, 1)];
        d.apply(&Edit::Do(Command::SetStructureParameter { name: "masses[2]".into(), value: 3.5 })).unwrap();
        assert_eq!(mass(&d), 3.5);
        d.undo();
        assert_eq!(mass(&d), 2.0);
    }
}
