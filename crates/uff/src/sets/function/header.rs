//! The header of a function, records 1 to 11 of data set 58.

use super::kind::FunctionKind;
use crate::body::Body;
use crate::dof::Dof;
use crate::error::{Error, Problem};
use crate::fields::{self, Column, Kind, Layout};
use crate::text::{decode, named};
use crate::warning::Fault;

/// An axis of a function: records 8 to 11.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Axis {
    /// Specific data type: 0 unknown, 1 general, 8 displacement, 11 velocity, 12 acceleration, 13 excitation force,
    /// 15 pressure, 17 time, 18 frequency and others.
    pub quantity: i64,
    /// Exponents of length, force and temperature; they count where the quantity is 1.
    pub exponents: [i64; 3],
    /// Label; empty where the file says `NONE`.
    pub label: String,
    /// Unit; empty where the file says `NONE`.
    pub unit: String,
}

/// Order of the bytes of binary data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ByteOrder {
    /// Least significant byte first (1 in the file).
    Little,
    /// Most significant byte first (2 in the file).
    Big,
}

/// What the first record of a binary function (58b) says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Binary {
    /// Order of the bytes; `None` where the file does not say it.
    pub order: Option<ByteOrder>,
    /// Number of bytes of data, as the header has it.
    pub bytes: u64,
    /// Number of text lines after the first record: 11.
    pub(crate) lines: i64,
    pub(crate) order_said: i64,
    pub(crate) format: i64,
}

/// All that a function says of itself before its values.
#[derive(Debug, Clone, PartialEq)]
pub struct FunctionHeader {
    /// Five lines of free text; empty where the file says `NONE`.
    pub id: [String; 5],
    /// What the function is: time response, frequency response, coherence and others.
    pub kind: FunctionKind,
    /// Number of the function.
    pub number: i64,
    /// Version or sequence.
    pub version: i64,
    /// Load case; 0 is excitation at a single point.
    pub load_case: i64,
    /// DOF of the response.
    pub response: Dof,
    /// DOF of the reference (the excitation).
    pub reference: Dof,
    /// Whether the ordinate is complex.
    pub complex: bool,
    /// Whether the values are double precision.
    pub double: bool,
    /// Number of values, or of pairs where the abscissa is uneven, as the header has it.
    pub count: u64,
    /// Whether the abscissa is `start + i step`.
    pub even: bool,
    /// First abscissa.
    pub start: f64,
    /// Step of the abscissa.
    pub step: f64,
    /// Value on the z axis.
    pub z: f64,
    /// Abscissa.
    pub abscissa: Axis,
    /// Ordinate, or its numerator.
    pub ordinate: Axis,
    /// Denominator of the ordinate.
    pub denominator: Axis,
    /// Z axis.
    pub z_axis: Axis,
    /// For 58b what its first record says.
    pub binary: Option<Binary>,
}

impl FunctionHeader {
    /// Numbers that stand in the file for one value: abscissa, real and imaginary part.
    pub(crate) fn numbers_per_value(&self) -> u64 {
        1 + u64::from(self.complex) + u64::from(!self.even)
    }

    /// Sizes in bytes that binary data of `count` values may have: all numbers of one precision, or with a single abscissa.
    pub(crate) fn binary_sizes(&self) -> [u64; 2] {
        let size = if self.double { 8 } else { 4 };
        let all = self.count.saturating_mul(self.numbers_per_value()).saturating_mul(size);
        let narrow = if self.even { all } else { all.saturating_sub(self.count.saturating_mul(size - 4)) };
        [all, narrow]
    }
}

const DOFS: Layout = Layout {
    record: "record 6 (DOF identification)",
    columns: &[
        ("function type", 5, Kind::Integer),
        ("function number", 10, Kind::Integer),
        ("version", 5, Kind::Integer),
        ("load case", 10, Kind::Integer),
        ("response entity", 11, Kind::Text),
        ("response node", 10, Kind::Integer),
        ("response direction", 4, Kind::Integer),
        ("reference entity", 11, Kind::Text),
        ("reference node", 10, Kind::Integer),
        ("reference direction", 4, Kind::Integer),
    ],
    required: 1,
};

const FORM: Layout = Layout {
    record: "record 7 (data form)",
    columns: &[
        ("data type", 10, Kind::Integer),
        ("number of values", 10, Kind::Integer),
        ("abscissa spacing", 10, Kind::Integer),
        ("first abscissa", 13, Kind::Real),
        ("abscissa step", 13, Kind::Real),
        ("z value", 13, Kind::Real),
    ],
    required: 3,
};

