//! What is known of one channel over the runs: measured, modelled and tried fundamentals over the force.

use super::response_curve as curve;
use crate::diagnosis::Comparison;
use crate::diagnosis::residual::comparison::{ChannelComparison, RunComparison};
use crate::exchange::Project;
use crate::measurement::Quantity;
use faer::c64;

/// One run of one channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Index of the run.
    pub run: usize,
    /// Hz.
    pub frequency: f64,
    /// Amplitude of the force, N.
    pub force: f64,
    /// Measured fundamental over the force's.
    pub measured: c64,
    /// The model's.
    pub model: c64,
    /// With the effect on trial.
    pub trial: Option<c64>,
}

/// The channel of a run in a comparison.
pub fn channel<'a>(comparison: &'a Comparison, run: usize, name: &str) -> Option<&'a ChannelComparison> {
    run_of(comparison, run)?.channels.iter().find(|c| c.channel == name)
}

/// Run number `run` of the project: it nearly always stands at that place, and this is asked of every run in every frame.
fn run_of(comparison: &Comparison, run: usize) -> Option<&RunComparison> {
    let runs = &comparison.runs;
    runs.get(run).filter(|r| r.index == run).or_else(|| runs.iter().find(|r| r.index == run))
}

/// All runs that have the channel and a force.
pub fn samples(p: &Project, comparison: &Comparison, trial: Option<&Comparison>, name: &str) -> Vec<Sample> {
    // Nearly all runs have the channel at the same place among theirs.
    let mut place = 0;
    let mut sample_of = |run: usize| {
        let (_, force) = curve::force(p, run)?;
        let now = run_of(comparison, run)?;
        if now.channels.get(place).is_none_or(|c| c.channel != name) {
            place = now.channels.iter().position(|c| c.channel == name)?;
        }
        let now = now.channels[place].harmonics.first().copied()?;
        let first = |c: &Comparison| channel(c, run, name)?.harmonics.first().copied();
        (force.norm() > 0.0).then(|| Sample {
            run,
            frequency: p.runs[run].frequency_hz(),
            force: force.norm(),
            measured: now.measured / force,
            model: now.model / force,
            trial: trial.and_then(first).map(|h| h.model / force),
        })
    };
    (0..p.runs.len()).filter_map(&mut sample_of).collect()
}

/// Degrees.
pub fn phase(z: c64) -> f64 {
    z.im.atan2(z.re).to_degrees()
}

/// Quantity and unit of a channel of a run; `m/s^2`, `rad`.
pub fn unit(p: &Project, run: usize, name: &str) -> &'static str {
    let found = p.runs.get(run).and_then(|r| r.fit.channels.iter().find(|c| c.channel.to_string() == name));
    let Some(fit) = found else { return "" };
    let rotation = p.structure.dofs().get(fit.channel.dof).is_some_and(|d| d.direction.is_rotation());
    fit.channel.quantity.si_unit(rotation)
}

/// Index of a channel in the fit of a run.
pub fn index(p: &Project, run: usize, name: &str) -> Option<usize> {
    p.runs.get(run)?.fit.channels.iter().position(|c| c.channel.to_string() == name)
}

/// The response channel that is looked at: that of the view where it measures motion, else the first that does.
pub fn selected(p: &Project, run: usize, wanted: usize) -> Option<String> {
    let channels = &p.runs.get(run)?.fit.channels;
    let motion = |c: &&crate::measurement::ChannelFit| c.channel.quantity != Quantity::Force;
    let found = channels.get(wanted).filter(motion).or_else(|| channels.iter().find(motion));
    found.map(|c| c.channel.to_string())
}
