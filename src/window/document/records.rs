//! Records that were read and fitted, kept for every state of the document that needs them: undo reads no file again.

use crate::control::Control;
use crate::exchange::project::Plan;
use crate::exchange::project::file::RunTable;
use crate::exchange::project::frf::FrfTable;
use crate::measurement::unsettled::take_unsettled;
use crate::measurement::{Run, TransientRun};
use crate::session::Document as State;
use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};

/// What the fit of a record depends on.
type Key = (String, u64);

/// Fitted runs by what they depend on; one entry a record, several runs for a file of harmonics.
#[derive(Debug, Clone, Default)]
pub(crate) struct Records {
    kept: HashMap<Key, Vec<Run>>,
    unsteady: HashMap<Key, TransientRun>,
}

/// Records that a change needs and that are still to be read: long work.
#[derive(Debug, Clone)]
pub(crate) struct Missing {
    state: State,
    runs: Vec<(usize, Key)>,
    unsteady: Vec<(usize, Key)>,
    harmonics: Vec<Key>,
    responses: Vec<(usize, Key)>,
}

/// Records that were read.
#[derive(Debug)]
pub(crate) struct Fitted {
    runs: Vec<(Key, Vec<Run>)>,
    unsteady: Vec<(Key, TransientRun)>,
}

impl Records {
    /// The runs of a state of the document in the order of its file, as far as their records were read.
    pub(crate) fn runs(&self, state: &State) -> Vec<Run> {
        let (file, on) = (state.file(), common(state));
        let recorded = file.run.iter().filter(|table| file.is_steady(table.kind)).filter_map(|table| {
            let mut run = self.kept.get(&run_key(table, on))?.first()?.clone();
            (run.enabled, run.insisted) = (table.enabled != Some(false), table.enabled == Some(true));
            (run.level, run.session) = (table.level, table.session.clone());
            Some(run)
        });
        let fitted = file.harmonics.iter().filter_map(|table| self.kept.get(&(table.file.clone(), on)));
        let responses = file.frf.iter().filter_map(|table| self.kept.get(&frf_key(table, on)));
        let mut runs: Vec<Run> =
            recorded.chain(fitted.flatten().cloned()).chain(responses.flatten().cloned()).collect();
        // The command line tells of it; here the table of the runs shows their flags.
        let _ = take_unsettled(&mut runs);
        runs
    }

    /// The decays and transients of a state of the document, as far as they were read.
    pub(crate) fn transient_runs(&self, state: &State) -> Vec<TransientRun> {
        let (file, on) = (state.file(), common(state));
        let unsteady = file.run.iter().filter(|table| !file.is_steady(table.kind));
        let run = |table: &RunTable| {
            let mut run = self.unsteady.get(&unsteady_key(table, on))?.clone();
            (run.enabled, run.level, run.session) = (table.enabled != Some(false), table.level, table.session.clone());
            Some(run)
        };
        unsteady.filter_map(run).collect()
    }

    /// What a state of the document needs and is not read yet.
    pub(crate) fn missing(&self, state: &State) -> Option<Missing> {
        let (file, on) = (state.file(), common(state));
        let steady = file.run.iter().enumerate().filter(|(_, table)| file.is_steady(table.kind));
        let runs: Vec<(usize, Key)> = steady.map(|(k, table)| (k, run_key(table, on))).collect();
        let runs: Vec<(usize, Key)> = runs.into_iter().filter(|(_, key)| !self.kept.contains_key(key)).collect();
        let unsteady = file.run.iter().enumerate().filter(|(_, table)| !file.is_steady(table.kind));
        let unsteady: Vec<(usize, Key)> = unsteady.map(|(k, table)| (k, unsteady_key(table, on))).collect();
        let unsteady: Vec<(usize, Key)> =
            unsteady.into_iter().filter(|(_, key)| !self.unsteady.contains_key(key)).collect();
        let harmonics: Vec<Key> = file.harmonics.iter().map(|table| (table.file.clone(), on)).collect();
        let harmonics = if harmonics.iter().all(|key| self.kept.contains_key(key)) { Vec::new() } else { harmonics };
        let responses = file.frf.iter().enumerate().map(|(k, table)| (k, frf_key(table, on)));
        let responses: Vec<(usize, Key)> = responses.filter(|(_, key)| !self.kept.contains_key(key)).collect();
        let any = !runs.is_empty() || !unsteady.is_empty() || !harmonics.is_empty() || !responses.is_empty();
        any.then(|| Missing { state: state.clone(), runs, unsteady, harmonics, responses })
    }

