//! Good, odd and bad files: every bad one is refused in one line that says where, what and how to mend it.
#![allow(clippy::disallowed_methods, clippy::unwrap_used, missing_docs, reason = "tests")]

#[path = "../common/mod.rs"]
mod common;
mod mapping;
mod projects;
mod projects_bad;
mod projects_random;
mod records;
mod records_random;
