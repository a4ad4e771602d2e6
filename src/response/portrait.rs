//! What a law does to a small structure: free decay, frequency response at several forces, hysteresis, energy a cycle. Figures
//! 2.2 to 2.19 of the source, for any law.

use super::harmonic_balance::{Excitation, ForwardModel, Settings, SweepPoint, SweepSettings, sweep};
use super::time_integration::TimeModel;
use crate::control::{Cancelled, Control};
use crate::effects::{Motion, Source};
use crate::structure::Structure;
use faer::c64;
use std::f64::consts::TAU;

/// Steps a period of the lowest mode in the free motion.
const STEPS: usize = 400;
/// Periods of the lowest mode in the free motion.
const PERIODS: usize = 16;
/// Samples of a loop.
const SAMPLES: usize = 256;
/// Force levels as shares of the force that is asked for.
pub const LEVELS: [f64; 3] = [0.5, 1.0, 2.0];
const SWEEP: SweepSettings = SweepSettings { harmonics: 5, tolerance: 1e-8, largest_step: 0.004, most_points: 3000 };

/// What is looked at.
#[derive(Debug, Clone)]
pub struct Setup {
    /// The structure; it needs matrices and a few DOFs only.
    pub structure: Structure,
    /// The law at its place, with its parameters.
    pub source: Source,
    /// Dashpot from every DOF to the ground, N s/m, which keeps resonances finite.
    pub background: f64,
    /// DOF that is driven and looked at.
    pub drive: usize,
    /// Amplitude of the force, N.
    pub force: f64,
    /// Frequency of the loops, Hz.
    pub frequency_hz: f64,
    /// Displacement of the driven DOF from which the free motion starts, m.
    pub displacement: f64,
}

/// A point of a frequency response.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ResponsePoint {
    /// Hz.
    pub frequency_hz: f64,
    /// Fundamental of the displacement over the force, m/N.
    pub receptance: c64,
    /// Whether a small disturbance dies out.
    pub stable: bool,
}

/// What belongs to one amplitude of the force, N.
#[derive(Debug, Clone, PartialEq)]
pub struct AtLevel<T> {
    /// Amplitude of the force, N.
    pub force: f64,
    /// What was found; one line where there is nothing.
    pub found: Result<T, String>,
}

/// Points x, y.
pub type Points = Vec<[f64; 2]>;

/// Everything that is shown of a law.
#[derive(Debug, Clone, PartialEq)]
pub struct Portrait {
    /// Free motion of the driven DOF: time, s, and displacement, m; one line where a law has no motion in time.
    pub decay: Result<Points, String>,
    /// Frequency responses at the [`LEVELS`], through their turning points.
    pub curves: Vec<AtLevel<Vec<ResponsePoint>>>,
    /// Force of the exciter, N, over the displacement of its DOF, m.
    pub loops: Vec<AtLevel<Points>>,
    /// Force of the law, N, over its own displacement, m.
    pub own: Vec<AtLevel<Points>>,
    /// Energy a cycle, J, over the amplitude of the law's own displacement, m, at the frequency of the loops.
    pub energy: Points,
}

/// Computes all of it.
///
/// # Errors
/// [`Cancelled`]; what fails for the law alone is said in its place.
pub fn portrait(setup: &Setup, control: &Control) -> Result<Portrait, Cancelled> {
    let decay = decay(setup);
    control.check()?;
    let sources = setup.sources();
    let model = ForwardModel::new(&setup.structure, &sources).map_err(|e| e.to_string());
    let forces = LEVELS.map(|share| share * setup.force);
    let (mut curves, mut loops, mut own) = (Vec::new(), Vec::new(), Vec::new());
    for (k, force) in forces.into_iter().enumerate() {
        let found = model.as_ref().map_err(Clone::clone).and_then(|m| curve(setup, m, force, control));
        curves.push(AtLevel { force, found });
        let both = model.as_ref().map_err(Clone::clone).and_then(|m| steady(setup, m, force, control));
        loops.push(AtLevel { force, found: both.as_ref().map(|b| b.0.clone()).map_err(Clone::clone) });
        own.push(AtLevel { force, found: both.map(|b| b.1) });
        control.check()?;
        control.report((k + 1) as f64 / LEVELS.len() as f64);
    }
    let energy = energy(setup, &own);
    Ok(Portrait { decay, curves, loops, own, energy })
}

