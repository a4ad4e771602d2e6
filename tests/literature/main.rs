//! Published numbers, at the tolerance that the source supports.
#![allow(clippy::unwrap_used, reason = "tests")]

mod structures;
