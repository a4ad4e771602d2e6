//! What is computed for the stage Explain, each by the model it was computed from: comparisons, diagnoses, fingerprints,
//! response curves; and the ledger of all models that were looked at.

pub(crate) mod first_suggestions;
mod jobs;
pub(crate) mod ledger;
pub(crate) mod model;

use crate::diagnosis::candidates::fingerprint_plot::Print;
use crate::diagnosis::candidates::restoring_force::RestoringForce;
use crate::diagnosis::records::compare::OneRecord;
use crate::diagnosis::result::Suggestion;
use crate::diagnosis::updating::scatter::Scatter;
use crate::diagnosis::{Comparison, Diagnosis};
use crate::effects::{Place, Source};
use crate::exchange::Project;
use crate::plots::record_residual::RecordResidual;
use crate::plots::response_curve::Curve;
use crate::session::validation::only_records;
use crate::window::background::cache::{Background, Cache, Cached};
use crate::window::document::Document;
use egui::Context;
use first_suggestions::FirstSuggestions;
use jobs::{compare_job, curve_job, decay_job, force_job, print_job, record_job, scatter_job, search_job};
use ledger::Ledger;
use model::{Key, Search};
use std::sync::Arc;
use std::time::Duration;

/// Error beyond which a model lacks its damping altogether, and the search waits until it is asked for.
pub const WITHOUT_DAMPING: f64 = 10.0;

/// A model with or without an effect on trial.
pub type Tried = (Key, Option<Source>);

/// A record that is not steady by its number in the project, and the channel that is looked at; `None` is the worst.
pub type Shown = (usize, Option<String>);

/// What the stage wants to see beside the comparison.
#[derive(Debug, Clone, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is a part of the stage that is wanted or not")]
pub struct Wanted {
    /// Whether suggestions are wanted.
    pub diagnosis: bool,
    /// Whether even for a model that is far from the data.
    pub anyway: bool,
    /// The effect on trial.
    pub trial: Option<Source>,
    /// The suggestion whose card is open.
    pub named: Option<Source>,
    /// Whether its fingerprint is shown.
    pub print: bool,
    /// Whether the missing force is shown: that of this suggestion, else at the place that explains most.
    pub force: bool,
    /// The record that is not steady that is shown.
    pub record: Option<Shown>,
    /// Whether corrections and scatter are shown.
    pub scatter: bool,
    /// Time after which the search answers with the best so far.
    pub limit: Option<Duration>,
    /// The run whose neighbourhood is shown.
    pub curve: Option<usize>,
}

/// Everything computed for the stage.
#[derive(Debug)]
pub struct Explained {
    key: Option<(u64, Key)>,
    /// The project as the jobs read it, shared by all of one revision.
    project: Option<(u64, Arc<Project>)>,
    comparisons: Cache<Tried, Comparison>,
    trials: Cache<Tried, Comparison>,
    diagnoses: Cache<Search, Diagnosis>,
    early: FirstSuggestions,
    prints: Cache<(Search, Source), Option<Print>>,
    forces: Cache<(Search, Option<Source>), Option<RestoringForce>>,
    scatters: Cache<Search, Option<Scatter>>,
    curves: Cache<(Key, usize), Vec<Curve>>,
    trial_curves: Cache<(Tried, usize), Vec<Curve>>,
    decays: Cache<Tried, Vec<OneRecord>>,
    records: Cache<(Tried, Shown), RecordResidual>,
    /// The way so far.
    pub ledger: Ledger,
}

impl Default for Explained {
    fn default() -> Self {
        Self {
            key: None,
            project: None,
            comparisons: Cache::new("Comparing"),
            trials: Cache::new("Trying"),
            diagnoses: Cache::new("Searching for what is missing"),
            early: FirstSuggestions::default(),
            prints: Cache::new("Fingerprint"),
            forces: Cache::new("Missing force"),
            scatters: Cache::new("Scatter of channels and runs"),
            curves: Cache::new("Frequency response"),
            trial_curves: Cache::new("Frequency response"),
            decays: Cache::new("Records of the model"),
            records: Cache::new("Preparing a record"),
            ledger: Ledger::default(),
        }
    }
}

/// How far suggestions may be trusted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Standing {
    /// The search has ended.
    Final,
    /// It has not: sizes, errors and probabilities may still change.
    Provisional,
    /// They are of an earlier search on the same model, before something else was ruled out or allowed again.
    Before,
}

impl Explained {
    /// The key of the document as it stands.
    pub fn key(&mut self, document: &Document) -> Key {
        if let Some((revision, key)) = &self.key
            && *revision == document.revision()
        {
            return key.clone();
        }
        let fresh = Key::new(document.session().document());
        let key = match &self.key {
            Some((_, old)) if *old == fresh => old.clone(),
            _ => fresh,
        };
        self.key = Some((document.revision(), key.clone()));
        key
    }

