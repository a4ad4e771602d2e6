//! What stands around the stages: bars, docked panes, inspector, schematic, start screen.

pub mod cards;
pub mod choose;
pub mod desk;
pub mod dock;
pub mod focus;
pub mod help;
pub mod icons;
pub mod inspector;
pub mod leave;
pub mod notice;
pub mod panes;
pub mod schematic;
pub mod start;
pub mod status;
mod tabs;
pub mod top;
pub mod units;
