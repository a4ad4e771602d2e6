//! The model's responses over frequency near a run, one a level of force, through their turning points, at every channel of
//! the run.

use crate::control::Control;
use crate::display::{format, units, words};
use crate::effects::{Kind, Source};
use crate::exchange::Project;
use crate::measurement::{ChannelFit, Quantity};
use crate::response::harmonic_balance::{Excitation, ForwardModel, HarmonicForce, SweepSettings, sweep};
use faer::c64;
use std::f64::consts::TAU;

/// One point of a curve.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CurvePoint {
    /// Frequency, Hz.
    pub frequency: f64,
    /// Fundamental of every channel of the run over the fundamental of the force; channels in the order of the fit.
    pub ratios: Vec<c64>,
    /// Whether a small disturbance dies out.
    pub stable: bool,
}

/// A response curve at one force.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Curve {
    /// Force amplitude, N.
    pub force: f64,
    /// Points in order along the curve; the frequency may turn back.
    pub points: Vec<CurvePoint>,
}

/// Largest step as a share of the range, and harmonics: enough for a picture.
const SETTINGS: SweepSettings = SweepSettings { harmonics: 5, tolerance: 1e-7, largest_step: 0.02, most_points: 1500 };

/// Runs in the neighbourhood of `run` in frequency, and the range that a curve through them covers, Hz.
pub(crate) fn neighbourhood(p: &Project, run: usize) -> Option<(Vec<usize>, [f64; 2])> {
    let centre = p.runs.get(run)?.frequency_hz();
    let near: Vec<usize> =
        (0..p.runs.len()).filter(|&r| (p.runs[r].frequency_hz() / centre).ln().abs() < 0.22).collect();
    let frequency = |r: &usize| p.runs[*r].frequency_hz();
    let (low, high) = near.iter().map(frequency).fold((f64::INFINITY, 0.0_f64), |(l, h), f| (l.min(f), h.max(f)));
    let margin = (0.35 * (high - low)).max(0.03 * centre);
    Some((near, [(low - margin).max(0.5 * low), high + margin]))
}

/// The fundamental of the first force channel of a run: row of its DOF and complex amplitude, N.
pub(crate) fn force(p: &Project, run: usize) -> Option<(usize, c64)> {
    let channels = &p.runs.get(run)?.fit.channels;
    let force = channels.iter().find(|c| c.channel.quantity == Quantity::Force)?;
    Some((force.channel.dof, *force.amplitudes.first()?))
}

/// Runs under one force.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ForceLevel {
    /// Mean amplitude of the force, N.
    pub force: f64,
    /// The runs.
    pub runs: Vec<usize>,
}

impl ForceLevel {
    /// Its amplitude in words: `3.2 N (peak)`.
    pub(crate) fn name(&self) -> String {
        let (factor, unit) = units::shown("N");
        words::peak(&format!("{} {unit}", format::significant(factor * self.force, 2)))
    }
}

/// Ratio by which forces of one level may differ, as a natural logarithm.
const SAME_LEVEL: f64 = 0.12;

/// The force levels of `runs`, lowest first; runs without force are left out.
pub(crate) fn levels(p: &Project, runs: &[usize]) -> Vec<ForceLevel> {
    let force = |r: &usize| Some((force(p, *r)?.1.norm(), *r)).filter(|(f, _)| *f > 0.0);
    let mut list: Vec<(f64, usize)> = runs.iter().filter_map(force).collect();
    list.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut levels: Vec<Vec<(f64, usize)>> = Vec::new();
    for (f, run) in list {
        match levels.last_mut() {
            Some(level) if (f / level[0].0).ln() < SAME_LEVEL => level.push((f, run)),
            _ => levels.push(vec![(f, run)]),
        }
    }
    let mean = |level: &Vec<(f64, usize)>| level.iter().map(|l| l.0).sum::<f64>() / level.len() as f64;
    let level_of =
        |level: Vec<(f64, usize)>| ForceLevel { force: mean(&level), runs: level.into_iter().map(|l| l.1).collect() };
    levels.into_iter().map(level_of).collect()
}

/// Most levels that have a curve of their own: lines beyond these cannot be told apart.
const MOST_LEVELS: usize = 8;

/// The levels among which curves are drawn: those of the runs near `run`, evenly thinned with its own kept.
fn drawn(p: &Project, run: usize, near: &[usize]) -> Vec<f64> {
    let all = levels(p, near);
    let own = all.iter().position(|l| l.runs.contains(&run));
    let step = all.len().div_ceil(MOST_LEVELS).max(1);
    let kept = |k: &usize| k % step == own.unwrap_or(0) % step;
    (0..all.len()).filter(kept).map(|k| all[k].force).collect()
}

/// Follows the response of the model with `effects` near `run`, once for every level of force that was measured there;
/// lowest level first.
///
/// # Errors
/// One line: no force, no matrices, no periodic response at any level.
pub(crate) fn curves(p: &Project, effects: &[Source], run: usize, control: &Control) -> Result<Vec<Curve>, String> {
    force(p, run).ok_or("the run has no force channel")?;
    let (near, range) = neighbourhood(p, run).ok_or("there is no such run")?;
    let acts = |s: &&Source| !matches!(s.effect.kind(), Kind::Channel(_));
    let known = p.sources.iter().filter(|s| s.state == crate::effects::State::Known);
    let sources: Vec<Source> = known.chain(effects).filter(acts).cloned().collect();
    let model = ForwardModel::new(&p.structure, &sources).map_err(|e| e.to_string())?;
    let mut found = Vec::new();
    let mut fault = "no run near it has a force".to_owned();
    for level in drawn(p, run, &near) {
        match one_level(p, &model, run, level, range, control) {
            Ok(curve) => found.push(curve),
            Err(error) => fault = error,
        }
    }
    if found.is_empty() { Err(fault) } else { Ok(found) }
}

/// The forces of a run in proportion, the first of them real and of this amplitude, N: a moving base loads every DOF.
fn excitation(p: &Project, run: usize, level: f64, omega: f64) -> Excitation {
    let forces = || p.runs[run].fit.channels.iter().filter(|c| c.channel.quantity == Quantity::Force);
    let fundamental = |c: &ChannelFit| c.amplitudes.first().copied().unwrap_or_default();
    let first = forces().next().map_or_else(|| c64::new(1.0, 0.0), fundamental);
    let harmonic = |c: &ChannelFit| HarmonicForce {
        dof: c.channel.dof,
        mean: 0.0,
        harmonics: vec![level * fundamental(c) / first],
    };
    Excitation { omega, forces: forces().map(harmonic).collect() }
}

/// The response under the forces of a run with `level` (N) of the first of them.
fn one_level(
    p: &Project,
    model: &ForwardModel,
    run: usize,
    level: f64,
    range: [f64; 2],
    control: &Control,
) -> Result<Curve, String> {
    let excitation = excitation(p, run, level, TAU * range[0]);
    let found = sweep(model, &excitation, range.map(|f| TAU * f), &SETTINGS, control).map_err(|e| e.to_string())?;
    let channels = &p.runs[run].fit.channels;
    let point = |point: &crate::response::harmonic_balance::SweepPoint| {
        let w = point.response.omega;
        let turn = c64::new(0.0, w);
        let ratio = |c: &ChannelFit| {
            let order = c.channel.quantity.derivatives().unwrap_or(0);
            turn.powi(order) * point.response.amplitude(c.channel.dof, 1) / level
        };
        CurvePoint { frequency: w / TAU, ratios: channels.iter().map(ratio).collect(), stable: point.stable }
    };
    Ok(Curve { force: level, points: found.points.iter().map(point).collect() })
}
