//! LabVIEW measurement files (`.lvm`): a header, then segments, each with its own header and channels.
//!
//! Source: "Specification for the LabVIEW Measurement File (.lvm)", National Instruments. `X_Columns` is `No`, `One` or
//! `Multi` (a column of x before each channel); `Multi_Headings` says whether each segment repeats the header.

use super::decode::numbered;
use crate::axis::even_step;
use crate::contents::{Axis, Channel, Contents, Format, Kind, Set, first_numbers};
use crate::error::{Fault, Read, one_line};
use crate::note::Note;
use crate::table::number::number;
use crate::table::{Column, Columns, TableSource};
use uff::Values;

const SPECIAL: &str = "***Start_Special***";
const SPECIAL_END: &str = "***End_Special***";
const END: &str = "***End_of_Header***";

/// The header of the file.
struct Head {
    separator: char,
    comma: bool,
    x: XColumns,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum XColumns {
    No,
    One,
    Multi,
}

/// A segment while its rows come in.
#[derive(Default)]
struct Segment {
    line: u64,
    /// Rows of its header by their word.
    keys: Vec<(String, Vec<String>)>,
    /// Row of names, x and comment included.
    names: Vec<String>,
    columns: Vec<Vec<f64>>,
    comments: Vec<String>,
    /// Whether there is a column of x before each channel.
    spread: bool,
}

enum Place {
    Between,
    Header,
    Names,
    Rows,
}

pub(super) fn read(text: &str) -> Read<(Contents, TableSource)> {
    let mut lines = numbered(text);
    let head = head(&mut lines)?;
    let mut segments: Vec<Segment> = Vec::new();
    let mut place = Place::Between;
    let mut special = false;
    for (line, row) in lines {
        // Special segments hold what their writer alone understands.
        special = (special || row.starts_with(SPECIAL)) && !row.starts_with(SPECIAL_END);
        if special || row.starts_with(SPECIAL_END) {
            continue;
        }
        let cells: Vec<&str> = row.split(head.separator).map(str::trim).collect();
        let blank = cells.iter().all(|cell| cell.is_empty());
        place = match place {
            Place::Between | Place::Rows if header_word(cells[0]) => {
                segments.push(Segment { line, ..Segment::default() });
                if let Some(last) = segments.last_mut() {
                    last.key(&cells);
                }
                Place::Header
            }
            Place::Header if cells[0] == END => Place::Names,
            Place::Header => {
                if let Some(last) = segments.last_mut() {
                    last.key(&cells);
                }
                Place::Header
            }
            Place::Names if blank => Place::Names,
            Place::Between if cells[0].starts_with("X_Value") => {
                segments.push(Segment { line, ..Segment::default() });
                name(&mut segments, &cells);
                Place::Rows
            }
            Place::Names => {
                name(&mut segments, &cells);
                Place::Rows
            }
            other if blank => other,
            Place::Rows => {
                if let Some(last) = segments.last_mut() {
                    last.row(line, &cells, head.comma)?;
                }
                Place::Rows
            }
            Place::Between => {
                return Err(Fault::line(
                    line,
                    format!("\"{}\" belongs to no segment; export the file again", one_line(row, 40)),
                ));
            }
        };
    }
    for segment in &mut segments {
        segment.spread = head.x == XColumns::Multi;
    }
    let segments = joined(segments);
    if segments.is_empty() {
        return Err(Fault::new("has a header and no segment of data; export the record with its samples"));
    }
    let mut contents = Contents::new(Format::Lvm);
    let mut sources = Vec::new();
    let several = segments.len() > 1;
    for (i, segment) in segments.into_iter().enumerate() {
        let (set, columns) =
            segment.finish(if several { format!("segment {}", i + 1) } else { String::new() }, head.x)?;
        contents.sets.push(set);
        sources.push(columns);
    }
    Ok((contents, TableSource { sets: sources }))
}

/// Segments that go on where the one before them ends, of the same channels and steps, are one record: programs write a
/// segment each time they read the device.
fn joined(segments: Vec<Segment>) -> Vec<Segment> {
    let mut out: Vec<Segment> = Vec::new();
    for segment in segments {
        match out.last_mut().filter(|last| segment.follows(last)) {
            Some(last) => {
                for (column, more) in last.columns.iter_mut().zip(segment.columns) {
                    column.extend(more);
                }
                last.comments.extend(segment.comments);
            }
            None => out.push(segment),
        }
    }
    out
}

fn name(segments: &mut [Segment], cells: &[&str]) {
    if let Some(last) = segments.last_mut() {
        last.names = cells.iter().map(|&cell| cell.to_owned()).collect();
        while last.names.last().is_some_and(String::is_empty) {
            last.names.pop();
        }
        last.columns = vec![Vec::new(); last.names.len()];
    }
}

/// Words that begin a segment.
fn header_word(word: &str) -> bool {
    matches!(
        word,
        "Channels"
            | "Samples"
            | "Notes"
            | "Test_Name"
            | "Test_Numbers"
            | "Test_Series"
            | "UUT_Name"
            | "UUT_M/N"
            | "UUT_S/N"
            | "Date"
    )
}

fn head<'a>(lines: &mut impl Iterator<Item = (u64, &'a str)>) -> Read<Head> {
    let mut head = Head { separator: '\t', comma: false, x: XColumns::One };
    for (_, row) in lines.by_ref() {
        if row.starts_with(END) {
            return Ok(head);
        }
        let mut parts = row.split(['\t', ',', ';']);
        let (word, value) = (parts.next().unwrap_or_default().trim(), parts.next().unwrap_or_default().trim());
        match (word, value.to_ascii_lowercase().as_str()) {
            ("Separator", "comma") => head.separator = ',',
            ("Separator", "semicolon") => head.separator = ';',
            // `Decimal_Separator,,`: the comma is the value and was cut away.
            ("Decimal_Separator", "" | ",") => head.comma = row.contains(','),
            ("X_Columns", "no") => head.x = XColumns::No,
            ("X_Columns", "multi") => head.x = XColumns::Multi,
            _ => {}
        }
    }
    Err(Fault::new(format!("has no {END}; it was cut short: export the file again")))
}

