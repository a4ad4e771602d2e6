//! Names, units and the sampling rate out of the lines above a block of numbers.

use super::header_line::{COMMENT_WORDS, HeaderLine, label, uncommented};
use super::number::number;
use super::sampling::{step, step_below};
use crate::axis::kind_of;
use crate::parts::words::is_bare_part;
use crate::units::{is_unit, split, stripped};

/// What a header says.
#[derive(Debug, Default)]
pub(crate) struct Header {
    /// Names of the columns, empty where there is none.
    pub names: Vec<String>,
    /// Units of the columns.
    pub units: Vec<String>,
    /// Time between samples, s, where a line says it.
    pub step: Option<f64>,
    /// Sensitivities of the columns, where a row says them.
    pub sensitivities: Vec<String>,
    /// The lines that are neither names nor units.
    pub remarks: Vec<String>,
}

const NAME_WORDS: [&str; 15] = [
    "source",
    "trace",
    "name",
    "names",
    "channel",
    "channels",
    "kanal",
    "signal",
    "channel name",
    "channel_name",
    "kanalname",
    "point",
    "point id",
    "dof",
    "dofs",
];
const UNIT_WORDS: [&str; 11] = [
    "unit",
    "units",
    "einheit",
    "einheiten",
    "y_unit",
    "y unit",
    "y_unit_label",
    "y axis unit",
    "y-axis unit",
    "ordinate unit",
    "vertical units",
];
const AXIS_UNIT_WORDS: [&str; 6] =
    ["x unit", "x_unit", "x axis unit", "x-axis unit", "abscissa unit", "horizontal units"];
const SENSITIVITY_WORDS: [&str; 5] = ["sensitivity", "sensitivities", "sens.", "empfindlichkeit", "sensibilità"];

/// Most rows between units and numbers, or between names and units.
const MOST_BELOW: usize = 8;

/// Reads the header of a block of `width` columns.
pub(crate) fn read(lines: &[HeaderLine], width: usize) -> Header {
    let lines: Vec<HeaderLine> = lines.iter().map(|line| words_of_comment(line, width)).collect();
    let lines = lines.as_slice();
    let Some((parts, lines)) = parts_beside_names(lines, width) else { return rows(lines, width) };
    let mut header = rows(&lines, width);
    for (c, (name, part)) in header.names.iter_mut().zip(&parts.cells).enumerate() {
        let (own, unit) = split(part);
        if c == 0 && kind_of(&own, &unit).is_some() {
            // The row of the parts names the abscissa itself: what stands above it is no name of it.
            *name = own;
            header.units[0] = if unit.is_empty() { std::mem::take(&mut header.units[0]) } else { unit };
        } else if !part.trim().is_empty() {
            *name = format!("{name} {}", part.trim()).trim().to_owned();
        }
    }
    header
}

/// A comment of as many words as there are columns is a row of them, though numbers are separated otherwise.
fn words_of_comment(line: &HeaderLine, width: usize) -> HeaderLine {
    let [cell] = &line.cells[..] else { return line.clone() };
    let words: Vec<String> = uncommented(cell).split_whitespace().map(str::to_owned).collect();
    let commented = uncommented(cell) != cell.trim();
    // `# Unit : m/s²/N` is a remark of its own.
    let remark = words.iter().any(|word| matches!(word.as_str(), ":" | "="));
    if commented && width > 1 && words.len() == width && !remark { HeaderLine { cells: words } } else { line.clone() }
}

