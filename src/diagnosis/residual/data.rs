//! What the comparison is made on: the runs that may be used, their forces and responses, harmonic by harmonic.

use crate::control::Cancelled;
use crate::effects::{Constant, Kind, Place, Source, source::State};
use crate::measurement::{ChannelFit, Quantity, Run};
use crate::response::harmonic_balance::{Excitation, HarmonicForce, ModelError, ResponseError};
use crate::structure::{Part, Structure};
use faer::c64;

/// A channel whose fundamental is below this share of the largest of its quantity in the run shows nothing.
const DEAD: f64 = 1e-9;
/// Share of the largest amplitude of its quantity over all runs below which no record tells anything, however little it scatters:
/// converters of 24 bits resolve 6e-8 of their range, and the fit of some thousand samples two digits more. Behind a joint that sticks
/// computed records go on where no sensor does.
const RESOLVED: f64 = 1e-9;

/// Why a model cannot be compared with its measurements or explained.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum DiagnosisError {
    #[error("no run can be used: all are switched off or not settled; add a settled run with `use = true`")]
    NoRuns,
    #[error("run {file} has no force channel: the response cannot be predicted without its cause; add force@DOF")]
    NoForce { file: String },
    #[error("run {file} has no response channel to compare with: add acc, vel or disp at a DOF")]
    NoResponse { file: String },
    #[error("run {file} could not be predicted: {reason}")]
    Response { file: String, reason: ResponseError },
    #[error(transparent)]
    Model(#[from] ModelError),
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl DiagnosisError {
    /// Why there is no response of a run. A model at fault is none of the run's: no run has a response then.
    pub(crate) fn of_response(file: String, reason: ResponseError) -> Self {
        match reason {
            ResponseError::Model(fault) => Self::Model(fault),
            ResponseError::Cancelled(cancelled) => Self::Cancelled(cancelled),
            reason => Self::Response { file, reason },
        }
    }
}

/// What was computed of a model; none where no structure is like that, with a mass below zero: or one that nothing holds: where
/// a search went too far.
pub(crate) fn if_possible<T>(computed: Result<T, DiagnosisError>) -> Result<Option<T>, DiagnosisError> {
    match computed {
        Err(DiagnosisError::Model(_)) => Ok(None),
        other => other.map(Some),
    }
}

/// A model and its measurements, borrowed from a project.
#[derive(Debug, Clone, Copy)]
pub struct Problem<'a> {
    /// Structure.
    pub structure: &'a Structure,
    /// Sources; those in state `known` are in the model.
    pub sources: &'a [Source],
    /// Runs in the order of the project.
    pub runs: &'a [Run],
}

impl Problem<'_> {
    /// The sources that are in the model. Errors of channels are not: the runs are corrected for them already.
    pub fn known(&self) -> Vec<Source> {
        let acts = |s: &&Source| s.state == State::Known && !matches!(s.effect.kind(), Kind::Channel(_));
        self.sources.iter().filter(acts).cloned().collect()
    }
}

/// Whether a run takes part in fits and errors.
pub fn is_used(run: &Run) -> bool {
    run.is_used()
}

/// Deviations of a real part beyond which an amplitude is not noise: `exp(-3.5^2 / 2) = 0.2 %`.
const BEYOND: f64 = 3.5;

/// One channel of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct ChannelData {
    /// Name in files, such as `acc@7`.
    pub name: String,
    /// What it measures.
    pub quantity: Quantity,
    /// Row of its DOF.
    pub dof: usize,
    /// Measured complex amplitudes of harmonics 1..=H, SI units.
    pub measured: Vec<c64>,
    /// Standard deviation of the real and of the imaginary part of each, the same unit.
    pub deviation: Vec<f64>,
}

impl ChannelData {
    fn new(fit: &ChannelFit) -> Self {
        let deviation = (1..=fit.amplitudes.len()).map(|h| finite(fit.deviation(h))).collect();
        let (quantity, dof) = (fit.channel.quantity, fit.channel.dof);
        Self { name: fit.channel.to_string(), quantity, dof, measured: fit.amplitudes.clone(), deviation }
    }

    /// Root of the sum of squared amplitudes over the harmonics.
    pub fn size(&self) -> f64 {
        size(&self.measured)
    }

    /// Whether harmonic `i + 1` is larger than noise is but once in 500 times.
    fn is_beyond_noise(&self, i: usize) -> bool {
        self.deviation.get(i).is_none_or(|d| self.measured[i].norm() > BEYOND * d)
    }

