//! A carriage that a motor moves: a mass without a spring, its force and its position recorded in a closed loop, as one identifies the
//! friction of drives.

use crate::common::models::{oscillator, source};
use dashpot::control::Control;
use dashpot::diagnosis::records::{Records, compare_records, diagnose_records};
use dashpot::diagnosis::result::{Diagnosis, Verdict};
use dashpot::diagnosis::updating::parameters::UpdatingParameter;
use dashpot::effects::{Effect, Source, State};
use dashpot::measurement::transient_run::TransientLabel;
use dashpot::measurement::{Channel, Flag, Kind, Quantity, Record, TransientRun};
use dashpot::structure::{Part, Structure};
use std::sync::Arc;

const STEP: f64 = 2e-3;
const FINE: usize = 40;
const MASS: f64 = 95.0;
const DASHPOT: f64 = 200.0;
/// Where the carriage goes, m, in how many seconds, and how long it rests there.
const STROKES: [(f64, f64, f64); 6] =
    [(0.2, 1.6, 0.4), (0.02, 1.6, 0.3), (0.22, 1.2, 0.4), (0.0, 1.2, 0.3), (0.15, 0.8, 0.4), (0.05, 0.8, 0.4)];

/// Where it is wanted at a time.
fn wanted(t: f64) -> f64 {
    let (mut from, mut begins) = (0.0, 0.3);
    for (to, seconds, rest) in STROKES {
        let share = ((t - begins) / seconds).clamp(0.0, 1.0);
        if t < begins + seconds + rest {
            return from + (to - from) * share.powi(3) * (10.0 - 15.0 * share + 6.0 * share * share);
        }
        (from, begins) = (to, begins + seconds + rest);
    }
    from
}

/// Its record with a friction of `friction` N and a constant pull of `offset` N, by small steps that stop it where it comes to rest; the
/// encoder has steps of half a micrometre.
fn recorded(friction: f64, offset: f64) -> TransientRun {
    let (mut x, mut v, h) = (0.0_f64, 0.0_f64, STEP / FINE as f64);
    let mut rows = vec![Vec::new(), Vec::new()];
    for n in 0..5000 {
        let t = STEP * f64::from(n);
        let speed = (wanted(t + STEP) - wanted(t)) / STEP;
        let force = MASS * (400.0 * (wanted(t) - x) + 32.0 * (speed - v));
        rows[0].push(force);
        rows[1].push((x / 5e-7).round() * 5e-7);
        for _ in 0..FINE {
            let drives = force - DASHPOT * v - offset;
            let against = if v == 0.0 { drives.clamp(-friction, friction) } else { friction.copysign(v) };
            let next = v + h * (drives - against) / MASS;
            v = if next * v < 0.0 { 0.0 } else { next };
            x += h * v;
        }
    }
    // The generator holds its force over a step: half a step later it is that of straight lines.
    let held: Vec<f64> = rows[0].clone();
    rows[0] = (0..held.len()).map(|n| 0.5 * (held[n] + held[n.saturating_sub(1)])).collect();
    let channel = |quantity| Channel { quantity, dof: 0, label: "1".into() };
    let channels = vec![channel(Quantity::Force), channel(Quantity::Displacement)];
    let time = (0..rows[0].len()).map(|n| STEP * n as f64).collect();
    let record = Record::new(time, channels, rows).unwrap();
    let label = TransientLabel { file: "drive.csv".into(), kind: Kind::Transient, enabled: true, ..Default::default() };
    TransientRun::new(label, Arc::new(record), &[]).unwrap()
}

/// A model whose mass is 3 % too large, with these known sources.
fn diagnosed(run: &TransientRun, known: &[Source]) -> (Structure, Diagnosis) {
    let model = oscillator(1.03 * MASS, 0.0);
    let records = Records::new(&model, known, std::slice::from_ref(run)).unwrap();
    let diagnosis = diagnose_records(&records, &[], &Control::unattended(), &|_| {}).unwrap();
    (model, diagnosis)
}

