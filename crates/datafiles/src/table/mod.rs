//! Tables of cells, from text or from sheets: blocks of numbers under headers of any depth become sets.

mod blocks;
pub(crate) mod cell;
mod clock;
mod header;
mod header_line;
mod indices;
mod listed;
mod sampling;
mod sets;

pub(crate) use blocks::{Block, Blocks};
pub(crate) use cell::Cell;
pub(crate) use sets::{Column, Columns, TableSource, finish};
