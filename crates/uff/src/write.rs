//! Writes sets in the columns of the standard.
//!
//! Text in columns has the digits that the columns have: five decimals in single, twelve in double precision. Binary
//! functions (58b) are exact to the last bit.

mod columns;
mod function;

use crate::error::{Error, Problem};
use crate::place::Place;
use crate::sets::analysis::Analysis;
use crate::sets::elements::Element;
use crate::sets::model::Model;
use crate::sets::nodes::Node;
use crate::sets::shape::Shape;
use crate::sets::trace::TraceLine;
use crate::sets::units::Units;
use crate::sets::{Set, Unknown};
use columns::{Columns, consistent};
use std::io::Write;

/// Writes sets, each between its delimiters.
///
/// A function is written as 58b where its header says `binary`, else as text; counts are those of its values.
pub fn write(out: &mut impl Write, sets: &[Set]) -> Result<(), Error> {
    for (i, set) in sets.iter().enumerate() {
        let place = Place { set: Some(i), kind: Some(set.number()), ..Place::default() };
        let bytes = set_bytes(set).map_err(|problem| Error { place, problem })?;
        let failed = |error: std::io::Error| Error { place, problem: Problem::Io { reason: error.to_string() } };
        out.write_all(&bytes).map_err(failed)?;
    }
    Ok(())
}

/// Writes sets to memory.
pub fn to_bytes(sets: &[Set]) -> Result<Vec<u8>, Error> {
    let mut bytes = Vec::new();
    write(&mut bytes, sets)?;
    Ok(bytes)
}

fn set_bytes(set: &Set) -> Result<Vec<u8>, Problem> {
    let mut out = Columns::default();
    out.delimiter();
    if let Set::Function(function) = set {
        function::write(&mut out, function)?;
    } else {
        out.text_line("set number", &format!("{:6}", set.number()))?;
        match set {
            Set::Model(model) => write_model(&mut out, model)?,
            Set::Units(units) => write_units(&mut out, units)?,
            Set::Nodes(nodes) => nodes.iter().try_for_each(|node| write_node(&mut out, node))?,
            Set::DoubleNodes(nodes) => nodes.iter().try_for_each(|node| write_double_node(&mut out, node))?,
            Set::Elements(elements) => elements.iter().try_for_each(|element| write_element(&mut out, element))?,
            Set::TraceLine(line) => write_trace(&mut out, line)?,
            Set::Shape(shape) => write_shape(&mut out, shape)?,
            Set::Analysis(analysis) => write_analysis(&mut out, analysis)?,
            Set::Unknown(unknown) => write_unknown(&mut out, unknown),
            Set::Function(_) => {}
        }
    }
    out.delimiter();
    Ok(out.bytes)
}

fn write_model(out: &mut Columns, model: &Model) -> Result<(), Problem> {
    out.named("model name", &model.name)?;
    out.named("description", &model.description)?;
    out.named("application", &model.application)?;
    for text in &model.created {
        out.left("date of creation", text, 10)?;
    }
    for text in &model.versions {
        out.right("version", if text.is_empty() { "0" } else { text }, 10)?;
    }
    out.end();
    for (dates, name) in [(&model.saved, "date of saving"), (&model.written, "date of writing")] {
        if name == "date of writing" {
            out.named("program", &model.program)?;
        }
        for text in dates {
            out.left(name, text, 10)?;
        }
        out.end();
    }
    Ok(())
}

fn write_units(out: &mut Columns, units: &Units) -> Result<(), Problem> {
    out.integer("units code", units.code, 10)?;
    out.left("units description", &units.description, 20)?;
    out.integer("temperature mode", units.temperature_mode, 10)?;
    out.end();
    for (i, factor) in [units.length, units.force, units.temperature, units.temperature_offset].into_iter().enumerate()
    {
        out.double(factor);
        if i >= 2 {
            out.end();
        }
    }
    Ok(())
}

fn write_node(out: &mut Columns, node: &Node) -> Result<(), Problem> {
    write_labels(out, node)?;
    node.position.iter().for_each(|&x| out.single(x));
    out.end();
    Ok(())
}

