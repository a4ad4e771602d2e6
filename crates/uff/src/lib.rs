#![doc = include_str!("../README.md")]

mod body;
mod dof;
mod entry;
mod error;
mod fields;
mod file;
mod lines;
mod number;
mod place;
mod scan;
mod sets;
mod text;
mod values;
mod warning;
mod write;

pub use dof::Dof;
pub use entry::{Entry, Summary};
pub use error::{Error, Problem};
pub use file::{File, Reading};
pub use place::Place;
pub use sets::analysis::{Analysis, AnalysisHeader};
pub use sets::elements::Element;
pub use sets::function::{Axis, Binary, ByteOrder, Function, FunctionHeader, FunctionKind};
pub use sets::model::Model;
pub use sets::nodes::Node;
pub use sets::shape::{Shape, ShapeHeader};
pub use sets::trace::TraceLine;
pub use sets::units::Units;
pub use sets::{Set, Unknown};
pub use values::Values;
pub use warning::{Fault, Warning};
pub use write::{to_bytes, write};
