//! The record of data sets 55 and 2414 that says what their values are.

use crate::body::Body;
use crate::error::{Error, Problem};
use crate::fields::{self, Kind, Layout};

/// More values at a node are a mistake in the column.
const MOST_PER_NODE: usize = 10_000;

const KINDS: Layout = Layout {
    record: "the record of kinds",
    columns: &[
        ("model type", 10, Kind::Integer),
        ("analysis type", 10, Kind::Integer),
        ("data characteristic", 10, Kind::Integer),
        ("specific data type", 10, Kind::Integer),
        ("data type", 10, Kind::Integer),
        ("values a node", 10, Kind::Integer),
    ],
    required: 6,
};

/// What the values are, in the numbers of the standard.
pub(super) struct Kinds {
    pub model: i64,
    pub analysis: i64,
    pub characteristic: i64,
    pub quantity: i64,
    pub data_type: i64,
    /// Values at each node.
    pub per_node: usize,
}

impl Kinds {
    /// Reads the record; `types` are the data types that the set may have.
    pub(super) fn read(body: &mut Body<'_>, types: &[i64]) -> Result<Self, Error> {
        let line = body.required(KINDS.record)?;
        let kinds = fields::read(body, line, &KINDS)?;
        let [model, analysis, characteristic, quantity, data_type, per_node] =
            [0, 1, 2, 3, 4, 5].map(|column| kinds.integer(column));
        if !types.contains(&data_type) {
            return Err(body.error(line, Problem::DataType { found: data_type }));
        }
        let negative = Problem::Negative { field: "the number of values a node", found: per_node };
        let per_node = usize::try_from(per_node).ok().filter(|&n| n <= MOST_PER_NODE);
        let per_node = per_node.ok_or_else(|| body.error(line, negative))?;
        Ok(Self { model, analysis, characteristic, quantity, data_type, per_node })
    }
}
