//! Why a record cannot be predicted.

/// Why a record cannot be predicted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TransientError {
    /// `points` structures have no equation of motion.
    #[error("the structure has no mass and stiffness matrices, so its records cannot be predicted")]
    NoMatrices,
    /// A law that exists only in steady state.
    #[error(
        "law `{effect}` is defined harmonic by harmonic and has no force in time: leave it out for decays and transients"
    )]
    NoTimeDomain {
        /// Its law.
        effect: &'static str,
    },
    /// Mass or stiffness that cannot be.
    #[error("mass and stiffness with the linear sources are not positive definite: correct negative masses or springs")]
    NotPositive,
    /// The eigenvalue iteration failed.
    #[error("the damped modes of the model were not found: check the sizes of its masses, springs and dashpots")]
    NoModes,
    /// Forces that are not finite.
    #[error(
        "the forces of a time step were not found: the motion grows without bounds, or a parameter is far too large"
    )]
    StepFailed,
}