const AXIS: [Column; 6] = [
    ("quantity", 10, Kind::Integer),
    ("length exponent", 5, Kind::Integer),
    ("force exponent", 5, Kind::Integer),
    ("temperature exponent", 5, Kind::Integer),
    ("label", 21, Kind::Text),
    ("unit", 21, Kind::Text),
];

const AXES: [Layout; 4] = [
    Layout { record: "record 8 (abscissa)", columns: &AXIS, required: 1 },
    Layout { record: "record 9 (ordinate)", columns: &AXIS, required: 1 },
    Layout { record: "record 10 (ordinate denominator)", columns: &AXIS, required: 1 },
    Layout { record: "record 11 (z axis)", columns: &AXIS, required: 1 },
];

/// First record of a binary function, after `58b`.
const BINARY: Layout = Layout {
    record: "first record of 58b",
    columns: &[
        ("byte order", 6, Kind::Integer),
        ("floating format", 6, Kind::Integer),
        ("lines of text", 12, Kind::Integer),
        ("bytes of data", 12, Kind::Integer),
    ],
    required: 0,
};

/// Reads the record with the number of the set; `Some` for 58b.
pub(crate) fn read_first(body: &mut Body<'_>) -> Result<Option<Binary>, Error> {
    let line = body.line().ok_or_else(|| body.error_here(Problem::Ends { record: "the number of the set" }))?;
    let Some(after) = line.bytes.iter().position(|b| matches!(b, b'b' | b'B')) else { return Ok(None) };
    let rest = crate::body::Line { bytes: &line.bytes[after + 1..], ..line };
    let fields = fields::read(body, rest, &BINARY)?;
    let order = match fields.integer(0) {
        1 => Some(ByteOrder::Little),
        2 => Some(ByteOrder::Big),
        _ => None,
    };
    let bytes = u64::try_from(fields.integer(3)).unwrap_or(0);
    Ok(Some(Binary {
        order,
        bytes,
        lines: fields.integer(2),
        order_said: fields.integer(0),
        format: fields.integer(1),
    }))
}

/// Reads records 1 to 11; the body stands before the values then.
pub(crate) fn read(body: &mut Body<'_>) -> Result<FunctionHeader, Error> {
    let binary = read_first(body)?;
    let id = identification(body)?;
    let line = body.required(DOFS.record)?;
    let dofs = fields::read(body, line, &DOFS)?;
    let dof = |i: usize| Dof { entity: named(dofs.text(i)), node: dofs.integer(i + 1), direction: dofs.integer(i + 2) };
    let line = body.required(FORM.record)?;
    let form = fields::read(body, line, &FORM)?;
    let (complex, double) = match form.integer(0) {
        2 => (false, false),
        4 => (false, true),
        5 => (true, false),
        6 => (true, true),
        found => return Err(body.error(line, Problem::DataType { found })),
    };
    let count = u64::try_from(form.integer(1))
        .map_err(|_| body.error(line, Problem::Negative { field: "the number of values", found: form.integer(1) }))?;
    let spacing = form.integer(2);
    if spacing != 0 && spacing != 1 {
        body.warn(line, Fault::Spacing { found: spacing });
    }
    if spacing != 0 && form.real(4) == 0.0 && count > 1 {
        body.warn(line, Fault::ZeroStep);
    }
    let [abscissa, ordinate, denominator, z_axis] = axes(body)?;
    Ok(FunctionHeader {
        id,
        kind: FunctionKind::from_number(dofs.integer(0)),
        number: dofs.integer(1),
        version: dofs.integer(2),
        load_case: dofs.integer(3),
        response: dof(4),
        reference: dof(7),
        complex,
        double,
        count,
        even: spacing != 0,
        start: form.real(3),
        step: form.real(4),
        z: form.real(5),
        abscissa,
        ordinate,
        denominator,
        z_axis,
        binary,
    })
}

/// Five lines of text, blank or not.
pub(crate) fn identification(body: &mut Body<'_>) -> Result<[String; 5], Error> {
    let mut id: [String; 5] = Default::default();
    for text in &mut id {
        let line = body.required("the five lines of identification")?;
        if !line.bytes.is_ascii() {
            body.warn(line, Fault::NotAscii);
        }
        *text = named(&decode(line.bytes));
    }
    Ok(id)
}

fn axes(body: &mut Body<'_>) -> Result<[Axis; 4], Error> {
    let mut axes: [Axis; 4] = Default::default();
    for (axis, layout) in axes.iter_mut().zip(&AXES) {
        let line = body.required(layout.record)?;
        let fields = fields::read(body, line, layout)?;
        *axis = Axis {
            quantity: fields.integer(0),
            exponents: [1, 2, 3].map(|i| fields.integer(i)),
            label: named(fields.text(4)),
            unit: named(fields.text(5)),
        };
    }
    Ok(axes)
}
