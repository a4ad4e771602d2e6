//! The ledger: every model that was looked at, with its error, and which one it came from. Nothing is ever taken out of it.

use super::model::Key;
use crate::diagnosis::Comparison;
use crate::session::Document;

/// One model on the way.
#[derive(Debug, Clone)]
pub struct LedgerEntry {
    /// What was changed, in a few words.
    pub label: String,
    /// Its key.
    pub key: Key,
    /// The document as it was then.
    pub document: Document,
    /// The step that it came from.
    pub parent: Option<usize>,
    /// Error of the model, a share.
    pub error: f64,
    /// What the error would be were the model exact, a share.
    pub noise_floor: f64,
    /// Largest error of one channel in one run.
    pub worst: f64,
}

/// All steps in the order in which they were first reached.
#[derive(Debug, Default)]
pub struct Ledger {
    steps: Vec<LedgerEntry>,
    current: usize,
}

impl Ledger {
    /// The steps.
    pub fn steps(&self) -> &[LedgerEntry] {
        &self.steps
    }

    /// Index of the step at which the document stands.
    pub fn current(&self) -> usize {
        self.current
    }

    /// The document stands at the model of `key`, whose comparison is known: goes to its step, or adds one.
    pub fn visit(&mut self, key: &Key, document: &Document, comparison: &Comparison) {
        if self.steps.get(self.current).is_some_and(|step| step.key == *key) {
            return;
        }
        if let Some(at) = self.steps.iter().position(|step| step.key == *key) {
            self.current = at;
            return;
        }
        let parent = (!self.steps.is_empty()).then_some(self.current);
        let label = parent.map_or_else(
            || "Model as opened".to_owned(),
            |p| capital(&key.0.change(&self.steps[p].key.0, document.structure())),
        );
        let channels = comparison.runs.iter().filter(|r| r.used).flat_map(|r| r.channels.iter().map(|c| c.error));
        let energies = comparison.runs.iter().filter(|r| r.used && r.channels.is_empty()).map(|r| r.error);
        self.steps.push(LedgerEntry {
            label,
            key: key.clone(),
            document: document.clone(),
            parent,
            error: comparison.error,
            noise_floor: comparison.noise_floor,
            worst: channels.chain(energies).fold(0.0, f64::max),
        });
        self.current = self.steps.len() - 1;
    }

    /// The steps from the first to the current one, each the parent of the next.
    pub fn path(&self) -> Vec<usize> {
        let mut path = Vec::new();
        let mut at = (!self.steps.is_empty()).then_some(self.current);
        while let Some(step) = at {
            path.push(step);
            at = self.steps[step].parent;
        }
        path.reverse();
        path
    }

    /// All steps as text with tabs: errors as shares, the step that each came from, whether it is the present one.
    pub fn table(&self) -> String {
        let line = |(k, step): (usize, &LedgerEntry)| {
            let parent = step.parent.map_or_else(String::new, |p| p.to_string());
            let now = if k == self.current { "yes" } else { "no" };
            format!("{k}\t{}\t{parent}\t{:e}\t{:e}\t{now}\n", step.label, step.error, step.noise_floor)
        };
        let lines: String = self.steps.iter().enumerate().map(line).collect();
        format!("step\twhat was changed\tafter step\terror\tnoise floor\tnow\n{lines}")
    }

    /// Lowest noise floor of all steps: the other end of the scale.
    pub fn least_floor(&self) -> f64 {
        self.steps.iter().map(|s| s.noise_floor).fold(f64::INFINITY, f64::min)
    }

    /// Largest error of one channel in one run over all steps: the end of the colour scale, so that a map fades.
    pub fn worst(&self) -> f64 {
        self.steps.iter().map(|s| s.worst).fold(0.0, f64::max)
    }
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests")]
    use super::{Key, Ledger};
    use crate::effects::{Effect, State};
    use crate::session::{Command, Session, SourceAt, SourceSpec};

    const CHAIN: &str = "[project]\nformat = 1\ntitle = \"Chain\"\n[structure]\nkind = \"chain\"\nmasses = [1.0, 2.0]\n\
                         ground_stiffness = [100.0, 0.0]\ncoupling_stiffness = [50.0]\n";

    fn add(law: Effect, dof: &str) -> Command {
        let parameters = law.parameters().iter().map(|p| (p.name.to_owned(), 1.0)).collect();
        Command::AddSource(SourceSpec { law, dofs: vec![dof.into()], elements: None, state: State::Known, parameters })
    }

    #[test]
    fn steps_are_kept_when_one_goes_back_and_takes_another_way() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("project.toml");
        std::fs::write(&path, CHAIN).unwrap();
        let mut session = Session::open(&path).unwrap();
        let mut ledger = Ledger::default();
        let visit = |ledger: &mut Ledger, session: &Session, error: f64| {
            let comparison = crate::plots::error_map::bare(error, Vec::new());
            ledger.visit(&Key::new(session.document()), session.document(), &comparison);
        };
        visit(&mut ledger, &session, 0.3);
        session.apply(&add(Effect::Viscous, "1")).unwrap();
        visit(&mut ledger, &session, 0.2);
        session.undo();
        visit(&mut ledger, &session, 0.3);
        assert_eq!((ledger.current(), ledger.steps().len()), (0, 2));
        session.apply(&add(Effect::Coulomb, "2")).unwrap();
        visit(&mut ledger, &session, 0.1);
        assert_eq!(ledger.path(), [0, 2], "the other way is kept beside this one");
        let labels: Vec<&str> = ledger.steps().iter().map(|s| s.label.as_str()).collect();
        assert_eq!(labels, ["Model as opened", "+ viscous dashpot at DOF 1", "+ Coulomb friction at DOF 2"]);
        let rows: Vec<Vec<String>> =
            ledger.table().lines().map(|l| l.split('\t').map(str::to_owned).collect()).collect();
        assert!(rows.len() == 4 && rows.iter().all(|r| r.len() == rows[0].len()), "{rows:?}");
        assert_eq!(rows[3][1..4], ["+ Coulomb friction at DOF 2", "0", "1e-1"]);
        assert_eq!((rows[2][5].as_str(), rows[3][5].as_str()), ("no", "yes"));
        // A candidate does not act in the model: no step.
        let source = SourceAt { law: Effect::Coulomb, dofs: vec!["2".into()], elements: None, state: None };
        session.apply(&Command::SetSourceState { source, state: State::Candidate }).unwrap();
        visit(&mut ledger, &session, 0.3);
        assert_eq!((ledger.current(), ledger.steps().len()), (0, 3));
    }
}
