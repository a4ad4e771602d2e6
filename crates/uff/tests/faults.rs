//! Faults of laboratories' files: those that are read over are told, the others are one clear line.
#![allow(clippy::unwrap_used, clippy::too_many_lines, missing_docs, reason = "tests")]

mod common;

use common::*;
use uff::{ByteOrder, File, Set, to_bytes};

/// A file of one set as text.
fn text(set: Set) -> String {
    String::from_utf8(to_bytes(&[set]).unwrap()).unwrap()
}

fn real() -> String {
    text(Set::Function(function(false, false, true, None)))
}

fn complex() -> String {
    text(Set::Function(function(true, true, true, None)))
}

fn uneven() -> String {
    text(Set::Function(function(false, true, false, None)))
}

fn binary() -> Vec<u8> {
    to_bytes(&[Set::Function(function(false, true, true, Some(ByteOrder::Little)))]).unwrap()
}

/// The file with one of its lines (counted from 1) put in another way.
fn line(file: &str, number: usize, new: impl Fn(&str) -> String) -> String {
    let lines = file.lines().enumerate().map(|(i, line)| if i + 1 == number { new(line) } else { line.to_string() });
    lines.map(|line| line + "\n").collect()
}

fn replace(file: &[u8], from: &[u8], to: &[u8]) -> Vec<u8> {
    let at = file.windows(from.len()).position(|window| window == from).expect("the text is there");
    [&file[..at], to, &file[at + from.len()..]].concat()
}

fn without_line(file: &str, number: usize) -> String {
    file.lines().enumerate().filter(|(i, _)| i + 1 != number).map(|(_, line)| format!("{line}\n")).collect()
}

/// All that is said of a file: faults and errors.
fn said(bytes: &[u8]) -> (usize, Vec<String>) {
    match File::from_bytes(bytes) {
        Err(error) => (0, vec![error.to_string()]),
        Ok(mut file) => {
            let mut all: Vec<String> = file.warnings().iter().map(ToString::to_string).collect();
            let mut read = 0;
            for reading in file.read_all() {
                match reading {
                    Ok(reading) => {
                        read += 1;
                        all.extend(reading.warnings.iter().map(ToString::to_string));
                    }
                    Err(error) => all.push(error.to_string()),
                }
            }
            (read, all)
        }
    }
}

