//! Harmonic fits, their covariance, the frequency, and the quality of records.

#![allow(clippy::unwrap_used, missing_docs, reason = "tests")]

mod close_modes;
mod fits;
mod flags;
mod frequencies;
mod releases;
mod runs;
mod signals;