impl Segment {
    fn key(&mut self, cells: &[&str]) {
        let values = cells[1..].iter().map(|&cell| cell.to_owned()).collect();
        self.keys.push((cells[0].to_owned(), values));
    }

    fn value(&self, word: &str, channel: usize) -> Option<&str> {
        let (_, values) = self.keys.iter().find(|(key, _)| key == word)?;
        // With a column of x before each channel, values stand over the channels or one after the other.
        let spread = self.spread && values.len() > 2 && values.iter().skip(1).step_by(2).all(String::is_empty);
        values.get(if spread { 2 * channel } else { channel }).map(String::as_str).filter(|value| !value.is_empty())
    }

    fn number(&self, word: &str, channel: usize) -> Option<f64> {
        let text = self.value(word, channel)?;
        number(text, false).or_else(|| number(text, true))
    }

    /// Whether a segment starts one step behind the last sample of another.
    fn follows(&self, before: &Self) -> bool {
        let steps = |segment: &Self| segment.number("Delta_X", 0).filter(|step| *step > 0.0);
        let (Some(step), Some(other)) = (steps(self), steps(before)) else { return false };
        let (Some(start), Some(first)) = (self.number("X0", 0), before.number("X0", 0)) else { return false };
        let first_y = usize::from(before.columns.len() > 1);
        let count = before.columns.get(first_y).map_or(0, Vec::len);
        let even = |segment: &Self| {
            let lengths = segment.columns.iter().map(Vec::len).filter(|len| *len > 0);
            lengths.clone().min() == lengths.max()
        };
        let units =
            |segment: &Self| segment.keys.iter().find(|(key, _)| key == "Y_Unit_Label").map(|(_, units)| units.clone());
        step == other
            && count > 0
            && self.names == before.names
            && units(self) == units(before)
            && even(self)
            && even(before)
            && (start - first - count as f64 * step).abs() < 0.01 * step
    }

