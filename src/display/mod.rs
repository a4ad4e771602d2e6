//! How values, units and names are shown to people: the same on the screen, in plots and in reports.

pub(crate) mod change;
pub mod findings;
pub mod format;
pub mod glossary;
pub mod run_differences;
pub mod units;
pub mod words;
