//! Data set 2412: elements of any kind, mixed.

use crate::body::{Body, Line};
use crate::error::{Error, Problem};
use crate::fields::{self, Kind, Layout};
use crate::warning::Fault;

/// An element.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Element {
    /// Label.
    pub label: i64,
    /// Descriptor: 11 rod, 21 to 24 beams, 41 triangle, 44 quadrilateral, 111 tetrahedron, 115 brick and others.
    pub descriptor: i64,
    /// Physical property table.
    pub physical: i64,
    /// Material property table.
    pub material: i64,
    /// Colour.
    pub color: i64,
    /// Labels of its nodes.
    pub nodes: Vec<i64>,
    /// For beams: orientation node, fore-end and aft-end cross section.
    pub beam: Option<[i64; 3]>,
}

impl Element {
    /// Whether elements of a descriptor have a record of orientation and sections.
    pub fn is_beam(descriptor: i64) -> bool {
        matches!(descriptor, 11 | 21 | 22 | 23 | 24)
    }
}

const ELEMENT: Layout = Layout {
    record: "element",
    columns: &[
        ("element label", 10, Kind::Integer),
        ("descriptor", 10, Kind::Integer),
        ("physical property", 10, Kind::Integer),
        ("material property", 10, Kind::Integer),
        ("color", 10, Kind::Integer),
        ("number of nodes", 10, Kind::Integer),
    ],
    required: 6,
};

pub(crate) fn read(body: &mut Body<'_>) -> Result<Vec<Element>, Error> {
    let mut elements = Vec::new();
    while let Some(line) = body.line() {
        let fields = fields::read(body, line, &ELEMENT)?;
        let count = usize::try_from(fields.integer(5)).map_err(|_| {
            body.error(line, Problem::Negative { field: "the number of nodes", found: fields.integer(5) })
        })?;
        let descriptor = fields.integer(1);
        let beam = if Element::is_beam(descriptor) { beam_record(body, line, count)? } else { None };
        elements.push(Element {
            label: fields.integer(0),
            descriptor,
            physical: fields.integer(2),
            material: fields.integer(3),
            color: fields.integer(4),
            nodes: node_labels(body, line, count)?,
            beam,
        });
    }
    Ok(elements)
}

/// Orientation and sections; `None` where the record was left out, so that the nodes follow at once.
fn beam_record(body: &mut Body<'_>, element: Line<'_>, count: usize) -> Result<Option<[i64; 3]>, Error> {
    let Some(line) = body.line() else {
        return Err(body.error_here(Problem::Ends { record: "the record of a beam" }));
    };
    let numbers = integers(body, line)?;
    let next = body.peek().and_then(Body::integers);
    if numbers.len() == count && next.is_none_or(|next| next.len() != count) {
        body.warn(element, Fault::BeamRecord);
        body.back_to(line);
        return Ok(None);
    }
    let number = |i: usize| numbers.get(i).copied().unwrap_or(0);
    Ok(Some([number(0), number(1), number(2)]))
}

fn node_labels(body: &mut Body<'_>, element: Line<'_>, count: usize) -> Result<Vec<i64>, Error> {
    let mut nodes = Vec::with_capacity(count.min(body.rest().len()));
    while nodes.len() < count {
        let Some(line) = body.line() else {
            let problem = Problem::Short { record: "the nodes of an element", needed: count, found: nodes.len() };
            return Err(body.error(element, problem));
        };
        nodes.extend(integers(body, line)?);
        if nodes.len() > count {
            let problem = Problem::TooMany { expected: count, found: nodes.len() };
            return Err(body.error(line, problem));
        }
    }
    Ok(nodes)
}

/// Whole numbers separated by blanks; in columns of ten where full columns have grown together.
pub(super) fn integers(body: &Body<'_>, line: Line<'_>) -> Result<Vec<i64>, Error> {
    const WIDTH: usize = 10;
    let grown = line.bytes.split(u8::is_ascii_whitespace).any(|token| token.len() > WIDTH);
    if let Some(numbers) = Body::integers(line).filter(|_| !grown) {
        return Ok(numbers);
    }
    let columns = crate::number::trim_end(line.bytes).chunks(WIDTH).map(crate::number::trim);
    let numbers: Option<Vec<i64>> = columns.map(crate::number::integer).collect();
    numbers.ok_or_else(|| body.error(line, Problem::Value { text: crate::text::quote(line.bytes) }))
}
