//! Fingerprints as plots: what an engineer would draw by hand to see which law is missing, run by run, with the slope.
//!
//! ```text
//! place on the structure   c_eq or k_eq = g / D against |D|, brought to one frequency: ln c = const + p ln |D| + q ln w
//! points without a model   c_eq = E / (pi w |D|^2), E the energy that the known sources do not take out
//! channel                  phase (delay: proportional to frequency) and ratio (gain: constant) of measured over model
//! ```

use crate::control::Control;
use crate::diagnosis::candidates::fingerprint::{Exponent, Fingerprint, fingerprint};
use crate::diagnosis::candidates::identified_force::{PlaceData, Ratio};
use crate::diagnosis::points::energies::energies;
use crate::diagnosis::residual::data::{Data, DiagnosisError, Problem, RunData};
use crate::diagnosis::residual::energy_balance::measured_displacement;
use crate::diagnosis::residual::prediction::{FINAL, Predictor, SEARCH};
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::diagnosis::updating::correction::Correction;
use crate::diagnosis::updating::parameters::Updating;
use crate::effects::{Effect, Kind, Place, Source};
use faer::c64;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// What a fingerprint shows upwards.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// Equivalent viscous coefficient, N s/m.
    Damping,
    /// Equivalent stiffness, N/m.
    Stiffness,
    /// Phase of measured over modelled amplitude, degrees.
    Phase,
    /// Measured over modelled amplitude.
    Ratio,
}

/// What it is plotted against.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Against {
    /// Amplitude of the relative motion at the place, m.
    Amplitude,
    /// Frequency, Hz.
    Frequency,
}

/// One run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PrintPoint {
    /// Index of the run in the project.
    pub run: usize,
    /// Amplitude or frequency.
    pub x: f64,
    /// The measure.
    pub y: f64,
    /// Standard deviation of `y`.
    pub deviation: f64,
}

/// One plot.
#[derive(Debug, Clone, PartialEq)]
pub struct Print {
    /// What is shown.
    pub measure: Measure,
    /// Against what.
    pub against: Against,
    /// Runs that show it.
    pub points: Vec<PrintPoint>,
    /// Power of `x` in `y` (both axes logarithmic) for damping and stiffness; degrees per hertz for a phase; mean ratio.
    pub slope: Option<Exponent>,
    /// Frequency to which the points were brought, Hz, where the frequency matters too.
    pub at_frequency: Option<f64>,
}

/// The fingerprint of `source` as one effect of the set `found`, with the `corrections` of the model that go with it; none
/// for the whole structure and where too few runs show it.
///
/// # Errors
/// What keeps the model from being compared.
pub(crate) fn print(
    problem: &Problem,
    found: &[Source],
    corrections: &[Correction],
    source: &Source,
    control: &Control,
) -> Result<Option<Print>, DiagnosisError> {
    let others: Vec<Source> = found.iter().filter(|e| !e.is_same(source)).cloned().collect();
    // What is suggested in place of the best set was not found beside it.
    let others = if others.len() < found.len() { others } else { Vec::new() };
    if problem.structure.matrices().is_none() {
        return of_points(problem, &others, source);
    }
    let data = Data::new(problem)?;
    let predictor = Predictor::new(problem.structure, problem.known(), &data)?;
    let updating = Updating {
        parameters: corrections.iter().map(|c| c.parameter.clone()).collect(),
        values: corrections.iter().map(|c| c.factor.ln()).collect(),
        ..Updating::default()
    };
    let predictor = if updating.is_empty() { predictor } else { predictor.updated(&updating)? };
    let reference = ReferenceModel::new(Arc::new(predictor), &data, control, &|_| {})?;
    match &source.place {
        Place::Dofs(_) => {
            let set: Vec<Source> = others.iter().chain(std::iter::once(source)).cloned().collect();
            let fit = reference.estimator().fit(&set, 1, &SEARCH, &[])?;
            Ok(reference.place_data(&fit, source)?.as_ref().and_then(|place| of_place(place, &data)))
        }
        Place::Channel(name) => of_channel(&reference, &others, name, source.effect),
        Place::Whole(_) => Ok(None),
    }
}

fn of_place(place: &PlaceData, data: &Data) -> Option<Print> {
    let found = fingerprint(place)?;
    let ratios: Vec<(usize, Ratio)> = place.ratios_by_run().into_iter().map(|(r, z)| (data.runs[r].index, z)).collect();
    powers(&ratios, &found)
}