    fn project(&mut self, document: &Document) -> Arc<Project> {
        if let Some((revision, project)) = &self.project
            && *revision == document.revision()
        {
            return Arc::clone(project);
        }
        let project = Arc::new(document.project.clone());
        self.project = Some((document.revision(), Arc::clone(&project)));
        project
    }

    /// Takes in what has been computed and starts what is wanted and not there yet.
    pub fn update(&mut self, ctx: &Context, document: &Document, wanted: &Wanted) {
        self.collect();
        if document.project.runs.is_empty() && !only_records(&document.project) {
            return;
        }
        let key = self.key(document);
        let p = &self.project(document);
        let search = Search::new(key.clone(), document.session().document());
        let tried = (key.clone(), None);
        self.comparisons.want(ctx, &tried, || compare_job(p, None));
        let Some(Ok(comparison)) = self.comparisons.get(&tried) else { return };
        self.ledger.visit(&key, document.session().document(), comparison);
        if wanted.diagnosis && (wanted.anyway || comparison.error <= WITHOUT_DAMPING) {
            let limit = wanted.limit;
            self.diagnoses.want(ctx, &search, || search_job(p, &search, limit, self.early.expect(ctx, &search)));
        }
        self.on_trial(ctx, p, &key, wanted);
        match wanted.named.as_ref().filter(|_| wanted.print) {
            Some(source) => {
                let asked = (search.clone(), source.clone());
                let diagnosis = self.diagnoses.get(&search).and_then(|d| d.as_ref().ok()).map(Arc::clone);
                self.prints.want(ctx, &asked, || print_job(p, diagnosis, source));
            }
            None => self.prints.rest(),
        }
        match self.diagnoses.get(&search).and_then(|d| d.as_ref().ok()).filter(|_| wanted.force).map(Arc::clone) {
            Some(diagnosis) => {
                let asked = (search.clone(), wanted.named.clone());
                self.forces.want(ctx, &asked, || force_job(p, diagnosis, wanted.named.clone()));
            }
            None => self.forces.rest(),
        }
        match self.diagnoses.get(&search).and_then(|d| d.as_ref().ok()).filter(|_| wanted.scatter).map(Arc::clone) {
            Some(diagnosis) => self.scatters.want(ctx, &search, || scatter_job(p, diagnosis)),
            None => self.scatters.rest(),
        }
        if only_records(p) {
            return self.records_of(ctx, p, (key, wanted.trial.clone()), wanted.record.as_ref());
        }
        match wanted.curve.filter(|_| p.structure.matrices().is_some()) {
            Some(run) => self.curves.want(ctx, &(key, run), || curve_job(p, None, run)),
            None => self.curves.rest(),
        }
    }

    fn collect(&mut self) {
        self.early.collect();
        self.background_mut().into_iter().for_each(Background::collect);
    }

    /// All that may run; the search first, since it takes longest.
    fn background(&self) -> [&dyn Background; 10] {
        [
            &self.diagnoses,
            &self.comparisons,
            &self.trials,
            &self.prints,
            &self.forces,
            &self.scatters,
            &self.curves,
            &self.trial_curves,
            &self.decays,
            &self.records,
        ]
    }

    fn background_mut(&mut self) -> [&mut dyn Background; 10] {
        [
            &mut self.diagnoses,
            &mut self.comparisons,
            &mut self.trials,
            &mut self.prints,
            &mut self.forces,
            &mut self.scatters,
            &mut self.curves,
            &mut self.trial_curves,
            &mut self.decays,
            &mut self.records,
        ]
    }

    /// Records that are not steady with the model's, and the one that is shown ready to be drawn.
    fn records_of(&mut self, ctx: &Context, p: &Arc<Project>, tried: Tried, shown: Option<&Shown>) {
        self.decays.want(ctx, &tried, || decay_job(p, tried.1.as_ref()));
        if let (Some(Ok(found)), Some(shown)) = (self.decays.get(&tried), shown) {
            self.records
                .want(ctx, &(tried, shown.clone()), || record_job(p, Arc::clone(found), shown.0, shown.1.clone()));
        }
    }

    fn on_trial(&mut self, ctx: &Context, p: &Arc<Project>, key: &Key, wanted: &Wanted) {
        let Some(source) = &wanted.trial else {
            self.trials.rest();
            self.trial_curves.rest();
            return;
        };
        let tried = (key.clone(), Some(source.clone()));
        self.trials.want(ctx, &tried, || compare_job(p, Some(source)));
        // An error of a channel does not change how the structure moves.
        let moves = !matches!(source.place, Place::Channel(_));
        if let Some(run) = wanted.curve.filter(|_| moves && p.structure.matrices().is_some()) {
            self.trial_curves.want(ctx, &(tried, run), || curve_job(p, Some(source), run));
        }
    }

