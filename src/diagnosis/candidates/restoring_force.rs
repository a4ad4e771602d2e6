//! The missing force as an engineer sees it: over the displacement and over the velocity at its place (Masri and Caughey,
//! "A nonparametric identification technique for nonlinear dynamic problems", J. Appl. Mech. 46, 1979).
//!
//! A free complex force `g_r,h` (N) at the place explains the residual of run `r` at harmonic `h` whatever the law; `D_r,h`
//! (m) is the relative displacement there that it implies. Over a period
//!
//! ```text
//! f_r(t) = Re sum_h g_r,h exp(i h w_r t)     d_r(t) = Re sum_h D_r,h exp(i h w_r t)     v_r(t) = d'_r(t)
//! sigma_r^2 = sum_h sigma_r,h^2              sigma_r,h: standard deviation of a real part of g_r,h
//! ```
//!
//! and `f` over `d` shows springs and hysteresis, `f` over `v` damping and friction. A law that is compared with them is
//! taken on the same motion and cut off at the same harmonics. Neither has its mean: periodic runs do not show it.

use crate::control::Control;
use crate::diagnosis::candidates::friction::friction;
use crate::diagnosis::candidates::identified_force::PlaceData;
use crate::diagnosis::localisation::cell::{FreeForce, shrunk};
use crate::diagnosis::localisation::location::Spot;
use crate::diagnosis::residual::data::{Data, DiagnosisError, Problem, RunData};
use crate::diagnosis::residual::levels::Levels;
use crate::diagnosis::residual::prediction::{Predictor, SEARCH};
use crate::diagnosis::result::Diagnosis;
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::diagnosis::updating::correction::Correction;
use crate::diagnosis::updating::parameters::Updating;
use crate::effects::{Law, Motion, Place, Source};
use faer::c64;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Most runs that are drawn: more loops cannot be told apart.
const MOST_RUNS: usize = 6;
/// Every so many samples of a period is a point.
const EVERY: usize = 4;
/// Amplitude of the motion, over the largest, below which a run is a dot at the origin.
const VISIBLE: f64 = 0.08;
/// Part of the force that the deviation may be, for a run to show anything.
const CLEAR: f64 = 0.5;

/// Force, relative displacement and velocity of a place at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForcePoint {
    /// Relative displacement, m (rad for rotations).
    pub displacement: f64,
    /// Relative velocity, m/s (rad/s).
    pub velocity: f64,
    /// Force of the missing effect on the structure's surroundings, N (N m).
    pub force: f64,
}

/// The missing force in one run.
#[derive(Debug, Clone, PartialEq)]
pub struct RunForce {
    /// Index of the run in the project.
    pub run: usize,
    /// Number of its level, from the least up.
    pub level: usize,
    /// Name of its level.
    pub level_name: String,
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Harmonics that the force was identified at.
    pub harmonics: usize,
    /// Identified points of one period.
    pub points: Vec<ForcePoint>,
    /// Standard deviation of the force of a point, N.
    pub deviation: f64,
    /// The law on the same motion, cut off at the same harmonics: a closed curve; empty without a law.
    pub law: Vec<ForcePoint>,
}

/// The missing force at a place.
#[derive(Debug, Clone, PartialEq)]
pub struct RestoringForce {
    /// Where it acts.
    pub place: Place,
    /// The law that is drawn through it.
    pub law: Option<Source>,
    /// Runs, lowest level first.
    pub runs: Vec<RunForce>,
}

/// The missing force at the place of `source`, one effect of the set `found`, with the `corrections` of the model that go
/// with it, and the law of `source` through it where `with_law`.
///
/// `None` for errors of channels and laws of the whole structure, for points without a model, and where no run shows it.
///
/// # Errors
/// What keeps the model from being compared.
pub fn restoring_force(
    problem: &Problem,
    found: &[Source],
    corrections: &[Correction],
    source: &Source,
    with_law: bool,
    control: &Control,
) -> Result<Option<RestoringForce>, DiagnosisError> {
    if problem.structure.matrices().is_none() || !matches!(source.place, Place::Dofs(_)) {
        return Ok(None);
    }
    let others: Vec<Source> = found.iter().filter(|e| !e.is_same(source)).cloned().collect();
    // What is suggested in place of the best set was not found beside it.
    let others = if others.len() < found.len() { others } else { Vec::new() };
    let data = Data::new(problem)?;
    let reference = ReferenceModel::new(corrected(problem, corrections, &data)?, &data, control, &|_| {})?;
    let set: Vec<Source> = others.iter().chain(std::iter::once(source)).cloned().collect();
    let fit = reference.estimator().fit(&set, 1, &SEARCH, &[])?;
    let law = with_law.then_some(source);
    let levels = Levels::new(problem, &data);
    Ok(reference.place_data(&fit, source)?.and_then(|place| drawn(&place, &source.place, law, &data, &levels)))
}

