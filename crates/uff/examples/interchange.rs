//! Reads a Universal File, prints every number as the bits of its float, and writes the file anew:
//! `cargo run --example interchange FILE COPY`. For `tests/pyuff/interchange.py`.

#![allow(clippy::disallowed_methods, reason = "an example outside the program")]

use uff::{File, Set};

fn main() -> Result<(), uff::Error> {
    let paths: Vec<String> = std::env::args().skip(1).collect();
    let mut file = File::open(&paths[0])?;
    let mut sets = Vec::new();
    for i in 0..file.sets().len() {
        let reading = file.read(i)?;
        reading.warnings.iter().for_each(|warning| println!("warning {warning}"));
        print(&reading.set);
        sets.push(reading.set);
    }
    let bytes = uff::to_bytes(&sets)?;
    std::fs::write(&paths[1], bytes).expect("the copy can be written");
    Ok(())
}

fn print(set: &Set) {
    println!("set {}", set.number());
    match set {
        Set::Function(f) => {
            line("x", f.abscissas());
            line("data", (0..f.values.len()).filter_map(|i| f.values.get(i)).flatten().collect());
        }
        Set::Nodes(nodes) | Set::DoubleNodes(nodes) => {
            line("label", nodes.iter().map(|node| node.label as f64).collect());
            line("position", nodes.iter().flat_map(|node| node.position).collect());
        }
        Set::Elements(elements) => {
            line("nodes", elements.iter().flat_map(|element| element.nodes.iter().map(|&node| node as f64)).collect());
        }
        Set::TraceLine(trace) => line("nodes", trace.nodes.iter().map(|&node| node as f64).collect()),
        Set::Shape(shape) => {
            line("nodes", shape.nodes.iter().map(|&node| node as f64).collect());
            line("reals", shape.header.reals.clone());
            line("values", (0..shape.values.len()).filter_map(|i| shape.values.get(i)).flatten().collect());
        }
        Set::Analysis(data) => {
            line("nodes", data.labels.iter().map(|labels| labels[0] as f64).collect());
            line("reals", data.header.reals.clone());
            line("values", (0..data.values.len()).filter_map(|i| data.values.get(i)).flatten().collect());
        }
        Set::Units(units) => {
            line("factors", vec![units.length, units.force, units.temperature, units.temperature_offset]);
        }
        _ => {}
    }
}

fn line(name: &str, numbers: Vec<f64>) {
    let bits: String = numbers.iter().map(|x| format!(" {:016x}", x.to_bits())).collect();
    println!("{name}{bits}");
}