    /// Recorded amplitude over displacement amplitude at circular frequency `w` (rad/s): `(i w)^q`.
    pub fn from_displacement(&self, w: f64) -> c64 {
        match self.quantity {
            Quantity::Acceleration | Quantity::Base => c64::new(-w * w, 0.0),
            Quantity::Velocity => c64::new(0.0, w),
            Quantity::Displacement | Quantity::Force => c64::new(1.0, 0.0),
        }
    }
}

/// Euclidean length of complex amplitudes.
pub(crate) fn size(amplitudes: &[c64]) -> f64 {
    amplitudes.iter().map(c64::norm_sqr).sum::<f64>().sqrt()
}

fn finite(value: f64) -> f64 {
    if value.is_finite() { value } else { 0.0 }
}

/// One run.
#[derive(Debug, Clone, PartialEq)]
pub struct RunData {
    /// Index in the project's runs.
    pub index: usize,
    /// Fundamental circular frequency, rad/s.
    pub omega: f64,
    /// Number of harmonics.
    pub harmonics: usize,
    /// Force channels.
    pub forces: Vec<ChannelData>,
    /// Response channels.
    pub responses: Vec<ChannelData>,
    /// Response channels that take part (not dead).
    pub alive: Vec<usize>,
    /// Whether the forces are loads of the masses on a moving base.
    pub on_moving_base: bool,
}

impl RunData {
    fn new(index: usize, run: &Run) -> Result<Self, DiagnosisError> {
        let all = run.fit.channels.iter().map(ChannelData::new);
        let (forces, responses): (Vec<_>, Vec<_>) = all.partition(|c| c.quantity == Quantity::Force);
        if forces.is_empty() {
            return Err(DiagnosisError::NoForce { file: run.file.clone() });
        }
        if responses.is_empty() {
            return Err(DiagnosisError::NoResponse { file: run.file.clone() });
        }
        let (omega, harmonics) = (run.fit.omega, run.fit.harmonics());
        let on_moving_base = run.on_moving_base;
        let mut data = Self { index, omega, harmonics, forces, responses, alive: Vec::new(), on_moving_base };
        data.alive = (0..data.responses.len())
            .filter(|&c| data.responses[c].size() > DEAD * data.largest(data.responses[c].quantity))
            .collect();
        Ok(data)
    }

    /// Largest size of a response channel of that quantity.
    pub fn largest(&self, quantity: Quantity) -> f64 {
        let same = self.responses.iter().filter(|c| c.quantity == quantity);
        same.map(ChannelData::size).fold(0.0, f64::max)
    }

    /// What the error of response channel `c` is measured by: its size, at least a twentieth of the largest of its
    /// quantity in the run, so that a sensor at a node does not rule, and its noise.
    pub fn scale(&self, c: usize) -> f64 {
        self.scale_beside(c, |_| 1.0)
    }

    /// The same where channels read too large by their `gain`, as the record reads.
    pub fn scale_beside(&self, c: usize, gain: impl Fn(&ChannelData) -> f64) -> f64 {
        let own = &self.responses[c];
        let same = self.responses.iter().filter(|other| other.quantity == own.quantity);
        let largest = same.map(|other| other.size() / gain(other)).fold(0.0, f64::max);
        let noise = own.deviation.first().copied().unwrap_or(0.0);
        own.size().max(gain(own) * largest / 20.0).max(noise)
    }

    /// The measured forces as excitation, each divided by the transfer of its channel at each harmonic; harmonics that are no
    /// more than noise are at rest, so that a linear model need not answer them.
    pub fn excitation(&self, transfer: impl Fn(&ChannelData, f64) -> c64) -> Excitation {
        let force = |channel: &ChannelData| {
            let amplitude = |(i, f): (usize, &c64)| {
                let felt = i == 0 || channel.is_beyond_noise(i);
                if felt { *f / transfer(channel, (i + 1) as f64 * self.omega) } else { c64::new(0.0, 0.0) }
            };
            let highest = (1..channel.measured.len()).rev().find(|&i| channel.is_beyond_noise(i)).unwrap_or(0);
            let harmonics = channel.measured.iter().take(highest + 1).enumerate().map(amplitude).collect();
            HarmonicForce { dof: channel.dof, mean: 0.0, harmonics }
        };
        Excitation { omega: self.omega, forces: self.forces.iter().map(force).collect() }
    }
}

