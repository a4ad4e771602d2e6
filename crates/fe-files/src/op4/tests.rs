//! Every variant of OUTPUT4 holds the same matrix.
#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;

/// `[[2, -1, 0], [-1, 2, 0.5], [0, 0.5, 3]]`.
const EXPECTED: [(usize, usize, f64); 5] = [(0, 0, 2.0), (1, 0, -1.0), (1, 1, 2.0), (2, 1, 0.5), (2, 2, 3.0)];
const COLUMNS: [(i32, &[f64]); 3] = [(1, &[2.0, -1.0]), (1, &[-1.0, 2.0, 0.5]), (2, &[0.5, 3.0])];

#[derive(Clone, Copy)]
struct Variant {
    little: bool,
    double: bool,
    /// 0 dense, 1 strings, 2 strings with BIGMAT.
    sparse: i32,
}

fn binary(v: Variant) -> Vec<u8> {
    let order = |mut b: Vec<u8>| {
        if !v.little {
            b.reverse();
        }
        b
    };
    let int = |i: i32| order(i.to_le_bytes().to_vec());
    let value = |x: f64| order(if v.double { x.to_le_bytes().to_vec() } else { (x as f32).to_le_bytes().to_vec() });
    let mut bytes = Vec::new();
    let mut record = |parts: Vec<u8>| {
        bytes.extend(int(parts.len() as i32));
        bytes.extend(&parts);
        bytes.extend(int(parts.len() as i32));
    };
    let rows = if v.sparse == 2 { -3 } else { 3 };
    let kind = if v.double { 2 } else { 1 };
    record([int(3), int(rows), int(6), int(kind), b"KAA     ".to_vec()].concat());
    for (j, (row, values)) in (1..).zip(COLUMNS) {
        let words = values.len() as i32 * kind;
        let numbers: Vec<u8> = values.iter().flat_map(|&x| value(x)).collect();
        let (row, head, count) = match v.sparse {
            0 => (row, Vec::new(), words),
            1 => (0, int(row + 65_536 * (words + 1)), words + 1),
            _ => (0, [int(words + 1), int(row)].concat(), words + 2),
        };
        record([int(j), int(row), int(count), head, numbers].concat());
    }
    record([int(4), int(1), int(kind), value(1.0)].concat());
    bytes
}

#[test]
fn binary_of_both_orders_precisions_and_all_layouts() {
    for (little, double, sparse) in (0..12).map(|k| (k % 2 == 0, k / 2 % 2 == 0, k / 4)) {
        let matrices = read(&binary(Variant { little, double, sparse }), "k.op4").unwrap();
        assert_eq!(matrices[0].name, "KAA");
        assert_eq!(matrices[0].entries, EXPECTED, "{little} {double} {sparse}");
    }
}

#[test]
fn ascii_of_all_layouts() {
    let number = |x: f64| format!("{:>23}", format!("{x:.16E}").replace('E', "E+0").replace("E+0-", "E-0"));
    for sparse in 0..3 {
        let mut text =
            format!("{:>8}{:>8}{:>8}{:>8}{:<8}1P,3E23.16\n", 3, if sparse == 2 { -3 } else { 3 }, 6, 2, "KAA");
        for (j, (row, values)) in (1..).zip(COLUMNS) {
            let words = 2 * values.len();
            text += &match sparse {
                0 => format!("{j:>8}{row:>8}{words:>8}\n"),
                1 => format!("{j:>8}{:>8}{:>8}\n{:>8}\n", 0, words + 1, row as usize + 65_536 * (words + 1)),
                _ => format!("{j:>8}{:>8}{:>8}\n{:>8}{row:>8}\n", 0, words + 2, words + 1),
            };
            text += &(values.iter().map(|&x| number(x)).collect::<String>() + "\n");
        }
        text += &format!("{:>8}{:>8}{:>8}\n 1.0E+00\n", 4, 1, 1);
        // A load of one column between the two is passed over; alone it is refused.
        let load = format!("{:>8}{:>8}{:>8}{:>8}{:<8}1P,3E23.16\n", 1, 3, 2, 2, "PG")
            + &format!("{:>8}{:>8}{:>8}\n", 1, 1, 6)
            + &([1.0, 2.0, 3.0].map(number).concat() + "\n")
            + &format!("{:>8}{:>8}{:>8}\n 1.0E+00\n", 2, 1, 1);
        assert!(read(load.as_bytes(), "p.op4").unwrap_err().to_string().starts_with("p.op4:1: matrix PG is 3 x 1"));
        let twice = text.clone() + &load + &text;
        let matrices = read(twice.as_bytes(), "k.op4").unwrap();
        assert_eq!(matrices.len(), 2);
        assert_eq!(matrices[1].entries, EXPECTED, "{text}");
    }
}

#[test]
fn every_cut_and_every_changed_byte_is_an_error_or_a_matrix() {
    for sparse in 0..3 {
        let whole = binary(Variant { little: true, double: true, sparse });
        for end in 0..whole.len() {
            assert!(read(&whole[..end], "k.op4").is_err(), "{end}");
        }
        for at in 0..whole.len() {
            for byte in [0, 1, 127, 255] {
                let mut changed = whole.clone();
                changed[at] = byte;
                let _ = read(&changed, "k.op4");
            }
        }
    }
    let message = read(&binary(Variant { little: true, double: true, sparse: 0 })[..60], "k.op4").unwrap_err();
    assert_eq!(message.to_string(), "k.op4: byte 32: the file ends in the middle of a record; copy or export it again");
}
