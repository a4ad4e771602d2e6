//! What stands around the stages: bars, docked panes, inspector, schematic, start screen.

pub(crate) mod cards;
pub(crate) mod choose;
pub mod desk;
pub(crate) mod dock;
pub(crate) mod focus;
pub(crate) mod help;
pub(crate) mod icons;
pub(crate) mod inspector;
mod language;
pub(crate) mod leave;
pub(crate) mod menu_bar;
pub(crate) mod notice;
pub mod panes;
pub(crate) mod report;
pub mod report_choice;
pub(crate) mod schematic;
pub(crate) mod start;
pub(crate) mod status;
mod tabs;
pub(crate) mod top;
pub(crate) mod units;
