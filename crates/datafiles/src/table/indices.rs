//! Numbers in brackets that tell columns of one name apart, `Acceleration[1]`, `Acceleration[2]`, are no units.

use super::header::Header;

/// Puts numbers that were taken for units back into names that stand several times.
pub(super) fn keep(header: &mut Header) {
    let is_index = |unit: &str| !unit.is_empty() && unit.bytes().all(|byte| byte.is_ascii_digit());
    let numbered = |c: usize| is_index(&header.units[c]).then_some(&header.names[c]);
    let again: Vec<bool> = (0..header.names.len())
        .map(|c| numbered(c).is_some_and(|name| (0..header.names.len()).any(|k| k != c && numbered(k) == Some(name))))
        .collect();
    for c in (0..again.len()).filter(|&c| again[c]) {
        header.names[c] = format!("{}[{}]", header.names[c], std::mem::take(&mut header.units[c]));
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use crate::contents::Axis;
    use crate::text;

    /// The layout of the ground vibration test of an aircraft: indices in brackets, the sampling rate in the first row of a column of
    /// its own.
    #[test]
    fn indices_and_a_rate_in_a_column_of_its_own() {
        for (rest, indices) in [("", ["[1]", "[2]"]), (",NaN", ["[1]", "[2]"]), (",400", [" [1]", " [2]"])] {
            let mut table = format!("Force,Acceleration{},Acceleration{},Fs\n1,2,3,400\n", indices[0], indices[1]);
            (0..50).for_each(|i| table.push_str(&format!("{i},-{i}.5,{i}e-3{rest}\n")));
            let (contents, _) = text::read(table.as_bytes()).unwrap();
            let set = &contents.sets[0];
            let names: Vec<&str> = set.channels.iter().map(|channel| channel.name.as_str()).collect();
            assert_eq!(names, ["Force", "Acceleration[1]", "Acceleration[2]"], "{rest}");
            assert!(set.channels.iter().all(|channel| channel.unit.is_empty()));
            assert!(set.channels.iter().all(|channel| channel.axis == Axis::Even { start: 0.0, step: 0.0025 }));
            assert_eq!(set.notes, ["column 4 states Fs = 400 of all samples".into()]);
        }
        let (contents, _) = text::read(b"H [1],Coherence [1]\n1,2\n2,3\n5,1\n").unwrap();
        assert_eq!(contents.sets[0].channels[1].unit, "1");
    }
}
