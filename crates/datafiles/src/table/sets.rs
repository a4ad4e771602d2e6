//! From blocks of numbers to sets: which column is the abscissa, how many values each has.

use super::block::{Block, Numbers};
use super::clock::{join_date, join_fractions, pass_midnight};
use super::{header, indices, listed, number, wrapped};
use crate::axis::{ascending, even_step, kind_of, unit_since_1970};
use crate::contents::{Axis, Channel, Kind, Set, first_numbers};
use crate::error::{Fault, Read};
use crate::note::{Defect, Note};
use crate::source::Source;
use crate::tree::{Sampling, sampling};
use uff::Values;

/// Values of a column.
#[derive(Debug, Clone)]
pub(crate) struct Column {
    pub values: Values,
    /// Row of its first value.
    pub first: usize,
}

/// Columns of a set, one a channel, and the column of its abscissa.
#[derive(Debug, Clone, Default)]
pub(crate) struct Columns {
    pub channels: Vec<Column>,
    pub axis: Option<Vec<f64>>,
}

/// Tables that were read whole.
#[derive(Debug)]
pub(crate) struct TableSource {
    pub sets: Vec<Columns>,
}

impl Source for TableSource {
    fn read(&self, set: usize, channel: usize) -> Read<Values> {
        let column = self.sets.get(set).and_then(|set| set.channels.get(channel));
        column.map(|column| column.values.clone()).ok_or_else(|| Fault::new("there is no such column"))
    }

    fn axis(&self, set: usize, channel: usize) -> Read<Vec<f64>> {
        let columns = self.sets.get(set).ok_or_else(|| Fault::new("there is no such table"))?;
        let axis = columns.axis.as_ref().ok_or_else(|| Fault::new("the table has no abscissa"))?;
        let column = &columns.channels[channel];
        let end = column.first + column.values.len();
        axis.get(column.first..end).map(<[f64]>::to_vec).ok_or_else(|| {
            Fault::new("the column goes on where its abscissa has ended; fill the first column to the last row")
        })
    }
}

/// Sets and columns of the blocks of a table called `name`.
pub(crate) fn finish(name: &str, blocks: Vec<Block>) -> (Vec<Set>, Vec<Columns>) {
    let several = blocks.len() > 1;
    let named = |i: usize| if several { format!("{name} {}", i + 1).trim().to_owned() } else { name.to_owned() };
    blocks.into_iter().enumerate().map(|(i, block)| one(named(i), block)).unzip()
}

/// The header of a block, its column of the abscissa, and what is said of its clock and its rate.
fn prepared(block: &mut Block) -> (header::Header, Option<(usize, Kind)>, Vec<String>) {
    let wrapped = wrapped::unwrap(block);
    let mut header = header::read(&block.header, block.columns.len());
    if let Some(stated) = wrapped {
        (header.names, header.units) = (vec![stated.name], vec![stated.unit]);
        header.step = header.step.or(stated.step);
        let said = format!("its {} samples are written on in lines of several", block.rows);
        return (header, None, vec![said]);
    }
    listed::take(&mut header, &block.header);
    indices::keep(&mut header);
    join_date(&mut header, block);
    join_fractions(&mut header, block);
    let midnight = pass_midnight(block);
    let axis = find_axis(&header, &block.columns, block.rows);
    let rate = if axis.is_none() && header.step.is_none() { stated_step(&mut header, block) } else { None };
    (header, axis, midnight.into_iter().chain(rate).collect())
}

