//! Damage to a good time record ends in a record or in one line, never in a panic.

use crate::common::models::cantilever;
use dashpot::control::Control;
use dashpot::exchange::records::{parse_harmonics, parse_record};
use proptest::prelude::*;

/// A unit may stand below its name in a quoted cell, and so may what is no name at all: found by the damage below.
#[test]
fn names_of_two_lines_are_refused_in_one() {
    let beam = cantilever(2);
    for text in [
        "time [s],\"force@1 [N],acc@3 [m/s^2]\nc",
        "\"time\n[ms]\",force@1 [N]\n0,1\n",
        "time [s],\"acc@99\n[g]\"\n0,1\n",
    ] {
        let said = parse_record(text.as_bytes(), "x", &beam, &Control::unattended()).unwrap_err().to_string();
        assert_eq!(said.lines().count(), 1, "{said}");
    }
}

proptest! {
    /// A good record with pieces changed, lost, doubled or put in: it is read, or refused in one line, as fast as a good one.
    #[test]
    fn damaged_records_never_panic(damages in proptest::collection::vec((any::<(u16, u8, u8)>(), 0_usize..7), 1..6)) {
        let rows: String = (0..60).map(|n| format!("{},{},{}\n", 0.01 * f64::from(n), n * 7 % 13, n * 5 % 11)).collect();
        let mut bytes = format!("time [s],force@1 [N],acc@3 [m/s^2]\n{rows}").into_bytes();
        for ((place, length, value), how) in damages {
            let at = usize::from(place) % bytes.len().max(1);
            let end = (at + 1 + usize::from(length) / 8).min(bytes.len());
            let odd: [&[u8]; 8] = [b"NaN", b"1e999", b",,,", b"\"", b"\xFF\xFE", b"\0", b"\r", b"99999999999999999999"];
            match how {
                0 if at < end => bytes[at] = value,
                1 => drop(bytes.drain(at..end)),
                2 => {
                    let piece = bytes[at..end].to_vec();
                    bytes.splice(at..at, piece);
                }
                3 => bytes.truncate(at),
                4 => bytes[at..end].fill(b'9'),
                _ => drop(bytes.splice(at..at, odd[usize::from(value) % odd.len()].iter().copied())),
            }
        }
        let beam = cantilever(2);
        let lines = |said: String| said.lines().count();
        if let Err(error) = parse_record(&bytes, "x", &beam, &Control::unattended()) {
            prop_assert_eq!(lines(error.to_string()), 1);
        }
        if let Err(error) = parse_harmonics(&bytes, "x", &beam) {
            prop_assert_eq!(lines(error.to_string()), 1);
        }
    }
}
