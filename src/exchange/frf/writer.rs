//! Frequency responses with coherences to a Universal File: units, nodes, drawn lines, functions as 58b.

use super::error::{FrfError, FrfProblem};
use super::names::number;
use super::units::Form;
use crate::exchange::atomic::write_atomically;
use crate::measurement::frf::{FrequencyResponse, ResponseSet};
use crate::measurement::{Channel, Quantity};
use crate::structure::Structure;
use std::path::Path;
use uff::{Axis, Binary, ByteOrder, Dof, Function, FunctionKind, Node, Set, TraceLine, Units, Values};

/// A set that was simulated, with evenly spaced frequencies.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SimulatedSet {
    /// The functions; the frequencies are `step_hz, 2 step_hz, ...` from `start_hz` on.
    pub set: ResponseSet,
    /// First frequency, Hz.
    pub start_hz: f64,
    /// Step, Hz.
    pub step_hz: f64,
}

/// Writes a simulated set to `path`.
pub(crate) fn write_responses(path: &Path, simulated: &SimulatedSet, structure: &Structure) -> Result<(), FrfError> {
    let in_file = |problem| FrfError { file: path.display().to_string(), problem };
    let bytes = bytes(simulated, structure).map_err(in_file)?;
    let failed = |error: std::io::Error| in_file(FrfProblem::Unwritable { reason: error.to_string() });
    write_atomically(path, &bytes).map_err(failed)
}

fn bytes(simulated: &SimulatedSet, structure: &Structure) -> Result<Vec<u8>, FrfProblem> {
    let mut sets = vec![Set::Units(Units::si()), Set::DoubleNodes(nodes(structure)?)];
    sets.extend(lines(structure)?);
    for function in &simulated.set.functions {
        sets.push(Set::Function(response(simulated, function, structure)?));
        if let Some(coherence) = &function.coherence {
            sets.push(Set::Function(coherence_of(simulated, function, coherence, structure)?));
        }
    }
    uff::to_bytes(&sets).map_err(FrfProblem::File)
}

fn node_number(structure: &Structure, node: usize) -> Result<i64, FrfProblem> {
    let label = &structure.nodes()[node].label;
    label.parse().map_err(|_| FrfProblem::NodeName { node: label.clone() })
}

fn nodes(structure: &Structure) -> Result<Vec<Node>, FrfProblem> {
    let node = |i: usize| Ok(Node::new(node_number(structure, i)?, structure.nodes()[i].position));
    (0..structure.nodes().len()).map(node).collect()
}

fn lines(structure: &Structure) -> Result<Vec<Set>, FrfProblem> {
    let mut strokes = Vec::new();
    for ends in structure.lines() {
        strokes.extend([node_number(structure, ends[0])?, node_number(structure, ends[1])?, 0]);
    }
    // Node 0 lifts the pen, so that lines to a node of that number cannot be drawn.
    let drawn: Vec<i64> = strokes.chunks(3).filter(|s| s[0] != 0 && s[1] != 0).flatten().copied().collect();
    let line = TraceLine { number: 1, color: 1, name: "structure".to_string(), nodes: drawn };
    Ok(if line.nodes.is_empty() { Vec::new() } else { vec![Set::TraceLine(line)] })
}

fn dof(channel: &Channel, structure: &Structure) -> Result<Dof, FrfProblem> {
    let dof = &structure.dofs()[channel.dof];
    Ok(Dof::new(node_number(structure, dof.node)?, number(dof.direction)))
}

fn function(
    kind: FunctionKind,
    simulated: &SimulatedSet,
    of: &FrequencyResponse,
    values: Values,
    structure: &Structure,
) -> Result<Function, FrfProblem> {
    let (response, reference) = (dof(&of.response, structure)?, dof(&of.reference, structure)?);
    let mut function = Function::even(kind, response, reference, simulated.start_hz, simulated.step_hz, values);
    function.header.binary = Some(Binary::new(ByteOrder::Little));
    function.header.id[0].clone_from(&simulated.set.name);
    function.header.abscissa = axis(18, "Frequency", "Hz");
    Ok(function)
}

fn response(simulated: &SimulatedSet, of: &FrequencyResponse, structure: &Structure) -> Result<Function, FrfProblem> {
    let values = Values::Complex(of.values.iter().map(|h| [h.re, h.im]).collect());
    let mut function = function(FunctionKind::FrequencyResponse, simulated, of, values, structure)?;
    let rotation = |channel: &Channel| structure.dofs()[channel.dof].direction.is_rotation();
    let quantity = of.response.quantity;
    let (code, name) = match Form::of(quantity) {
        Some(Form::Mobility) => (11, "Velocity"),
        Some(Form::Accelerance) => (12, "Acceleration"),
        _ => (8, "Displacement"),
    };
    function.header.ordinate = axis(code, name, quantity.si_unit(rotation(&of.response)));
    function.header.denominator = axis(13, "Force", Quantity::Force.si_unit(rotation(&of.reference)));
    Ok(function)
}

fn coherence_of(
    simulated: &SimulatedSet,
    of: &FrequencyResponse,
    coherence: &[f64],
    structure: &Structure,
) -> Result<Function, FrfProblem> {
    let mut function = function(FunctionKind::Coherence, simulated, of, Values::Real(coherence.to_vec()), structure)?;
    function.header.ordinate = axis(0, "Coherence", "");
    function.header.double = false;
    Ok(function)
}

fn axis(quantity: i64, label: &str, unit: &str) -> Axis {
    Axis { quantity, exponents: [0; 3], label: label.to_string(), unit: unit.to_string() }
}
