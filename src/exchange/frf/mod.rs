//! Measured frequency responses in files, in and out.

mod error;
mod names;
mod reader;
mod units;
mod writer;

pub use error::{FrfError, FrfProblem};
pub use reader::{FrfSource, read_responses};
pub use units::Form;
pub use writer::{SimulatedSet, write_responses};