/// Faults that are read over: name, file, number of sets that are read, what is said.
fn tolerated() -> Vec<(&'static str, Vec<u8>, usize, &'static str)> {
    let (real, complex, uneven, binary) = (real(), complex(), uneven(), binary());
    let bytes = |text: String| text.into_bytes();
    let end = binary.len() - 7;
    let stray = [&binary[..end], b"\r\n", &binary[end..]].concat();
    let nodes = text(Set::Nodes(nodes()));
    let elements = text(Set::Elements(elements()));
    let shape = text(Set::Shape(shape(false, 3)));
    let trace = text(geometry().remove(5));
    let twice = format!("{real}{real}");
    let shared = twice.replacen("    -1\n    -1\n", "    -1\n", 1);
    vec![
        ("text before", bytes(format!("exported by hand\n\n{real}")), 1, "line 1: text between the sets"),
        ("text between", bytes(format!("{real}remark\nremark\n{real}")), 2, "line 19: text between the sets"),
        ("stray delimiter", bytes(format!("    -1\n{real}")), 1, "line 1: a -1 too many"),
        ("lone delimiter", bytes(format!("{real}    -1\n\n")), 1, "line 19: a -1 without a set"),
        ("shared delimiter", bytes(shared), 2, "line 18: the -1 between two sets is missing"),
        ("not closed", bytes(real[..real.len() - 7].to_string()), 1, "ends without the -1"),
        ("at the left", bytes(real.replacen("    -1", "-1", 1)), 1, "line 1: the -1 does not stand in columns 5 and 6"),
        ("blank line", bytes(line(&real, 15, |l| format!("\n{l}"))), 1, "line 15: a blank line"),
        (
            "NaN",
            bytes(line(&real, 14, |l| format!("          NaN{}", &l[13..]))),
            1,
            "line 14: 1 values are not finite",
        ),
        ("Windows NaN", bytes(line(&real, 14, |l| format!("      1.#QNAN{}", &l[13..]))), 1, "1 values are not finite"),
        ("infinite", bytes(line(&real, 14, |l| format!("         -Inf{}", &l[13..]))), 1, "1 values are not finite"),
        ("overflowed", bytes(line(&real, 14, |l| format!("*************{}", &l[13..]))), 1, "1 values overflowed"),
        ("D exponents", bytes(complex.replace("E+0", "D+0").replace("E-0", "d-0")), 1, ""),
        ("cut off", bytes(without_line(&real, 15)), 1, "cut off: the header says 23 values, 17 are there"),
        (
            "half a pair",
            bytes(line(&complex, 25, |l| l[..20].to_string())),
            1,
            "the header says 23 values, 22 are there",
        ),
        (
            "too many values",
            bytes(line(&real, 17, |l| format!("{l} 1.0 2.0"))),
            1,
            "line 17: the header says 23 values; 2 numbers",
        ),
        (
            "lines too many",
            bytes(line(&real, 17, |l| format!("{l}\n 3.0 4.0 5.0"))),
            1,
            "line 18: the header says 23 values; 3 numbers",
        ),
        (
            "slipped data form",
            bytes(line(&real, 9, |l| l.replace("         2        23", "  2  23"))),
            1,
            "record 7 (data form) is not in its columns",
        ),
        (
            "slipped axis",
            bytes(line(&real, 10, |l| l.replacen("        17", "  17", 1))),
            1,
            "record 8 (abscissa) is not in its columns",
        ),
        (
            "no step",
            bytes(line(&real, 9, |l| l.replace("1.25000E-01", "0.00000E+00"))),
            1,
            "line 9: the abscissa has no step",
        ),
        (
            "spacing 2",
            bytes(line(&real, 9, |l| l.replace("         1 ", "         2 "))),
            1,
            "abscissa spacing 2 is neither",
        ),
        (
            "exponent of three digits",
            bytes(line(&real, 9, |l| l.replace(" 5.00000E-01 1.25000E-01", "5.00000E-001 1.25000E-01"))),
            1,
            "",
        ),
        ("latin-1", replace(&real.clone().into_bytes(), b"m/s^2", b"m/s\xb2 "), 1, "line 11: characters outside ASCII"),
        ("UTF-8", bytes(real.replace("m/s^2", "m/s\u{b2} ")), 1, "characters outside ASCII"),
        ("byte order mark", [b"\xef\xbb\xbf".as_slice(), real.as_bytes()].concat(), 1, ""),
        ("DOS lines", bytes(real.replace('\n', "\r\n")), 1, ""),
        ("DOS end of file", bytes(format!("{real}\x1a")), 1, ""),
        ("blanks behind", bytes(uneven.replace('\n', "                    \n")), 1, ""),
        ("stray line end in 58b", stray, 1, ""),
        (
            "stray bytes in 58b",
            [&binary[..end], b"\r\n\r\n", &binary[end..]].concat(),
            1,
            "4 stray bytes after the values",
        ),
        (
            "byte count too small",
            replace(&binary, b"         184", b"          92"),
            1,
            "the header says 92 bytes of data, 184 are there",
        ),
        (
            "byte count too large",
            replace(&binary, b"         184", b"      999999"),
            1,
            "the header says 999999 bytes of data, 184",
        ),
        ("byte count missing", replace(&binary, b"         184", b"           0"), 1, "the header says 0 bytes"),
        (
            "binary cut off",
            [&binary[..end - 60], &binary[end..]].concat(),
            1,
            "the header says 23 values, 15 are there",
        ),
        ("binary not closed", binary[..end - 60].to_vec(), 1, "ends without the -1"),
        ("no byte order", replace(&binary, b"58b     1", b"58b     0"), 1, "byte order 0 is neither 1 nor 2"),
        ("lines of header", replace(&binary, b"          11", b"          12"), 1, "the header says 12 lines of text"),
        (
            "nodes slipped",
            bytes(line(&nodes, 4, |_| " 20 0 0 3 0.5 -0.5 0.001".into())),
            1,
            "line 4: node is not in its columns",
        ),
        ("columns missing", bytes(line(&nodes, 4, |l| l[..53].to_string())), 1, ""),
        ("no beam record", bytes(without_line(&elements, 4)), 1, "line 3: the record of orientation"),
        (
            "trace count",
            bytes(line(&trace, 3, |l| l.replacen("        10", "        12", 1))),
            1,
            "12 entries were announced, 10 are there",
        ),
        ("short row", bytes(line(&shape, 12, |l| l[..26].to_string())), 1, "line 12: 2 of 3 values in the row"),
    ]
}

