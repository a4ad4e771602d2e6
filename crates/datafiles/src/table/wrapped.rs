//! One record that is written on in lines of several values, as accelerograms of earthquakes are.
//!
//! ```text
//! ACCELERATION TIME SERIES IN UNITS OF G
//! NPTS=  4000, DT= .0100 SEC
//!   .1234E-03  .1240E-03  .1251E-03  .1263E-03  .1270E-03
//! ```

use super::block::{Block, Numbers};
use super::header_line::HeaderLine;
use super::number::number;

/// Words for the number of samples.
const COUNTS: [&str; 8] =
    ["npts", "numberofpoints", "nopoints", "numberofsamples", "nsamples", "points", "samples", "numberofdata"];

/// What the header says of one record.
#[derive(Debug, PartialEq)]
pub(super) struct Stated {
    /// Time between samples, s.
    pub step: Option<f64>,
    /// Unit behind `in units of`.
    pub unit: String,
    /// The words in front of `time series`, or of that line.
    pub name: String,
}

/// Puts the rows of a block one behind the other where the header states as many samples as they hold together.
pub(super) fn unwrap(block: &mut Block) -> Option<Stated> {
    let width = block.columns.iter().rposition(|column| !column.re.is_empty())? + 1;
    let held: usize = block.columns.iter().map(|column| column.re.len()).sum();
    let whole = block.columns.iter().all(|column| column.im.is_empty() && !column.clock && column.gaps == 0);
    let count = block.header.iter().find_map(|line| stated(line, &COUNTS))?;
    // The last line alone may be shorter.
    let filled = block.columns[..width].windows(2).all(|pair| pair[0].re.len() >= pair[1].re.len());
    if width < 2 || block.rows < 2 || !whole || !filled || count != held as f64 || held <= (block.rows - 1) * width {
        return None;
    }
    let columns = std::mem::take(&mut block.columns);
    let values = (0..held).map(|i| columns[i % width].re[i / width]).collect();
    block.columns = vec![Numbers { re: values, ..Numbers::default() }];
    block.rows = held;
    let (name, unit) = block.header.iter().rev().find_map(series).unwrap_or_default();
    let step = block.header.iter().find_map(|line| stated(line, &["dt", "deltat", "timestep", "samplinginterval"]));
    Some(Stated { step, unit, name })
}

/// The number behind one of some words, such as 4000 of `NPTS=  4000, DT= .0100 SEC`.
fn stated(line: &HeaderLine, words: &[&str]) -> Option<f64> {
    let text = line.cells.join(" ").replace(',', " ");
    let parts: Vec<&str> = text.split(['=', ':', ' ', '\t']).filter(|part| !part.is_empty()).collect();
    let plain = |part: &str| part.chars().filter(|c| c.is_alphanumeric()).collect::<String>().to_lowercase();
    (1..parts.len()).find_map(|i| {
        let value = number(parts[i], false).filter(|value| *value > 0.0)?;
        let named = (1..=3.min(i))
            .any(|back| words.contains(&parts[i - back..i].iter().map(|p| plain(p)).collect::<String>().as_str()));
        named.then_some(value)
    })
}

/// Name and unit out of `ACCELERATION TIME SERIES IN UNITS OF G`.
fn series(line: &HeaderLine) -> Option<(String, String)> {
    let text = line.cells.join(" ");
    let lower = text.to_lowercase();
    let at = lower.find("in units of")?;
    let unit = text[at..].split_whitespace().nth(3)?.trim_end_matches(['.', ',', ';']);
    let unit = if unit.eq_ignore_ascii_case("g") { "g" } else { unit };
    let name = lower[..at].trim().trim_end_matches("time series").trim();
    Some((name.to_owned(), unit.to_lowercase()))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use crate::text;
    use uff::Values;

    const HEAD: &str = "STRONG MOTION RECORD\nACCELERATION TIME SERIES IN UNITS OF G\n";

    /// Five values a line are one channel where the header states their number, and a table where it does not.
    #[test]
    fn lines_of_several_values_are_one_record() {
        let rows = "  .1E-1  .2E-1  .3E-1\n  .4E-1  .5E-1  .6E-1\n  .7E-1\n";
        let (contents, source) = text::read(format!("{HEAD}NPTS=  7, DT= .0100 SEC\n{rows}").as_bytes()).unwrap();
        let channel = &contents.sets[0].channels[0];
        assert_eq!(
            (contents.sets[0].channels.len(), channel.name.as_str(), channel.unit.as_str()),
            (1, "acceleration", "g")
        );
        assert_eq!(channel.axis.step(), Some(0.01));
        assert!(
            matches!(source.read(0, 0).unwrap(), Values::Real(values) if values == [0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07])
        );
        let (table, _) = text::read(format!("{HEAD}NPTS=  3, DT= .0100 SEC\n{rows}").as_bytes()).unwrap();
        assert!(table.sets[0].channels.len() > 2);
    }
}
