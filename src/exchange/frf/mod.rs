//! Measured frequency responses in files, in and out.

mod coherences;
mod error;
mod names;
mod other;
mod reader;
mod units;
mod writer;

pub use error::{FrfError, FrfProblem};
pub use names::{pair_in_name, plain_place, response_in_name};
pub use reader::{FrfSource, labels_in, read_responses};
pub use units::Form;
pub use writer::{SimulatedSet, write_responses};
