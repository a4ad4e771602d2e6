//! Steps of the model of a record between its samples, and the measured forces over them.

use super::data::RecordData;
use crate::response::transient::SampledForces;
use std::f64::consts::TAU;

/// Phase of the highest seen motion that one step of the model may cover, rad.
const STEP_PHASE: f64 = 0.2;
/// The same in the course of a fit, where what longer steps miss is put right ([`super::coarse_steps`]).
const COARSE_PHASE: f64 = 0.4;

/// How long the steps of a model are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Steps {
    /// As long as its motion allows.
    Fine,
    /// Longer, for the course of a fit.
    Coarse,
}

impl RecordData {
    /// Steps of the model from one sample to the next, `step` s later, where a law is nonlinear; each covers no more than `most` rad
    /// of the highest motion.
    pub(super) fn steps_between(&self, step: f64, most: f64) -> usize {
        let phase = TAU * self.highest_hz.min(3.0 * self.median_hz) * step;
        ((phase / most).ceil() as usize).clamp(1, 8)
    }

    /// The same as short as its motion asks for.
    pub(super) fn fine_steps(&self) -> usize {
        self.steps_between(self.force_step(), STEP_PHASE)
    }

    /// Whether there are longer steps than [`Self::substeps`] for the course of a fit.
    pub(super) fn has_coarse_steps(&self) -> bool {
        self.steps(Steps::Coarse) < self.substeps || !self.step_lengths(self.every).is_empty()
    }

    fn steps(&self, steps: Steps) -> usize {
        match steps {
            Steps::Fine => self.substeps,
            Steps::Coarse => self.steps_between(self.force_step(), COARSE_PHASE).min(self.substeps),
        }
    }

    /// Time from one sample of the forces to the next, s.
    pub(super) fn force_step(&self) -> f64 {
        self.step / self.every as f64
    }

    /// The measured forces, with all samples to be predicted that they have.
    pub(super) fn excitation(&self, linear: bool) -> SampledForces {
        SampledForces { every: 1, step_lengths: Vec::new(), ..self.excitation_in(self.len(), linear, Steps::Fine) }
    }

    /// Those up to sample `samples` of the channels, in steps of some length.
    pub(super) fn excitation_in(&self, samples: usize, linear: bool, steps: Steps) -> SampledForces {
        let (every, step) = (self.every, self.force_step());
        let samples = (samples.max(1) - 1) * every + 1;
        let forces = self.forces.iter().map(|list| list[..samples].to_vec()).collect();
        let substeps = if linear { 1 } else { self.steps(steps) };
        let longest = if linear || steps == Steps::Coarse { self.every } else { self.every / 2 };
        SampledForces { step, samples, forces, substeps, every, step_lengths: self.step_lengths(longest) }
    }
}
