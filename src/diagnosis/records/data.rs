//! The records of a project as they are fitted: forces, responses, noise, the modes that they show.

use super::channel_noise::under_forces;
use super::frequencies::Motions;
use super::part_directions::PartDirections;
use super::weights::{SHARE, SHARE_OF_ONE, deviations, with_share};
use crate::control::Cancelled;
use crate::effects::{Kind as EffectKind, Source, State};
use crate::math::statistics::mean;
use crate::measurement::{Channel, Kind, TransientRun, without_zero};
use crate::response::transient::{TransientError, TransientModel, TransientSetup};
use crate::structure::modes::Modes;
use crate::structure::{Part, Structure, StructureError};
use std::f64::consts::TAU;

/// Most modes that are followed one by one; the rest by residual flexibility.
const MOST_MODES: usize = 8;
/// Frequency over that of the last mode that is followed from which on motion is not that of these modes.
const ABOVE: f64 = 2.0;
/// Frequency of a mode over the limit of those that are followed up to which a decay is asked whether it shows it: a model that is off
/// by some per cent has it on either side of any limit.
const BESIDE_LIMIT: f64 = 1.2;
/// Sampling rate over the highest frequency of motion that is enough: it holds the harmonics of a law that is not linear, and
/// steps of the model lose no phase over some hundred periods.
const OVERSAMPLED: f64 = 20.0;
/// Samples that a record keeps in any case, and that are enough of a long one.
const FEWEST: usize = 2000;
const MANY: usize = 8000;
/// Why records cannot be compared or explained.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum RecordDiagnosisError {
    #[error("no decay or transient can be used: all are switched off; add one with `use = true`")]
    NoRuns,
    #[error("run {file}: {reason}")]
    Model { file: String, reason: TransientError },
    #[error(transparent)]
    Structure(#[from] StructureError),
    #[error(
        "run {file} is a transient without a force channel: add force@DOF, or `kind = \"decay\"` for its free part"
    )]
    NoForce { file: String },
    #[error(
        "the fit of the records failed: their equations have no solution; check that each has motion above the noise"
    )]
    Singular,
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// One record.
#[derive(Debug, Clone)]
pub struct RecordData {
    /// Number among the transient runs of the project.
    pub index: usize,
    /// Name of its file.
    pub file: String,
    /// The run itself.
    pub run: TransientRun,
    /// Decay or transient.
    pub kind: Kind,
    /// Time of the first sample and between samples, s.
    pub first_s: f64,
    /// Time between samples, s.
    pub step: f64,
    /// Channels of motion.
    pub channels: Vec<Channel>,
    /// Their samples less their means, SI.
    pub samples: Vec<Vec<f64>>,
    /// Their means over the whole record, SI: a sensor has its zero somewhere, and what of a mean is motion is found as an offset.
    pub means: Vec<f64>,
    /// Largest sample of every channel of the whole record, SI.
    pub largest: Vec<f64>,
    /// Rows of the driven DOFs.
    pub drives: Vec<usize>,
    /// Their forces, N.
    pub forces: Vec<Vec<f64>>,
    /// Samples of the forces from one sample of the channels to the next; where there are none, shares of that time.
    pub every: usize,
    /// Samples of the forces from which on steps of 2, 4, 8, ... of them resolve the motion.
    pub settled: Vec<usize>,
    /// Standard deviation of the noise of each channel.
    pub noise: Vec<f64>,
    /// Standard deviation of every sample: its noise and what lies above the modes that are followed.
    pub sigma: Vec<Vec<f64>>,
    /// Variance of every sample by the noise of the forces, one list a channel; empty where there is none.
    pub by_force: Vec<Vec<f64>>,
    /// Deviation of a mean squared residual over its variance by that noise.
    pub scatter: f64,
    /// Steps of the model from one sample to the next where a law is nonlinear.
    pub substeps: usize,
    /// Frequency of the highest peak, Hz.
    pub dominant_hz: f64,
    /// Frequency that halves the power of the motion above the noise, no less than that of the highest peak, Hz.
    pub median_hz: f64,
    /// Highest frequency at which the motion stands out, Hz.
    pub highest_hz: f64,
}

