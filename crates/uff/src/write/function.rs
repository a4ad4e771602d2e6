//! Writes data set 58 as text or binary.

use super::columns::{Columns, consistent, scientific};
use crate::error::Problem;
use crate::sets::function::{Axis, ByteOrder, Function};
use crate::values::Values;

pub(super) fn write(out: &mut Columns, function: &Function) -> Result<(), Problem> {
    let header = &function.header;
    if let Some(uneven) = &function.uneven {
        consistent("uneven abscissas", uneven.len(), function.values.len())?;
    }
    let data = header.binary.map(|binary| bytes(function, binary.order.unwrap_or(ByteOrder::Little)));
    match (&data, header.binary) {
        (Some(data), Some(binary)) => {
            let order = if binary.order == Some(ByteOrder::Big) { 2 } else { 1 };
            let count = data.len();
            out.text_line(
                "record 0",
                &format!("    58b{order:6}{:6}{:12}{count:12}{:6}{:6}{:12}{:12}", 2, 11, 0, 0, 0, 0),
            )?;
        }
        _ => out.text_line("record 0", "    58")?,
    }
    write_header(out, function)?;
    match data {
        Some(data) => out.bytes.extend(data),
        None => write_text(out, function),
    }
    Ok(())
}

fn write_header(out: &mut Columns, function: &Function) -> Result<(), Problem> {
    let header = &function.header;
    header.id.iter().try_for_each(|text| out.named("identification", text))?;
    out.integer("function type", header.kind.number(), 5)?;
    out.integer("function number", header.number, 10)?;
    out.integer("version", header.version, 5)?;
    out.integer("load case", header.load_case, 10)?;
    for (dof, name) in [(&header.response, "response entity"), (&header.reference, "reference entity")] {
        out.left("blank", " ", 1)?;
        out.left(name, or_none(&dof.entity), 10)?;
        out.integer("node", dof.node, 10)?;
        out.integer("direction", dof.direction, 4)?;
    }
    out.end();
    let even = function.uneven.is_none();
    let data_type = match (function.values.is_complex(), header.double) {
        (false, false) => 2,
        (false, true) => 4,
        (true, false) => 5,
        (true, true) => 6,
    };
    out.integers("data form", &[data_type, function.values.len() as i64, i64::from(even)])?;
    for x in [if even { header.start } else { 0.0 }, if even { header.step } else { 0.0 }, header.z] {
        precise(out, x);
    }
    out.end();
    for axis in [&header.abscissa, &header.ordinate, &header.denominator, &header.z_axis] {
        write_axis(out, axis)?;
    }
    Ok(())
}

fn or_none(text: &str) -> &str {
    if text.is_empty() { "NONE" } else { text }
}

fn write_axis(out: &mut Columns, axis: &Axis) -> Result<(), Problem> {
    out.integer("quantity", axis.quantity, 10)?;
    axis.exponents.iter().try_for_each(|&exponent| out.integer("unit exponent", exponent, 5))?;
    for (text, name) in [(&axis.label, "label"), (&axis.unit, "unit")] {
        out.left("blank", " ", 1)?;
        out.left(name, or_none(text), 20)?;
    }
    out.end();
    Ok(())
}

/// A number in 13 columns with a decimal more where five do not say it and a blank still separates it.
fn precise(out: &mut Columns, x: f64) {
    const WIDTH: usize = 13;
    let five = scientific(x, 5, 'E');
    let six = scientific(x, 6, 'E');
    let text = if five.parse() != Ok(x) && six.len() < WIDTH { six } else { five };
    out.bytes.extend_from_slice(format!("{text:>WIDTH$}").as_bytes());
}

/// The numbers of a value: abscissa where uneven, real and imaginary part.
fn numbers(function: &Function) -> impl Iterator<Item = (Option<f64>, f64, Option<f64>)> + '_ {
    (0..function.values.len()).map(|i| {
        let abscissa = function.uneven.as_ref().map(|uneven| uneven[i]);
        match &function.values {
            Values::Real(values) => (abscissa, values[i], None),
            Values::Complex(values) => (abscissa, values[i][0], Some(values[i][1])),
        }
    })
}

/// Values in text: cases 1 to 8 of the standard.
fn write_text(out: &mut Columns, function: &Function) {
    let double = function.header.double;
    let per_line = match (double, function.uneven.is_some(), function.values.is_complex()) {
        (false, ..) => 6,
        (true, true, true) => 3,
        (true, ..) => 4,
    };
    let mut count = 0;
    let mut put = |x: f64, wide: bool| {
        if wide {
            out.real(x, 20, 12, 'E');
        } else {
            out.single(x);
        }
        count += 1;
        if count % per_line == 0 {
            out.end();
        }
    };
    for (abscissa, re, im) in numbers(function) {
        if let Some(x) = abscissa {
            put(x, false);
        }
        put(re, double);
        if let Some(im) = im {
            put(im, double);
        }
    }
    if count % per_line != 0 {
        out.end();
    }
}

/// Values as IEEE 754 floats, abscissas in the precision of the ordinates.
fn bytes(function: &Function, order: ByteOrder) -> Vec<u8> {
    let mut bytes = Vec::new();
    let double = function.header.double;
    let mut put = |x: f64| match (double, order) {
        (true, ByteOrder::Little) => bytes.extend(x.to_le_bytes()),
        (true, ByteOrder::Big) => bytes.extend(x.to_be_bytes()),
        (false, ByteOrder::Little) => bytes.extend((x as f32).to_le_bytes()),
        (false, ByteOrder::Big) => bytes.extend((x as f32).to_be_bytes()),
    };
    for (abscissa, re, im) in numbers(function) {
        abscissa.into_iter().chain([re]).chain(im).for_each(&mut put);
    }
    bytes
}
