//! What is written reads back: binary to the last bit, text to its digits.
#![allow(clippy::unwrap_used, clippy::too_many_lines, missing_docs, reason = "tests")]

mod common;

use common::*;
use uff::{ByteOrder, File, Function, Set, Summary, Values, to_bytes};

fn read_back(sets: &[Set]) -> Vec<Set> {
    let mut file = File::from_bytes(to_bytes(sets).unwrap()).unwrap();
    assert!(file.warnings().is_empty(), "{:?}", file.warnings());
    let read = file.read_all().into_iter().map(Result::unwrap);
    read.map(|reading| {
        assert!(reading.warnings.is_empty(), "{:?}", reading.warnings);
        reading.set
    })
    .collect()
}

/// What the header says of itself after writing.
fn as_written(mut function: Function, read: &Function) -> Function {
    let header = &mut function.header;
    (header.complex, header.count) = (function.values.is_complex(), function.values.len() as u64);
    if let (Some(ours), Some(theirs)) = (header.binary.as_mut(), read.header.binary) {
        assert_eq!(ours.order, theirs.order);
        *ours = theirs;
    }
    function
}

#[test]
fn every_set_reads_back_as_it_was_written() {
    let sets = everything();
    for (written, read) in sets.iter().zip(read_back(&sets)) {
        match (written, &read) {
            (Set::Function(function), Set::Function(back)) if function.header.binary.is_some() => {
                assert_eq!(&as_written(function.clone(), back), back);
            }
            (Set::Function(function), Set::Function(back)) => {
                assert_eq!(function.header.response, back.header.response);
                assert_eq!(function.header.ordinate, back.header.ordinate);
                assert_eq!(function.abscissas(), back.abscissas());
                close(&function.values, &back.values, if function.header.double { 1e-12 } else { 1e-5 });
            }
            (written, read) => assert_eq!(*written, *read),
        }
    }
}

fn close(written: &Values, read: &Values, tolerance: f64) {
    assert_eq!(written.len(), read.len());
    for i in 0..written.len() {
        let (a, b) = (written.get(i).unwrap(), read.get(i).unwrap());
        for part in 0..2 {
            assert!((a[part] - b[part]).abs() <= tolerance * a[part].abs(), "{} {}", a[part], b[part]);
        }
    }
}

#[test]
fn binary_values_read_back_to_the_last_bit_even_where_they_look_like_a_delimiter() {
    let mut function = function(false, true, true, Some(ByteOrder::Little));
    let trap = f64::from_le_bytes(*b"\n    -1\n");
    let Values::Real(values) = &mut function.values else { panic!() };
    values.extend([trap, f64::MIN_POSITIVE / 8.0, -0.0, f64::MAX, f64::from_bits(0x7ff8_0000_0000_1234), trap]);
    let expected: Vec<u64> = values.iter().map(|x| x.to_bits()).collect();
    let bytes = to_bytes(&[Set::Function(function.clone()), Set::Function(function)]).unwrap();
    let mut file = File::from_bytes(bytes).unwrap();
    assert_eq!(file.sets().len(), 2);
    for i in 0..2 {
        let Set::Function(back) = file.read(i).unwrap().set else { panic!() };
        let Values::Real(values) = back.values else { panic!() };
        assert_eq!(values.iter().map(|x| x.to_bits()).collect::<Vec<_>>(), expected);
    }
}

#[test]
fn the_list_says_what_the_sets_are_without_reading_them() {
    let sets = everything();
    let file = File::from_bytes(to_bytes(&sets).unwrap()).unwrap();
    assert_eq!(file.sets().len(), sets.len());
    for (entry, set) in file.sets().iter().zip(&sets) {
        assert_eq!(entry.number, set.number());
        match (&entry.summary, set) {
            (Summary::Function(header), Set::Function(function)) => assert_eq!(header.kind, function.header.kind),
            (Summary::Shape(header), Set::Shape(shape)) => assert_eq!(header.frequency(), shape.header.frequency()),
            (Summary::Analysis(header), Set::Analysis(data)) => assert_eq!(header.frequency(), data.header.frequency()),
            (Summary::Unreadable(error), _) => panic!("{error}"),
            _ => {}
        }
    }
}

