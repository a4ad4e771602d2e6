//! Why nothing could be identified.

use crate::balance::BalanceError;
use crate::balance::windows::WindowError;
use crate::control::Cancelled;
use crate::math::nnls::NnlsError;
use crate::math::subsets::SubsetError;

/// A fault of the data or the settings that stops identification.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum IdentifyError {
    #[error("no run to use; add a [[run]] or set use = true")]
    NoRuns,
    #[error("no source to identify; add a [[source]] with state = \"candidate\" or a [[candidates]] family")]
    NoCandidates,
    #[error("{source_name} is forced, but {reason}; set its state to \"candidate\" or \"off\"")]
    ForcedImpossible { source_name: String, reason: String },
    #[error("{forced} sources are forced but there are only {runs} runs; measure more runs or force fewer sources")]
    TooManyForced { forced: usize, runs: usize },
    #[error("max_sources is {max_sources} but {forced} sources are forced; raise max_sources")]
    MaxSources { max_sources: usize, forced: usize },
    #[error(
        "the exciters put no energy in: input energy is not positive in any run; check the sign and place of the force channel"
    )]
    NoInput,
    #[error(
        "no set of sources with positive coefficients explains the energy; `dashpot diagnose` looks for reversed, exchanged and moved channels; else check the signs and places of force and motion channels"
    )]
    NothingFits,
    #[error("damping ratios need mass and stiffness, which this structure lacks; leave them out")]
    RatioWithoutModel,
    #[error(
        "the damping ratio at {frequency_hz:.4} Hz belongs to no mode of the model; mend its frequency or remove it"
    )]
    RatioOfNoMode { frequency_hz: f64 },
    #[error("the damping ratio at {frequency_hz:.4} Hz is {ratio}; give one between 0 and 1, and its deviation")]
    RatioValue { frequency_hz: f64, ratio: f64 },
    #[error(
        "damping ratios cannot stand beside {source_name}, whose damping depends on the amplitude; leave the ratios out or set its state to \"off\""
    )]
    RatioOfAmplitude { source_name: String },
    #[error(transparent)]
    Balance(#[from] BalanceError),
    #[error(transparent)]
    Windows(#[from] WindowError),
    #[error(transparent)]
    Solve(#[from] NnlsError),
    #[error(transparent)]
    Search(SubsetError),
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl From<SubsetError> for IdentifyError {
    fn from(error: SubsetError) -> Self {
        match error {
            SubsetError::Cancelled(cancelled) => Self::Cancelled(cancelled),
            other => Self::Search(other),
        }
    }
}
