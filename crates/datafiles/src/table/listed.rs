//! Columns that a header lists line by line, where no row of names stands above them.
//!
//! ```text
//! Abscissa: Time [s]              X-Axis:  Frequency  Hz
//! 1. Channel: Force [N]           Y-Axis:  [(m/s²)/N]
//! 2. Channel: Acc 1 [m/s²]        1   0.0   1.2e-3   3.4e-5        (number, abscissa, real, imaginary)
//! ```

use super::header::Header;
use super::header_line::{HeaderLine, label};
use crate::axis::kind_of;
use crate::units::{is_unit, split, stripped};

/// Names and units that the lines of a header give one by one.
pub(super) fn take(header: &mut Header, lines: &[HeaderLine]) {
    if header.names.len() < 2 || header.names.iter().any(|name| !name.is_empty()) {
        return;
    }
    if !by_axes(header, lines) {
        by_channels(header, lines);
    }
}

/// What stands behind a label, name and unit.
fn behind(line: &HeaderLine) -> Option<(String, String, String)> {
    let text = line.cells.join("\t");
    let (front, rest) = text.split_once([':', '='])?;
    let mut words = rest.split('\t').map(str::trim).filter(|word| !word.is_empty());
    let (name, unit) = split(words.next().unwrap_or_default());
    let unit = if unit.is_empty() { words.next().map(stripped).unwrap_or_default().to_owned() } else { unit };
    Some((label(front), name, unit))
}

/// Abscissa and ordinate of a file of one function; its rows are numbered, the abscissa stands in the second column.
fn by_axes(header: &mut Header, lines: &[HeaderLine]) -> bool {
    let find = |words: [&str; 3]| lines.iter().filter_map(behind).find(|(label, ..)| words.contains(&label.as_str()));
    let Some((_, x, x_unit)) = find(["x-axis", "x axis", "x_axis"]) else { return false };
    let width = header.names.len();
    if kind_of(&x, &x_unit).is_none() || !(3..5).contains(&width) {
        return false;
    }
    let y = find(["y-axis", "y axis", "y_axis"]);
    let y_unit = y.map(|(_, name, unit)| if unit.is_empty() { stripped(&name).to_owned() } else { unit });
    let title = find(["title1", "title", "title 1"]).map(|(_, name, _)| name).unwrap_or_default();
    let parts: &[&str] = if width == 4 { &["Real", "Imag"] } else { &[""] };
    header.names = vec!["row".to_owned(), x];
    header.names.extend(parts.iter().map(|part| format!("{title} {part}").trim().to_owned()));
    header.units = vec![String::new(), x_unit];
    header.units.resize(width, y_unit.filter(|unit| is_unit(unit)).unwrap_or_default());
    true
}

/// `1. Channel: Force [N]`, `Channel 2: Acc`, `Kanal 3 = Weg [mm]`; an abscissa that is not among them is the first column.
fn by_channels(header: &mut Header, lines: &[HeaderLine]) {
    let width = header.names.len();
    let mut found = Vec::new();
    for (label, name, unit) in lines.iter().filter_map(behind) {
        let digits: String = label.chars().filter(char::is_ascii_digit).collect();
        let word: String = label.chars().filter(|c| c.is_alphabetic()).collect();
        let number = digits.parse::<usize>().ok().filter(|number| (1..=width).contains(number));
        if let (Some(number), "channel" | "kanal" | "ch" | "column" | "spalte") = (number, word.as_str()) {
            found.push((number, name, unit));
        } else if matches!(word.as_str(), "abscissa" | "abszisse") {
            found.push((0, name, unit));
        }
    }
    let numbers: Vec<usize> = found.iter().map(|(number, ..)| *number).filter(|number| *number > 0).collect();
    let ascending = numbers.iter().copied().eq(1..=numbers.len());
    let behind_axis = numbers.len() + 1 == width;
    if !ascending || !(behind_axis || numbers.len() == width) {
        return;
    }
    for (number, name, unit) in found {
        if let Some(at) = if behind_axis { Some(number) } else { number.checked_sub(1) } {
            (header.names[at], header.units[at]) = (name, unit);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(lines: &[HeaderLine], width: usize) -> Header {
        let mut header = super::super::header::read(lines, width);
        take(&mut header, lines);
        header
    }

    fn lines(text: &[&str]) -> Vec<HeaderLine> {
        text.iter().map(|line| HeaderLine { cells: line.split('\t').map(str::to_owned).collect() }).collect()
    }

    #[test]
    fn channels_are_listed_by_their_numbers() {
        let header = read(&lines(&["Abscissa: Time [s]", "1. Channel: Force [N]", "2. Channel: Acc 1 [m/s²]"]), 3);
        assert_eq!((header.names.join(","), header.units.join(",")), ("Time,Force,Acc 1".into(), "s,N,m/s²".into()));
        let header = read(&lines(&["Channel 1: Force [N]", "Channel 2: Acc 1 [g]", "Sampling rate: 100 Hz"]), 2);
        assert_eq!((header.names.join(","), header.step), ("Force,Acc 1".into(), Some(0.01)));
        assert_eq!(read(&lines(&["Channel 1: Force [N]", "Channel 3: Acc 1 [g]"]), 3).units.concat(), "");
    }

    #[test]
    fn axes_of_one_function() {
        let text = ["Title1:\tFRF H1(Acc,Force)", "X-Axis:\tFrequency\tHz\t", "Y-Axis:\t[(m/s²)/N]"];
        let header = read(&lines(&text), 4);
        assert_eq!(header.names.join(";"), "row;Frequency;FRF H1(Acc,Force) Real;FRF H1(Acc,Force) Imag");
        assert_eq!(header.units.join(";"), ";Hz;(m/s²)/N;(m/s²)/N");
    }
}