/// All that is fitted.
#[derive(Debug, Clone)]
pub struct Records<'a> {
    /// Structure with matrices.
    pub structure: &'a Structure,
    /// Sources that are known.
    pub known: Vec<Source>,
    /// Undamped modes.
    pub modes: Modes,
    /// How many are followed.
    pub kept: usize,
    /// How the parts of the structure may be stated wrongly.
    pub(super) parts: PartDirections,
    /// Records that are used.
    pub list: Vec<RecordData>,
    /// Channels of motion that differ.
    pub(super) sensors: Vec<Channel>,
}

impl<'a> Records<'a> {
    /// Takes the runs that are switched on.
    ///
    /// # Errors
    /// [`RecordDiagnosisError`]: no run, no force, no matrices.
    pub fn new(
        structure: &'a Structure,
        sources: &[Source],
        runs: &[TransientRun],
    ) -> Result<Self, RecordDiagnosisError> {
        let modes = structure.modes()?;
        let acts = |s: &&Source| s.state == State::Known && !matches!(s.effect.kind(), EffectKind::Channel(_));
        let known = sources.iter().filter(acts).cloned().collect();
        let mut list = Vec::new();
        for (index, run) in runs.iter().enumerate().filter(|(_, run)| run.enabled) {
            list.push(record(index, run)?);
        }
        if list.is_empty() {
            return Err(RecordDiagnosisError::NoRuns);
        }
        let mut kept = modes_followed(&list, &modes);
        let last_hz = last_hz(&list, &modes, kept);
        for own in &mut list {
            if let Some(run) = own.at_lower_rate(last_hz) {
                *own = record(own.index, &run)?;
                kept = 0;
            }
        }
        if kept == 0 {
            kept = modes_followed(&list, &modes);
        }
        let sensors = different(&list);
        let parts = PartDirections::new(structure, &modes, kept);
        Ok(Self { structure, known, modes, kept, parts, list, sensors }.with_force_noise())
    }

    /// The same records beside another structure of the same DOFs.
    pub(super) fn on<'b>(&self, structure: &'b Structure) -> Result<Records<'b>, RecordDiagnosisError>
    where
        'a: 'b,
    {
        let modes = structure.modes()?;
        let kept = self.kept.min(modes.len());
        let parts = PartDirections::new(structure, &modes, kept);
        let list = self.list.iter().map(|r| r.clone().with_base_load(self.structure, structure)).collect();
        Ok(Records { structure, modes, kept, parts, list, ..self.clone() })
    }

    /// Logarithms of the factors on the stiffness of the kept modes that stand for the parts of a fit.
    pub(super) fn stiffness_by_parts(&self, parts: &[f64]) -> Vec<f64> {
        self.parts.stiffness_of_modes(parts, self.kept)
    }

    /// Frequency (Hz) from which on motion is not that of the modes that are followed.
    fn corner_hz(&self) -> f64 {
        let last = last_hz(&self.list, &self.modes, self.kept);
        let next = self.modes.omega.get(self.kept).map_or(f64::INFINITY, |w| (last * w / TAU).sqrt());
        next.min(ABOVE * last)
    }

    /// Standard deviation of every sample of a record of which `left` (one list a channel) is not predicted.
    pub(crate) fn deviations(&self, record: &RecordData, left: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let channel_deviations = |(c, (e, noise)): (usize, (&Vec<f64>, &f64))| {
            let mut own = deviations(e, *noise, record.step, self.corner_hz());
            let by_force = record.by_force.get(c).into_iter().flatten();
            // What is left above the modes that are followed may be the noise of the force: it counts once.
            own.iter_mut().zip(by_force).for_each(|(s, v)| *s = s.max((noise * noise + v).sqrt()));
            own
        };
        left.iter().zip(&record.noise).enumerate().map(channel_deviations).collect()
    }

    /// The same records, each sample weighted by what a model leaves above the modes that are followed (`residual` of whole
    /// records, over the noise, `[record][channel][sample]`), and by the share of the motion by which any model is wrong.
    pub(crate) fn weighted(&self, residual: &[Vec<Vec<f64>>]) -> Self {
        let mut weighted = self.clone();
        let share = if self.has_one_shape() { SHARE_OF_ONE } else { SHARE };
        for (record, left) in weighted.list.iter_mut().zip(residual) {
            let in_units = |(e, sigma): (&Vec<f64>, &Vec<f64>)| e.iter().zip(sigma).map(|(e, s)| e * s).collect();
            let left: Vec<Vec<f64>> = left.iter().zip(&record.sigma).map(in_units).collect();
            let half = (1.0 / (record.dominant_hz * record.step)).ceil() as usize;
            let above = self.deviations(record, &left);
            record.sigma = above.iter().zip(&record.samples).map(|(s, y)| with_share(share, s, y, half)).collect();
        }
        weighted
    }

    /// The model of a record with these sources and factors on stiffness and mass, and logarithms of those on the
    /// stiffness and the damping of single modes; `shape_errors` of the sensors.
    pub(crate) fn model(
        &self,
        record: &RecordData,
        sources: &[Source],
        factors: [f64; 2],
        modes: [&[f64]; 2],
        parts: &[(Part, f64)],
        shape_errors: &[Vec<f64>],
    ) -> Result<TransientModel, RecordDiagnosisError> {
        let shape_errors = &self.shape_errors(record, shape_errors);
        let setup = self.setup(record, sources, factors, modes, parts);
        let directions = &self.parts.weights;
        TransientModel::new(&TransientSetup { directions, shape_errors, ..setup })
            .map_err(|reason| RecordDiagnosisError::Model { file: record.file.clone(), reason })
    }

    /// The same before it is assembled, without errors of shapes and derivatives by parts.
    pub(super) fn setup<'s>(
        &'s self,
        record: &'s RecordData,
        sources: &'s [Source],
        factors: [f64; 2],
        [mode_stiffness, mode_damping]: [&'s [f64]; 2],
        parts: &'s [(Part, f64)],
    ) -> TransientSetup<'s> {
        TransientSetup {
            structure: self.structure,
            modes: &self.modes,
            kept: self.kept,
            sources,
            drives: &record.drives,
            channels: &record.channels,
            factors,
            mode_stiffness,
            mode_damping,
            parts,
            directions: &[],
            step: [record.force_step(), record.force_step() / record.substeps.max(1) as f64],
            shape_errors: &[],
        }
    }
}

