//! What is said of a file that cannot be read.

use crate::error::{Fault, one_line};

/// The one line on an error of the reader.
pub(super) fn wrong(error: impl std::fmt::Display) -> Fault {
    Fault::new(format!(
        "cannot be read as HDF5 ({}); it was cut short or is damaged: copy or export it again",
        one_line(&error.to_string(), 160)
    ))
}
