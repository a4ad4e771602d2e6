//! Laboratory files as runs: which channel of a file is which quantity at which DOF, in which unit and sense.
//!
//! The mapping is a template in the project, `[[channel]]`, and holds for all its files of the same layout. Files are opened
//! by `dashpot_datafiles` and never rewritten.

mod amplitudes;
mod guess;
mod memory;
pub mod propose;
mod read;
mod runs;
pub(crate) mod samples;
mod stepped;
pub(crate) mod table;
pub(crate) mod units;

pub use amplitudes::AmplitudeColumns;
pub(crate) use amplitudes::{AmplitudeTable, read_amplitudes, sets_with};
pub(crate) use propose::DIRECTION_ASSUMED;
pub use propose::{FORCE_WITHOUT_PLACE, NotMapped, Proposal, propose};
pub use read::is_own_record;
pub(crate) use read::{Template, read_mapped, reads_as_own};
pub use runs::runs_of;
pub use stepped::{Stepped, stepped};
pub use table::ChannelTable;
