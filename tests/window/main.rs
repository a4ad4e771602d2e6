//! The window, driven by accessible labels and real pointer events, and pictured by a software adapter.
#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests")]

mod events;
mod export;
mod path;
mod pictures;
mod space;
mod support;
mod wing;