impl Setup {
    fn sources(&self) -> Vec<Source> {
        let background = |d: usize| Source::dashpot(vec![d], self.background);
        let damped = (0..self.structure.len()).filter(|_| self.background > 0.0).map(background);
        damped.chain([self.source.clone()]).collect()
    }

    /// Circular frequencies of the lowest and the highest mode without the law, rad/s.
    fn ends(&self) -> Result<[f64; 2], String> {
        let modes = self.structure.modes().map_err(|e| e.to_string())?;
        Ok([modes.omega[0], modes.omega[modes.len() - 1]])
    }
}

fn decay(setup: &Setup) -> Result<Points, String> {
    let [lowest, _] = setup.ends()?;
    let still = Excitation::sine(lowest, setup.drive, c64::new(0.0, 0.0));
    let mut model = TimeModel::new(&setup.structure, &setup.sources(), &still, STEPS).map_err(|e| e.to_string())?;
    let mut start = vec![0.0; setup.structure.len()];
    start[setup.drive] = setup.displacement;
    model.start(&start, &vec![0.0; setup.structure.len()]);
    let mut points = Vec::with_capacity(STEPS * PERIODS);
    for _ in 0..STEPS * PERIODS {
        points.push([model.time(), model.displacement(setup.drive)]);
        model.advance().map_err(|e| e.to_string())?;
    }
    Ok(points)
}

fn curve(setup: &Setup, model: &ForwardModel, force: f64, control: &Control) -> Result<Vec<ResponsePoint>, String> {
    let [lowest, highest] = setup.ends()?;
    let range = [0.4 * lowest, 1.5 * highest];
    let excitation = Excitation::sine(range[0], setup.drive, c64::new(force, 0.0));
    let found = sweep(model, &excitation, range, &SWEEP, control).map_err(|e| e.to_string())?;
    let point = |p: &SweepPoint| ResponsePoint {
        frequency_hz: p.response.omega / TAU,
        receptance: p.response.amplitude(setup.drive, 1) / force,
        stable: p.stable,
    };
    Ok(found.points.iter().map(point).collect())
}

/// Loops of the exciter and of the law.
fn steady(setup: &Setup, model: &ForwardModel, force: f64, control: &Control) -> Result<(Points, Points), String> {
    let omega = TAU * setup.frequency_hz;
    let excitation = Excitation::sine(omega, setup.drive, c64::new(force, 0.0));
    let response = model.respond(&excitation, &Settings::default(), None, control).map_err(|e| e.to_string())?;
    let period = TAU / omega;
    let times = (0..=SAMPLES).map(|k| period * k as f64 / SAMPLES as f64);
    let exciter = times.map(|t| [response.state_at(t).0[setup.drive], force * (omega * t).cos()]).collect();
    let mut own = Vec::new();
    if let (Some(law), Some(leg)) = (setup.source.effect.law(), setup.source.place.legs().first()) {
        let harmonics: Vec<c64> = (1..=response.order()).map(|h| leg.relative(|d| response.amplitude(d, h))).collect();
        let motion = Motion::new(omega, leg.relative(|d| response.mean[d]), &harmonics, SAMPLES);
        let mut values = vec![0.0; SAMPLES];
        law.force(&setup.source.parameters, &motion, &mut values);
        own = motion.displacement.iter().zip(&values).map(|(&d, &f)| [d, f]).collect();
        own.extend(own.first().copied());
    }
    Ok((exciter, own))
}

/// From a hundredth of the largest amplitude of the loops to three times it.
fn energy(setup: &Setup, own: &[AtLevel<Points>]) -> Points {
    let Some(law) = setup.source.effect.law() else { return Vec::new() };
    let amplitudes = own.iter().filter_map(|o| o.found.as_ref().ok()).flatten().map(|p| p[0].abs());
    let largest = amplitudes.fold(0.0, f64::max);
    let largest = if largest > 0.0 { largest } else { 1e-3 };
    let omega = TAU * setup.frequency_hz;
    let energy_at = |k: usize| {
        let amplitude = largest * 10f64.powf(-2.0 + 2.5 * k as f64 / 60.0);
        let motion = Motion::cosine(omega, amplitude, 1024);
        [amplitude, law.energy(&setup.source.parameters, &motion)]
    };
    (0..=60).map(energy_at).collect()
}