fn write_double_node(out: &mut Columns, node: &Node) -> Result<(), Problem> {
    write_labels(out, node)?;
    out.end();
    node.position.iter().for_each(|&x| out.double(x));
    out.end();
    Ok(())
}

fn write_labels(out: &mut Columns, node: &Node) -> Result<(), Problem> {
    out.integers("node", &[node.label, node.definition_system, node.displacement_system, node.color])
}

fn write_element(out: &mut Columns, element: &Element) -> Result<(), Problem> {
    let Element { label, descriptor, physical, material, color, nodes, beam } = element;
    out.integers("element", &[*label, *descriptor, *physical, *material, *color, nodes.len() as i64])?;
    out.end();
    if Element::is_beam(*descriptor) {
        out.integers("beam", &beam.unwrap_or_default())?;
        out.end();
    }
    out.integer_lines("element node", nodes)
}

fn write_trace(out: &mut Columns, line: &TraceLine) -> Result<(), Problem> {
    out.integers("trace line", &[line.number, line.nodes.len() as i64, line.color])?;
    out.end();
    out.named("name of the line", &line.name)?;
    out.integer_lines("node", &line.nodes)
}

fn write_shape(out: &mut Columns, shape: &Shape) -> Result<(), Problem> {
    let header = &shape.header;
    let complex = shape.values.is_complex();
    consistent("values of the shape", shape.values.len(), shape.nodes.len() * header.per_node)?;
    header.id.iter().try_for_each(|text| out.named("identification", text))?;
    let data_type = if complex { 5 } else { 2 };
    let kinds = [header.model, header.analysis, header.characteristic, header.quantity, data_type];
    out.integers("kind", &kinds)?;
    out.integer("values a node", header.per_node as i64, 10)?;
    out.end();
    let mut parameters = vec![header.integers.len() as i64, header.reals.len() as i64];
    parameters.extend(&header.integers);
    out.integer_lines("parameter", &parameters)?;
    out.single_lines(&header.reals);
    for (i, &node) in shape.nodes.iter().enumerate() {
        out.integer("node", node, 10)?;
        out.end();
        out.single_lines(&shape.values.numbers(i * header.per_node, (i + 1) * header.per_node));
    }
    Ok(())
}

fn write_analysis(out: &mut Columns, analysis: &Analysis) -> Result<(), Problem> {
    let header = &analysis.header;
    consistent("beginnings of rows", analysis.starts.len(), analysis.labels.len() + 1)?;
    consistent("values of the rows", analysis.values.len(), analysis.starts.last().copied().unwrap_or(0))?;
    out.integer("label", header.label, 10)?;
    out.end();
    out.named("name", &header.name)?;
    out.integer("location", header.location, 10)?;
    out.end();
    header.id.iter().try_for_each(|text| out.named("identification", text))?;
    let kinds = [header.model, header.analysis, header.characteristic, header.quantity, header.data_type];
    out.integers("kind", &kinds)?;
    out.integer("values a node", header.per_node as i64, 10)?;
    out.end();
    let mut whole = header.integers.clone();
    whole.resize(10, 0);
    out.integer_lines("parameter", &whole)?;
    let mut reals = header.reals.clone();
    reals.resize(12, 0.0);
    out.single_lines(&reals);
    for (labels, ends) in analysis.labels.iter().zip(analysis.starts.windows(2)) {
        out.integers("label", labels)?;
        out.end();
        if ends[0] > ends[1] || ends[1] > analysis.values.len() {
            return Err(Problem::Inconsistent { what: "end of a row", found: ends[1], expected: ends[0] });
        }
        out.single_lines(&analysis.values.numbers(ends[0], ends[1]));
    }
    Ok(())
}

fn write_unknown(out: &mut Columns, unknown: &Unknown) {
    out.bytes.extend_from_slice(&unknown.bytes);
    if unknown.bytes.last().is_some_and(|&b| b != b'\n') {
        out.end();
    }
}