/// All runs that take part.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Data {
    /// Runs in the order of the project.
    pub runs: Vec<RunData>,
    /// Effects at places where somebody knows better: they are not suggested.
    pub excluded: Vec<Source>,
    /// Whether there are lines of frequency responses among the runs: they have no amplitude, and laws that depend on it
    /// cannot be told from them.
    pub per_unit_force: bool,
    /// Names of the channels that are not relied on: where there are some, the model is not taken for exact either.
    pub doubted: Vec<String>,
    /// Whether the runs are those that tell most of more.
    pub chosen: bool,
    /// How many runs were left out because they do not fit the others.
    pub left_out: usize,
    /// Numbers of the runs that were left out and turned out to fit: they are not doubted again.
    pub kept: Vec<usize>,
    /// Rows of the DOFs that are rotations.
    pub rotations: Vec<usize>,
    /// Number of the session of each run; none where they cannot be told apart.
    pub sessions: Vec<usize>,
}

impl Data {
    /// The used runs of a problem.
    pub fn new(problem: &Problem) -> Result<Self, DiagnosisError> {
        let used = problem.runs.iter().enumerate().filter(|(_, run)| is_used(run));
        let runs = used.map(|(index, run)| RunData::new(index, run)).collect::<Result<Vec<_>, _>>()?;
        if runs.is_empty() { Err(DiagnosisError::NoRuns) } else { Ok(Self::of(problem, runs)) }
    }

    /// All runs, whether used or not, for a display of every run.
    pub fn every(problem: &Problem) -> Result<Self, DiagnosisError> {
        let runs = problem.runs.iter().enumerate();
        let runs = runs.map(|(index, run)| RunData::new(index, run)).collect::<Result<Vec<_>, _>>()?;
        Ok(Self::of(problem, runs))
    }

    fn of(problem: &Problem, mut runs: Vec<RunData>) -> Self {
        let per_unit_force = runs.iter().any(|run| problem.runs[run.index].per_unit_force);
        if !per_unit_force {
            resolved(&mut runs);
        }
        let dofs = problem.structure.dofs().iter().enumerate();
        let rotations = dofs.filter(|(_, dof)| dof.direction.is_rotation()).map(|(row, _)| row).collect();
        Self {
            runs,
            excluded: Vec::new(),
            per_unit_force,
            doubted: Vec::new(),
            chosen: false,
            left_out: 0,
            kept: Vec::new(),
            rotations,
            sessions: Vec::new(),
        }
    }

    /// Whether an effect at its place may be suggested: not one that is ruled out, none of more parameters than runs,
    /// none that depends on an amplitude that the runs do not have, and no mass that only turns: none is without one that moves.
    pub fn allows(&self, source: &Source) -> bool {
        let told = source.effect.is_linear() || !self.per_unit_force;
        let turns = |dofs: &[usize]| dofs.iter().any(|dof| self.rotations.contains(dof));
        let only_turns =
            source.effect.adds_to(Constant::Mass) && matches!(&source.place, Place::Dofs(dofs) if turns(dofs));
        told && !only_turns
            && source.parameters.len() <= self.runs.len()
            && !self.excluded.iter().any(|other| other.is_same(source))
    }

    /// Whether a correction of that part of the structure would be an effect that is ruled out, by another name.
    pub fn is_ruled_out(&self, part: Part) -> bool {
        let (constant, dofs) = match part {
            Part::PointMass(dof) => (Constant::Mass, vec![dof]),
            Part::GroundSpring(dof) => (Constant::Stiffness, vec![dof]),
            Part::Coupling(pair) => (Constant::Stiffness, pair.to_vec()),
            _ => return false,
        };
        let place = Place::Dofs(dofs);
        self.excluded.iter().any(|source| source.effect.adds_to(constant) && source.place.is_same(&place))
    }

    /// Names of all response channels and of all force channels, each once.
    pub fn channel_names(&self) -> [Vec<String>; 2] {
        let mut names = [Vec::new(), Vec::new()];
        for run in &self.runs {
            for (list, channels) in names.iter_mut().zip([&run.responses, &run.forces]) {
                for channel in channels {
                    if !list.contains(&channel.name) {
                        list.push(channel.name.clone());
                    }
                }
            }
        }
        names
    }
}