/// A row of `Real`, `Imag` (or `Mag [g/N]`, `Phase [deg]`) beside names that stand once over both: the row, and the other lines
/// with the names over every column.
fn parts_beside_names(lines: &[HeaderLine], width: usize) -> Option<(HeaderLine, Vec<HeaderLine>)> {
    let is_parts = |line: &HeaderLine| {
        let mut distinct: Vec<String> =
            line.cells.iter().filter(|cell| is_bare_part(cell)).map(|c| c.to_lowercase()).collect();
        distinct.sort_unstable();
        distinct.dedup();
        if distinct.len() < 2 {
            return false;
        }
        let parts = line.cells.iter().filter(|cell| is_bare_part(cell)).count();
        parts > 1 && 2 * parts > line.cells.iter().filter(|cell| !cell.is_empty()).count()
    };
    let at = lines.iter().rposition(is_parts).filter(|_| width > 2)?;
    let named = |i: &usize| {
        let i = *i;
        let filled = lines[i].cells.iter().filter(|cell| !cell.is_empty()).count();
        // `Signal:` in front of a text is a label, no name over columns, and so is what stands before nothing but a unit.
        let only_units = lines[i].cells[1..].iter().filter(|cell| !cell.is_empty()).all(|cell| is_unit(cell));
        let labels = lines[i].cells[0].trim_end().ends_with([':', '=']) || only_units;
        lines[i].cells.len() > 1
            && fits(&lines[i].cells, width)
            && filled > 1
            && !labels
            && !units_row(&lines[i].cells)
            && lines[i].cells.len() + 2 > width
    };
    // Testlab has its names below the parts.
    let above = (at.saturating_sub(2)..at).rev().find(named);
    let names = above.or_else(|| (at + 1..lines.len()).find(named))?;
    let mut parts = lines[at].clone();
    if above.is_none()
        && let Some(first) = parts.cells.first_mut()
    {
        // The spacing of the abscissa, such as `Linear`.
        first.clear();
    }
    let mut others = lines.to_vec();
    let cells = &mut others[names].cells;
    cells.resize(width, String::new());
    for c in 1..width {
        if is_bare_part(parts.cells.get(c).map_or("", String::as_str)) {
            if cells[c].is_empty() {
                cells[c] = cells[c - 1].clone();
            }
        } else if let Some(cell) = parts.cells.get_mut(c).filter(|cell| is_unit(cell)) {
            cell.clear();
        }
    }
    // The word that labels a row of names is no name of the abscissa, and what the first column says there is its unit.
    if NAME_WORDS.contains(&label(&others[names].cells[0]).as_str()) {
        others[names].cells[0].clear();
    }
    let first = parts.cells.first_mut()?;
    if is_unit(first) && split(&others[names].cells[0]).1.is_empty() {
        others[names].cells[0] = format!("{} [{first}]", others[names].cells[0]).trim().to_owned();
        first.clear();
    }
    others.remove(at);
    Some((parts, others))
}

fn rows(lines: &[HeaderLine], width: usize) -> Header {
    let mut header =
        Header { names: vec![String::new(); width], units: vec![String::new(); width], ..Header::default() };
    let labelled = |words: &[&str]| {
        lines
            .iter()
            .rposition(|line| width > 1 && line.cells.len() > 1 && words.contains(&label(&line.cells[0]).as_str()))
    };
    // A row of names must fill the table; `Channel;7` above a table of three columns is a remark.
    let full = |at: &usize| lines[*at].cells.len() >= width.min(3);
    let (names, units) = match labelled(&UNIT_WORDS).filter(full) {
        Some(units) => (labelled(&NAME_WORDS).filter(full).or_else(|| units.checked_sub(1)), Some(units)),
        None => unlabelled(lines, width),
    };
    if let Some(at) = names {
        header.take_names(&lines[at].cells, units.is_none());
        // The word that labels the row is no name of the first column.
        if width > 1 && NAME_WORDS.contains(&label(&lines[at].cells[0]).as_str()) {
            header.names[0].clear();
        }
    }
    if let Some(at) = units {
        header.take_units(&lines[at].cells);
    }
    if let Some(above) = names.and_then(|at| at.checked_sub(1)).filter(|above| Some(*above) != units) {
        header.tell_apart(&lines[above].cells);
    }
    if let Some(at) = labelled(&SENSITIVITY_WORDS) {
        header.sensitivities = lines[at].cells.iter().map(|cell| uncommented(cell).to_owned()).collect();
    }
    header.units_behind_names();
    header.comments(names.and_then(|at| lines.get(at + 1)));
    if let Some(at) = labelled(&AXIS_UNIT_WORDS).filter(|_| header.units[0].is_empty()) {
        stripped(&lines[at].cells[1]).clone_into(&mut header.units[0]);
    }
    header.step = step_below(lines);
    if let Some(unit) = lines.iter().find_map(|line| unit_of_functions(&line.cells)) {
        header.take_unit_of_functions(&unit);
    }
    let used = |i: &usize| Some(*i) != names && Some(*i) != units;
    for line in (0..lines.len()).filter(used).map(|i| &lines[i]) {
        header.step = header.step.or_else(|| step(&line.cells));
        header.remarks.push(line.cells.join(" ").trim().to_owned());
    }
    header
}

/// The unit of all functions out of a line such as `Amplitude unit: (m/s²)/N`.
fn unit_of_functions(cells: &[String]) -> Option<String> {
    let line = cells.join("\t");
    let (front, rest) = line.split_once([':', '=', '\t'])?;
    let words =
        ["amplitude unit", "y-axis unit", "y axis unit", "y unit", "ordinate unit", "frf unit", "amplitudeneinheit"];
    let rest = rest.trim().split(['\t', ';', ',']).next()?.split("  ").next()?.trim();
    let unit = stripped(rest);
    let front = label(front);
    ((front == "unit" || words.contains(&front.as_str())) && unit.contains('/') && is_unit(unit))
        .then(|| unit.to_owned())
}