#[test]
fn modes_say_their_frequency_and_damping() {
    assert_eq!(
        (shape(false, 3).header.frequency(), shape(false, 3).header.damping_ratio()),
        (Some(10.5), Some(0.0125))
    );
    let complex = shape(true, 3).header;
    let size = 0.5f64.hypot(62.5);
    assert!((complex.frequency().unwrap() - size / std::f64::consts::TAU).abs() < 1e-12);
    assert!((complex.damping_ratio().unwrap() - 0.5 / size).abs() < 1e-12);
    assert_eq!(
        (analysis(false).header.frequency(), analysis(false).header.damping_ratio()),
        (Some(23.5), Some(0.0125))
    );
}

#[test]
fn long_text_functions_are_passed_over_and_still_read() {
    for (count, carriage) in [(30_001, false), (30_000, true), (29_998, true)] {
        let mut long = function(true, true, true, None);
        long.values = values(count, true);
        let mut bytes = to_bytes(&[Set::Function(long.clone()), Set::TraceLine(line())]).unwrap();
        if carriage {
            bytes = bytes.iter().flat_map(|&b| if b == b'\n' { vec![b'\r', b'\n'] } else { vec![b] }).collect();
        }
        let lines = bytes.iter().filter(|&&b| b == b'\n').count() as u64;
        let mut file = File::from_bytes(bytes).unwrap();
        assert_eq!(file.sets().len(), 2);
        assert_eq!(file.sets()[1].place.line, Some(lines - 4), "lines are counted through the jump");
        let Set::Function(back) = file.read(0).unwrap().set else { panic!() };
        close(&long.values, &back.values, 1e-12);
    }
}

fn line() -> uff::TraceLine {
    uff::TraceLine { number: 1, color: 8, name: "edge".into(), nodes: vec![1, 2, 3] }
}

#[test]
fn what_does_not_fit_the_format_is_refused_in_words() {
    let mut function = function(false, true, true, None);
    function.header.ordinate.unit = "a unit of more than twenty letters".into();
    let error = to_bytes(&[Set::Function(function.clone())]).unwrap_err().to_string();
    assert_eq!(
        error,
        "set 1 (58): unit: \"a unit of more than twenty letters\" does not fit the 20 columns of the format: choose a shorter one"
    );
    function.header.ordinate.unit = "\u{3a9}".into();
    assert!(to_bytes(&[Set::Function(function.clone())]).unwrap_err().to_string().contains("latin-1"));
    function.header.ordinate.unit = "-".into();
    function.header.id[1] = " -1".into();
    assert!(to_bytes(&[Set::Function(function)]).is_err());
    let mut nodes = nodes();
    nodes[0].label = 12_345_678_901;
    assert!(to_bytes(&[Set::Nodes(nodes)]).unwrap_err().to_string().contains("does not fit the 10 columns"));
}

#[test]
fn the_first_values_of_a_long_binary_function_are_read_alone() {
    for form in [(false, true), (true, true), (false, false)] {
        let mut long = function(form.0, form.1, true, Some(ByteOrder::Little));
        long.values = values(5000, form.0);
        let text = function(false, true, true, None);
        let mut file = File::from_bytes(to_bytes(&[Set::Function(long), Set::Function(text)]).unwrap()).unwrap();
        let first = file.first_values(0, 4096).unwrap().unwrap();
        let Set::Function(all) = file.read(0).unwrap().set else { unreachable!() };
        assert!(first.len() > 100 && first.len() < 5000, "{}", first.len());
        assert!((0..first.len()).all(|i| first.get(i) == all.values.get(i)));
        assert!(file.first_values(0, 1 << 20).is_none() && file.first_values(1, 16).is_none());
    }
}
