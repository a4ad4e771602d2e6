//! Columns of texts beside those of numbers: the state of a machine, the time in a form that is not understood; and what
//! oscilloscopes write in front of the first rows of their samples.
//!
//! ```text
//! Time,State,Force [N]            Record Length,2500,,-0.5,0.12
//! 0.000,ok,1.25                   Sample Interval,0.001,,-0.499,0.14
//! 0.001,ok,1.31                   ,,,-0.498,0.15
//! ```

use super::block::{Block, Numbers};
use super::cell::Cell;
use super::header_line::HeaderLine;
use super::number::number;

/// Fewest rows of a table with a column of texts.
pub(crate) const FEWEST: usize = 4;

/// Rows one after the other that hold texts in the same columns and numbers in all others.
#[derive(Debug, Default)]
pub(super) struct Run {
    pub texts: Vec<usize>,
    pub rows: Vec<(u64, Vec<Cell>)>,
}

/// Columns of the texts of a row that has two numbers at least.
pub(crate) fn texts_of(cells: &[Cell]) -> Option<Vec<usize>> {
    let texts: Vec<usize> = (0..cells.len()).filter(|&i| matches!(cells[i], Cell::Word(_))).collect();
    let numbers = cells.iter().filter(|cell| cell.is_number()).count();
    (!texts.is_empty() && numbers > 1).then_some(texts)
}

impl Run {
    /// Whether a row goes on with the run, or begins it.
    pub(super) fn takes(&self, cells: &[Cell]) -> bool {
        let texts = texts_of(cells);
        match self.rows.first() {
            Some((_, first)) => first.len() == cells.len() && texts.as_ref() == Some(&self.texts),
            None => texts.is_some(),
        }
    }

    pub(super) fn push(&mut self, line: u64, cells: &[Cell]) {
        if let Some(texts) = texts_of(cells) {
            self.texts = texts;
            self.rows.push((line, cells.to_vec()));
        }
    }
}

/// The numbers of a row of an open block: without its texts where these stand in columns of texts, without what is said of the
/// table in front of them, which becomes a line of its header. None where words stand elsewhere.
pub(super) fn numbers_of(block: &mut Block, cells: &[Cell]) -> Option<Vec<Cell>> {
    let is_word = |cell: &Cell| matches!(cell, Cell::Word(_));
    if block.skip > 0 {
        let (front, own) = cells.split_at_checked(block.skip)?;
        if own.is_empty() || own.iter().any(is_word) {
            return None;
        }
        block.header.push(said(front));
        return Some([vec![Cell::Empty; block.skip], own.to_vec()].concat());
    }
    let among = |i: usize| block.texts.binary_search(&i).is_ok();
    if block.texts.is_empty() || !(0..cells.len()).all(|i| among(i) || !is_word(&cells[i])) {
        return None;
    }
    let own = (0..cells.len()).map(|i| if among(i) { Cell::Empty } else { cells[i].clone() });
    Some(own.collect())
}

/// The block that begins with a row of numbers. Where these stand behind empty cells, lines above that have texts there and numbers
/// below its own are its first rows.
pub(super) fn begun(mut header: Vec<HeaderLine>, cells: &[Cell], width: usize) -> Block {
    let skip = cells.iter().position(|cell| !cell.is_empty()).unwrap_or(0);
    let row = |line: &HeaderLine| -> Option<Vec<f64>> {
        let own = line.cells.get(skip..).filter(|own| own.len() == cells.len() - skip)?;
        own.iter().map(|cell| number(cell, false)).collect()
    };
    let first = header.iter().rposition(|line| row(line).is_none()).map_or(0, |last| last + 1);
    if skip == 0 || first == header.len() {
        return Block { header, columns: vec![Numbers::default(); width], ..Block::default() };
    }
    let mut columns = vec![Numbers::default(); cells.len() - skip];
    for line in &mut header[first..] {
        for (column, value) in columns.iter_mut().zip(row(line).unwrap_or_default()) {
            column.re.push(value);
        }
        line.cells.truncate(skip);
    }
    Block { rows: header.len() - first, header, columns, skip, ..Block::default() }
}

/// What stands in front of a table, without empty cells behind it.
fn said(front: &[Cell]) -> HeaderLine {
    let text = |cell: &Cell| match cell {
        Cell::Word(word) => word.clone(),
        Cell::Real(value) => value.to_string(),
        _ => String::new(),
    };
    let end = front.iter().rposition(|cell| !cell.is_empty()).map_or(0, |last| last + 1);
    HeaderLine { cells: front[..end].iter().map(text).collect() }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use crate::contents::Contents;
    use crate::text;
    use uff::Values;

    fn of(table: &str) -> (Contents, Vec<Vec<f64>>) {
        let (contents, source) = text::read(table.as_bytes()).unwrap();
        let channels = 0..contents.sets[0].channels.len();
        let values = channels.map(|c| match source.read(0, c).unwrap() {
            Values::Real(values) => values,
            Values::Complex(_) => Vec::new(),
        });
        let values = values.collect();
        (contents, values)
    }

    /// A column of texts is no channel and no end of the table, wherever it stands; that is said.
    #[test]
    fn a_column_of_texts_is_passed_over() {
        let heads = ["Time [s],State,Force [N]", "State,Time [s],Force [N]", "Time [s],Force [N],State"];
        let rows = [("{t},ok,{f}"), ("idle,{t},{f}"), ("{t},{f},at rest")];
        for (head, row) in heads.iter().zip(rows) {
            let row =
                |i: i32| row.replace("{t}", &format!("{}", f64::from(i) * 0.5)).replace("{f}", &format!("{i}.25"));
            let table = format!("{head}\n{}", (0..6).map(|i| row(i) + "\n").collect::<String>());
            let (contents, values) = of(&table);
            let names: Vec<&str> = contents.sets[0].channels.iter().map(|channel| channel.name.as_str()).collect();
            assert_eq!((names, values[0].len(), values[0][5]), (vec!["Force"], 6, 5.25), "{table}");
            let told = contents.sets[0].notes.iter().any(|note| note.text.contains("\"State\" holds texts"));
            assert!(told, "{:?}", contents.sets[0].notes);
        }
    }

    /// Lines of a header with numbers for every channel are none of its rows, though they are alike.
    #[test]
    fn lines_of_a_header_stay_above_the_table() {
        let more = "Offset,0.5,1.5\nGain,1,2\nRange,10,20\nLowest,-1,-2\nHighest,1,2\n";
        let (contents, values) =
            of(&format!("Name,Force [N],Acc [g]\n{more}0,1.5,2.5\n1,2.5,3.5\n2,3.5,4.5\n3,4.5,5.5\n"));
        assert_eq!((contents.sets.len(), values.last().unwrap().len()), (1, 4));
    }

    /// What an oscilloscope writes in front of the first samples takes none of these away.
    #[test]
    fn samples_beside_what_is_said_of_them_are_kept() {
        let front = ["Record Length,6,", "Sample Interval,0.5,", "Trigger Point,0,", ",,", "Source,CH1,", ",,"];
        let rows = front.iter().enumerate().map(|(i, front)| format!("{front},{},{i}.5,\n", 0.5 * i as f64));
        let (contents, values) = of(&rows.collect::<String>());
        assert_eq!(values, [vec![0.5, 1.5, 2.5, 3.5, 4.5, 5.5]]);
        assert_eq!(contents.sets[0].channels[0].axis.step(), Some(0.5));
        assert_eq!(contents.sets[0].channels[0].name, "CH1");
    }
}
