//! Universal Files: the sets of the crate `uff` as sets of channels. Each data set is a set.

use crate::contents::{Axis, Channel, Contents, FIRST, Format, Kind, Number, Set, first_numbers};
use crate::error::{Fault, Read, one_line};
use crate::source::Source;
use std::fs::File;
use std::path::Path;
use std::sync::Mutex;
use uff::{Dof, FunctionHeader, FunctionKind, Reading, Summary, Values};

/// Bytes from which on only the first values of a binary function are read for the listing.
const LARGE: u64 = 1 << 22;
/// Most bytes of sets that are read for their first values.
const MOST_PREVIEWED: u64 = 256 << 20;
/// Most warnings that are shown of a file.
const MOST_WARNINGS: usize = 50;

/// Abscissae of functions: field 1 of record 8.
const TIME: i64 = 17;
const FREQUENCY: i64 = 18;

struct Universal {
    file: Mutex<uff::File<File>>,
}

/// Whether bytes are the start of a Universal File: a delimiter, then the number of a set.
pub(crate) fn is_universal(start: &[u8], path: &Path) -> bool {
    let text = String::from_utf8_lossy(start);
    let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    let named = path
        .extension()
        .is_some_and(|end| ["uff", "unv", "uf", "ufb"].iter().any(|known| end.eq_ignore_ascii_case(known)));
    if named {
        return lines.any(|line| line == "-1");
    }
    lines.next() == Some("-1") && lines.next().is_some_and(is_number_of_set)
}

fn is_number_of_set(line: &str) -> bool {
    let number = line.split_whitespace().next().unwrap_or_default().trim_end_matches('b');
    number.parse::<u32>().is_ok_and(|number| (10..100_000).contains(&number))
}

fn wrong(error: uff::Error) -> Fault {
    Fault { place: None, problem: error.to_string() }
}

/// Opens a Universal File.
pub(crate) fn open(path: &Path) -> Read<(Contents, Box<dyn Source>)> {
    let mut file = uff::File::open(path).map_err(wrong)?;
    let mut contents = Contents::new(Format::Uff);
    let entries = file.sets().to_vec();
    contents.notes.extend(file.warnings().iter().take(MOST_WARNINGS).map(|warning| warning.to_string().into()));
    let mut previewed = 0;
    let units = entries.iter().find_map(|entry| match &entry.summary {
        Summary::Units(units) => Some(units.clone()),
        _ => None,
    });
    for (i, entry) in entries.iter().enumerate() {
        let suffix = if entry.binary { "b" } else { "" };
        let mut set = Set::new(format!("{} ({}{suffix})", i + 1, entry.number), Kind::Table);
        if let Summary::Function(header) = &entry.summary {
            function(&mut set, header, units.as_ref());
        }
        if let (Some(Ok(values)), Some(channel)) = (file.first_values(i, LARGE), set.channels.first_mut()) {
            channel.first = first_numbers(&values);
            contents.sets.push(set);
            continue;
        }
        previewed += entry.bytes.end - entry.bytes.start;
        let reading = (previewed <= MOST_PREVIEWED).then(|| file.read(i));
        match reading {
            Some(Ok(reading)) => fill(&mut set, &reading),
            Some(Err(error)) => set.notes.push(format!("cannot be read: {error}").into()),
            None => set.notes.push("its first values are not shown: the file is large".into()),
        }
        if let Summary::Unknown = entry.summary {
            set.notes.push(format!("data set {} is not read", entry.number).into());
        }
        set.notes.truncate(MOST_WARNINGS);
        contents.sets.push(set);
    }
    Ok((contents, Box::new(Universal { file: Mutex::new(file) })))
}

