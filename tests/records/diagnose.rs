//! Hidden effects in decays and hammers, their records made by the independent stepping of the whole structure.

use crate::common::models::{short_cantilever, whole};
use dashpot::control::Control;
use dashpot::diagnosis::records::{Records, compare_records, diagnose_records, missing_force};
use dashpot::diagnosis::result::{Added, Diagnosis, Step, Verdict};
use dashpot::diagnosis::updating::parameters::UpdatingParameter;
use dashpot::effects::{Effect, Place, Source, State};
use dashpot::measurement::transient_run::TransientLabel;
use dashpot::measurement::{Channel, Flag, Kind, Quantity, Record, TransientRun};
use dashpot::response::time_integration::TimeModel;
use dashpot::structure::{Part, Structure};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::sync::Arc;

const STEP: f64 = 1e-3;
/// Steps of the truth a sample.
const FINE: usize = 40;

/// A release from the shape of mode 1, 3 mm at the tip, recorded at three places with 0.3 % noise.
fn decay(structure: &Structure, truth: &[Source], samples: usize, seed: u64) -> TransientRun {
    decay_of(structure, truth, &[3e-3], (samples, seed))
}

/// The same from the shapes of several modes, each so many metres at the tip.
fn decay_of(structure: &Structure, truth: &[Source], tips: &[f64], (samples, seed): (usize, u64)) -> TransientRun {
    let mut model = TimeModel::under_force(structure, truth, None, STEP / FINE as f64).unwrap();
    let modes = structure.modes().unwrap();
    let n = structure.len();
    let part = |r: usize, dof: usize| tips[r] * modes.shapes[(dof, r)] / modes.shapes[(n - 2, r)];
    let start: Vec<f64> = (0..n).map(|dof| (0..tips.len()).map(|r| part(r, dof)).sum()).collect();
    model.start(&start, &vec![0.0; n]);
    let dofs = [n - 2, n - 4, 0];
    let mut rows: Vec<Vec<f64>> = vec![Vec::new(); 3];
    for _ in 0..samples {
        for (row, &dof) in rows.iter_mut().zip(&dofs) {
            row.push(model.displacement(dof));
        }
        model.run(FINE).unwrap();
    }
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    for row in &mut rows {
        let size = (row.iter().map(|x| x * x).sum::<f64>() / samples as f64).sqrt();
        row.iter_mut().for_each(|x| {
            // The sum of twelve uniform numbers is normal enough for a test.
            let normal: f64 = (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0;
            *x += 3e-3 * size * normal;
        });
    }
    let time = (0..samples).map(|k| STEP * k as f64).collect();
    let channel = |&dof: &usize| Channel { quantity: Quantity::Displacement, dof, label: structure.label(dof).into() };
    let record = Record::new(time, dofs.iter().map(channel).collect(), rows).unwrap();
    let label = TransientLabel { file: "decay.csv".into(), kind: Kind::Decay, enabled: true, ..Default::default() };
    TransientRun::new(label, Arc::new(record), &[]).unwrap()
}

fn at(effect: Effect, dof: usize, parameters: &[f64]) -> Source {
    Source::known(effect, Place::Dofs(vec![dof]), parameters)
}

/// A model with what it knows, and the record of a beam that hides more.
struct Project {
    model: Structure,
    known: Vec<Source>,
    runs: [TransientRun; 1],
}

impl Project {
    fn new(model: Structure, hidden: &[Source]) -> Self {
        let known = vec![at(Effect::Viscous, 6, &[0.05])];
        let truth: Vec<Source> = known.iter().chain(hidden).cloned().collect();
        Self { model, known, runs: [decay(&short_cantilever(4), &truth, 1500, 7)] }
    }

    /// Of a record of `specimen` that shows three modes, beside a model of the beam.
    fn of_three_modes(specimen: &Structure, known: Vec<Source>) -> Self {
        let runs = [decay_of(specimen, &known, &[3e-3, 1e-3, 3e-4], (1500, 7))];
        Self { model: short_cantilever(4), known, runs }
    }

    fn records(&self) -> Records<'_> {
        Records::new(&self.model, &self.known, &self.runs).unwrap()
    }

    fn diagnosed(&self, control: &Control) -> Diagnosis {
        diagnose_records(&self.records(), &[], control, &|_| {}).unwrap()
    }

    /// The project with the corrections and the first suggestion.
    fn applied(&self, diagnosis: &Diagnosis) -> Self {
        let mut factors = Vec::new();
        let mut known = self.known.clone();
        for correction in &diagnosis.corrections {
            match &correction.parameter {
                UpdatingParameter::Structure(part) => factors.push((*part, correction.factor)),
                UpdatingParameter::Known(k) => known[*k].parameters[0] *= correction.factor,
                other => panic!("{other:?}"),
            }
        }
        let first = diagnosis.suggestions.first();
        known.extend(first.map(|s| Source { state: State::Known, ..s.added.source.clone() }));
        Self { model: self.model.with_factors(&factors), known, runs: self.runs.clone() }
    }
}