/// The missing force at the place that explains most, whatever the law: what is left to see where nothing was named.
///
/// # Errors
/// What keeps the model from being compared.
pub fn at_best_place(
    problem: &Problem,
    corrections: &[Correction],
    control: &Control,
) -> Result<Option<RestoringForce>, DiagnosisError> {
    if problem.structure.matrices().is_none() {
        return Ok(None);
    }
    let data = Data::new(problem)?;
    let reference = ReferenceModel::new(corrected(problem, corrections, &data)?, &data, control, &|_| {})?;
    let mut view = reference.view(None)?;
    let is_leg = |s: usize| matches!(view.screen.spots[s], Spot::Leg(_));
    let Some(best) = view.screen.singles().iter().map(|p| p.spots[0]).find(|&s| is_leg(s)) else { return Ok(None) };
    reference.need(&mut view, &[best])?;
    let (forces, fields) = reference.free(&view, &[best]);
    let place = reference.at_place(&view, best, &forces[0], &fields);
    Ok(drawn(&place, &view.screen.spots[best].place(), None, &data, &Levels::new(problem, &data)))
}

/// What a diagnosis leaves to be seen: the force of its suggestion `source`, its law drawn through unless nothing explains
/// the data; without a suggestion the force at the best place.
///
/// # Errors
/// What keeps the model from being compared.
pub fn of_diagnosis(
    problem: &Problem,
    diagnosis: &Diagnosis,
    source: Option<&Source>,
    control: &Control,
) -> Result<Option<RestoringForce>, DiagnosisError> {
    let unexplained = diagnosis.verdict == crate::diagnosis::result::Verdict::Unexplained;
    let Some(source) = source else { return at_best_place(problem, &diagnosis.corrections, control) };
    let last = diagnosis.steps.last();
    let found: Vec<Source> = last.map_or_else(Vec::new, |s| s.added.iter().map(|a| a.source.clone()).collect());
    restoring_force(problem, &found, &diagnosis.corrections, source, !unexplained, control)
}

/// The known model with what the search corrected.
fn corrected(problem: &Problem, corrections: &[Correction], data: &Data) -> Result<Arc<Predictor>, DiagnosisError> {
    let predictor = Predictor::new(problem.structure, problem.known(), data)?;
    let updating = Updating {
        parameters: corrections.iter().map(|c| c.parameter.clone()).collect(),
        values: corrections.iter().map(|c| c.factor.ln()).collect(),
        ..Updating::default()
    };
    Ok(Arc::new(if updating.is_empty() { predictor } else { predictor.updated(&updating)? }))
}

fn drawn(data: &PlaceData, place: &Place, law: Option<&Source>, all: &Data, levels: &Levels) -> Option<RestoringForce> {
    let mut chosen = informative_runs(data, levels);
    chosen.sort_by_key(|&r| (levels.numbers[r], r));
    let runs: Vec<RunForce> = chosen.iter().map(|&r| run_force(data, law, &all.runs[r], r, levels)).collect();
    (!runs.is_empty()).then(|| RestoringForce { place: place.clone(), law: law.cloned(), runs })
}

fn run_force(data: &PlaceData, law: Option<&Source>, run: &RunData, r: usize, levels: &Levels) -> RunForce {
    let motion = &data.motions[r];
    let points = points(motion, &data.histories[r]).into_iter().step_by(EVERY).collect();
    let on_motion = |source: &Source| {
        let mut curve = points_of_law(data, source, r)?;
        curve.extend(curve.first().copied());
        Some(curve)
    };
    RunForce {
        run: run.index,
        level: levels.numbers[r],
        level_name: levels.names[r].clone(),
        frequency_hz: run.omega / TAU,
        harmonics: data.forces[r].iter().filter(|f| f.weight > 0.0).count(),
        points,
        deviation: deviation(&data.forces[r]),
        law: law.and_then(on_motion).unwrap_or_default(),
    }
}