/// The channel of a function by its header.
fn function(set: &mut Set, header: &FunctionHeader, units: Option<&uff::Units>) {
    set.kind = match header.kind {
        FunctionKind::FrequencyResponse | FunctionKind::Transmissibility => Kind::Frf,
        FunctionKind::TimeResponse | FunctionKind::AutoCorrelation | FunctionKind::CrossCorrelation => Kind::Time,
        FunctionKind::General | FunctionKind::Other(_) => match header.abscissa.quantity {
            TIME => Kind::Time,
            FREQUENCY if header.complex => Kind::Frf,
            FREQUENCY => Kind::Spectrum,
            _ => Kind::Table,
        },
        _ => Kind::Spectrum,
    };
    set.axis_unit = match (header.abscissa.unit.as_str(), header.abscissa.quantity) {
        ("", TIME) => "s".to_owned(),
        ("", FREQUENCY) => "Hz".to_owned(),
        (unit, _) => unit.to_owned(),
    };
    set.name = format!("{} {}", set.name, header.kind.name());
    let below = denominator(header);
    let stated = !header.ordinate.unit.is_empty() || !below.is_empty();
    let by_set =
        units.filter(|_| !stated && set.kind == Kind::Time).and_then(|units| unit_of(header.ordinate.quantity, units));
    let unit = match (header.ordinate.unit.as_str(), below) {
        (unit, "") => unit.to_owned(),
        ("", below) => format!("1/{below}"),
        (unit, below) if below.contains(['/', '*', '·', ' ']) => format!("{unit}/({below})"),
        (unit, below) => format!("{unit}/{below}"),
    };
    let unit = by_set.map_or(unit, str::to_owned);
    let mut channel = Channel::new(name(header), unit, header.count);
    channel.complex = header.complex;
    channel.axis =
        if header.even { Axis::Even { start: header.start, step: header.step } } else { Axis::Stored { step: None } };
    let mut attribute = |word: &str, value: String| {
        if !value.is_empty() {
            channel.attributes.push((word.to_owned(), value));
        }
    };
    attribute("function", header.kind.name().to_owned());
    let [response, reference] = header.stated_dofs();
    attribute("response", place(&response));
    attribute("reference", place(&reference));
    attribute("quantity", header.ordinate.quantity.to_string());
    attribute("reference quantity", header.denominator.quantity.to_string());
    attribute("label", header.ordinate.label.clone());
    for (i, line) in header.id.iter().enumerate() {
        attribute(&format!("id line {}", i + 1), line.trim().to_owned());
    }
    set.channels.push(channel);
}

/// Unit of the denominator of a function that has one. A coherence has none, and a record over time only where its type is
/// stated: some programs fill the field with whatever the last function had.
fn denominator(header: &FunctionHeader) -> &str {
    match header.kind {
        FunctionKind::Coherence => "",
        FunctionKind::TimeResponse if header.denominator.quantity == 0 => "",
        _ => &header.denominator.unit,
    }
}

/// The unit of a record that states none, by its type of ordinate and the units of the file (set 164).
fn unit_of(quantity: i64, units: &uff::Units) -> Option<&'static str> {
    const LENGTHS: [(f64, [&str; 3]); 5] = [
        (1.0, ["m", "m/s", "m/s^2"]),
        (1e3, ["mm", "mm/s", "mm/s^2"]),
        (100.0, ["cm", "cm/s", "cm/s^2"]),
        (1.0 / 0.0254, ["in", "in/s", "in/s^2"]),
        (1.0 / 0.3048, ["ft", "ft/s", "ft/s^2"]),
    ];
    const FORCES: [(f64, &str); 5] =
        [(1.0, "N"), (1e3, "mN"), (1e-3, "kN"), (1.0 / 4.448_221_615_260_5, "lbf"), (1.0 / 9.806_65, "kgf")];
    let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-3;
    let order = match quantity {
        8 => 0,
        11 => 1,
        12 => 2,
        9 | 13 => return FORCES.iter().find(|(factor, _)| near(units.force, *factor)).map(|(_, name)| *name),
        _ => return None,
    };
    LENGTHS.iter().find(|(factor, _)| near(units.length, *factor)).map(|(_, names)| names[order])
}

/// `12:+Z`, with the entity in front where the file names one.
fn place(dof: &Dof) -> String {
    if dof.node == 0 && dof.direction == 0 { dof.entity.trim().to_owned() } else { dof.to_string() }
}

/// Response over reference for functions of two, else the response, else the entity or the text of the first line.
fn name(header: &FunctionHeader) -> String {
    let [response, reference] = header.stated_dofs().map(|dof| place(&dof));
    let two = matches!(
        header.kind,
        FunctionKind::FrequencyResponse
            | FunctionKind::Transmissibility
            | FunctionKind::Coherence
            | FunctionKind::CrossSpectrum
            | FunctionKind::CrossCorrelation
    );
    match (response.is_empty(), reference.is_empty()) {
        (false, false) if two => format!("{response}/{reference}"),
        (false, _) => response,
        _ => header.id.iter().map(|line| line.trim()).find(|line| !line.is_empty()).unwrap_or_default().to_owned(),
    }
}

