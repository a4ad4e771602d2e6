//! Measured frequency responses in files, in and out.

mod checks;
mod coherences;
mod data_files;
mod error;
mod names;
mod reader;
mod shapes;
mod source;
mod units;
mod universal;
mod writer;

pub use error::{FrfError, FrfProblem};
pub use names::{pair_in_name, plain_place, response_in_name};
pub use reader::{labels_in, read_responses};
pub use shapes::{has_shapes, read_shapes};
pub use source::FrfSource;
pub use units::Form;
pub use writer::{SimulatedSet, write_responses};