/// Samples of a period.
fn points(motion: &Motion, force: &[f64]) -> Vec<ForcePoint> {
    let moving = motion.displacement.iter().zip(&motion.velocity);
    moving.zip(force).map(|((&displacement, &velocity), &force)| ForcePoint { displacement, velocity, force }).collect()
}

/// The law of `source` on the motion of run `r`, with the harmonics of the identified force.
fn points_of_law(data: &PlaceData, source: &Source, r: usize) -> Option<Vec<ForcePoint>> {
    let law: &dyn Law = source.effect.law()?;
    let (order, motion) = (data.forces[r].len(), &data.motions[r]);
    let harmonics: Vec<c64> = match friction(source.effect) {
        Some(friction) => data.held(friction, &source.parameters, r, order),
        None => data.law_force(law, &source.parameters, r, order),
    };
    Some(points(motion, &data.sampling.motion(1.0, 0.0, &harmonics).displacement))
}

/// Standard deviation of a sample of a free force, its higher harmonics drawn towards zero as [`shrunk`] does.
fn deviation(forces: &[FreeForce]) -> f64 {
    let variance = |(i, free): (usize, &FreeForce)| {
        if free.weight <= 0.0 {
            return 0.0;
        }
        let share = if free.value.norm() > 0.0 { shrunk(forces, i + 1).norm() / free.value.norm() } else { 1.0 };
        share * share / free.weight
    };
    forces.iter().enumerate().map(variance).sum::<f64>().sqrt()
}

/// The runs that tell most: of every level the one whose motion is largest; beside these, where there is room, others whose
/// motion is far from theirs.
fn informative_runs(data: &PlaceData, levels: &Levels) -> Vec<usize> {
    let amplitude = |r: usize| data.motions[r].harmonics.first().map_or(0.0, |d| d.norm());
    let clear = |r: &usize| {
        let Some(first) = data.forces[*r].first() else { return false };
        first.weight > 0.0 && deviation(&data.forces[*r]) < CLEAR * first.value.norm()
    };
    let mut rest: Vec<usize> = (0..data.motions.len()).filter(clear).collect();
    let largest = rest.iter().map(|&r| amplitude(r)).fold(0.0, f64::max);
    rest.retain(|&r| amplitude(r) > VISIBLE * largest);
    rest.sort_by(|&a, &b| amplitude(b).total_cmp(&amplitude(a)));
    let mut chosen: Vec<usize> = Vec::new();
    for &r in &rest {
        if chosen.len() < MOST_RUNS && chosen.iter().all(|&c| levels.numbers[c] != levels.numbers[r]) {
            chosen.push(r);
        }
    }
    rest.retain(|r| !chosen.contains(r));
    let apart = |r: usize, chosen: &[usize]| {
        chosen.iter().map(|&c| (amplitude(r) / amplitude(c)).ln().abs()).fold(f64::INFINITY, f64::min)
    };
    while chosen.len() < MOST_RUNS / 2 {
        let next = rest.iter().copied().max_by(|&a, &b| apart(a, &chosen).total_cmp(&apart(b, &chosen)));
        let Some(next) = next.filter(|&r| apart(r, &chosen) > 0.3) else { break };
        chosen.push(next);
        rest.retain(|&r| r != next);
    }
    chosen
}

#[cfg(test)]
mod tests {
    use super::deviation;
    use crate::diagnosis::localisation::cell::FreeForce;
    use faer::c64;

    /// The force of a sample is a sum of `Re g exp(i phi)`, whose variance is that of one real part of `g`.
    #[test]
    fn a_sample_scatters_as_its_harmonics_do() {
        let one = FreeForce { value: c64::new(3.0, 0.0), weight: 25.0 };
        assert!((deviation(&[one]) - 0.2).abs() < 1e-15);
        // A second harmonic that the data hardly see is drawn to zero and adds next to nothing.
        let unseen = FreeForce { value: c64::new(50.0, 0.0), weight: 1e-6 };
        assert!(deviation(&[one, unseen]) < 0.21);
    }
}