fn diagnosed(hidden: &[Source]) -> Diagnosis {
    Project::new(short_cantilever(4), hidden).diagnosed(&Control::unattended())
}

fn found(diagnosis: &Diagnosis, effect: Effect, dof: usize, value: f64) {
    let first = &diagnosis.suggestions[0];
    let names: Vec<String> =
        diagnosis.suggestions.iter().map(|s| format!("{} {:?}", s.added.source.effect, s.added.source.place)).collect();
    assert_eq!(diagnosis.verdict, Verdict::Missing, "{names:?}");
    assert!(first.added.source.is_same(&at(effect, dof, &[value])), "{names:?}");
    let [p, d] = [first.added.source.parameters[0], first.added.deviations[0]];
    assert!((p / value - 1.0).abs() < 0.03, "{p} +- {d} against {value}");
    assert!(first.error_after < 0.3 * diagnosis.error_before);
}

#[test]
fn friction_in_a_decay_is_found() {
    found(&diagnosed(&[at(Effect::Coulomb, 4, &[0.02])]), Effect::Coulomb, 4, 0.02);
}

#[test]
fn a_cubic_spring_in_a_decay_is_found() {
    found(&diagnosed(&[at(Effect::CubicStiffness, 6, &[2e7])]), Effect::CubicStiffness, 6, 2e7);
}

/// Lasers that stand off the beam by many times its motion show the same decay; what is taken out is told.
#[test]
fn sensors_off_zero_change_nothing() {
    let project = Project::new(short_cantilever(4), &[at(Effect::CubicStiffness, 6, &[2e7])]);
    let run = &project.runs[0];
    let channel = |c: usize| run.samples(c).iter().map(|y| y + 0.05 * (c + 1) as f64).collect::<Vec<f64>>();
    let samples = (0..run.channels().len()).map(channel).collect();
    let record = Record::new(run.time().to_vec(), run.channels().to_vec(), samples).unwrap();
    let label = TransientLabel { file: "decay.csv".into(), kind: Kind::Decay, enabled: true, ..Default::default() };
    let moved = TransientRun::new(label, Arc::new(record), &[]).unwrap();
    assert_eq!(moved.findings.iter().filter(|f| f.flag == Flag::Offset).count(), 3, "{:?}", moved.findings);
    assert!(run.findings.iter().all(|f| f.flag != Flag::Offset), "{:?}", run.findings);
    let project = Project { runs: [moved], ..project };
    found(&project.diagnosed(&Control::unattended()), Effect::CubicStiffness, 6, 2e7);
}

/// Modes that are off by a per cent in frequency, each its own way: what is told is found beside them, and once all of it stands
/// in the project, the error is the one that was promised.
#[test]
fn the_error_after_adding_is_the_one_that_was_promised() {
    let model =
        short_cantilever(4).with_factors(&[(Part::Mode(0), 1.02), (Part::Mode(1), 0.975), (Part::Stiffness, 1.01)]);
    let project = Project::new(model, &[at(Effect::Coulomb, 4, &[0.02])]);
    let diagnosis = project.diagnosed(&Control::unattended());
    found(&diagnosis, Effect::Coulomb, 4, 0.02);
    // Error and noise floor of the model as it is are those that comparing shows.
    let as_is = compare_records(&project.records(), &[], &Control::unattended()).unwrap();
    assert!((diagnosis.error_before / as_is.error - 1.0).abs() < 1e-9, "{} {}", diagnosis.error_before, as_is.error);
    let floors = [diagnosis.noise_floor, as_is.noise_floor];
    assert!((floors[0] / floors[1] - 1.0).abs() < 1e-9 && floors[0] > 0.0, "{floors:?}");
    let applied = project.applied(&diagnosis);
    let error = compare_records(&applied.records(), &[], &Control::unattended()).unwrap().error;
    let promised = diagnosis.suggestions[0].error_after;
    assert!((error / promised - 1.0).abs() < 0.05, "{error} against {promised}: {:?}", diagnosis.corrections);
}

