//! Validated records: what was measured, the harmonics fitted to it with their covariance, and what is wrong with it.

pub mod channel;
pub mod fit;
pub mod frequency;
pub mod quality;
pub mod record;
pub mod run;

pub use channel::{Channel, Quantity, Unit};
pub use fit::{ChannelFit, HarmonicFit};
pub use quality::{Finding, Flag};
pub use record::Record;
pub use run::Run;
