//! The session: laws of undo, commands as data, results that are never shown stale, saving that survives a kill.
#![allow(clippy::disallowed_methods, clippy::unwrap_used, reason = "tests")]

mod commands;
mod kill;
mod laws;
mod saving;
mod support;
