//! Measured data in CSV files: time records and fitted harmonics, read leniently and written exactly.

pub(crate) mod columns;
pub(crate) mod error;
pub(crate) mod harmonics;
mod harmonics_run;
pub(crate) mod places;
pub(crate) mod reader;
pub(crate) mod stepped_sine;
mod table;
pub(crate) mod writer;

pub use error::{RecordFileError, RecordProblem};
pub use harmonics::{parse_harmonics, read_harmonics, read_harmonics_as, write_harmonics};
pub use harmonics_run::HarmonicsRun;
pub(crate) use reader::{base_channel, known_labels};
pub use reader::{parse_record, read_record, read_record_with};
pub use stepped_sine::SteppedSine;
pub(crate) use stepped_sine::is_stepped_table;
pub use writer::write_record;