/// Whose time is up is told what there is, and that it is not all.
#[test]
fn an_answer_in_a_hurry_says_so() {
    let control = Control::unattended();
    control.hurry();
    let diagnosis = Project::new(short_cantilever(4), &[at(Effect::Coulomb, 4, &[0.02])]).diagnosed(&control);
    assert!(!diagnosis.complete && diagnosis.error_before > 0.1);
}

#[test]
fn a_model_that_agrees_is_left_alone() {
    let diagnosis = diagnosed(&[]);
    assert_eq!(diagnosis.verdict, Verdict::Adequate);
    assert!(diagnosis.suggestions.is_empty() && diagnosis.corrections.is_empty());
}

/// Modes that are damped in another proportion than the stated laws give are told as that, and no damper is missing; once all of it
/// stands in the project, the error is the one that was promised.
#[test]
fn modes_that_are_damped_otherwise_than_stated_are_told() {
    let wrong = [(Part::ModeDamping(0), 1.4), (Part::ModeDamping(1), 0.65), (Part::ModeDamping(2), 1.3)];
    let whole = |effect, value| Source::known(effect, Place::Whole(None), &[value]);
    let known = vec![whole(Effect::StiffnessProportional, 2e-6), whole(Effect::MassProportional, 1.0)];
    let project = Project::of_three_modes(&short_cantilever(4).with_factors(&wrong), known);
    let diagnosis = project.diagnosed(&Control::unattended());
    assert!(diagnosis.suggestions.is_empty(), "{:?}", diagnosis.suggestions);
    assert_eq!(diagnosis.verdict, Verdict::Detuned);
    for (part, factor) in wrong {
        let told = diagnosis.corrections.iter().find(|c| c.parameter == UpdatingParameter::Structure(part));
        let told = told.unwrap_or_else(|| panic!("{:?}", diagnosis.corrections));
        assert!((told.factor - factor).abs() < (3.0 * told.deviation).max(0.1), "{told:?}");
    }
    let applied = project.applied(&diagnosis);
    let error = compare_records(&applied.records(), &[], &Control::unattended()).unwrap().error;
    let promised = diagnosis.steps.last().unwrap().error;
    assert!((error / promised - 1.0).abs() < 0.05 && error < 0.2 * diagnosis.error_before, "{error} {promised}");
}

/// Of a specimen that was warmer in one test than in the other nothing is missing, and how much of the error that makes is said.
#[test]
fn frequencies_that_differ_from_record_to_record_are_no_effect() {
    let model = short_cantilever(4);
    let known = vec![at(Effect::Viscous, 6, &[0.05])];
    let stiffness = [1.018, 1.022];
    let specimen = |factor: f64| decay(&model.with_factors(&[(Part::Stiffness, factor)]), &known, 1500, 7);
    let runs = stiffness.map(specimen);
    let records = Records::new(&model, &known, &runs).unwrap();
    let diagnosis = diagnose_records(&records, &[], &Control::unattended(), &|_| {}).unwrap();
    assert!(diagnosis.suggestions.is_empty(), "{:?}", diagnosis.suggestions);
    assert_eq!(diagnosis.verdict, Verdict::Detuned);
    let last = diagnosis.steps.last().unwrap().error;
    let test = diagnosis.test_errors.unwrap();
    let scatter = 0.5 * (stiffness[1] / stiffness[0]).ln() / 2.0_f64.sqrt();
    assert!((test.frequency_scatter / scatter - 1.0).abs() < 0.1, "{} of {scatter}", test.frequency_scatter);
    assert!(test.error_left < 5e-3 && last > 4.0 * test.error_left, "{} of {last}", test.error_left);
}