/// Rows of names and units by their place right above the numbers.
fn unlabelled(lines: &[HeaderLine], width: usize) -> (Option<usize>, Option<usize>) {
    // `X-Axis:` in front of its texts is a line of its own, no row over the columns.
    let labels = |i: usize| width > 1 && lines[i].cells[0].trim_end().ends_with(':');
    let wide = |i: &usize| lines[*i].cells.len() >= width.saturating_sub(width / 4).max(1) && !labels(*i);
    let Some(last) = (0..lines.len()).rev().find(wide) else { return (None, None) };
    let above = last.checked_sub(1).filter(wide);
    if units_row(&lines[last].cells) {
        return (names_above(lines, last, width).or(above), Some(last));
    }
    // Further rows, such as sensors and comments, between the units and the numbers.
    let lower = last.saturating_sub(MOST_BELOW)..last;
    if let Some(units) = lower.rev().find(|i| wide(i) && units_row(&lines[*i].cells))
        && (above != Some(units) || same_throughout(&lines[last].cells))
        && let Some(names) = names_above(lines, units, width)
    {
        return (Some(names), Some(units));
    }
    // Comments on the channels below their names.
    if COMMENT_WORDS.contains(&label(&lines[last].cells[0]).as_str())
        && let Some(names) = above.filter(|&at| kind_of_cell(&lines[at].cells[0]))
    {
        return (Some(names), None);
    }
    // Units above the names.
    match above.filter(|&at| units_row(&lines[at].cells)) {
        Some(at) => (Some(last), Some(at)),
        None => (Some(last), None),
    }
}

/// Whether a cell names an abscissa, with or without its unit.
fn kind_of_cell(cell: &str) -> bool {
    let (name, unit) = split(uncommented(cell));
    kind_of(&name, &unit).is_some()
}

/// Whether a row has no more words than there are columns; one that has says something else.
fn fits(cells: &[String], width: usize) -> bool {
    cells.iter().rposition(|cell| !cell.trim().is_empty()).is_none_or(|last| last < width)
}

/// Whether a row says the same of all columns, such as the time of their start: it holds no names.
fn same_throughout(cells: &[String]) -> bool {
    cells.len() > 1 && !cells[0].trim().is_empty() && cells.iter().all(|cell| *cell == cells[0])
}

/// The nearest wide row above a row of units whose names tell the columns apart.
fn names_above(lines: &[HeaderLine], units: usize, width: usize) -> Option<usize> {
    let distinct = |cells: &[String]| {
        let mut names: Vec<&String> = cells.iter().skip(1).filter(|cell| !cell.is_empty()).collect();
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        names.len() == count
            && count + 1 >= width.saturating_sub(width / 4)
            && !names.iter().any(|name| is_bare_part(name))
    };
    let near = units.saturating_sub(MOST_BELOW)..units;
    near.rev().find(|&i| !units_row(&lines[i].cells) && fits(&lines[i].cells, width) && distinct(&lines[i].cells))
}

/// Whether most of the cells of a row are units.
fn units_row(cells: &[String]) -> bool {
    // Numbers behind the units are values of what stands above them.
    let end =
        cells.iter().rposition(|cell| !cell.is_empty() && number(cell, false).is_none()).map_or(0, |last| last + 1);
    let filled: Vec<&String> = cells[..end].iter().filter(|cell| !cell.is_empty()).collect();
    let bracketed = |cell: &String| stripped(uncommented(cell)) != uncommented(cell);
    let units = filled.iter().filter(|cell| is_unit(uncommented(cell)) || bracketed(cell)).count();
    !filled.is_empty()
        && 2 * units > filled.len()
        && filled.iter().any(|cell| is_unit(uncommented(cell)) || bracketed(cell))
}

impl Header {
    fn take_names(&mut self, cells: &[String], with_units: bool) {
        for (i, cell) in cells.iter().take(self.names.len()).enumerate() {
            let text = if i == 0 { uncommented(cell) } else { cell.trim() };
            let (name, unit) = split(text);
            if with_units || !unit.is_empty() {
                (self.names[i], self.units[i]) = (name, unit);
            } else {
                text.clone_into(&mut self.names[i]);
            }
        }
    }

    /// Names that stand several times get those above them in front: `Y`, `Y` under `Force`, `Acc`.
    fn tell_apart(&mut self, above: &[String]) {
        let twice = |name: &String| !name.is_empty() && self.names.iter().filter(|other| *other == name).count() > 1;
        let again: Vec<bool> = (0..self.names.len())
            .map(|c| twice(&self.names[c]) && kind_of(&self.names[c], &self.units[c]).is_none())
            .collect();
        if !again.contains(&true) || above.len() < 2 {
            return;
        }
        let mut last = "";
        for (c, name) in self.names.iter_mut().enumerate() {
            last = above.get(c).map(|cell| cell.trim()).filter(|cell| !cell.is_empty()).unwrap_or(last);
            if again[c] && !last.is_empty() {
                *name = if name.eq_ignore_ascii_case("y") { last.to_owned() } else { format!("{last} {name}") };
            }
        }
    }

