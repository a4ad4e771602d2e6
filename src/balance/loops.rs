//! The loops of a component: displacement, velocity and acceleration that are imposed, the force that is measured.

use crate::control::Cancelled;
use crate::effects::{Constant, Kind as EffectKind, Range, Source, State};
use crate::math::spectrum::Spectrum;
use crate::math::statistics::root_mean_square;
use crate::measurement::{Quantity, TransientRun};
use crate::structure::Structure;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use std::f64::consts::TAU;

/// Samples a period that are compared; laws with memory see the motion as finely.
const PER_PERIOD: f64 = 120.0;
/// Least and greatest half width, in periods, of the polynomial by which the displacement is differentiated, and the share of
/// the amplitude that its noise may have behind it: a stiff spring makes a force of every bit of it.
const SMOOTH: [f64; 2] = [0.008, 0.03];
const STILL: f64 = 5e-4;

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
pub struct Loop {
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
    /// What noise like that of the displacement leaves of displacement, velocity and acceleration (m, m/s, m/s^2): one draw of it.
    pub jitter: [Vec<f64>; 3],
    /// Frequency of the largest line of the displacement, Hz.
    pub frequency_hz: f64,
}

/// All records of a component.
#[derive(Debug, Clone, PartialEq)]
pub struct Loops {
    /// Records that are used.
    pub list: Vec<Loop>,
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
        let list: Vec<Loop> = used.map(|(index, run)| Loop::new(index, run)).collect::<Result<_, _>>()?;
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
    pub fn range(&self) -> Range {
        let most = |x: &[f64]| x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let sizes: Vec<f64> = self.list.iter().map(|l| most(&l.d)).collect();
        let logs: f64 = self.list.iter().map(|l| (TAU * l.frequency_hz).ln()).sum();
        Range {
            displacement: sizes.iter().fold(0.0, |m, s| f64::max(m, *s)),
            least: sizes.iter().fold(f64::INFINITY, |m, s| f64::min(m, *s)),
            velocity: self.list.iter().map(|l| most(&l.v)).fold(0.0, f64::max),
            omega: (logs / self.list.len() as f64).exp(),
        }
    }
}

impl Loop {
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
        let moved = only_channel(Quantity::Displacement, "of displacement (disp)")?;
        let pushed = only_channel(Quantity::Force, "of force (force)")?;
        let (d, force, step) = (run.samples(moved), run.samples(pushed), run.step());
        let mean = d.iter().sum::<f64>() / d.len() as f64;
        let centred: Vec<f64> = d.iter().map(|d| d - mean).collect();
        let peak = Spectrum::new(&centred, step).and_then(|s| s.highest_peak());
        let Some(peak) = peak.filter(|p| p.amplitude > 0.0) else {
            return Err(ComponentError::NoMotion { file });
        };
        let period = 1.0 / (peak.frequency_hz * step);
        let every = ((period / PER_PERIOD) as usize).max(1);
        let [least, most] = SMOOTH.map(|share| ((share * period).round() as usize).max(2).max(every / 2));
        // The middle of a parabola through 2 h + 1 samples has 9 / 4 of the variance of their mean.
        let needed = 9.0 / 8.0 * (noise(d) / (STILL * peak.amplitude)).powi(2);
        let half = (needed.min(1e9) as usize).clamp(least, most.max(least));
        let numbers: Vec<usize> = (half..d.len().saturating_sub(half)).step_by(every).collect();
        let fits = |d: &[f64]| numbers.iter().map(|&n| cubic(&d[n - half..=n + half], step)).collect::<Vec<[f64; 3]>>();
        let motion = |fits: &[[f64; 3]]| [0, 1, 2].map(|k| fits.iter().map(|f| f[k]).collect::<Vec<f64>>());
        let ([d, v, a], jitter) = (motion(&fits(d)), motion(&fits(&drawn(noise(d), d.len()))));
        let averaged = |n: &usize| {
            let part = &force[n - every / 2..=n + every / 2];
            part.iter().sum::<f64>() / part.len() as f64
        };
        let forces: Vec<f64> = numbers.iter().map(averaged).collect();
        Ok(Self {
            index,
            file,
            channel: run.channels()[pushed].to_string(),
            first_s: run.time()[0] + half as f64 * step,
            step: every as f64 * step,
            d,
            v,
            a,
            jitter,
            noise: noise(force) / (every as f64).sqrt(),
            force: forces,
            frequency_hz: peak.frequency_hz,
        })
    }

    /// The same record with one more draw of the noise of its displacement.
    pub(crate) fn jittered(&self) -> Self {
        let moved = |x: &[f64], k: usize| x.iter().zip(&self.jitter[k]).map(|(x, e)| x + e).collect();
        Self { d: moved(&self.d, 0), v: moved(&self.v, 1), a: moved(&self.a, 2), ..self.clone() }
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
            let force = |(d, v): (&f64, &f64)| law.point(p, *d, *v).unwrap_or_default().force;
            return Some(self.d.iter().zip(&self.v).map(force).collect());
        }
        let mut memory = law.memory(p)?;
        // The record begins where the component is at rest.
        let start = self.d[0];
        Some(self.d.iter().map(|d| memory.advance(d - start, self.step)).collect())
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