fn one(name: String, mut block: Block) -> (Set, Columns) {
    let (header, axis, said) = prepared(&mut block);
    let kind = axis.map_or(if header.step.is_some() { Kind::Time } else { Kind::Table }, |(_, kind)| kind);
    let mut set = Set::new(name, kind);
    set.notes.extend(header.remarks.iter().filter(|line| !line.is_empty()).take(20).map(|line| line.as_str().into()));
    set.notes.extend(said.into_iter().map(Note::from).chain(ends_and_order(&header, &block, axis.is_some())));
    set.notes.extend(axis.and_then(|(at, _)| without_empty_ends(&mut block, at)).map(Note::from));
    let axis_values = axis.map(|(at, _)| block.columns[at].re.clone());
    let (mut columns, step) = (Columns::default(), axis_values.as_deref().and_then(even_step));
    if let Some((at, _)) = axis {
        name_axis(&mut set, &header, at, &block.columns[at], step);
    }
    for (i, numbers) in block.columns.into_iter().enumerate() {
        if block.texts.contains(&i) || numbers.re.is_empty() && number::number(&header.names[i], false).is_some() {
            let name = if header.names[i].is_empty() { format!("column {}", i + 1) } else { header.names[i].clone() };
            let text = || format!("\"{name}\" holds texts: it is no channel").into();
            set.notes.extend(block.texts.contains(&i).then(text));
            continue;
        }
        if axis.is_some_and(|(at, _)| at == i) || unused(&numbers, &header.names[i]) {
            continue;
        }
        if i == 0 && counts_rows(&numbers, &header.names[0]) {
            set.notes.push("column 1 counts the rows: it is no channel and no time".into());
            continue;
        }
        // Some programs write the abscissa beside every channel.
        if axis.is_some_and(|(_, kind)| kind_of(&header.names[i], &header.units[i]) == Some(kind))
            && axis_values.as_ref() == Some(&numbers.re)
        {
            continue;
        }
        let name = if header.names[i].is_empty() { format!("column {}", i + 1) } else { header.names[i].clone() };
        let mut channel = Channel::new(name, header.units[i].clone(), numbers.re.len() as u64);
        if numbers.gaps > 0 {
            let (name, gaps) = (&channel.name, numbers.gaps);
            set.notes.push(format!("\"{name}\" has {gaps} empty cells between its numbers; they read as NaN").into());
        }
        channel.axis = match (&axis_values, header.step) {
            (Some(_), _) => Axis::Stored { step },
            (None, Some(step)) => Axis::Even { start: 0.0, step },
            (None, None) => Axis::None,
        };
        if let Some(said) = header.sensitivities.get(i).filter(|said| !said.is_empty()) {
            channel.attributes.push(("sensitivity".to_owned(), said.clone()));
        }
        let column = Column { first: numbers.first, values: values(numbers) };
        channel.complex = matches!(column.values, Values::Complex(_));
        channel.first = first_numbers(&column.values);
        set.channels.push(channel);
        columns.channels.push(column);
    }
    if set.kind == Kind::Spectrum && set.channels.iter().any(|channel| channel.complex) {
        set.kind = Kind::Frf;
    }
    if set.axis_unit.is_empty() && set.kind == Kind::Time {
        "s".clone_into(&mut set.axis_unit);
    }
    columns.axis = axis_values;
    (set, columns)
}

/// Gives a set the unit of its axis, column number `at`, whose values are `step` apart, and says what is assumed of it.
fn name_axis(set: &mut Set, header: &header::Header, at: usize, column: &Numbers, step: Option<f64>) {
    set.axis_unit = axis_unit(header, at, set.kind, column.clock);
    if set.kind == Kind::Time && header.units[at].is_empty() && !column.clock {
        let counted = column.re.first().copied().and_then(unit_since_1970);
        if let Some(unit) = counted {
            unit.clone_into(&mut set.axis_unit);
            set.notes.push(format!("the times count from 1970: by their size they are taken in {unit}").into());
        }
        // Seconds are seldom whole, milliseconds and numbers of samples are.
        if let Some(step) = step.filter(|step| counted.is_none() && *step >= 1.0 && step.fract() == 0.0) {
            let text = format!("the times have no unit and rise by {step}: they are taken in s");
            set.notes.push(Note::new(Defect::TimesCount, text));
        }
    }
    if header.names[at].is_empty() {
        let text = format!("column {} rises evenly and has no name: it is taken as the time in s", at + 1);
        set.notes.push(text.into());
    }
}

/// Says that the table was cut off, or that its times are not in order.
fn ends_and_order(header: &header::Header, block: &Block, has_axis: bool) -> Vec<Note> {
    let back = if has_axis || header.step.is_some() { None } else { goes_back(header, block) };
    cut_off(block).into_iter().chain(back).collect()
}

/// Says that the last row ends before those above it do, in a column that has a number in every other row.
fn cut_off(block: &Block) -> Option<Note> {
    let rows = block.rows;
    let short = |numbers: &Numbers| numbers.re.len() + 1 == rows && numbers.gaps == 0 && numbers.first == 0;
    let missing = block.columns.iter().skip(block.last_width).filter(|numbers| short(numbers)).count();
    (rows > 2 && missing > 0).then(|| {
        let (width, line) = (block.columns.len(), block.lines[1]);
        let text = format!("the file ends in line {line}, which has {} of {width} cells", width - missing);
        Note::new(Defect::CutOff, text)
    })
}

/// Says where the times of a column of that name go back.
fn goes_back(header: &header::Header, block: &Block) -> Option<Note> {
    let of_time = |i: &usize| kind_of(&header.names[*i], &header.units[*i]) == Some(Kind::Time);
    let times = &block.columns[(0..block.columns.len().min(3)).find(of_time)?].re;
    let row = times.windows(2).position(|pair| pair[1] < pair[0])? + 1;
    let (now, before, line) = (times[row], times[row - 1], block.lines[0] + row as u64);
    (times.len() == block.rows).then(|| {
        let text = format!("the time goes back in line {line}: {now} follows {before}");
        Note::new(Defect::TimeGoesBack, text)
    })
}

