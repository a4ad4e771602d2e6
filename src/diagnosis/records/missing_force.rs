//! The force that a model lacks in its records, over the displacement and the velocity at its place, with the law through it
//! (restoring force: Masri and Caughey 1979): [`FreeForce`] over parts of two periods of large, middle and small motion.

use super::compare::started;
use super::data::{RecordData, RecordDiagnosisError, Records};
use super::fit_motion::FitMotion;
use super::free_force::{FreeForce, in_band};
use super::localisation::locate;
use crate::control::Control;
use crate::diagnosis::candidates::restoring_force::{ForcePoint, RestoringForce, RunForce};
use crate::diagnosis::result::{Diagnosis, Verdict};
use crate::diagnosis::updating::parameters::UpdatingParameter;
use crate::effects::{Family, Place, Source, State};
use crate::math::statistics::root_mean_square;
use crate::response::transient::force_along;
use crate::structure::Part;

/// Periods of the dominant motion that a part shows.
const PERIODS: f64 = 2.0;
/// Motion in the parts that are shown, over the largest.
const SIZES: [f64; 3] = [1.0, 0.5, 0.2];
/// Most parts of all records.
const MOST: usize = 3;
/// Share of a record at either end that is not shown: a spectrum does not know whether its ends meet.
const ENDS: f64 = 0.04;
/// Force over its deviation from which on it is shown.
const CLEAR: f64 = 2.0;
/// Most points of a part.
const POINTS: usize = 120;

/// What a diagnosis of records leaves to be seen: the force of its suggestion `source` beside all else that it found, its law drawn
/// through unless nothing explains the records; without a suggestion the force at the place that explains most.
///
/// `None` for laws of the whole structure and where no record shows the force.
///
/// # Errors
/// [`RecordDiagnosisError`]: a model that cannot be predicted.
pub fn missing_force(
    records: &Records,
    diagnosis: &Diagnosis,
    source: Option<&Source>,
    control: &Control,
) -> Result<Option<RestoringForce>, RecordDiagnosisError> {
    let part = |parameter: &UpdatingParameter| match parameter {
        UpdatingParameter::Structure(part) => Some(*part),
        _ => None,
    };
    let factors: Vec<(Part, f64)> =
        diagnosis.corrections.iter().filter_map(|c| Some((part(&c.parameter)?, c.factor))).collect();
    let structure = records.structure.with_factors(&factors);
    let mut corrected = records.on(&structure)?;
    for correction in &diagnosis.corrections {
        if let UpdatingParameter::Known(k) = correction.parameter
            && let Some(known) = corrected.known.get_mut(k)
        {
            known.effect.scaled().iter().for_each(|&p| known.parameters[p] *= correction.factor);
        }
    }
    let last = diagnosis.steps.last().map_or(&[][..], |step| &step.added);
    let found: Vec<Source> = last.iter().map(|a| a.source.clone()).collect();
    let Some(source) = source else {
        let all = Family::EachTranslation.places(&structure).into_iter().chain(Family::EachPair.places(&structure));
        let best = locate(&corrected, &all.collect::<Vec<Place>>(), 0.0).into_iter().next();
        return best.map_or(Ok(None), |best| at_place(&corrected, &[], &best.place, None, control));
    };
    let others: Vec<Source> = found.iter().filter(|e| !e.is_same(source)).cloned().collect();
    // What is suggested in place of the best set was not found beside it.
    let others = if others.len() < found.len() { others } else { Vec::new() };
    let law = (diagnosis.verdict != Verdict::Unexplained).then_some(source);
    at_place(&corrected, &others, &source.place, law, control)
}

/// The force at a place beside `others`.
fn at_place(
    records: &Records,
    others: &[Source],
    place: &Place,
    law: Option<&Source>,
    control: &Control,
) -> Result<Option<RestoringForce>, RecordDiagnosisError> {
    let (Place::Dofs(_), Some(leg)) = (place, place.legs().first().copied()) else { return Ok(None) };
    let (mut linear, drawn) = with_others(records, others, law, control)?;
    linear.list = drawn;
    let record_force = |r: usize| FreeForce::new(&linear, &linear.list[r], leg).map(|force| (r, force));
    let found: Vec<(usize, FreeForce)> = control.map(linear.list.len(), record_force).into_iter().flatten().collect();
    control.check()?;
    let clear = |force: &FreeForce| root_mean_square(&force.force) > CLEAR * force.deviation;
    let mut parts: Vec<(f64, RunForce)> = found
        .iter()
        .filter(|(_, force)| clear(force))
        .flat_map(|(r, force)| parts(&linear.list[*r], force, law))
        .collect();
    parts.sort_by(|a, b| b.0.total_cmp(&a.0));
    while parts.len() > MOST {
        // Of two parts of like size one is enough.
        let ratio = |k: &usize| parts[*k].0 / parts[k + 1].0;
        let Some(next) = (0..parts.len() - 1).min_by(|a, b| ratio(a).total_cmp(&ratio(b))) else { break };
        parts.remove(next + 1);
    }
    parts.reverse();
    let runs: Vec<RunForce> =
        parts.into_iter().enumerate().map(|(level, (_, run))| RunForce { level, ..run }).collect();
    Ok((!runs.is_empty()).then(|| RestoringForce { place: place.clone(), law: law.cloned(), runs }))
}