/// What cannot be read: name, file, what the error says.
fn refused() -> Vec<(&'static str, Vec<u8>, &'static str)> {
    let (real, complex, binary) = (real(), complex(), binary());
    let bytes = |text: String| text.into_bytes();
    let head = |n: usize| real.lines().take(n).map(|l| format!("{l}\n")).collect::<String>().into_bytes();
    let nodes = text(Set::Nodes(nodes()));
    let double = text(Set::DoubleNodes(common::nodes()));
    let elements = text(Set::Elements(elements()));
    let shape = text(Set::Shape(shape(false, 3)));
    let analysis = text(Set::Analysis(analysis(false)));
    let trace = text(geometry().remove(5));
    let units = text(geometry().remove(1));
    let with = |file: &str, number: usize, new: &str| bytes(line(file, number, |_| new.to_string()));
    let swap = |file: &str, number: usize, from: &str, to: &str| bytes(line(file, number, |l| l.replacen(from, to, 1)));
    vec![
        ("empty", Vec::new(), "line 1: no data set begins here"),
        ("blank", b"\n\n  \n".to_vec(), "no data set begins here"),
        ("not a Universal File", b"time,acc\n0,1\n".to_vec(), "is this a Universal File?"),
        ("zeros", vec![0; 4000], "no data set begins here"),
        ("delimiters only", b"    -1\n    -1\n    -1\n".to_vec(), "no data set begins here"),
        ("word for a number", with(&real, 2, "  time"), "set 1, line 2: \"time\" is not the number of a data set"),
        ("negative number", with(&real, 2, "   -58"), "\"-58\" is not the number"),
        ("huge number", with(&real, 2, "99999999999999"), "is not the number of a data set"),
        ("nothing but the number", head(2), "set 1 (58), line 3: the set ends before the five lines of identification"),
        ("header cut in the text", head(5), "line 6: the set ends before the five lines"),
        ("no DOFs", head(7), "line 8: the set ends before record 6"),
        ("no data form", head(8), "line 9: the set ends before record 7"),
        ("no abscissa", head(9), "line 10: the set ends before record 8"),
        ("no ordinate", head(10), "line 11: the set ends before record 9"),
        ("no denominator", head(11), "line 12: the set ends before record 10"),
        ("no z axis", head(12), "line 13: the set ends before record 11"),
        (
            "function type in words",
            swap(&real, 8, "    1", " time"),
            "line 8: function type: \"time\" is not a whole number: correct this field (columns 1 to 5)",
        ),
        ("function type empty", swap(&real, 8, "    1", "     "), "line 8: function type"),
        (
            "node in words",
            swap(&real, 8, "        12   3", "      left   3"),
            "response node: \"left\" is not a whole number",
        ),
        (
            "direction in words",
            swap(&real, 8, "        12   3", "        12  +Z"),
            "response direction: \"+Z\" is not a whole number: correct this field (columns 52 to 55)",
        ),
        ("data type 3", swap(&real, 9, "         2", "         3"), "line 9: data type 3 does not exist"),
        ("data type empty", swap(&real, 9, "         2", "          "), "line 9: "),
        (
            "negative count",
            swap(&real, 9, "        23", "       -23"),
            "line 9: the number of values is -23: it must not be negative",
        ),
        (
            "count in words",
            swap(&real, 9, "        23", "      many"),
            "number of values: \"many\" is not a whole number",
        ),
        ("step in words", swap(&real, 9, " 1.25000E-01", "       fast "), "abscissa step: \"fast\" is not a number"),
        ("axis in words", with(&real, 10, "time s"), "line 10: quantity: \"time s\" is not a whole number"),
        ("word among the values", swap(&real, 15, "E", "x"), "line 15: \""),
        (
            "two points",
            with(&real, 14, "  1.0  1.2.3"),
            "line 14: \"1.2.3\" among the values is not a number: correct it",
        ),
        ("decimal comma", with(&complex, 14, "  1,0  2,0"), "\"1,0\" among the values is not a number"),
        ("control characters", with(&real, 14, "  1.0 \u{1}\u{2}"), "\"??\" among the values"),
        ("exponent alone", with(&real, 14, "  E+05"), "\"E+05\" among the values"),
        ("exponent without digits", with(&real, 14, "  1.0E+"), "\"1.0E+\" among the values"),
        ("hexadecimal", with(&real, 14, "  0x1F"), "\"0x1F\" among the values"),
        (
            "DEC floats",
            replace(&binary, b"58b     1     2", b"58b     1     1"),
            "floating format 1 (DEC VMS) is not read: export with IEEE 754",
        ),
        ("IBM floats", replace(&binary, b"58b     1     2", b"58b     1     3"), "floating format 3 (IBM 5/370)"),
        (
            "byte order in words",
            replace(&binary, b"58b     1", b"58b    LE"),
            "byte order: \"LE\" is not a whole number",
        ),
        ("bytes in words", replace(&binary, b"         184", b"        much"), "bytes of data: \"much\""),
        (
            "node label in words",
            swap(&nodes, 4, "        20", "       top"),
            "line 4: node label: \"top\" is not a whole number",
        ),
        ("node label empty", swap(&nodes, 4, "        20", "          "), "line 4: node label"),
        (
            "node coordinate in words",
            swap(&nodes, 4, "-5.00000E-01", "        left"),
            "y: \"left\" is not a number: correct this field (columns 54 to 66)",
        ),
        (
            "node position cut off",
            bytes(double.lines().take(5).map(|l| format!("{l}\n")).collect()),
            "line 5: the position of a node needs 3 numbers, 0 are here",
        ),
        ("node position short", with(&double, 12, "  1.0 2.0"), "the position of a node needs 3 numbers, 2 are here"),
        (
            "element without nodes",
            bytes(elements.lines().take(6).map(|l| format!("{l}\n")).collect()),
            "line 6: the nodes of an element needs 4 numbers, 0 are here",
        ),
        (
            "element fields missing",
            with(&elements, 6, "         2        44"),
            "line 6: physical property: \"\" is not a whole number",
        ),
        (
            "element nodes in words",
            with(&elements, 7, "        10      left"),
            "\"10      left\" among the values is not a number",
        ),
        ("negative number of nodes", swap(&elements, 6, "         4", "        -4"), "the number of nodes is -4"),
        (
            "too many nodes",
            with(&elements, 7, "  10  20  30  40  50"),
            "line 7: 5 values stand here where the record says 4",
        ),
        (
            "beam cut off",
            bytes(elements.lines().take(3).map(|l| format!("{l}\n")).collect()),
            "the set ends before the record of a beam",
        ),
        (
            "trace without head",
            bytes(trace.lines().take(2).map(|l| format!("{l}\n")).collect()),
            "line 3: the set ends before record 1 (trace line)",
        ),
        (
            "trace without name",
            bytes(trace.lines().take(3).map(|l| format!("{l}\n")).collect()),
            "line 4: the set ends before the name of the line",
        ),
        ("trace count in words", swap(&trace, 3, "        10", "       ten"), "number of nodes: \"ten\""),
        ("trace node in words", with(&trace, 5, "        10         b"), "line 5: \"10         b\" among the values"),
        (
            "units without factors",
            bytes(units.lines().take(3).map(|l| format!("{l}\n")).collect()),
            "line 4: record 2 (factors) needs 3 numbers, 0 are here",
        ),
        (
            "units code in words",
            swap(&units, 3, "         1", "        SI"),
            "line 3: units code: \"SI\" is not a whole number",
        ),
        ("units factor in words", with(&units, 4, "  meter"), "line 4: \"meter\" among the values"),
        (
            "shape without kinds",
            bytes(shape.lines().take(7).map(|l| format!("{l}\n")).collect()),
            "line 8: the set ends before the record of kinds",
        ),
        (
            "shape without parameters",
            bytes(shape.lines().take(8).map(|l| format!("{l}\n")).collect()),
            "line 9: the set ends before record 7",
        ),
        (
            "shape parameters short",
            bytes(shape.lines().take(9).map(|l| format!("{l}\n")).collect()),
            "record 8 (real parameters) needs 4 numbers, 0 are here",
        ),
        (
            "shape data type",
            swap(&shape, 8, "         2         3", "         9         3"),
            "line 8: data type 9 does not exist",
        ),
        (
            "shape of negative width",
            swap(&shape, 8, "         2         3", "         2        -3"),
            "the number of values a node is -3",
        ),
        (
            "shape of absurd width",
            swap(&shape, 8, "         2         3", "         2999999999"),
            "the number of values a node is 999999999",
        ),
        ("shape node in words", with(&shape, 11, "      left"), "line 11: \"left\" among the values"),
        (
            "shape row too long",
            bytes(line(&shape, 12, |l| format!("{l} 1.0"))),
            "line 12: 4 values stand here where the record says 3",
        ),
        ("analysis without label", with(&analysis, 3, "  x"), "line 3: \"x\" among the values"),
        (
            "analysis cut off",
            bytes(analysis.lines().take(12).map(|l| format!("{l}\n")).collect()),
            "line 13: the set ends before record 11",
        ),
        (
            "analysis without location",
            with(&analysis, 5, ""),
            "line 5: record 3 (location) needs 1 numbers, 0 are here",
        ),
        (
            "analysis row absurd",
            swap(
                &analysis.replace("\n         1\nNONE", "\n         2\nNONE"),
                16,
                "        10",
                "        10 900000000",
            ),
            "a row of values needs 900000000 numbers",
        ),
    ]
}

