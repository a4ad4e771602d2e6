//! Identification on windows of decays and hammer tests: the right sources come out and their deviations are honest.
#![allow(clippy::unwrap_used, reason = "tests")]

#[path = "../common/mod.rs"]
mod common;
mod honest;
mod rows;
mod support;