    fn take_units(&mut self, cells: &[String]) {
        for (i, cell) in cells.iter().take(self.units.len()).enumerate() {
            let unit = stripped(uncommented(cell));
            if UNIT_WORDS.contains(&label(cell).as_str()) {
                continue;
            }
            unit.clone_into(&mut self.units[i]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(text: &[&str]) -> Vec<HeaderLine> {
        text.iter().map(|line| HeaderLine { cells: line.split(';').map(str::to_owned).collect() }).collect()
    }

    #[test]
    fn a_row_of_units_stands_below_the_names() {
        let header = read(&lines(&["Test 7", "Time;Acc 1;Acc 2", "s;m/s^2;g"]), 3);
        assert_eq!((header.names.join(","), header.units.join(",")), ("Time,Acc 1,Acc 2".into(), "s,m/s^2,g".into()));
        assert_eq!(header.remarks, ["Test 7"]);
    }

    #[test]
    fn labelled_rows_are_found_in_deep_headers() {
        let header = read(&lines(&["Channel;A1;A2", "Unit;g;N", "Serial;12;13"]), 3);
        assert_eq!((header.names[1].as_str(), header.units[2].as_str()), ("A1", "N"));
    }

    #[test]
    fn names_and_units_stand_further_up_or_once_over_two_columns() {
        let titles = |text: &[&str], width| {
            let header = read(&lines(text), width);
            (header.names.join(","), header.units.join(","))
        };
        let catman = [
            "Zeit;Kraft;Acc_1",
            "s;N;g",
            "Kommentar;;",
            "Sample rate=1;Sample rate=1;Sample rate=1",
            "SensorType=;U9C;B12",
        ];
        assert_eq!(titles(&catman, 3), ("Zeit,Kraft,Acc_1".into(), "s,N,g".into()));
        assert_eq!(
            titles(&["Zeit;Kraft;Acc", "s;N;g", "at 11:58;at 11:58;at 11:58"], 3),
            ("Zeit,Kraft,Acc".into(), "s,N,g".into())
        );
        assert_eq!(titles(&["Force;;Acc;", "X [s];Y [N];X [s];Y [g]"], 4), ("X,Force,X,Acc".into(), "s,N,s,g".into()));
        assert_eq!(titles(&["t/s;F/N;s/µm"], 3), ("t,F,s".into(), "s,N,µm".into()));
        assert_eq!(titles(&["time_s;force_N;acc_mg"], 3), ("time_s,force_N,acc_mg".into(), "s,N,mg".into()));
        let header = read(&lines(&["Channel;Time;Force", "Unit;s;mV", "Sensitivity;;22.5 mV/N"]), 3);
        assert_eq!(header.sensitivities[2], "22.5 mV/N");
    }

    #[test]
    fn parts_stand_below_names_over_both() {
        let header = read(&lines(&["Frequency;Point 1;;Point 2", "Hz;Real;Imag;Real;Imag"]), 5);
        let names = "Frequency,Point 1 Real,Point 1 Imag,Point 2 Real,Point 2 Imag";
        assert_eq!((header.names.join(",").as_str(), header.units[0].as_str()), (names, "Hz"));
        let header = read(&lines(&["f;H11;H11", "[Hz];[m/s²/N];[m/s²/N]", "-;Re;Im"]), 3);
        assert_eq!((header.names[2].as_str(), header.units[2].as_str()), ("H11 Im", "m/s²/N"));
        let header = read(&lines(&["Point;Beam:1;Direction;+Z", "Frequency;Real;Imag", "Hz;g/N;g/N"]), 3);
        assert_eq!((header.names.join(",").as_str(), header.units[2].as_str()), ("Frequency,Real,Imag", "g/N"));
        let said = ["X-axis unit;Hz", "Y-axis unit;(m/s²)/N", "Frequency [Hz];Real;Imaginary"];
        let header = read(&lines(&said), 3);
        assert_eq!((header.names[0].as_str(), header.units[0].as_str()), ("Frequency", "Hz"));
        let header = read(&lines(&["# Type : FRF H1", "# Unit : m/s²/N", "# X Axis : Hz", "Frequency;Real;Imag"]), 3);
        assert_eq!((header.names.join(",").as_str(), header.units[2].as_str()), ("Frequency,Real,Imag", "m/s²/N"));
    }
}
