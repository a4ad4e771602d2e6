//! Data set 82: lines drawn through nodes.

use super::elements::integers;
use crate::body::Body;
use crate::error::{Error, Problem};
use crate::fields::{self, Kind, Layout};
use crate::text::{decode, named};
use crate::warning::Fault;

/// A line through nodes; 0 lifts the pen.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TraceLine {
    /// Number of the line.
    pub number: i64,
    /// Colour.
    pub color: i64,
    /// Name.
    pub name: String,
    /// Node labels in the order of drawing; 0 between strokes.
    pub nodes: Vec<i64>,
}

impl TraceLine {
    /// The strokes as pairs of nodes.
    pub fn segments(&self) -> Vec<[i64; 2]> {
        self.nodes.windows(2).filter(|pair| pair[0] != 0 && pair[1] != 0).map(|pair| [pair[0], pair[1]]).collect()
    }

    pub(crate) fn read(body: &mut Body<'_>) -> Result<Self, Error> {
        const TRACE: Layout = Layout {
            record: "record 1 (trace line)",
            columns: &[
                ("number of the line", 10, Kind::Integer),
                ("number of nodes", 10, Kind::Integer),
                ("color", 10, Kind::Integer),
            ],
            required: 2,
        };
        let head = body.required(TRACE.record)?;
        let fields = fields::read(body, head, &TRACE)?;
        let count = usize::try_from(fields.integer(1)).map_err(|_| {
            body.error(head, Problem::Negative { field: "the number of nodes", found: fields.integer(1) })
        })?;
        let name = body.required("the name of the line")?;
        let mut nodes = Vec::new();
        while let Some(line) = body.line() {
            nodes.extend(integers(body, line)?);
        }
        // Some programs fill the last line up with zeros.
        if nodes.len() > count && nodes[count..].iter().all(|&node| node == 0) {
            nodes.truncate(count);
        }
        if nodes.len() != count {
            body.warn(head, Fault::Entries { declared: count as u64, found: nodes.len() as u64 });
        }
        Ok(Self { number: fields.integer(0), color: fields.integer(2), name: named(&decode(name.bytes)), nodes })
    }
}