/// Leaves out the first and last rows in which no column but the abscissa has a number; says how many.
fn without_empty_ends(block: &mut Block, axis: usize) -> Option<String> {
    let rows = block.rows;
    let others = |i: &usize| *i != axis && !block.columns[*i].re.is_empty();
    let columns: Vec<usize> = (0..block.columns.len()).filter(others).collect();
    let whole = |&i: &usize| block.columns[i].re.len() == rows && block.columns[i].im.is_empty();
    if columns.is_empty() || !columns.iter().all(whole) {
        return None;
    }
    let empty = |row: usize| columns.iter().all(|&i| block.columns[i].re[row].is_nan());
    let front = (0..rows).take_while(|&row| empty(row)).count();
    let back = (front..rows).rev().take_while(|&row| empty(row)).count();
    if front == rows || front + back == 0 {
        return None;
    }
    for i in columns {
        let column = &mut block.columns[i];
        column.re.truncate(rows - back);
        column.re.drain(..front);
        column.first += front;
    }
    Some(format!(
        "{front} rows at the start and {back} at the end have no numbers (NaN) beside the abscissa: they are left out"
    ))
}

/// The step that a column of its own states, such as `Fs` with 400 in its first row: the column is no channel. Says so.
fn stated_step(header: &mut header::Header, block: &mut Block) -> Option<String> {
    for (i, numbers) in block.columns.iter_mut().enumerate() {
        let Some(&value) = numbers.re.first().filter(|_| numbers.first == 0 && numbers.im.is_empty()) else { continue };
        let constant = numbers.re.iter().all(|other| other.is_nan() || *other == value);
        if let Some(Sampling::Step(step)) = sampling(&header.names[i], value).filter(|_| constant && block.rows > 1) {
            let said = format!("column {} states {} = {value} of all samples", i + 1, header.names[i]);
            header.step = Some(step);
            header.names[i].clear();
            *numbers = Numbers::default();
            return Some(said);
        }
    }
    None
}

/// Names of a column that counts the rows.
const COUNTERS: [&str; 18] = [
    "", "x", "sequence", "line", "row", "index", "idx", "no", "no.", "nr", "nr.", "#", "sample", "samples", "point",
    "zeile", "kanal", "channel",
];

/// Whether the first column counts the rows, 0, 1, 2, ... or 1, 2, 3, ...
fn counts_rows(numbers: &Numbers, name: &str) -> bool {
    let first = numbers.re.first().copied().unwrap_or(f64::NAN);
    let counted = || numbers.re.iter().enumerate().all(|(i, value)| (value - first - i as f64).abs() < 1e-9);
    COUNTERS.contains(&name.trim().to_lowercase().as_str())
        && numbers.re.len() > 3
        && numbers.im.is_empty()
        && (first == 0.0 || first == 1.0)
        && counted()
}

/// A column that a separator at the end of rows makes.
fn unused(numbers: &Numbers, name: &str) -> bool {
    numbers.re.is_empty() && (name.is_empty() || name.eq_ignore_ascii_case("comment"))
}

fn axis_unit(header: &header::Header, at: usize, kind: Kind, clock: bool) -> String {
    let unit = header.units[at].clone();
    match kind {
        _ if clock || !unit.is_empty() && !matches!(unit.as_str(), "sec" | "secs" | "second" | "seconds") => {
            if clock {
                "s".to_owned()
            } else {
                unit
            }
        }
        Kind::Time => "s".to_owned(),
        _ => "Hz".to_owned(),
    }
}

/// The column of the abscissa: by its name or unit; where the first column has no name, that column if it rises evenly.
fn find_axis(header: &header::Header, columns: &[Numbers], rows: usize) -> Option<(usize, Kind)> {
    let usable = |i: usize| columns[i].im.is_empty() && columns[i].re.len() == rows && ascending(&columns[i].re);
    if columns.len() < 2 {
        return None;
    }
    let named = (0..columns.len().min(3)).find_map(|i| {
        let kind = kind_of(&header.names[i], &header.units[i])?;
        usable(i).then_some((i, kind))
    });
    if named.is_some() {
        return named;
    }
    if let Some(clock) = (0..columns.len().min(2)).find(|&i| columns[i].clock && usable(i)) {
        return Some((clock, Kind::Time));
    }
    let nameless = header.names[0].is_empty() && header.units[0].is_empty();
    let counts = || counts_rows(&columns[0], "");
    (nameless && rows > 3 && usable(0) && even_step(&columns[0].re).is_some() && !counts()).then_some((0, Kind::Time))
}

fn values(numbers: Numbers) -> Values {
    if numbers.im.is_empty() {
        return Values::Real(numbers.re);
    }
    let mut im = numbers.im;
    im.resize(numbers.re.len(), 0.0);
    Values::Complex(numbers.re.into_iter().zip(im).map(|(re, im)| [re, im]).collect())
}
