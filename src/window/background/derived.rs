//! What is computed from the document, each remembering the revision it was computed from; everything that may take longer
//! than a frame in the background.

use crate::classical::FrequencyResponses;
use crate::classical::incompleteness::{self, Grid, Incompleteness};
use crate::classical::side_by_side::{SideBySide, side_by_side};
use crate::control::Control;
use crate::identify::{self, Measurements, Outcome};
use crate::measurement::Quantity;
use crate::plots::bode::ReceptanceCurve;
use crate::plots::forward;
use crate::plots::hysteresis::HysteresisPlot;
use crate::plots::unsteady_record::UnsteadyRecord;
use crate::session::Revisions;
use crate::session::states::{self, Against, Compared};
use crate::structure::modes::Modes;
use crate::window::app::view::View;
use crate::window::background::cache::{Background, Cache, Cached};
use crate::window::document::Document;
use crate::window::document::prepared_records::{PreparedRecord, PreparedRecords};
use crate::window::explained::Explained;
use crate::window::schematic::Scene;
use egui::Context;
use std::sync::Arc;

/// Displacement of every DOF in a run; empty where it cannot be expanded.
pub(crate) type Motion = Vec<faer::c64>;

/// Revision, response DOF, excited DOF.
type Asked = (u64, usize, usize);

/// Everything derived.
#[derive(Debug)]
pub struct Derived {
    scene: Option<(u64, Arc<Scene>)>,
    modes: Cache<u64, Modes>,
    outcome: Cache<u64, Outcome>,
    response: Cache<Asked, ReceptanceCurve>,
    motions: Cache<u64, Vec<Motion>>,
    loops: Cache<(u64, usize), Vec<HysteresisPlot>>,
    methods: Cache<u64, SideBySide>,
    incompleteness: Cache<u64, Incompleteness>,
    change: Cache<(u64, Against), Compared>,
    unsteady: Cache<(u64, usize, usize), UnsteadyRecord>,
    prepared_records: PreparedRecords,
    seen: Revisions,
    /// Of the stage Explain.
    pub explained: Explained,
}

impl Default for Derived {
    fn default() -> Self {
        Self {
            scene: None,
            modes: Cache::of_last("Modes"),
            outcome: Cache::of_last("Identifying"),
            response: Cache::of_last("Frequency response"),
            motions: Cache::of_last("Expanding the runs"),
            loops: Cache::of_last("Hysteresis"),
            methods: Cache::of_last("Classical methods"),
            incompleteness: Cache::of_last("Study of incompleteness"),
            change: Cache::of_last("Comparing two states"),
            unsteady: Cache::of_last("Preparing a record"),
            prepared_records: PreparedRecords::default(),
            seen: Revisions::default(),
            explained: Explained::default(),
        }
    }
}

impl Derived {
    /// Forgets what no longer belongs to the document as it stands.
    pub fn keep_up(&mut self, document: &Document) {
        let now = document.session().revisions();
        if self.seen.structure != now.structure || self.seen.measurements != now.measurements {
            self.prepared_records.clear();
        }
        self.seen = now;
    }

    /// Gives up what is being computed; it starts again with the next change.
    pub fn cancel(&mut self) {
        self.explained.cancel();
        let work: [&mut dyn Background; 10] = [
            &mut self.outcome,
            &mut self.modes,
            &mut self.response,
            &mut self.motions,
            &mut self.loops,
            &mut self.methods,
            &mut self.incompleteness,
            &mut self.change,
            &mut self.unsteady,
            &mut self.prepared_records,
        ];
        work.into_iter().for_each(Background::cancel);
    }

    /// The motion of every DOF in every run at its fundamental, m or rad: measured where it is, expanded where it is not.
    pub fn motions(&mut self, ctx: &Context, document: &Document) -> Option<Cached<Vec<Motion>>> {
        let outcome = self.known_outcome(document)?.ok();
        self.motions.obtain(ctx, &document.revision(), || {
            let p = document.project.clone();
            move |_: &Control| forward::motions(&p, outcome.as_deref())
        })
    }

    /// The scene of the schematic.
    pub fn scene(&mut self, document: &Document) -> Arc<Scene> {
        if let Some((revision, scene)) = &self.scene
            && *revision == document.revision()
        {
            return Arc::clone(scene);
        }
        let p = &document.project;
        let scene = Scene::new(&p.structure, &p.sources, &p.runs).with_records(&p.transient_runs);
        let scene = Arc::new(scene);
        self.scene = Some((document.revision(), Arc::clone(&scene)));
        scene
    }

    /// Undamped modes of the structure as it stands; `None` while they are computed.
    pub fn modes(&mut self, ctx: &Context, document: &Document) -> Option<Cached<Modes>> {
        self.modes.obtain(ctx, &document.session().revisions().structure, || {
            let structure = document.project.structure.clone();
            move |_: &Control| structure.modes().map_err(|e| e.to_string())
        })
    }

    /// Name and progress of the job that runs, if one does.
    pub fn running(&self) -> Option<(&str, f64)> {
        let work: [&dyn Background; 10] = [
            &self.outcome,
            &self.modes,
            &self.response,
            &self.motions,
            &self.loops,
            &self.methods,
            &self.incompleteness,
            &self.change,
            &self.unsteady,
            &self.prepared_records,
        ];
        work.into_iter().find_map(Background::running).or_else(|| self.explained.running())
    }