impl Records<'_> {
    /// Number of samples of all channels of all records.
    pub(super) fn samples(&self) -> usize {
        self.list.iter().map(|r| r.len() * r.channels.len()).sum()
    }
}

impl RecordData {
    /// Mean of a channel over its largest sample.
    pub(super) fn mean_share(&self, c: usize) -> f64 {
        self.means.get(c).map_or(0.0, |mean| mean.abs() / self.largest[c].max(f64::MIN_POSITIVE))
    }

    /// Channels with the means of those that were measured.
    pub(super) fn as_measured(&self, channels: &[Vec<f64>]) -> Vec<Vec<f64>> {
        channels.iter().zip(&self.means).map(|(list, mean)| list.iter().map(|y| y + mean).collect()).collect()
    }

    /// The run at a lower rate where its own is many times that of the motion of modes up to `last_hz`: nothing is to be seen in between,
    /// and every fit would take as many times longer. Of a long record that is so many times the frequency of its largest motion.
    fn at_lower_rate(&self, last_hz: f64) -> Option<TransientRun> {
        let highest = self.highest_hz.clamp(last_hz, ABOVE * last_hz);
        let factor = |frequency: f64| (1.0 / (OVERSAMPLED * frequency * self.step)) as usize;
        let enough = factor(highest).min(self.len() / FEWEST);
        let long = factor(self.dominant_hz).min(self.len() / MANY);
        let factor = enough.max(long);
        if factor > 1 { self.run.decimated(factor) } else { None }
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.samples[0].len()
    }

    /// Whether there is no sample; never true.
    pub fn is_empty(&self) -> bool {
        self.samples[0].is_empty()
    }
}

/// Number of modes that are followed one by one: those of the motion that stands out, and those that a driven record plainly shows.
fn modes_followed(list: &[RecordData], modes: &Modes) -> usize {
    let top = list.iter().map(|r| r.highest_hz).fold(0.0, f64::max);
    let nyquist = list.iter().map(|r| 0.4 / r.step).fold(f64::INFINITY, f64::min);
    let limit = (1.5 * top).min(nyquist);
    let below = modes.omega.iter().filter(|w| **w <= TAU * limit).count();
    let observable = |r: &RecordData| r.observable_modes(modes, below, MOST_MODES, BESIDE_LIMIT * limit);
    list.iter().map(observable).fold(below, usize::max).clamp(1, MOST_MODES).min(modes.len())
}