    fn row(&mut self, line: u64, cells: &[&str], comma: bool) -> Read<()> {
        for (i, cell) in cells.iter().enumerate().filter(|(_, cell)| !cell.is_empty()) {
            let comment = self.names.get(i).is_none_or(|name| name == "Comment");
            match (number(cell, comma), self.columns.get_mut(i)) {
                (Some(value), Some(column)) if !comment => column.push(value),
                (None, Some(_)) if !comment => {
                    let problem =
                        format!("column {}: \"{}\" is not a number; export the file again", i + 1, one_line(cell, 40));
                    return Err(Fault::line(line, problem));
                }
                _ => {
                    if self.comments.len() < 20 {
                        self.comments.push(format!("line {line}: {}", one_line(cell, 80)));
                    }
                }
            }
        }
        Ok(())
    }

    fn finish(mut self, name: String, x: XColumns) -> Read<(Set, Columns)> {
        if self.names.is_empty() {
            return Err(Fault::line(self.line, "this segment has no row of names; export the file again"));
        }
        let kind = match self.value("X_Dimension", 0) {
            Some("Frequency") => Kind::Spectrum,
            _ => Kind::Time,
        };
        let mut set = Set::new(name, kind);
        set.axis_unit = self.value("X_Unit_Label", 0).unwrap_or(if kind == Kind::Time { "s" } else { "Hz" }).to_owned();
        set.notes = std::mem::take(&mut self.comments).into_iter().map(Note::from).collect();
        if let Some(notes) = self.value("Notes", 0) {
            set.notes.push(notes.into());
        }
        let mut columns = Columns::default();
        let width = self.names.len() - usize::from(self.names.last().is_some_and(|name| name == "Comment"));
        let is_x = |i: usize| if x == XColumns::Multi { i.is_multiple_of(2) } else { i == 0 };
        for (number, i) in (0..width).filter(|&i| !is_x(i)).enumerate() {
            let at_x = if x == XColumns::Multi { i - 1 } else { 0 };
            let values = std::mem::take(&mut self.columns[i]);
            let channel = self.channel(i, number, &values, &self.columns[at_x]);
            if columns.axis.is_none() && x == XColumns::One {
                columns.axis = Some(self.columns[0].clone());
            }
            set.channels.push(channel);
            columns.channels.push(Column { values: Values::Real(values), first: 0 });
        }
        if set.channels.is_empty() {
            return Err(Fault::line(self.line, "this segment has no channel beside X_Value; export the file again"));
        }
        Ok((set, columns))
    }

    /// Entry of channel number `number`. Its step is that of its header, which counts where it has fewer samples than x.
    fn channel(&self, column: usize, number: usize, values: &[f64], x: &[f64]) -> Channel {
        let unit = self.value("Y_Unit_Label", number).unwrap_or_default();
        let mut channel = Channel::new(self.names[column].clone(), unit, values.len() as u64);
        let stated = self.number("Delta_X", number).filter(|step| *step > 0.0);
        let uneven = x.len() > 1 && x.len() == values.len() && even_step(x).is_none();
        channel.axis = match stated {
            _ if uneven => Axis::Stored { step: None },
            Some(step) => Axis::Even { start: self.number("X0", number).unwrap_or(0.0), step },
            None if x.len() == values.len() && !x.is_empty() => match even_step(x) {
                Some(step) => Axis::Even { start: x[0], step },
                None => Axis::None,
            },
            None => Axis::None,
        };
        channel.first = first_numbers(&Values::Real(values.iter().take(3).copied().collect()));
        channel
    }
}
