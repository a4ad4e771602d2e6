//! Why no energy equation can be written.

/// A fault of the data or the settings that stops the energy balance.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum BalanceError {
    #[error("{file}: no force channel; name the exciter's channel force@DOF")]
    NoForce { file: String },
    #[error("{file}: no acceleration, velocity or displacement channel")]
    NoSensor { file: String },
    #[error(
        "{file}: every force channel is zero at its frequency of {frequency_hz} Hz; check the channel and the frequency"
    )]
    ZeroForce { file: String, frequency_hz: f64 },
    #[error(
        "{file}: force@{dof} has no sensor, and without mass and stiffness its input energy is unknown; add acc@{dof}"
    )]
    DriveUnmeasured { file: String, dof: String },
    #[error("expansion {method} needs mass and stiffness, which a points structure lacks; use expansion = \"none\"")]
    NoMatrices { method: &'static str },
    #[error(
        "{file}: harmonic {harmonic} is at a frequency whose mode {mode} does not move at any sensor; add a sensor or use expansion = \"dynamic\""
    )]
    ModeUnseen { file: String, harmonic: usize, mode: usize },
    #[error("the structure's modes cannot be computed: {reason}")]
    Modes { reason: String },
}
