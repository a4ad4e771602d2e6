//! Why a model cannot be made or asked, and why there is no response.

use crate::control::Cancelled;

/// Why there is no response.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ResponseError {
    /// The model itself is at fault.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// Nothing converged.
    #[error(
        "no periodic response was found at {frequency_hz:.6} Hz beyond {level:.3} of the force (residual {residual:.1e} with {harmonics} harmonics after {steps} steps): the motion there may not be periodic; lower the force or give a start nearby"
    )]
    NotConverged {
        /// Fundamental frequency, Hz.
        frequency_hz: f64,
        /// Share of the excitation that was reached.
        level: f64,
        /// Harmonics tried last.
        harmonics: usize,
        /// Newton steps in all.
        steps: usize,
        /// Relative residual left.
        residual: f64,
    },
    /// The fundamental frequency is not positive.
    #[error("the fundamental frequency is {frequency_hz} Hz: give a positive one")]
    BadFrequency {
        /// Value given, Hz.
        frequency_hz: f64,
    },
    /// The computation was asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Why a forward model cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// `points` structures have no equation of motion.
    #[error(
        "the structure has no mass and stiffness matrices, so its response cannot be predicted: give kind \"beam\", \"chain\" or \"matrices\""
    )]
    NoMatrices,
    /// Cholesky factors of the mass do not exist.
    #[error("the mass matrix is not positive definite: every degree of freedom needs mass")]
    MassNotPositive,
    /// Eigenvalues were not found.
    #[error("the natural modes were not found: {reason}")]
    NoModes {
        /// What went wrong.
        reason: String,
    },
    /// A DOF beyond the matrices.
    #[error("a source or force acts on row {dof} of {size} degrees of freedom (counted from zero)")]
    NoSuchDof {
        /// Row asked for.
        dof: usize,
        /// Rows there are.
        size: usize,
    },
    /// A parameter that is not a number.
    #[error("parameter `{parameter}` of source {source_index} ({effect}) is {value}: give a finite number")]
    BadParameter {
        /// Index in the list of sources.
        source_index: usize,
        /// Its law.
        effect: &'static str,
        /// Name of the parameter.
        parameter: &'static str,
        /// Value given.
        value: f64,
    },
    /// Negative stiffness or mass that makes the model resonate without damping.
    #[error(
        "the linear sources make the model singular at {frequency_hz:.6} Hz: a negative stiffness or mass balances the structure exactly"
    )]
    SingularSources {
        /// Frequency, Hz.
        frequency_hz: f64,
    },
}
