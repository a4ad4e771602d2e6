//! The model's response over frequency near a run, through its turning points, at every channel of the run.

use crate::control::Control;
use crate::effects::{Source, effect::Kind};
use crate::exchange::Project;
use crate::measurement::Quantity;
use crate::response::harmonic_balance::{Excitation, ForwardModel, SweepSettings, sweep};
use faer::c64;
use std::f64::consts::TAU;

/// One point of a curve.
#[derive(Debug, Clone, PartialEq)]
pub struct CurvePoint {
    /// Frequency, Hz.
    pub frequency: f64,
    /// Fundamental of every channel of the run over the fundamental of the force; channels in the order of the fit.
    pub ratios: Vec<c64>,
    /// Whether a small disturbance dies out.
    pub stable: bool,
}

/// A response curve at one force.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Force amplitude, N.
    pub force: f64,
    /// Points in order along the curve; the frequency may turn back.
    pub points: Vec<CurvePoint>,
}

/// Largest step as a share of the range, and harmonics: enough for a picture.
const SETTINGS: SweepSettings = SweepSettings { harmonics: 5, tolerance: 1e-7, largest_step: 0.02, most_points: 1500 };

/// Runs in the neighbourhood of `run` in frequency, and the range that a curve through them covers, Hz.
pub fn neighbourhood(p: &Project, run: usize) -> Option<(Vec<usize>, [f64; 2])> {
    let centre = p.runs.get(run)?.frequency_hz();
    let near: Vec<usize> =
        (0..p.runs.len()).filter(|&r| (p.runs[r].frequency_hz() / centre).ln().abs() < 0.22).collect();
    let of = |r: &usize| p.runs[*r].frequency_hz();
    let (low, high) = near.iter().map(of).fold((f64::INFINITY, 0.0_f64), |(l, h), f| (l.min(f), h.max(f)));
    let margin = (0.35 * (high - low)).max(0.03 * centre);
    Some((near, [(low - margin).max(0.5 * low), high + margin]))
}

/// The fundamental of the first force channel of a run: row of its DOF and complex amplitude, N.
pub fn force(p: &Project, run: usize) -> Option<(usize, c64)> {
    let channels = &p.runs.get(run)?.fit.channels;
    let force = channels.iter().find(|c| c.channel.quantity == Quantity::Force)?;
    Some((force.channel.dof, *force.amplitudes.first()?))
}

/// Follows the response of the model with `effects` under the force of `run`.
///
/// # Errors
/// One line: no force, no matrices, no periodic response.
pub fn curve(p: &Project, effects: &[Source], run: usize, control: &Control) -> Result<Curve, String> {
    let (dof, amplitude) = force(p, run).ok_or("the run has no force channel")?;
    let (_, range) = neighbourhood(p, run).ok_or("there is no such run")?;
    let level = amplitude.norm();
    let acts = |s: &&Source| !matches!(s.effect.kind(), Kind::Channel(_));
    let known = p.sources.iter().filter(|s| s.state == crate::effects::State::Known);
    let sources: Vec<Source> = known.chain(effects).filter(acts).cloned().collect();
    let model = ForwardModel::new(&p.structure, &sources).map_err(|e| e.to_string())?;
    let excitation = Excitation::sine(TAU * range[0], dof, c64::new(level, 0.0));
    let found = sweep(&model, &excitation, range.map(|f| TAU * f), &SETTINGS, control).map_err(|e| e.to_string())?;
    let channels = &p.runs[run].fit.channels;
    let point = |point: &crate::response::harmonic_balance::SweepPoint| {
        let w = point.response.omega;
        let turn = c64::new(0.0, w);
        let ratio = |c: &crate::measurement::ChannelFit| {
            let order = c.channel.quantity.derivatives().unwrap_or(0);
            turn.powi(order) * point.response.amplitude(c.channel.dof, 1) / level
        };
        CurvePoint { frequency: w / TAU, ratios: channels.iter().map(ratio).collect(), stable: point.stable }
    };
    Ok(Curve { force: level, points: found.points.iter().map(point).collect() })
}