/// The records beside linear sources only, those of `others` among them; what other sources do stands as forces in each record.
fn with_others<'a>(
    records: &Records<'a>,
    others: &[Source],
    law: Option<&Source>,
    control: &Control,
) -> Result<(Records<'a>, Vec<RecordData>), RecordDiagnosisError> {
    let all: Vec<Source> = records.known.iter().chain(others).cloned().collect();
    let (linear, other): (Vec<Source>, Vec<Source>) = all.into_iter().partition(|s| s.effect.is_linear());
    let mut list = records.list.clone();
    if !other.is_empty() {
        let effects: Vec<Source> =
            others.iter().chain(law).map(|s| Source { state: State::Known, ..s.clone() }).collect();
        let motion = FitMotion::new(records, &started(records, &effects, control)?, control)?;
        for (source, leg) in other.iter().flat_map(|s| s.place.legs().into_iter().map(move |leg| (s, leg))) {
            for (r, record) in list.iter_mut().enumerate() {
                let Some([d, v, a]) = motion.relative(leg, r) else { continue };
                let Some(force) = force_along(source, [&d, &v, &a], record.step) else { continue };
                let signed = |sign: f64| force.iter().map(|f| sign * f).collect::<Vec<f64>>();
                record.drives.push(leg.first);
                record.forces.push(signed(-1.0));
                if let Some(second) = leg.second {
                    record.drives.push(second);
                    record.forces.push(signed(1.0));
                }
            }
        }
    }
    Ok((Records { known: linear, ..records.clone() }, list))
}

/// Parts of a record of different amplitude, each with the root mean square of its displacement.
fn parts(record: &RecordData, free: &FreeForce, law: Option<&Source>) -> Vec<(f64, RunForce)> {
    let count = free.force.len();
    let length = ((PERIODS / (record.dominant_hz * record.step)) as usize).clamp(8, count / 4 + 8);
    let [from, to] = [ENDS, 1.0 - ENDS].map(|share| (share * count as f64) as usize);
    let starts: Vec<usize> = (from..to.saturating_sub(length)).step_by((length / 2).max(1)).collect();
    let size = |start: usize| root_mean_square(&free.motion[0][start..start + length]);
    let sizes: Vec<f64> = starts.iter().map(|&start| size(start)).collect();
    let most = sizes.iter().copied().fold(0.0, f64::max);
    let along = law.and_then(|law| {
        let [d, v, a] = &free.motion;
        Some(in_band(&force_along(law, [d, v, a], record.step)?, free.lines))
    });
    let mut taken: Vec<usize> = Vec::new();
    for wanted in SIZES {
        let off = |k: &usize| (sizes[*k] / (wanted * most)).ln().abs();
        let nearest = (0..starts.len()).min_by(|a, b| off(a).total_cmp(&off(b)));
        taken.extend(nearest.filter(|k| !taken.contains(k)));
    }
    let part = |k: usize| {
        let start = starts[k];
        let points = |force: &[f64], every: usize| -> Vec<ForcePoint> {
            let point_at_sample =
                |n: usize| ForcePoint { displacement: free.motion[0][n], velocity: free.motion[1][n], force: force[n] };
            (start..start + length).step_by(every).map(point_at_sample).collect()
        };
        let second = |n: usize| record.first_s + n as f64 * record.step;
        let run = RunForce {
            run: record.index,
            level: 0,
            level_name: format!("{:.2} s", second(start)),
            frequency_hz: record.dominant_hz,
            harmonics: 0,
            points: points(&free.force, length.div_ceil(POINTS)),
            deviation: free.deviation,
            law: along.as_ref().map_or_else(Vec::new, |force| points(force, 1)),
        };
        (sizes[k], run)
    };
    taken.into_iter().map(part).collect()
}