/// Points in the direction of the fingerprint's force, brought to the mean frequency.
fn powers(ratios: &[(usize, Ratio)], found: &Fingerprint) -> Option<Print> {
    let part = |z: &Ratio| if found.damping { z.ratio.im / z.omega } else { z.ratio.re };
    let share = |z: &Ratio| z.deviation / if found.damping { z.omega } else { 1.0 };
    let seen: Vec<&(usize, Ratio)> =
        ratios.iter().filter(|(_, z)| part(z) != 0.0 && share(z) < 0.3 * part(z).abs()).collect();
    if seen.is_empty() {
        return None;
    }
    let mean = (seen.iter().map(|(_, z)| z.omega.ln()).sum::<f64>() / seen.len() as f64).exp();
    let along = found.by_amplitude.is_some() || found.by_frequency.is_none();
    let power = if along { found.by_frequency.map_or(0.0, |q| q[0]) } else { 0.0 };
    let point = |&&(run, z): &&(usize, Ratio)| {
        let scale = (mean / z.omega).powf(power);
        let x = if along { z.amplitude } else { z.omega / TAU };
        PrintPoint { run, x, y: part(&z).abs() * scale, deviation: share(&z) * scale }
    };
    Some(Print {
        measure: if found.damping { Measure::Damping } else { Measure::Stiffness },
        against: if along { Against::Amplitude } else { Against::Frequency },
        points: seen.iter().map(point).collect(),
        slope: if along { found.by_amplitude } else { found.by_frequency },
        at_frequency: (along && found.by_frequency.is_some()).then_some(mean / TAU),
    })
}

/// Measured over modelled fundamental of one channel in every run.
fn of_channel(
    reference: &ReferenceModel,
    others: &[Source],
    name: &str,
    effect: Effect,
) -> Result<Option<Print>, DiagnosisError> {
    let predictions = reference.estimator().predict(others, &FINAL, &[])?;
    let mut ratios: Vec<(usize, f64, c64, f64)> = Vec::new();
    for ((run, prediction), noise) in reference.data.runs.iter().zip(&predictions).zip(&reference.noise.runs) {
        let Some(c) = run.responses.iter().position(|channel| channel.name == name) else { continue };
        let (measured, model) = (run.responses[c].measured[0], prediction.channels[c][0]);
        if model.norm() > 0.0 {
            ratios.push((run.index, run.omega / TAU, measured / model, noise.deviation(c, 1) / model.norm()));
        }
    }
    if ratios.is_empty() {
        return Ok(None);
    }
    let delay = matches!(effect.kind(), Kind::Channel(law) if law.turns_phase());
    let degrees = |z: c64| z.im.atan2(z.re).to_degrees();
    let point = |&(run, x, z, deviation): &(usize, f64, c64, f64)| {
        let (y, deviation) = if delay { (degrees(z), deviation.to_degrees()) } else { (z.norm(), deviation) };
        PrintPoint { run, x, y, deviation }
    };
    let points: Vec<PrintPoint> = ratios.iter().map(point).collect();
    let slope = through(&points, |p| if delay { p.x } else { 1.0 });
    let measure = if delay { Measure::Phase } else { Measure::Ratio };
    Ok(Some(Print { measure, against: Against::Frequency, points, slope, at_frequency: None }))
}

/// Weighted factor `b` of `y = b f(x)` with its standard deviation.
fn through(points: &[PrintPoint], f: impl Fn(&PrintPoint) -> f64) -> Option<Exponent> {
    let weight = |p: &PrintPoint| p.deviation.max(1e-12).powi(-2);
    let normal: f64 = points.iter().map(|p| weight(p) * f(p).powi(2)).sum();
    let product: f64 = points.iter().map(|p| weight(p) * f(p) * p.y).sum();
    (normal > 0.0).then(|| [product / normal, normal.sqrt().recip()])
}

/// Equivalent viscous coefficient of the energy that is not accounted for, at the measured relative motion.
fn of_points(problem: &Problem, others: &[Source], source: &Source) -> Result<Option<Print>, DiagnosisError> {
    let legs = source.place.legs();
    let [leg] = legs[..] else { return Ok(None) };
    let data = Data::every(problem)?;
    let mut ratios = Vec::new();
    for (energy, run) in energies(problem, others)?.iter().zip(&data.runs) {
        let used = crate::diagnosis::residual::data::is_used(&problem.runs[energy.index]);
        let Some(motion) = fundamental(run, leg.first, leg.second).filter(|_| used) else { continue };
        let factor = PI * motion * motion;
        if factor > 0.0 {
            // The energy stands for the imaginary part of force over motion: `E = pi |D|^2 Im (g / D)`.
            let ratio = c64::new(0.0, (energy.input - energy.taken) / factor);
            let deviation = energy.deviation / factor;
            let weight = deviation.max(f64::MIN_POSITIVE).powi(-2);
            ratios.push((energy.index, Ratio { ratio, deviation, weight, amplitude: motion, omega: run.omega }));
        }
    }
    let list: Vec<Ratio> = ratios.iter().map(|(_, z)| *z).collect();
    Ok(crate::diagnosis::candidates::fingerprint::of_ratios(&list).and_then(|found| powers(&ratios, &found)))
}

/// Amplitude of the measured relative motion, m.
fn fundamental(run: &RunData, first: usize, second: Option<usize>) -> Option<f64> {
    let displacement = |dof| measured_displacement(run, dof).and_then(|x| x.first().copied());
    let other = second.map_or(Some(c64::new(0.0, 0.0)), displacement)?;
    Some((displacement(first)? - other).norm())
}
