//! Prints every channel of a data file, each number as the bits of its double: `cargo run --example bits FILE...`.
//! For `scripts/interchange/peers.py`.

use dashpot_datafiles::{Values, open};
use std::path::Path;

fn main() {
    for path in std::env::args().skip(1) {
        println!("file {path}");
        match open(Path::new(&path)) {
            Ok(file) => print(&file),
            Err(error) => println!("error {error}"),
        }
    }
}

fn print(file: &dashpot_datafiles::DataFile) {
    for (s, set) in file.contents().sets.iter().enumerate() {
        for (c, channel) in set.channels.iter().enumerate() {
            println!("channel {}\t{}\t{}", set.name, channel.name, channel.unit);
            match file.read(s, c) {
                Ok(values) => println!("values{}", bits(&values)),
                Err(error) => println!("error {error}"),
            }
        }
    }
}

fn bits(values: &Values) -> String {
    let word = |x: &f64| format!(" {:016x}", x.to_bits());
    match values {
        Values::Real(values) => values.iter().map(word).collect(),
        Values::Complex(values) => values.iter().flatten().map(word).collect(),
    }
}