    /// Keeps what was read.
    pub(crate) fn take(&mut self, fitted: Fitted) {
        self.kept.extend(fitted.runs);
        self.unsteady.extend(fitted.unsteady);
    }
}

impl Missing {
    /// Reads and fits.
    ///
    /// # Errors
    /// One line: file, line, what is wrong and how to mend it; or cancelled.
    pub(crate) fn read(self, control: &Control) -> Result<Fitted, String> {
        let plan = self.state.plan(&self.state.folder().join("project.toml")).map_err(|e| e.to_string())?;
        let mut fitted = Vec::new();
        let count = self.runs.len() + self.unsteady.len() + self.harmonics.len();
        let unsteady = unsteady(&plan, &self.unsteady, self.runs.len(), count, control)?;
        for (done, (index, key)) in self.runs.into_iter().enumerate() {
            control.check().map_err(|e| e.to_string())?;
            let piece = control.piece(done, count);
            fitted.push((key, vec![plan.run(index, &piece).map_err(|e| e.to_string())?]));
            piece.report(1.0);
        }
        if !self.harmonics.is_empty() {
            fitted.extend(harmonics(&plan, &self.harmonics)?);
        }
        for (index, key) in self.responses {
            fitted.push((key, plan.frf(index, control).map_err(|e| e.to_string())?.runs));
        }
        Ok(Fitted { runs: fitted, unsteady })
    }
}

/// Decays and transients; they are pieces of the work from number `first` of `count` on.
fn unsteady(
    plan: &Plan,
    missing: &[(usize, Key)],
    first: usize,
    count: usize,
    control: &Control,
) -> Result<Vec<(Key, TransientRun)>, String> {
    let read = |(done, (index, key)): (usize, &(usize, Key))| {
        control.check().map_err(|e| e.to_string())?;
        let piece = control.piece(first + done, count);
        let run = plan.transient_run(*index, &piece).map_err(|e| e.to_string())?;
        piece.report(1.0);
        Ok((key.clone(), run))
    };
    missing.iter().enumerate().map(read).collect()
}

/// Runs that came as fitted harmonics; each file's runs bear its name or stand in its order.
fn harmonics(plan: &Plan, keys: &[Key]) -> Result<Vec<(Key, Vec<Run>)>, String> {
    let corrections = plan.corrections();
    let harmonics_of = |(index, key): (usize, &Key)| {
        let read = plan.harmonics_of(index).map_err(|e| e.to_string())?;
        let fitted = read.into_iter().map(|fitted| fitted.run(&corrections));
        let runs =
            fitted.map(|run| plan.on_its_base(None, run).map_err(|e| e.to_string())).collect::<Result<_, _>>()?;
        Ok((key.clone(), runs))
    };
    keys.iter().enumerate().map(harmonics_of).collect()
}

/// Runs of a file of frequency responses depend on all that its table says.
fn frf_key(table: &FrfTable, on: u64) -> Key {
    let mut hasher = DefaultHasher::new();
    (on, format!("{table:?}")).hash(&mut hasher);
    (table.file.clone(), hasher.finish())
}

/// What all fits of a state depend on: number of harmonics, errors of the channels, rows of the DOFs.
fn common(state: &State) -> u64 {
    let mut hasher = DefaultHasher::new();
    let file = state.file();
    file.analysis.harmonics.hash(&mut hasher);
    file.base.hash(&mut hasher);
    for sensor in &file.sensor {
        (&sensor.channel, sensor.delay.map(f64::to_bits), sensor.gain.map(f64::to_bits)).hash(&mut hasher);
    }
    // How laboratory files are read.
    format!("{:?}", file.channel).hash(&mut hasher);
    for dof in state.structure().dofs() {
        dof.label.hash(&mut hasher);
    }
    hasher.finish()
}

fn run_key(table: &RunTable, common: u64) -> Key {
    let mut hasher = DefaultHasher::new();
    let part = [table.frequency, table.start_s, table.end_s, table.sampling_hz];
    (common, &table.set, &table.sets, part.map(|value| value.map(f64::to_bits))).hash(&mut hasher);
    (table.file.clone(), hasher.finish())
}

/// A record that is not steady also depends on its kind and on the window over its motion.
fn unsteady_key(table: &RunTable, common: u64) -> Key {
    let (file, on) = run_key(table, common);
    let mut hasher = DefaultHasher::new();
    (on, format!("{:?}", table.kind), table.exponential_window_s.map(f64::to_bits)).hash(&mut hasher);
    (file, hasher.finish())
}
