//! The data sets, one file each.

pub(crate) mod analysis;
pub(crate) mod elements;
pub(crate) mod function;
mod kinds;
pub(crate) mod model;
pub(crate) mod nodes;
mod rows;
pub(crate) mod shape;
pub(crate) mod trace;
pub(crate) mod units;

use crate::body::Body;
use crate::error::Error;
use analysis::Analysis;
use elements::Element;
use function::Function;
use model::Model;
use nodes::Node;
use shape::Shape;
use trace::TraceLine;
use units::Units;

/// A data set with its numbers.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
#[allow(clippy::large_enum_variant, reason = "a file has few sets, and almost all of them are functions")]
pub enum Set {
    /// 151: what the file is about.
    Model(Model),
    /// 164: units.
    Units(Units),
    /// 15: nodes in single precision.
    Nodes(Vec<Node>),
    /// 2411: nodes in double precision.
    DoubleNodes(Vec<Node>),
    /// 2412: elements.
    Elements(Vec<Element>),
    /// 82: a line drawn through nodes.
    TraceLine(TraceLine),
    /// 55: data at nodes, such as a mode shape.
    Shape(Shape),
    /// 2414: analysis data at nodes or elements, such as a mode shape.
    Analysis(Analysis),
    /// 58 and 58b: a function, such as a time history or a frequency response.
    Function(Function),
    /// Any other set, as it stands in the file.
    Unknown(Unknown),
}

/// A set that is not known here: nothing is lost, nothing is understood.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unknown {
    /// Its number.
    pub number: u32,
    /// All after the record with the number, up to the closing delimiter.
    pub bytes: Vec<u8>,
}

impl Unknown {
    /// The set as text, UTF-8 or latin-1.
    pub fn text(&self) -> String {
        crate::text::decode(&self.bytes)
    }
}

impl Set {
    /// Number of the data set.
    pub fn number(&self) -> u32 {
        match self {
            Self::Model(_) => 151,
            Self::Units(_) => 164,
            Self::Nodes(_) => 15,
            Self::DoubleNodes(_) => 2411,
            Self::Elements(_) => 2412,
            Self::TraceLine(_) => 82,
            Self::Shape(_) => 55,
            Self::Analysis(_) => 2414,
            Self::Function(_) => 58,
            Self::Unknown(unknown) => unknown.number,
        }
    }

    /// Reads a set from the record with its number on.
    pub(crate) fn read(number: u32, body: &mut Body<'_>) -> Result<Self, Error> {
        if number == 58 {
            return Function::read(body).map(Self::Function);
        }
        body.line();
        Ok(match number {
            151 => Self::Model(Model::read(body)),
            164 => Self::Units(Units::read(body)?),
            15 => Self::Nodes(nodes::read_single(body)?),
            2411 => Self::DoubleNodes(nodes::read_double(body)?),
            2412 => Self::Elements(elements::read(body)?),
            82 => Self::TraceLine(TraceLine::read(body)?),
            55 => Self::Shape(Shape::read(body)?),
            2414 => Self::Analysis(Analysis::read(body)?),
            number => Self::Unknown(Unknown { number, bytes: body.rest().to_vec() }),
        })
    }
}