/// A clamp that the model takes for rigid and that gives way is told as that, and nothing is missing.
#[test]
fn a_clamp_that_gives_way_is_told() {
    let clamp = Part::Support(short_cantilever(4).supports()[0]);
    let project = Project::of_three_modes(
        &short_cantilever(4).with_factors(&[(clamp, 0.5)]),
        vec![at(Effect::Viscous, 6, &[0.05])],
    );
    let diagnosis = project.diagnosed(&Control::unattended());
    assert!(diagnosis.suggestions.is_empty(), "{:?}", diagnosis.suggestions);
    assert_eq!(diagnosis.verdict, Verdict::Detuned);
    let told = diagnosis.corrections.iter().find(|c| c.parameter == UpdatingParameter::Structure(clamp));
    let told = told.unwrap_or_else(|| panic!("{:?}", diagnosis.corrections));
    assert!((told.factor - 0.5).abs() < (3.0 * told.deviation).max(0.05), "{told:?}");
    let last = diagnosis.steps.last().unwrap();
    assert!(last.error < 0.1 * diagnosis.error_before, "{} of {}", last.error, diagnosis.error_before);
}

/// The force that is drawn is that of the hidden law along the motion that the stepped truth has there.
#[test]
fn the_missing_force_of_a_decay_is_that_of_its_law() {
    let hidden = at(Effect::CubicStiffness, 6, &[2e7]);
    let project = Project::new(short_cantilever(4), std::slice::from_ref(&hidden));
    let added = Added { source: hidden.clone(), deviations: vec![0.0] };
    let step = Step { added: vec![added], error: 0.0, misfit: 1.0 };
    let diagnosis = Diagnosis { error_before: 1.0, verdict: Verdict::Missing, ..Diagnosis::adequate(step, 0.0) };
    let drawn = missing_force(&project.records(), &diagnosis, Some(&hidden), &Control::unattended()).unwrap();
    let drawn = drawn.expect("the force stands out");
    assert!(drawn.runs.len() >= 2, "large and small motion");
    let all = || drawn.runs.iter().flat_map(|run| &run.points);
    let (mut left, mut size, mut most) = (0.0, 0.0, 0.0_f64);
    for point in all() {
        let force = 2e7 * point.displacement.powi(3);
        left += (point.force - force).powi(2);
        size += force * force;
        most = most.max(point.displacement.abs());
    }
    assert!(left < 0.04 * size, "{:.3} of the force is off", (left / size).sqrt());
    // Released from 3 mm.
    assert!(most > 2e-3 && most < 3.2e-3, "{most}");
    let deviation = drawn.runs[0].deviation;
    assert!(
        left / (all().count() as f64) < (4.0 * deviation).powi(2).max(0.01 * size / all().count() as f64),
        "{deviation}"
    );
}

/// A beam of 2 % less stiffness and half the loss factor that its model states: both are told, and no effect.
#[test]
fn a_loss_factor_that_is_off_is_corrected() {
    let specimen = short_cantilever(4).with_factors(&[(Part::Stiffness, 0.98)]);
    let project = Project::of_three_modes(&specimen, vec![whole(Effect::LossFactor, 0.02)]);
    let project = Project { known: vec![whole(Effect::LossFactor, 0.04)], ..project };
    let diagnosis = project.diagnosed(&Control::unattended());
    assert_eq!(diagnosis.verdict, Verdict::Detuned, "{diagnosis:?}");
    let factor = |wanted: UpdatingParameter| {
        let correction = diagnosis.corrections.iter().find(|c| c.parameter == wanted);
        correction.unwrap_or_else(|| panic!("{diagnosis:?}")).factor
    };
    let [loss, stiffness] = [UpdatingParameter::Known(0), UpdatingParameter::Structure(Part::Stiffness)].map(factor);
    assert!((loss - 0.5).abs() < 0.02 && (stiffness - 0.98).abs() < 0.002, "{loss} {stiffness}");
}
