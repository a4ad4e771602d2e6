//! Models with exact answers, and runs as they would be measured on them: for the tests of the engine in `src`, those of the
//! program, and the benchmarks.
#![allow(dead_code, unreachable_pub, reason = "each test and each benchmark takes what it needs")]
#![allow(clippy::unwrap_used, reason = "models that are known to be possible")]

pub mod models;
pub mod runs;
