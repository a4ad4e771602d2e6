//! The window, driven by accessible labels and real pointer events, and pictured by a software adapter.
#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests")]

mod book;
mod cells;
mod change;
mod choose;
#[path = "../common/mod.rs"]
mod common;
mod crash;
mod desk;
mod drive;
mod events;
mod explain;
mod export;
mod extremes;
mod first_hour;
mod friction;
mod full_disk;
mod history;
mod importing;
mod journey;
mod keyboard;
mod laboratory;
mod language;
mod laws;
mod leave_out;
mod legible;
mod many;
mod mend;
mod names;
mod path;
mod pictures;
mod records;
mod report;
mod sizes;
mod space;
mod states;
mod support;
mod terms;
mod units;
mod values;
mod walk_frf;
mod wing;
mod zoom;