/// Raises the deviations of responses to what no record resolves beside the largest of its quantity in all `runs`.
fn resolved(runs: &mut [RunData]) {
    let largest = |quantity: Quantity| RESOLVED * runs.iter().map(|run| run.largest(quantity)).fold(0.0, f64::max);
    let quantities = [Quantity::Acceleration, Quantity::Velocity, Quantity::Displacement];
    let least = quantities.map(|quantity| (quantity, largest(quantity)));
    for channel in runs.iter_mut().flat_map(|run| &mut run.responses) {
        let least = least.iter().find(|(quantity, _)| *quantity == channel.quantity).map_or(0.0, |(_, least)| *least);
        channel.deviation.iter_mut().for_each(|deviation| *deviation = deviation.max(least));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn harmonics_of_a_force_that_are_noise_are_at_rest() {
        let force = |amplitudes: &[f64]| {
            let channel = ChannelData {
                name: "force@1".into(),
                quantity: Quantity::Force,
                dof: 0,
                measured: amplitudes.iter().map(|&a| c64::new(0.0, a)).collect(),
                deviation: vec![1e-3; amplitudes.len()],
            };
            let (forces, harmonics) = (vec![channel], amplitudes.len());
            let (responses, alive) = (Vec::new(), Vec::new());
            let run = RunData { index: 0, omega: 1.0, harmonics, forces, responses, alive, on_moving_base: false };
            run.excitation(|_, _| c64::new(2.0, 0.0)).forces.remove(0).harmonics
        };
        assert_eq!(force(&[1.0, 2e-3, 3e-3, 1e-3]), [c64::new(0.0, 0.5)]);
        // What the exciter adds stays, the noise between is at rest.
        assert_eq!(force(&[1.0, 2e-3, 0.1, 1e-3]), [c64::new(0.0, 0.5), c64::new(0.0, 0.0), c64::new(0.0, 0.05)]);
        assert_eq!(force(&[1e-4]), [c64::new(0.0, 5e-5)], "the fundamental always drives");
    }

    /// Behind a joint that sticks at the lower level nothing is told, however little it scatters there.
    #[test]
    fn what_no_record_resolves_beside_the_largest_is_noise() {
        let run = |size: f64| {
            let channel = ChannelData {
                name: "acc@1".into(),
                quantity: Quantity::Acceleration,
                dof: 0,
                measured: vec![c64::new(size, 0.0)],
                deviation: vec![1e-3 * size],
            };
            let (forces, responses, on_moving_base) = (Vec::new(), vec![channel], false);
            RunData { index: 0, omega: 1.0, harmonics: 1, forces, responses, alive: vec![0], on_moving_base }
        };
        let mut runs = [run(5.0), run(1e-4), run(1e-11)];
        resolved(&mut runs);
        let told = |k: usize| (runs[k].responses[0].deviation[0], runs[k].scale(0));
        assert_eq!((told(0), told(2)), ((5e-3, 5.0), (5e-9, 5e-9)));
        assert!((told(1).0 / 1e-7 - 1.0).abs() < 1e-12 && told(1).1 == 1e-4);
    }

    /// What the error of a channel is measured by is that of the record in which all channels read rightly, as the channel reads: the
    /// largest, of which a node is given a twentieth, is 1.5 times too large here.
    #[test]
    fn errors_beside_a_gain_are_measured_as_in_the_mended_record() {
        let run = |sizes: [f64; 3]| {
            let channel = |(k, size): (usize, f64)| ChannelData {
                name: format!("acc@{}", k + 1),
                quantity: Quantity::Acceleration,
                dof: k,
                measured: vec![c64::new(0.6 * size, 0.8 * size)],
                deviation: vec![1e-3],
            };
            let responses: Vec<ChannelData> = sizes.into_iter().enumerate().map(channel).collect();
            let (forces, alive) = (Vec::new(), vec![0, 1, 2]);
            RunData { index: 0, omega: 1.0, harmonics: 1, forces, responses, alive, on_moving_base: false }
        };
        let (read, mended) = (run([3.0, 0.01, 1.0]), run([2.0, 0.01, 1.0]));
        let gain = |channel: &ChannelData| if channel.dof == 0 { 1.5 } else { 1.0 };
        for c in 0..3 {
            let scale = read.scale_beside(c, gain) / gain(&read.responses[c]);
            assert!((scale - mended.scale(c)).abs() < 1e-12, "{c}: {scale}");
        }
        assert!((mended.scale(1) - 0.1).abs() < 1e-12 && (read.scale(1) - 0.15).abs() < 1e-12);
    }
}
