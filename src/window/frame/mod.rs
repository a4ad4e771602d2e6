//! What stands around the stages: bars, inspector, schematic, start screen.

pub mod inspector;
pub mod keys;
pub mod schematic;
pub mod start;
pub mod status;
pub mod top;