    /// The comparison of the document as it stands, if it is there; starts nothing.
    pub fn comparison(&self, document: &Document) -> Option<&Cached<Comparison>> {
        self.comparisons.get(&(self.current(document)?, None))
    }

    /// The last comparison of any model: what is shown, faded, while the next one runs.
    pub fn last_comparison(&self) -> Option<&Arc<Comparison>> {
        self.comparisons.last()
    }

    /// The comparison with an effect on trial.
    pub fn trial(&self, document: &Document, source: &Source) -> Option<&Cached<Comparison>> {
        self.trials.get(&(self.current(document)?, Some(source.clone())))
    }

    /// The diagnosis of the document as it stands.
    pub fn diagnosis(&self, document: &Document) -> Option<&Cached<Diagnosis>> {
        self.diagnoses.get(&self.search(document)?)
    }

    /// Suggestions for the document as it stands, best first, and how far they may be trusted. What the user has ruled out
    /// meanwhile may still be among them.
    pub fn suggestions(&self, document: &Document) -> (&[Suggestion], Standing) {
        let Some(search) = self.search(document) else { return (&[], Standing::Provisional) };
        match self.diagnoses.get(&search) {
            Some(Ok(diagnosis)) => return (&diagnosis.suggestions, Standing::Final),
            Some(Err(_)) => return (&[], Standing::Final),
            None => {}
        }
        let early = self.early.of(&search);
        let before = || self.diagnoses.find(|other| other.model == search.model);
        match before() {
            Some(diagnosis) if early.is_empty() => (&diagnosis.suggestions, Standing::Before),
            _ => (early, Standing::Provisional),
        }
    }

    /// Whether the search on the document as it stands was cancelled.
    pub fn is_cancelled(&self, document: &Document) -> bool {
        self.search(document).is_some_and(|search| self.diagnoses.is_cancelled(&search))
    }

    /// The fingerprint of a suggestion.
    pub fn print(&self, document: &Document, source: &Source) -> Option<&Cached<Option<Print>>> {
        let search = self.search(document)?;
        self.prints.get(&(search, source.clone()))
    }

    /// The missing force at the place of a suggestion, or at the place that explains most.
    pub fn force(&self, document: &Document, source: Option<&Source>) -> Option<&Cached<Option<RestoringForce>>> {
        self.forces.get(&(self.search(document)?, source.cloned()))
    }

    /// What the data say of channels and runs.
    pub fn scatter(&self, document: &Document) -> Option<&Cached<Option<Scatter>>> {
        self.scatters.get(&self.search(document)?)
    }

    /// The response curves of the model near a run, one a level.
    pub(crate) fn curve(&self, document: &Document, run: usize) -> Option<&Cached<Vec<Curve>>> {
        self.curves.get(&(self.current(document)?, run))
    }

    /// The response curves with an effect on trial.
    pub(crate) fn trial_curve(&self, document: &Document, source: &Source, run: usize) -> Option<&Cached<Vec<Curve>>> {
        self.trial_curves.get(&((self.current(document)?, Some(source.clone())), run))
    }

    /// Records that are not steady with the model beside them, with an effect on trial.
    pub fn decays(&self, document: &Document, trial: Option<&Source>) -> Option<&Cached<Vec<OneRecord>>> {
        self.decays.get(&(self.current(document)?, trial.cloned()))
    }

    /// One channel of a record that is not steady, ready to be drawn.
    pub fn record(&self, document: &Document, trial: Option<&Source>, shown: Shown) -> Option<&Cached<RecordResidual>> {
        self.records.get(&((self.current(document)?, trial.cloned()), shown))
    }

    fn search(&self, document: &Document) -> Option<Search> {
        Some(Search::new(self.current(document)?, document.session().document()))
    }

    fn current(&self, document: &Document) -> Option<Key> {
        self.key.as_ref().filter(|(revision, _)| *revision == document.revision()).map(|(_, key)| key.clone())
    }

    /// The sources that act in the model, in the order of the project.
    pub fn known(&self, document: &Document) -> Vec<Source> {
        self.current(document).map_or_else(Vec::new, |key| key.0.known.clone())
    }

    /// Name and progress of what runs; the search first, since it takes longest.
    pub fn running(&self) -> Option<(&str, f64)> {
        self.background().into_iter().find_map(Background::running)
    }

    /// Stops all that runs but the comparison of the model as it stands.
    pub fn cancel(&mut self) {
        let [search, _, others @ ..] = self.background_mut();
        search.cancel();
        others.into_iter().for_each(Background::cancel);
    }

    /// The search answers with the best so far, as soon as it can.
    pub fn hurry(&self) {
        self.diagnoses.hurry();
    }

    /// Starts again what was cancelled, failed or ended before its time.
    pub fn retry(&mut self) {
        self.diagnoses.forget(|d| !d.complete);
        self.background_mut().into_iter().for_each(Background::retry);
    }
}
