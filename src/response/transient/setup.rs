//! What a model of a record is made of, what it is asked, and what it answers.

use crate::effects::Source;
use crate::measurement::Channel;
use crate::structure::modes::Modes;
use crate::structure::{Part, Structure};

/// What a model is made of.
#[derive(Debug, Clone, Copy)]
pub struct TransientSetup<'a> {
    /// Structure with matrices.
    pub structure: &'a Structure,
    /// Its undamped modes.
    pub modes: &'a Modes,
    /// How many of them are followed; the rest by residual flexibility.
    pub kept: usize,
    /// Sources that act.
    pub sources: &'a [Source],
    /// Rows of the driven DOFs.
    pub drives: &'a [usize],
    /// Channels that are predicted; those of forces repeat the drive.
    pub channels: &'a [Channel],
    /// Factors on all stiffness and on all mass.
    pub factors: [f64; 2],
    /// Logarithms of factors on the stiffness of the kept modes beside that; none for those beyond its end.
    pub mode_stiffness: &'a [f64],
    /// Logarithms of factors on the damping that laws of the whole structure give the kept modes; none for those beyond its end.
    pub mode_damping: &'a [f64],
    /// Parts of the structure with logarithms of factors on their stiffness or mass beside that.
    pub parts: &'a [(Part, f64)],
    /// Directions in which these logarithms move together, `[direction][part]`.
    pub directions: &'a [Vec<f64>],
    /// Time between samples and between the steps of a model that is not linear, s.
    pub step: [f64; 2],
    /// What each channel's mass-normalised shape is more than the model's, `[channel][kept mode]`, kg^(-1/2); none beyond its end.
    pub shape_errors: &'a [Vec<f64>],
}

#[cfg(test)]
impl<'a> TransientSetup<'a> {
    /// A structure as it is stated, three modes followed, in steps of `step` s.
    pub(crate) fn stated(
        structure: &'a Structure,
        modes: &'a Modes,
        sources: &'a [Source],
        channels: &'a [Channel],
        step: f64,
    ) -> Self {
        Self {
            structure,
            modes,
            kept: 3,
            sources,
            drives: &[],
            channels,
            factors: [1.0; 2],
            mode_stiffness: &[],
            mode_damping: &[],
            parts: &[],
            directions: &[],
            step: [step; 2],
            shape_errors: &[],
        }
    }
}

/// A parameter by which records are differentiated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TransientParameter {
    /// Parameter of a law, by its own unit.
    Source {
        /// Number of the source.
        source: usize,
        /// Number of the parameter.
        parameter: usize,
    },
    /// Logarithm of the factor on all stiffness.
    Stiffness,
    /// Logarithm of the factor on all mass.
    Mass,
    /// Logarithm of the stiffness of a kept mode.
    Mode(usize),
    /// Logarithm of the damping that laws of the whole structure give a kept mode.
    ModeDamping(usize),
    /// Way along a direction of the parts of the structure, by its number in the setup.
    Direction(usize),
    /// Entry of the initial state (see `TransientModel::predict`).
    Initial(usize),
}

/// Measured forces at equal steps.
#[derive(Debug, Clone, PartialEq)]
pub struct SampledForces {
    /// Time from one sample to the next, s.
    pub step: f64,
    /// Number of samples.
    pub samples: usize,
    /// Forces, N, one list a driven DOF; between samples they go on as band-limited ones do.
    pub forces: Vec<Vec<f64>>,
    /// Steps of the model from one sample to the next.
    pub substeps: usize,
    /// What is predicted are every so many samples, the first of them the first.
    pub every: usize,
    /// Longer steps from some samples on, in their order; none where all are as short as `substeps` says. What is predicted lies
    /// between them.
    pub step_lengths: Vec<StepLength>,
}

/// Steps of several samples, over which forces go on straight between their means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StepLength {
    /// Number of the sample from which on a step is so long.
    pub from: usize,
    /// Samples that a step covers.
    pub samples: usize,
}

/// A predicted record.
#[derive(Debug, Clone, PartialEq)]
pub struct TransientResponse {
    /// `[channel][sample]`, SI units.
    pub channels: Vec<Vec<f64>>,
    /// `[parameter][channel][sample]`.
    pub derivatives: Vec<Vec<Vec<f64>>>,
    /// What a channel of each order of differentiation shows of a unit of each kept mode, `[order][mode][sample]`; empty where no
    /// derivatives are asked for, or no channel has the order.
    pub modal: [Vec<Vec<f64>>; 3],
    /// State at the last sample, in the terms of the initial one.
    pub end: Vec<f64>,
}
