//! Validated records: what was measured, the harmonics fitted to it with their covariance, and what is wrong with it.

mod any_columns;
pub mod base;
pub mod channel;
mod decay;
mod design;
mod even_columns;
pub mod fit;
pub mod frequency;
pub mod frf;
pub mod kind;
mod noise;
pub mod proposal;
pub mod quality;
mod ramps;
pub mod ratio;
pub mod record;
pub mod run;
mod settling;
mod slips;
mod stuck;
mod transient_quality;
pub mod transient_run;

pub use channel::{Channel, ChannelName, Quantity, Unit};
pub use fit::{ChannelFit, FitError, HarmonicFit, fit};
pub use kind::{Kind, Part};
pub use quality::{Finding, Flag};
pub use ramps::steady_part;
pub use ratio::MeasuredRatio;
pub use record::{Record, RecordError};
pub use run::{Amplitudes, Correction, Run};
pub use transient_run::{TransientLabel, TransientRun, TransientRunError};