/// Value, slope and curvature at the middle of a cubic through samples (least squares; Savitzky and Golay 1964).
fn cubic(samples: &[f64], step: f64) -> [f64; 3] {
    let half = (samples.len() / 2) as f64;
    let (mut s2, mut s4, mut s6) = (0.0, 0.0, 0.0);
    let (mut y0, mut y1, mut y2, mut y3) = (0.0, 0.0, 0.0, 0.0);
    for (n, y) in samples.iter().enumerate() {
        let x = n as f64 - half;
        let square = x * x;
        s2 += square;
        s4 += square * square;
        s6 += square * square * square;
        y0 += y;
        y1 += x * y;
        y2 += square * y;
        y3 += square * x * y;
    }
    let count = samples.len() as f64;
    let (even, odd) = (count * s4 - s2 * s2, s2 * s6 - s4 * s4);
    let offset = if even > 0.0 { (s4 * y0 - s2 * y2) / even } else { y0 / count };
    let square = if even > 0.0 { (count * y2 - s2 * y0) / even } else { 0.0 };
    let slope = if odd > 1e-9 * s2 * s6 { (s6 * y1 - s4 * y3) / odd } else { y1 / s2 };
    [offset, slope / step, 2.0 * square / (step * step)]
}

/// One draw of white noise of this deviation; the same on every machine.
fn drawn(deviation: f64, samples: usize) -> Vec<f64> {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    (0..samples).map(|_| deviation * Distribution::<f64>::sample(&StandardNormal, &mut random)).collect()
}

/// Standard deviation of white noise on a signal, from its third differences.
fn noise(samples: &[f64]) -> f64 {
    let third_difference = |w: &[f64]| (w[3] - 3.0 * w[2] + 3.0 * w[1] - w[0]).abs();
    let differences: Vec<f64> = samples.windows(4).map(third_difference).collect();
    crate::math::statistics::median(&differences) / (0.6745 * 20.0_f64.sqrt())
}

#[cfg(test)]
mod tests {
    use super::cubic;

    #[test]
    fn a_cubic_is_its_own_fit() {
        let step = 0.1;
        let samples: Vec<f64> = (-3..=3)
            .map(|n| {
                2.0 - 0.5 * step * f64::from(n) + 4.0 * (step * f64::from(n)).powi(2) + (step * f64::from(n)).powi(3)
            })
            .collect();
        let [value, slope, curvature] = cubic(&samples, step);
        assert!((value - 2.0).abs() < 1e-12 && (slope + 0.5).abs() < 1e-12 && (curvature - 8.0).abs() < 1e-9);
    }
}
