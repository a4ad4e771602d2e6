//! What a file lists of a set without reading its numbers.

use crate::body::Body;
use crate::error::Error;
use crate::place::Place;
use crate::sets::analysis::{self, AnalysisHeader};
use crate::sets::function::{self, FunctionHeader};
use crate::sets::model::Model;
use crate::sets::shape::{self, ShapeHeader};
use crate::sets::units::Units;
use std::ops::Range;

/// A set in the list of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// Number of the data set, such as 58; 0 where it cannot be read.
    pub number: u32,
    /// Whether it holds binary data (58b).
    pub binary: bool,
    /// Place of the record with its number.
    pub place: Place,
    /// Bytes from that record to the closing delimiter.
    pub bytes: Range<u64>,
    /// What its first records say.
    pub summary: Summary,
}

/// What the first records of a set say.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Summary {
    /// A function.
    Function(Box<FunctionHeader>),
    /// Data at nodes (55).
    Shape(Box<ShapeHeader>),
    /// Analysis data (2414).
    Analysis(Box<AnalysisHeader>),
    /// Units.
    Units(Units),
    /// What the file is about.
    Model(Box<Model>),
    /// Nodes, elements and lines: they have no header.
    Geometry,
    /// A set that is not known here.
    Unknown,
    /// The first records cannot be read.
    Unreadable(Error),
}

impl Summary {
    /// Summary of a set from its first lines.
    pub(crate) fn read(number: u32, head: &[u8], origin: Place) -> Self {
        let mut body = Body::new(head, origin);
        let read = |body: &mut Body<'_>| -> Result<Self, Error> {
            if number == 58 {
                return function::read_header(body).map(|header| Self::Function(Box::new(header)));
            }
            body.line();
            Ok(match number {
                55 => Self::Shape(Box::new(shape::read_header(body)?)),
                2414 => Self::Analysis(Box::new(analysis::read_header(body)?)),
                164 => Self::Units(Units::read(body)?),
                151 => Self::Model(Box::new(Model::read(body))),
                15 | 82 | 2411 | 2412 => Self::Geometry,
                _ => Self::Unknown,
            })
        };
        read(&mut body).unwrap_or_else(Self::Unreadable)
    }
}