/// First values, shapes and geometry out of the set itself.
fn fill(set: &mut Set, reading: &Reading) {
    set.notes.extend(reading.warnings.iter().take(MOST_WARNINGS).map(|warning| warning.to_string().into()));
    match &reading.set {
        uff::Set::Function(function) => {
            if let Some(channel) = set.channels.first_mut() {
                channel.first = first_numbers(&function.values);
                // What is there counts, not what the header states.
                channel.count = function.values.len() as u64;
                if let Some(uneven) = &function.uneven {
                    channel.axis = Axis::Stored { step: crate::axis::even_step(uneven) };
                }
            }
        }
        uff::Set::Shape(shape) => shape_channels(
            set,
            &shape.header.id,
            shape.header.frequency(),
            shape.header.damping_ratio(),
            shape.nodes.len(),
            &shape.values,
        ),
        uff::Set::Analysis(shape) => {
            shape_channels(
                set,
                &shape.header.id,
                shape.header.frequency(),
                shape.header.damping_ratio(),
                shape.labels.len(),
                &shape.values,
            );
        }
        uff::Set::Nodes(nodes) | uff::Set::DoubleNodes(nodes) => {
            geometry(set, "nodes", nodes.len());
            for (axis, word) in ["x", "y", "z"].into_iter().enumerate() {
                let mut channel = Channel::new(word, "", nodes.len() as u64);
                channel.first = nodes.iter().take(FIRST).map(|node| Number::Real(node.position[axis])).collect();
                set.channels.push(channel);
            }
            let mut labels = Channel::new("node", "", nodes.len() as u64);
            labels.first = nodes.iter().take(FIRST).map(|node| Number::Real(node.label as f64)).collect();
            set.channels.push(labels);
        }
        uff::Set::Elements(elements) => geometry(set, "elements", elements.len()),
        uff::Set::TraceLine(line) => {
            geometry(set, "points of a line", line.nodes.len());
            let mut channel = Channel::new("node", "", line.nodes.len() as u64);
            channel.first = line.nodes.iter().take(FIRST).map(|&node| Number::Real(node as f64)).collect();
            set.channels.push(channel);
        }
        uff::Set::Model(model) => {
            set.name.push_str(" header");
            let texts = [&model.name, &model.description, &model.program];
            set.notes.extend(
                texts.into_iter().filter(|text| !text.trim().is_empty()).map(|text| one_line(text, 160).into()),
            );
        }
        uff::Set::Units(units) => {
            set.name.push_str(" units");
            set.notes.push(
                format!(
                    "{}; lengths divided by {} are m, forces divided by {} are N",
                    units.description.trim(),
                    units.length,
                    units.force
                )
                .into(),
            );
        }
        _ => {}
    }
}

fn geometry(set: &mut Set, what: &str, count: usize) {
    set.kind = Kind::Geometry;
    set.name = format!("{} {what}", set.name);
    set.notes.push(format!("{count} {what}").into());
}

fn shape_channels(
    set: &mut Set,
    id: &[String; 5],
    frequency: Option<f64>,
    damping: Option<f64>,
    nodes: usize,
    values: &Values,
) {
    set.kind = Kind::Shape;
    set.name = format!("{} shape", set.name);
    let name = id.iter().map(|line| line.trim()).find(|line| !line.is_empty()).unwrap_or("shape");
    let mut channel = Channel::new(name, "", values.len() as u64);
    channel.complex = values.is_complex();
    channel.first = first_numbers(values);
    let mut attribute = |word: &str, value: Option<f64>| {
        channel.attributes.extend(value.map(|value| (word.to_owned(), value.to_string())));
    };
    attribute("frequency [Hz]", frequency);
    attribute("damping ratio", damping);
    attribute("nodes", Some(nodes as f64));
    set.channels.push(channel);
}

impl Universal {
    fn set(&self, set: usize) -> Read<uff::Set> {
        let mut file = self.file.lock().map_err(|_| Fault::new("cannot be read again; open it anew"))?;
        Ok(file.read(set).map_err(wrong)?.set)
    }
}

impl Source for Universal {
    fn read(&self, set: usize, channel: usize) -> Read<Values> {
        match self.set(set)? {
            uff::Set::Function(function) => Ok(function.values),
            uff::Set::Shape(shape) => Ok(shape.values),
            uff::Set::Analysis(shape) => Ok(shape.values),
            uff::Set::Nodes(nodes) | uff::Set::DoubleNodes(nodes) => Ok(Values::Real(match channel {
                3 => nodes.iter().map(|node| node.label as f64).collect(),
                axis => nodes.iter().map(|node| node.position[axis.min(2)]).collect(),
            })),
            uff::Set::TraceLine(line) => Ok(Values::Real(line.nodes.iter().map(|&node| node as f64).collect())),
            _ => Err(Fault::new("the set has no values")),
        }
    }

    fn axis(&self, set: usize, _channel: usize) -> Read<Vec<f64>> {
        match self.set(set)? {
            uff::Set::Function(function) => Ok(function.abscissas()),
            _ => Err(Fault::new("the set has no abscissa")),
        }
    }
}