    /// A channel of a run, by its index in the fit.
    pub fn trace(&mut self, ctx: &Context, document: &Document, run: usize, channel: usize) -> PreparedRecord {
        self.prepared_records.get(ctx, &document.project.runs, run, channel)
    }

    /// A channel of a record that is not steady, ready to be drawn; `None` while it is prepared.
    pub fn unsteady(
        &mut self,
        ctx: &Context,
        document: &Document,
        [record, channel]: [usize; 2],
    ) -> Option<Cached<UnsteadyRecord>> {
        let key = (document.session().revisions().measurements, record, channel);
        self.unsteady.obtain(ctx, &key, || {
            let run = document.project.transient_runs.get(record).cloned();
            move |_: &Control| {
                let found = run.as_ref().and_then(|run| UnsteadyRecord::new(run, channel));
                found.ok_or_else(|| "there is no such record".to_owned())
            }
        })
    }

    /// The answer of the identification for the document as it stands; `None` while it is computed.
    pub fn outcome(&mut self, ctx: &Context, document: &Document) -> Option<Cached<Outcome>> {
        self.outcome.obtain(ctx, &document.revision(), || {
            let p = document.project.clone();
            move |control: &Control| {
                let given = Measurements { runs: &p.runs, transient_runs: &p.transient_runs, ratios: &[] };
                let found = identify::identify_measured(&p.structure, &p.sources, given, &p.settings, control);
                found.map_err(|e| e.to_string())
            }
        })
    }

    /// Every classical method that the data allow; `None` while they run.
    pub fn methods(&mut self, ctx: &Context, document: &Document) -> Option<Cached<SideBySide>> {
        self.methods.obtain(ctx, &document.revision(), || {
            let p = document.project.clone();
            move |control: &Control| {
                side_by_side(&p.structure, &p.sources, &p.runs, &p.reference_shapes, control).map_err(|e| e.to_string())
            }
        })
    }

    /// Errors of the classical methods on this structure against modes and sensors: with its known damping, else with the
    /// identified one; `None` while it is computed.
    pub fn incompleteness(&mut self, ctx: &Context, document: &Document) -> Option<Cached<Incompleteness>> {
        let p = &document.project;
        let truth = match incompleteness::known_damping(&p.structure, &p.sources) {
            Some(known) => known,
            None => match self.known_outcome(document)? {
                Ok(outcome) => outcome.results.equivalent_viscous.clone(),
                Err(error) => return Some(Err(error)),
            },
        };
        self.incompleteness.obtain(ctx, &document.revision(), || {
            let structure = p.structure.clone();
            let own = FrequencyResponses::from_runs(&p.runs).map_or_else(Vec::new, |r| r.sensors);
            move |control: &Control| {
                let grid = Grid::new(&structure, &own);
                incompleteness::incompleteness(&structure, truth.as_ref(), &grid, control).map_err(|e| e.to_string())
            }
        })
    }

    /// What changed between an earlier state and the project as it stands; `None` while both are identified.
    pub fn change(&mut self, ctx: &Context, document: &Document, against: &Against) -> Option<Cached<Compared>> {
        self.change.obtain(ctx, &(document.revision(), against.clone()), || {
            let (p, against) = (document.project.clone(), against.clone());
            move |control: &Control| {
                let states = states::states(&p, &against, control)?;
                states::compare(states, control).map_err(|e| e.to_string())
            }
        })
    }

    /// The answer, if it is there and fresh; starts nothing.
    pub fn known_outcome(&self, document: &Document) -> Option<Cached<Outcome>> {
        self.outcome.known(&document.revision())
    }

    /// Receptance of the identified model between the selected DOF (else the last sensor) and the exciter.
    pub fn response(&mut self, ctx: &Context, document: &Document, view: &View) -> Option<Cached<ReceptanceCurve>> {
        let outcome = match self.known_outcome(document)? {
            Ok(outcome) => outcome,
            Err(error) => return Some(Err(error)),
        };
        let p = &document.project;
        let channels = || p.runs.iter().flat_map(|r| &r.fit.channels).map(|c| &c.channel);
        let excitation = channels().find(|c| c.quantity == Quantity::Force).map(|c| c.dof);
        let sensor = channels().filter(|c| c.quantity != Quantity::Force).map(|c| c.dof).next_back();
        let (Some(excitation), Some(sensor)) = (excitation, sensor) else {
            return Some(Err("No run has a force and a motion.".to_owned()));
        };
        let asked = (document.revision(), view.dof.unwrap_or(sensor), excitation);
        self.response.obtain(ctx, &asked, || {
            let (structure, sources) = (p.structure.clone(), forward::acting(p, &outcome));
            let omega = forward::frequencies(p, &outcome);
            move |control: &Control| forward::receptance(&structure, &sources, omega, [asked.1, asked.2], control)
        })
    }

    /// Hysteresis loops of a run from the identified model's steady state; `None` while they are computed.
    pub fn loops(&mut self, ctx: &Context, document: &Document, run: usize) -> Option<Cached<Vec<HysteresisPlot>>> {
        let outcome = match self.known_outcome(document)? {
            Ok(outcome) => outcome,
            Err(error) => return Some(Err(error)),
        };
        self.loops.obtain(ctx, &(document.revision(), run), || {
            let p = document.project.clone();
            move |_: &Control| forward::run_loops(&p, &outcome, run)
        })
    }
}