/// Frequency (Hz) of the last mode that is followed; of the motion where that mode has no period within a record, as of a carriage on
/// rails, whose motion is all that of its force.
fn last_hz(list: &[RecordData], modes: &Modes, kept: usize) -> f64 {
    let last = modes.omega[kept - 1] / TAU;
    let longest = list.iter().map(|r| r.step * r.len() as f64).fold(0.0, f64::max);
    if last * longest > 1.0 { last } else { list.iter().map(|r| r.highest_hz).fold(last, f64::max) }
}

fn record(index: usize, run: &TransientRun) -> Result<RecordData, RecordDiagnosisError> {
    let driven = run.force_channels();
    if run.kind == Kind::Transient && driven.is_empty() {
        return Err(RecordDiagnosisError::NoForce { file: run.file.clone() });
    }
    let seen = run.response_channels();
    let channels: Vec<Channel> = seen.iter().map(|&c| run.channels()[c].clone()).collect();
    let (samples, means): (Vec<_>, Vec<_>) = seen.iter().map(|&c| centred(run.samples(c))).unzip();
    let step = run.step();
    let largest = samples.iter().map(|y| y.iter().fold(0.0_f64, |m, y| m.max(y.abs()))).collect();
    let forces: Vec<Vec<f64>> = driven.iter().map(|&c| without_zero(run.samples(c))).collect();
    let noise: Vec<f64> = samples.iter().map(|y| under_forces(y, &forces, step)).collect();
    let sigma = samples.iter().zip(&noise).map(|(y, noise)| vec![*noise; y.len()]).collect();
    let motions = Motions { samples: &samples, noise: &noise, step };
    let dominant_hz = motions.dominant_hz();
    let (median_hz, highest_hz) = (motions.median_hz().max(dominant_hz), motions.highest_hz(dominant_hz));
    let mut record = RecordData {
        index,
        file: run.file.clone(),
        run: run.clone(),
        kind: run.kind,
        first_s: run.time()[0],
        step,
        channels,
        samples,
        means,
        largest,
        drives: driven.iter().map(|&c| run.channels()[c].dof).collect(),
        forces,
        every: 1,
        settled: Vec::new(),
        noise,
        sigma,
        by_force: Vec::new(),
        scatter: 0.0,
        substeps: 1,
        dominant_hz,
        median_hz,
        highest_hz,
    };
    record.substeps = record.fine_steps();
    Ok(record)
}

/// A signal less its mean, and the mean.
fn centred(signal: &[f64]) -> (Vec<f64>, f64) {
    let mean = mean(signal);
    (signal.iter().map(|y| y - mean).collect(), mean)
}

/// The channels that differ in what they measure and where.
fn different(records: &[RecordData]) -> Vec<Channel> {
    let mut list: Vec<Channel> = Vec::new();
    for channel in records.iter().flat_map(|r| &r.channels) {
        if !list.iter().any(|c| c.dof == channel.dof && c.quantity == channel.quantity) {
            list.push(channel.clone());
        }
    }
    list
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::chain;
    use crate::common::runs::decay;

    /// A mode that rings for a moment at one and a half times the frequency of the last that stands out is followed by models that have
    /// it on either side of that.
    #[test]
    fn a_mode_that_a_decay_shows_is_followed_by_models_that_are_off() {
        let with_stiffness =
            |factor: f64| chain(&[2.0, 1.0, 1.5], &[800.0 * factor, 0.0, 0.0], &[1500.0 * factor, 900.0 * factor]);
        let truth = with_stiffness(1.0).modes().unwrap();
        let (step, damping) = (5e-3, [0.1, 0.1, 6.0]);
        let omega = [truth.omega[0], truth.omega[2] / 1.5, truth.omega[2]];
        let wave = |n: usize, dof: usize| -> f64 {
            let t = step * n as f64;
            let mode = |r: usize| 1e-2 * truth.shapes[(dof, r)] * (-damping[r] * t).exp() * (omega[r] * t).cos();
            (0..3).map(mode).sum()
        };
        let run = decay(step, (0..3).map(|dof| (0..4000).map(|n| wave(n, dof)).collect()).collect());
        for factor in [0.96, 1.0, 1.04] {
            let structure = with_stiffness(factor);
            let records = Records::new(&structure, &[], std::slice::from_ref(&run)).unwrap();
            assert_eq!(records.kept, 3, "stiffness times {factor}");
        }
    }
}