#[test]
fn tolerated_faults_are_told_with_their_place() {
    let all = tolerated();
    assert!(all.len() >= 40);
    for (name, bytes, sets, expected) in all {
        let (read, told) = said(&bytes);
        assert_eq!(read, sets, "{name}: {told:?}");
        if expected.is_empty() {
            assert!(told.is_empty(), "{name}: {told:?}");
        } else {
            assert!(told.iter().any(|line| line.contains(expected)), "{name}: {told:?}");
        }
    }
}

#[test]
fn what_cannot_be_read_is_one_line_with_place_and_remedy() {
    let all = refused();
    assert!(all.len() >= 60, "{}", all.len());
    for (name, bytes, expected) in all {
        let (_, told) = said(&bytes);
        assert!(told.iter().any(|line| line.contains(expected)), "{name}: {told:?}");
        assert!(told.iter().all(|line| !line.contains('\n')), "{name}: {told:?}");
    }
}

#[test]
fn one_bad_set_leaves_the_others_readable() {
    let bad = line(&real(), 14, |_| "  1.0  1.2.3".to_string());
    let (read, told) = said(format!("{}{bad}{}", complex(), uneven()).as_bytes());
    assert_eq!(read, 2);
    assert_eq!(
        told,
        [
            "set 2 (58), line 40: \"1.2.3\" among the values is not a number: correct it, or write NaN where nothing was measured"
        ]
    );
}

#[test]
fn a_count_never_asks_for_more_memory_than_the_file_could_fill() {
    let huge = line(&real(), 9, |l| l.replacen("        23", "9000000000", 1));
    let (read, told) = said(huge.as_bytes());
    assert_eq!((read, told.len()), (1, 1));
    assert!(told[0].contains("the header says 9000000000 values, 23 are there"), "{told:?}");
    let binary = replace(&binary(), b"        23", b"9000000000");
    let (read, told) = said(&binary);
    assert_eq!(read, 1, "{told:?}");
}
