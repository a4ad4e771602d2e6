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

pub(crate) use error::FrfError;
pub(crate) use names::{pair_in_name, plain_place, response_in_name};
pub(crate) use reader::{labels_in, read_test};
pub(crate) use shapes::{has_shapes, read_shapes};
pub(crate) use source::FrfSource;
pub(crate) use units::Form;
pub(crate) use writer::{SimulatedSet, write_responses};