fn told(diagnosis: &Diagnosis) -> Vec<(Effect, Vec<f64>)> {
    let sure = diagnosis.suggestions.iter().filter(|s| s.probability > 0.5);
    sure.map(|s| (s.added.source.effect, s.added.source.parameters.clone())).collect()
}

/// Mass and dashpot are corrected beside the friction that is found, and the project so corrected shows what was promised.
#[test]
fn the_friction_of_a_drive_is_found_beside_a_wrong_mass() {
    let (run, known) = (recorded(20.0, -3.0), [source(Effect::Viscous, &[0], &[0.75 * DASHPOT])]);
    assert!(!run.findings.iter().any(|f| matches!(f.flag, Flag::Clipped | Flag::OtherKind)), "{:?}", run.findings);
    let (model, diagnosis) = diagnosed(&run, &known);
    let told = told(&diagnosis);
    let [(Effect::AsymmetricCoulomb, friction)] = &told[..] else { panic!("{told:?}") };
    assert!((friction[0] / 20.0 - 1.0).abs() < 0.02 && (friction[1] / -3.0 - 1.0).abs() < 0.05, "{friction:?}");
    let (mut corrected, mut factors) = (known.to_vec(), Vec::new());
    for correction in &diagnosis.corrections {
        match &correction.parameter {
            UpdatingParameter::Known(0) => corrected[0].parameters[0] *= correction.factor,
            UpdatingParameter::Structure(part) => factors.push((*part, correction.factor)),
            other => panic!("{other:?}"),
        }
    }
    let mass = factors.iter().find(|(part, _)| *part == Part::Mass).map_or(1.0, |(_, factor)| *factor);
    assert!((1.03 * mass - 1.0).abs() < 0.01, "{mass}");
    assert!((corrected[0].parameters[0] / DASHPOT - 1.0).abs() < 0.02, "{corrected:?}");
    corrected.push(Source { state: State::Known, ..diagnosis.suggestions[0].added.source.clone() });
    let model = model.with_factors(&factors);
    let records = Records::new(&model, &corrected, std::slice::from_ref(&run)).unwrap();
    let error = compare_records(&records, &[], &Control::unattended()).unwrap().error;
    let promised = diagnosis.steps.last().unwrap().error;
    assert!((error / promised - 1.0).abs() < 0.02 && error < 0.01, "{error} and {promised}");
}

/// Without a dashpot in the model both are missing, each by its plainest law.
#[test]
fn friction_and_a_dashpot_of_a_drive_are_found_together() {
    let (_, diagnosis) = diagnosed(&recorded(20.0, 0.0), &[]);
    let told = told(&diagnosis);
    let of = |effect: Effect| told.iter().find(|(e, _)| *e == effect).map_or(f64::NAN, |(_, p)| p[0]);
    assert!(told.len() == 2 && (of(Effect::Viscous) / DASHPOT - 1.0).abs() < 0.02, "{told:?}");
    let friction = told.iter().find(|(e, _)| matches!(e, Effect::Coulomb | Effect::AsymmetricCoulomb)).unwrap();
    assert!((friction.1[0] / 20.0 - 1.0).abs() < 0.02, "{told:?}");
}

/// A drive of which nothing is missing is only stated a little wrongly; a dashpot of a third of its size is missing the rest.
#[test]
fn what_is_stated_of_a_drive_is_corrected_as_far_as_that_is_believed() {
    let run = recorded(0.0, 0.0);
    let (_, slight) = diagnosed(&run, &[source(Effect::Viscous, &[0], &[0.8 * DASHPOT])]);
    assert!(slight.verdict == Verdict::Detuned && slight.suggestions.is_empty(), "{:?}", slight.suggestions);
    let (_, much) = diagnosed(&run, &[source(Effect::Viscous, &[0], &[DASHPOT / 3.0])]);
    let told = told(&much);
    let [(Effect::Viscous, more)] = &told[..] else { panic!("{told:?} {:?}", much.corrections) };
    assert!((more[0] / (2.0 / 3.0 * DASHPOT) - 1.0).abs() < 0.03, "{more:?}");
}
