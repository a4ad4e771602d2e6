//! Laboratory data files: opens what measuring systems write, shows what is in it before anything is read, and reads one
//! channel at a time.
//!
//! [`open`] tells the format by the content, never by the ending alone, and returns a [`DataFile`]: a tree of sets and
//! channels ([`Contents`]) that is cheap to make, and the values of each channel on request. The crate knows names, units,
//! steps and numbers; what they measure and where is for its user to say.
//!
//! Memory is bounded: a length in a header never allocates more than the file could hold. Errors are one line with file,
//! set, line or byte, what is wrong and how to mend it. Nothing panics on any input.

#![allow(
    clippy::assigning_clones,
    clippy::case_sensitive_file_extension_comparisons,
    clippy::cast_lossless,
    clippy::large_enum_variant,
    clippy::match_same_arms,
    clippy::option_option,
    clippy::struct_excessive_bools,
    clippy::unreadable_literal,
    clippy::unused_self,
    reason = "readers follow the layouts of their formats"
)]

mod axis;
mod bytes;
mod contents;
mod detect;
mod error;
mod file;
mod gathered;
mod guard;
mod hdf5;
mod mat;
mod npy;
mod npz;
mod parts;
mod shared_times;
mod source;
mod table;
mod tdms;
mod text;
mod tree;
pub mod units;
mod universal;
mod wav;
mod xlsx;

pub use contents::{Axis, Channel, Contents, Format, Kind, Number, Set};
pub use error::Error;
pub use file::{DataFile, open, open_paired};
pub use parts::{Pairing, core_of, is_coherence};
pub use table::{CUT_OFF, TIME_GOES_BACK, TIMES_COUNT};
pub use tdms::BROKEN_OFF;
pub use text::listed_names;
pub use uff::Values;
