//! Sets of every kind, from which files for the tests are made.
#![allow(dead_code, clippy::unwrap_used, missing_docs, reason = "tests; each uses some of it")]

use uff::{
    Analysis, AnalysisHeader, Axis, Binary, ByteOrder, Dof, Element, Function, FunctionKind, Model, Node, Set, Shape,
    ShapeHeader, TraceLine, Units, Unknown, Values,
};

/// Numbers of all sizes that are exact in single precision.
pub(crate) fn numbers(count: usize) -> Vec<f64> {
    (0..count).map(|i| f64::from((i as f32 * 0.37).sin() * 10f32.powi((i % 9) as i32 - 4))).collect()
}

pub(crate) fn values(count: usize, complex: bool) -> Values {
    let all = numbers(2 * count);
    if complex {
        Values::Complex(all.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect())
    } else {
        Values::Real(all[..count].to_vec())
    }
}

/// A function of one of the eight forms, as text or binary.
pub(crate) fn function(complex: bool, double: bool, even: bool, order: Option<ByteOrder>) -> Function {
    const COUNT: usize = 23;
    let kind = if complex { FunctionKind::FrequencyResponse } else { FunctionKind::TimeResponse };
    let (response, reference) = (Dof { entity: "Acc 7".to_string(), ..Dof::new(12, 3) }, Dof::new(1, -2));
    let values = values(COUNT, complex);
    let mut function = if even {
        Function::even(kind, response, reference, 0.5, 0.125, values)
    } else {
        let abscissas = (0..COUNT).map(|i| f64::from(i as u32).powi(2) * 0.25).collect();
        Function::uneven(kind, response, reference, abscissas, values)
    };
    let header = &mut function.header;
    header.double = double;
    header.binary = order.map(Binary::new);
    header.id[0] = "a beam".to_string();
    header.id[2] = "22-Nov-26 04:32:02".to_string();
    (header.number, header.version, header.load_case) = (7, 2, 0);
    let axis = |quantity, label: &str, unit: &str| Axis {
        quantity,
        exponents: [0; 3],
        label: label.into(),
        unit: unit.into(),
    };
    header.abscissa = if complex { axis(18, "Frequency", "Hz") } else { axis(17, "Time", "s") };
    header.ordinate = axis(12, "Acceleration", "m/s^2");
    header.denominator = if complex { axis(13, "Force", "N") } else { Axis::default() };
    function
}

/// Every form of function.
pub(crate) fn functions() -> Vec<Function> {
    let mut all = Vec::new();
    for order in [None, Some(ByteOrder::Little), Some(ByteOrder::Big)] {
        for form in 0..8 {
            all.push(function(form & 1 > 0, form & 2 > 0, form & 4 > 0, order));
        }
    }
    all
}

pub(crate) fn nodes() -> Vec<Node> {
    (1..=5).map(|i| Node { color: 3, ..Node::new(i * 10, [f64::from(i as u8) * 0.25, -0.5, 1.0e-3]) }).collect()
}

pub(crate) fn shape(complex: bool, per_node: usize) -> Shape {
    let (analysis, integers, reals) = if complex {
        (3, vec![1, 4], vec![-0.5, 62.5, 1.0, 0.0, 0.0, 2.0])
    } else {
        (2, vec![1, 3], vec![10.5, 2.0, 0.0125, 0.0])
    };
    let header = ShapeHeader {
        id: ["mode".into(), String::new(), String::new(), String::new(), String::new()],
        model: 1,
        analysis,
        characteristic: if per_node == 6 { 3 } else { 2 },
        quantity: 8,
        complex,
        per_node,
        integers,
        reals,
    };
    let values = Values::Real((0..12 * per_node).map(|i| f64::from(i as u8) / 8.0).collect());
    let values = match values {
        Values::Real(all) if complex => Values::Complex(all.chunks_exact(2).map(|p| [p[0], -p[1]]).collect()),
        Values::Real(all) => Values::Real(all[..6 * per_node].to_vec()),
        complex @ Values::Complex(_) => complex,
    };
    Shape { header, nodes: (1..=6).collect(), values }
}

pub(crate) fn analysis(complex: bool) -> Analysis {
    let header = AnalysisHeader {
        label: 4,
        name: "Mode 4".into(),
        location: 1,
        id: Default::default(),
        model: 1,
        analysis: 2,
        characteristic: 2,
        quantity: 8,
        data_type: if complex { 5 } else { 2 },
        per_node: 3,
        integers: vec![0, 0, 1, 0, 0, 4, 0, 0, 0, 0],
        reals: vec![0.0, 23.5, 0.0, 1.0, 0.0125, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    };
    let starts = vec![0, 3, 6];
    let shape = shape(complex, 1).values;
    let values = match shape {
        Values::Complex(values) => Values::Complex(values[..6].to_vec()),
        Values::Real(values) => Values::Real(values[..6].to_vec()),
    };
    Analysis { header, labels: vec![vec![10], vec![20]], starts, values }
}

pub(crate) fn elements() -> Vec<Element> {
    let element = |label, descriptor, nodes: &[i64], beam| Element {
        label,
        descriptor,
        physical: 1,
        material: 2,
        color: 7,
        nodes: nodes.to_vec(),
        beam,
    };
    vec![
        element(1, 11, &[10, 20], Some([0, 1, 1])),
        element(2, 44, &[10, 20, 30, 40], None),
        element(3, 41, &[10, 20, 50], None),
        element(4, 118, &[1, 2, 3, 4, 5, 6, 7, 8, 9, 10], None),
    ]
}

pub(crate) fn model() -> Model {
    let date = || ["22-Nov-26".to_string(), "04:32:02".to_string()];
    Model {
        name: "beam".into(),
        description: "cantilever".into(),
        application: "test".into(),
        created: date(),
        versions: ["1".into(), "2".into(), "0".into()],
        saved: date(),
        program: "tests of uff".into(),
        written: date(),
    }
}

pub(crate) fn geometry() -> Vec<Set> {
    let line =
        TraceLine { number: 1, color: 8, name: "edge".into(), nodes: vec![10, 20, 30, 0, 40, 50, 10, 20, 30, 40] };
    vec![
        Set::Model(model()),
        Set::Units(Units::si()),
        Set::Nodes(nodes()),
        Set::DoubleNodes(nodes()),
        Set::Elements(elements()),
        Set::TraceLine(line),
        Set::Unknown(Unknown { number: 18, bytes: b"         1         0\nSYS\n  0.0 0.0\n".to_vec() }),
    ]
}

/// One file with every set in every form.
pub(crate) fn everything() -> Vec<Set> {
    let mut sets = geometry();
    sets.extend(functions().into_iter().map(Set::Function));
    sets.extend([shape(false, 3), shape(false, 6), shape(true, 3)].map(Set::Shape));
    sets.extend([analysis(false), analysis(true)].map(Set::Analysis));
    sets
}
