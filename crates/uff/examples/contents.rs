//! Lists the sets of Universal Files, reads them all, and tells every fault: `cargo run --example contents FILE...`

use uff::{File, Set, Summary};

fn main() {
    for path in std::env::args().skip(1) {
        println!("{path}");
        match File::open(&path) {
            Ok(mut file) => list(&mut file),
            Err(error) => println!("  {error}"),
        }
    }
}

fn list(file: &mut File<std::fs::File>) {
    file.warnings().iter().for_each(|warning| println!("  fault: {warning}"));
    for (i, entry) in file.sets().to_vec().iter().enumerate() {
        let head = match &entry.summary {
            Summary::Function(f) => format!("{}, {} / {}, {} values", f.kind.name(), f.response, f.reference, f.count),
            Summary::Shape(shape) => format!("shape, analysis {}, {:?} Hz", shape.analysis, shape.frequency()),
            Summary::Analysis(data) => format!("data {} {:?}, {:?} Hz", data.label, data.name, data.frequency()),
            Summary::Unreadable(error) => error.to_string(),
            _ => String::new(),
        };
        println!("  {}: {} {head}", i + 1, entry.number);
        match file.read(i) {
            Ok(reading) => {
                println!("     {}", size(&reading.set));
                reading.warnings.iter().for_each(|warning| println!("     fault: {warning}"));
            }
            Err(error) => println!("     {error}"),
        }
    }
}

fn size(set: &Set) -> String {
    match set {
        Set::Nodes(nodes) | Set::DoubleNodes(nodes) => format!("{} nodes", nodes.len()),
        Set::Elements(elements) => format!("{} elements", elements.len()),
        Set::TraceLine(line) => format!("{} nodes, {} segments", line.nodes.len(), line.segments().len()),
        Set::Shape(shape) => format!("{} nodes, {} values", shape.nodes.len(), shape.values.len()),
        Set::Analysis(data) => format!("{} rows, {} values", data.labels.len(), data.values.len()),
        Set::Function(f) => format!("{} values, {:?} at {}", f.values.len(), f.values.get(0), f.abscissa(0)),
        Set::Unknown(set) => format!("{} bytes kept as they stand", set.bytes.len()),
        other => format!("{other:?}"),
    }
}
