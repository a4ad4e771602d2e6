//! The loops of a component: displacement, velocity and acceleration that are imposed, the force that is measured.

use crate::control::Cancelled;
use crate::effects::{self, Constant, Kind as EffectKind, Source, State};
use crate::math::spectrum::Spectrum;
use crate::math::statistics::root_mean_square;
use crate::measurement::{Quantity, TransientRun};
use crate::structure::Structure;
use imposed_motion::{Band, derivatives};
use std::borrow::Cow;
use std::f64::consts::TAU;
use std::ops::Range;

mod imposed_motion;

/// Samples a period that are compared; laws with memory see the motion as finely.
const PER_PERIOD: f64 = 120.0;
/// Half width, in periods, of the polynomial by which the displacement is differentiated.
const SMOOTH: f64 = 0.008;
/// Speed over the largest below which a machine that has not started yet, or has stopped, rests.
const AT_REST: f64 = 0.01;

/// Why the loops of a component cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum ComponentError {
    #[error("no record can be used: all are switched off; add one with `use = true`")]
    NoRuns,
    #[error(
        "record {file} has no channel {needed}: a component is tested by its displacement and its force, such as disp@1 [mm] and force@1 [N]"
    )]
    NoChannel { file: String, needed: &'static str },
    #[error("record {file}: the displacement does not move; check its channel and unit")]
    NoMotion { file: String },
    #[error("law `{law}` has no force in time: it cannot be compared with the loops of a component; give another")]
    NoTimeDomain { law: &'static str },
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// One record.
#[derive(Debug, Clone, PartialEq)]
pub struct LoopRecord {
    /// Number among the records of the project.
    pub index: usize,
    /// Name of its file.
    pub file: String,
    /// Channel of the force.
    pub channel: String,
    /// Time of the first sample, s.
    pub first_s: f64,
    /// Time between samples that are compared, s.
    pub step: f64,
    /// Displacement, m.
    pub d: Vec<f64>,
    /// Velocity, m/s.
    pub v: Vec<f64>,
    /// Acceleration, m/s^2.
    pub a: Vec<f64>,
    /// Force, N.
    pub force: Vec<f64>,
    /// Standard deviation of the noise of the force, N.
    pub noise: f64,
    /// What laws see of the motion, with what noise like that of the displacement leaves of it.
    path: Vec<Node>,
    /// Samples of the path before the first that is compared.
    led: usize,
    /// What such noise leaves of displacement, velocity and acceleration (m, m/s, m/s^2) at the samples: one draw of it.
    jitter: [Vec<f64>; 3],
    /// Frequency of the largest line of the displacement, Hz.
    pub frequency_hz: f64,
}

/// A sample of the motion at which laws are evaluated. Where the motion turns, a force may jump between two samples that are compared:
/// there every measured sample is one, and the law's forces are averaged as the measured ones are.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Node {
    /// Number of the sample whose force it is part of, from the beginning of the motion.
    sample: usize,
    /// Time since the node before, s.
    step: f64,
    /// Displacement (m) and velocity (m/s).
    motion: [f64; 2],
    /// What noise leaves of both.
    jitter: [f64; 2],
}

/// All records of a component.
#[derive(Debug, Clone, PartialEq)]
pub struct Loops {
    /// Records that are used.
    pub list: Vec<LoopRecord>,
    /// Known sources.
    pub known: Vec<Source>,
    /// Mass that moves with the force cell, kg.
    pub mass: f64,
}

impl Loops {
    /// Takes the runs that are switched on.
    ///
    /// # Errors
    /// [`ComponentError`]: no run, a channel that is missing, a law without a force in time.
    pub fn new(structure: &Structure, sources: &[Source], runs: &[TransientRun]) -> Result<Self, ComponentError> {
        let used = runs.iter().enumerate().filter(|(_, run)| run.enabled);
        let list: Vec<LoopRecord> = used.map(|(index, run)| LoopRecord::new(index, run)).collect::<Result<_, _>>()?;
        if list.is_empty() {
            return Err(ComponentError::NoRuns);
        }
        let acts = |s: &&Source| s.state == State::Known && !matches!(s.effect.kind(), EffectKind::Channel(_));
        let known: Vec<Source> = sources.iter().filter(acts).cloned().collect();
        let mass = structure.origin().component_mass;
        let loops = Self { list, known, mass };
        let refused = loops.known.iter().find(|s| loops.list[0].law_force(s).is_none());
        match refused {
            Some(source) => Err(ComponentError::NoTimeDomain { law: source.effect.name() }),
            None => Ok(loops),
        }
    }

    /// Range of the motion over all records.
    pub fn range(&self) -> effects::Range {
        let most = |x: &[f64]| x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let sizes: Vec<f64> = self.list.iter().map(|l| most(&l.d)).collect();
        let logs: f64 = self.list.iter().map(|l| (TAU * l.frequency_hz).ln()).sum();
        effects::Range {
            displacement: sizes.iter().fold(0.0, |m, s| f64::max(m, *s)),
            least: sizes.iter().fold(f64::INFINITY, |m, s| f64::min(m, *s)),
            velocity: self.list.iter().map(|l| most(&l.v)).fold(0.0, f64::max),
            omega: (logs / self.list.len() as f64).exp(),
        }
    }
}

impl LoopRecord {
    /// Of a run.
    ///
    /// # Errors
    /// [`ComponentError`]: a channel that is missing, a displacement that does not move.
    pub fn new(index: usize, run: &TransientRun) -> Result<Self, ComponentError> {
        let file = run.file.clone();
        let only_channel = |quantity: Quantity, needed| {
            let found = run.channels().iter().position(|c| c.quantity == quantity);
            found.ok_or(ComponentError::NoChannel { file: file.clone(), needed })
        };
        let pushed = only_channel(Quantity::Force, "of force (force)")?;
        let (force, step) = (run.samples(pushed), run.step());
        let d = match only_channel(Quantity::Displacement, "of displacement (disp) or velocity (vel)") {
            Ok(moved) => Cow::Borrowed(run.samples(moved)),
            Err(missing) => match only_channel(Quantity::Velocity, "") {
                Ok(moved) => Cow::Owned(integrated(run.samples(moved), step)),
                Err(_) => return Err(missing),
            },
        };
        let d: &[f64] = &d;
        let mean = d.iter().sum::<f64>() / d.len() as f64;
        let centred: Vec<f64> = d.iter().map(|d| d - mean).collect();
        let peak = Spectrum::new(&centred, step).and_then(|s| s.highest_peak());
        let Some(peak) = peak.filter(|p| p.amplitude > 0.0) else {
            return Err(ComponentError::NoMotion { file });
        };
        let period = 1.0 / (peak.frequency_hz * step);
        let every = ((period / PER_PERIOD) as usize).max(1);
        let half = ((SMOOTH * period).round() as usize).max(2).max(every / 2);
        let band = Band::of(d, step, peak.frequency_hz);
        let [measured, drawn] =
            [band.filtered(d, step), band.drawn_noise(d.len(), step)].map(|d| derivatives(&d, step, half));
        let moving = moving_part(&measured);
        let numbers: Vec<usize> = (moving.start + half..moving.end + half).step_by(every).collect();
        let path = path(&numbers, [&measured, &drawn], [half, every / 2], step);
        // How the motion went on beyond the ends of the record is not known to the filter.
        let edge = (1.0 / (band.highest_hz * step)) as usize;
        let led = numbers.iter().take_while(|n| **n < edge).count();
        let numbers: Vec<usize> = numbers.into_iter().skip(led).filter(|n| n + edge < d.len()).collect();
        if numbers.is_empty() {
            return Err(ComponentError::NoMotion { file });
        }
        let at_numbers = |motion: &[[f64; 3]]| [0, 1, 2].map(|k| numbers.iter().map(|n| motion[n - half][k]).collect());
        let ([d, v, a], jitter) = (at_numbers(&measured), at_numbers(&drawn));
        let averaged = |n: &usize| {
            let part = &force[n - every / 2..=n + every / 2];
            part.iter().sum::<f64>() / part.len() as f64
        };
        let forces: Vec<f64> = numbers.iter().map(averaged).collect();
        Ok(Self {
            index,
            file,
            channel: run.channels()[pushed].to_string(),
            first_s: run.time()[0] + numbers[0] as f64 * step,
            step: every as f64 * step,
            d,
            v,
            a,
            path,
            led,
            jitter,
            noise: noise(force) / (every as f64).sqrt(),
            force: forces,
            frequency_hz: peak.frequency_hz,
        })
    }

    /// The same record with one more draw of the noise of its displacement.
    pub(crate) fn jittered(&self) -> Self {
        let moved = |x: &[f64], k: usize| x.iter().zip(&self.jitter[k]).map(|(x, e)| x + e).collect();
        let displaced = |node: &Node| Node { motion: [0, 1].map(|k| node.motion[k] + node.jitter[k]), ..*node };
        let path = self.path.iter().map(displaced).collect();
        Self { d: moved(&self.d, 0), v: moved(&self.v, 1), a: moved(&self.a, 2), path, ..self.clone() }
    }

    /// Force of a source along the motion, N; none where its law has no force in time.
    pub fn law_force(&self, source: &Source) -> Option<Vec<f64>> {
        let (law, p) = (source.effect.law()?, &source.parameters);
        let linear = source.effect.constant().and_then(|constant| match constant {
            Constant::Stiffness => Some(&self.d),
            Constant::Viscous => Some(&self.v),
            Constant::Mass => Some(&self.a),
            Constant::Hysteretic => None,
        });
        if let Some(along) = linear {
            return Some(along.iter().map(|x| source.coefficient() * x).collect());
        }
        if law.point(p, 0.0, 1.0).is_some() {
            return Some(self.averaged(|node| law.point(p, node.motion[0], node.motion[1]).unwrap_or_default().force));
        }
        let mut memory = law.memory(p)?;
        // The record begins where the component is at rest.
        let start = self.path[0].motion[0];
        Some(self.averaged(|node| memory.advance(node.motion[0] - start, node.step)))
    }

    /// The mean of a force over the nodes of each sample, N.
    fn averaged(&self, mut force: impl FnMut(&Node) -> f64) -> Vec<f64> {
        let mut sums = vec![[0.0, 0.0]; self.d.len()];
        for node in &self.path {
            let force = force(node);
            if let Some([sum, count]) = node.sample.checked_sub(self.led).and_then(|sample| sums.get_mut(sample)) {
                (*sum, *count) = (*sum + force, *count + 1.0);
            }
        }
        sums.iter().map(|[sum, count]| sum / count).collect()
    }

    /// Work done on the component over the record, J, by a force along its motion.
    pub fn work(&self, force: &[f64]) -> f64 {
        self.step * force.iter().zip(&self.v).map(|(f, v)| f * v).sum::<f64>()
    }

    /// Root mean square of the force about its mean, N.
    pub fn size(&self) -> f64 {
        let mean = self.force.iter().sum::<f64>() / self.force.len() as f64;
        root_mean_square(&self.force.iter().map(|f| f - mean).collect::<Vec<f64>>())
    }
}

/// Displacement of a measured velocity, by the trapezoidal rule and without the straight line that an error of its zero makes of it: the
/// middle of the motion is its zero. Of four cycles with ramps at both ends the line takes away or adds some 1.4 % of the range.
fn integrated(velocity: &[f64], step: f64) -> Vec<f64> {
    let mut d = vec![0.0; velocity.len()];
    for n in 1..d.len() {
        d[n] = d[n - 1] + 0.5 * step * (velocity[n - 1] + velocity[n]);
    }
    let from_middle = |n: usize| n as f64 - 0.5 * (velocity.len() as f64 - 1.0);
    let mean = d.iter().sum::<f64>() / d.len() as f64;
    let (product, square) = d
        .iter()
        .enumerate()
        .fold((0.0, 0.0), |(product, square), (n, d)| (product + from_middle(n) * d, square + from_middle(n).powi(2)));
    let slope = if square > 0.0 { product / square } else { 0.0 };
    d.iter().enumerate().map(|(n, d)| d - mean - slope * from_middle(n)).collect()
}

/// The samples from where the motion begins to where it ends: at rest a contact holds any force up to that of its friction.
fn moving_part(motion: &[[f64; 3]]) -> Range<usize> {
    let least = AT_REST * motion.iter().map(|m| m[1].abs()).fold(0.0, f64::max);
    let moves = |m: &[f64; 3]| m[1].abs() > least;
    let first = motion.iter().position(moves).unwrap_or(0);
    first..motion.iter().rposition(moves).map_or(0, |last| last + 1)
}

/// The motion as laws see it at the samples `numbers`: every measured one up to `reach` away where it turns. `motion` and its noise begin
/// at sample `half`.
fn path(numbers: &[usize], [motion, noise]: [&[[f64; 3]]; 2], [half, reach]: [usize; 2], step: f64) -> Vec<Node> {
    let mut nodes = Vec::with_capacity(numbers.len());
    let mut next = 0;
    for (sample, &number) in numbers.iter().enumerate() {
        let middle = number - half;
        let around = middle.saturating_sub(reach)..=(middle + reach).min(motion.len() - 1);
        let turns = motion[around.clone()].iter().any(|m| m[1] * motion[middle][1] <= 0.0);
        for k in if turns { around } else { middle..=middle } {
            if k < next {
                continue;
            }
            let after = if next == 0 { 1 } else { k + 1 - next };
            let [motion, jitter] = [motion, noise].map(|m| [m[k][0], m[k][1]]);
            nodes.push(Node { sample, step: after as f64 * step, motion, jitter });
            next = k + 1;
        }
    }
    nodes
}

/// Standard deviation of white noise on a signal, from its third differences.
fn noise(samples: &[f64]) -> f64 {
    let third_difference = |w: &[f64]| (w[3] - 3.0 * w[2] + 3.0 * w[1] - w[0]).abs();
    let differences: Vec<f64> = samples.windows(4).map(third_difference).collect();
    crate::math::statistics::median(&differences) / (0.6745 * 20.0_f64.sqrt())
}
