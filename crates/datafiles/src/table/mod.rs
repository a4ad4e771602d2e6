//! Tables of cells, from text or from sheets: blocks of numbers under headers of any depth become sets.

mod block;
mod blocks;
mod cell;
mod clock;
mod header;
mod header_line;
mod header_units;
mod indices;
mod listed;
mod moment;
pub(crate) mod number;
mod sampling;
mod sets;
mod text_columns;
mod wrapped;

pub(crate) use block::Block;
pub(crate) use blocks::Blocks;
pub(crate) use cell::Cell;
pub use sets::{CUT_OFF, TIME_GOES_BACK, TIMES_COUNT};
pub(crate) use sets::{Column, Columns, TableSource, finish};
pub(crate) use text_columns::{FEWEST, texts_of};
