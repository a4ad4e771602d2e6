//! Blocks of numbers in rows that come one by one.

use super::block::{Block, Numbers};
use super::cell::{Cell, no_number};
use super::header_line::HeaderLine;
use super::moment::date_and_time;
use super::text_columns::{self, Run};
use crate::axis::ascending;
use crate::error::{Fault, Read, one_line};

/// Most lines of a header that are kept: names and units stand right above the numbers.
const MOST_HEADER: usize = 200;
/// Most columns of a table.
const MOST_COLUMNS: usize = 20_000;

/// Most lines of single words between rows of one table.
const MOST_WORDS: usize = 5;
/// Steps of its first column from which a table does not go on, but another begins.
const MOST_LOST: f64 = 100.0;

/// Finds blocks of numbers in rows that come one by one.
#[derive(Debug, Default)]
pub(crate) struct Blocks {
    header: Vec<HeaderLine>,
    open: Option<Block>,
    done: Vec<Block>,
    gap: bool,
    /// Line of the words that ended the last block.
    torn_at: u64,
    lost_header: usize,
    /// Rows of numbers with texts in the same columns, of which it is not known yet whether they are the table.
    run: Run,
}

impl Blocks {
    /// Takes the next row; `line` is its number from 1.
    pub(crate) fn push(&mut self, line: u64, cells: &[Cell]) -> Read<()> {
        let width = cells.iter().rposition(|cell| !cell.is_empty()).map_or(0, |last| last + 1);
        let cells = &cells[..width];
        if width == 0 {
            self.gap = true;
            return Ok(());
        }
        if width > MOST_COLUMNS {
            return Err(Fault::line(line, format!("has {width} columns; at most {MOST_COLUMNS} are read")));
        }
        let words = cells.iter().filter(|cell| matches!(cell, Cell::Word(_))).count();
        if words == 0 {
            self.numbers(line, cells)?;
        } else {
            self.words(line, cells, words)?;
        }
        self.gap = false;
        Ok(())
    }

    fn numbers(&mut self, line: u64, cells: &[Cell]) -> Read<()> {
        if self.open.is_none() {
            self.pass_run();
            self.not_torn(cells)?;
        }
        if let Some(block) = &self.open
            && cells.len() > block.columns.len() + block.skip
        {
            let (found, expected) = (cells.len(), block.columns.len() + block.skip);
            if block.rows <= 1 {
                // A lone number above the table, such as a count of samples.
                self.demote();
            } else if self.gap {
                self.close();
            } else {
                return Err(Fault::line(
                    line,
                    format!(
                        "there are {found} cells and {expected} columns above; give each row one cell a column (with a decimal comma, separate the columns by semicolons)"
                    ),
                ));
            }
        }
        let header = &mut self.header;
        let block = self.open.get_or_insert_with(|| {
            let header = std::mem::take(header);
            let named = header.last().map_or(0, |line| line.cells.len());
            let width = cells.len().max(if named <= cells.len() + 64 { named } else { 0 });
            text_columns::begun(header, cells, width)
        });
        let cells = cells.get(block.skip..).unwrap_or_default();
        let row = block.rows;
        block.lines = [if row == 0 { line } else { block.lines[0] }, line];
        block.last_width = cells.len();
        for (i, column) in block.columns.iter_mut().enumerate() {
            column.push(cells.get(i).unwrap_or(&Cell::Empty), row);
        }
        block.rows += 1;
        Ok(())
    }

    fn words(&mut self, line: u64, cells: &[Cell], words: usize) -> Read<()> {
        if let Some(numbers) = self.open.as_mut().and_then(|block| text_columns::numbers_of(block, cells)) {
            return self.numbers(line, &numbers);
        }
        if let Some(block) = &self.open {
            let numbers = cells.iter().filter(|cell| cell.is_number()).count();
            let comment =
                matches!(cells.first(), Some(Cell::Word(word)) if word.starts_with(['#', '%', '!', '*', '/']));
            // Words behind the last column are remarks.
            let width = block.skip + block.columns.len();
            let remark = cells[..cells.len().min(width)].iter().all(|cell| !matches!(cell, Cell::Word(_)));
            if remark && numbers > 0 {
                let kept = cells[..width].to_vec();
                return self.numbers(line, &kept);
            }
            if numbers > 0 && numbers >= words && !self.gap && block.rows > 1 {
                let at = cells.iter().position(|cell| matches!(cell, Cell::Word(_))).unwrap_or_default();
                let Cell::Word(word) = &cells[at] else { return Ok(()) };
                return Err(Fault::line(
                    line,
                    format!("column {}: \"{}\" {}", at + 1, one_line(word, 40), no_number(word)),
                ));
            }
            if comment {
                return Ok(());
            }
            if block.rows <= 1 {
                self.demote();
            } else {
                self.torn_at = line;
                self.close();
            }
        }
        if self.open.is_none() && self.remark_behind(cells) {
            return self.numbers(line, &cells[..cells.len() - 1]);
        }
        if self.open.is_none()
            && let Some(width) = self.words_beside(cells)
        {
            return self.numbers(line, &cells[..width]);
        }
        if !self.run.takes(cells) {
            self.pass_run();
        }
        if self.run.takes(cells) {
            self.run.push(line, cells);
            if self.run.rows.len() > MOST_HEADER {
                self.open_run()?;
            }
            return Ok(());
        }
        self.remark(HeaderLine { cells: cells.iter().map(text).collect() });
        Ok(())
    }

    /// Refuses a row of numbers that goes on where the block before ended, with nothing but single words between them, such
    /// as `Overload`: taken for two tables, the record would lose all that follows.
    fn not_torn(&self, cells: &[Cell]) -> Read<()> {
        let Some(before) = self.done.last().filter(|block| block.columns.len() == cells.len() && cells.len() > 1)
        else {
            return Ok(());
        };
        let word = |line: &HeaderLine| {
            let mut words = line.cells.iter().filter(|cell| !cell.is_empty());
            let first = words.next();
            first.filter(|_| words.next().is_none()).cloned()
        };
        let words: Option<Vec<String>> = self.header.iter().map(word).collect();
        let Some(word) = words.filter(|words| words.len() <= MOST_WORDS).and_then(|words| words.into_iter().next())
        else {
            return Ok(());
        };
        let (times, Some(Cell::Real(now) | Cell::Clock(now))) = (&before.columns[0].re, cells.first()) else {
            return Ok(());
        };
        let (Some(first), Some(last)) = (times.first(), times.last()) else { return Ok(()) };
        let step = (last - first) / (times.len() as f64 - 1.0);
        let goes_on = ascending(times) && step > 0.0 && *now > *last && now - last < MOST_LOST * step;
        if !goes_on {
            return Ok(());
        }
        let word = one_line(&word, 40);
        Err(Fault::line(
            self.torn_at,
            format!(
                "\"{word}\" stands between rows of one table, which goes on below it; remove the line (and the samples on one side of it, where it says that they are wrong)"
            ),
        ))
    }

    /// Keeps a line of the header.
    fn remark(&mut self, line: HeaderLine) {
        if self.header.len() >= MOST_HEADER {
            self.header.remove(MOST_HEADER / 2);
            self.lost_header += 1;
        }
        self.header.push(line);
    }

    /// What looked like rows with texts among their numbers were lines of the header.
    fn pass_run(&mut self) {
        for (_, cells) in std::mem::take(&mut self.run).rows {
            self.remark(HeaderLine { cells: cells.iter().map(text).collect() });
        }
    }

    /// Rows with texts among their numbers are the table.
    fn open_run(&mut self) -> Read<()> {
        let run = std::mem::take(&mut self.run);
        let width = run.rows.first().map_or(0, |(_, cells)| cells.len());
        let header = std::mem::take(&mut self.header);
        let columns = vec![Numbers::default(); width];
        self.open = Some(Block { header, columns, texts: run.texts, ..Block::default() });
        for (line, cells) in run.rows {
            self.words(line, &cells, 1)?;
        }
        Ok(())
    }

    /// Whether the only word of a row stands in its last cell, under the name of a column of remarks.
    fn remark_behind(&self, cells: &[Cell]) -> bool {
        const REMARKS: [&str; 8] =
            ["comment", "comments", "kommentar", "remark", "remarks", "bemerkung", "note", "event"];
        let Some((Cell::Word(_), numbers)) = cells.split_last() else { return false };
        let named = |line: &HeaderLine| {
            line.cells.len() == cells.len()
                && line.cells.last().is_some_and(|cell| REMARKS.contains(&cell.trim().to_lowercase().as_str()))
        };
        numbers.len() > 1 && numbers.iter().all(Cell::is_number) && self.header.iter().any(named)
    }

    /// Width of the table where the words of a row of numbers stand beside it, under no name and behind an empty column.
    fn words_beside(&self, cells: &[Cell]) -> Option<usize> {
        let names = self.header.last()?;
        let first = names.cells.iter().position(|cell| !cell.is_empty())?;
        let width = names.cells.len();
        let over_all = names.cells[first..].iter().all(|cell| !cell.is_empty()) && width - first > 1;
        let full = cells.len() > width && cells[first..width].iter().all(Cell::is_number);
        let beside = cells.get(width).is_some_and(Cell::is_empty);
        (over_all && full && beside).then_some(width)
    }

    /// What looked like a block of one row was a line of the header.
    fn demote(&mut self) {
        let Some(block) = self.open.take() else { return };
        self.header = block.header;
        let cells = block.columns.iter().map(|column| column.re.first().map_or_else(String::new, ToString::to_string));
        self.header.push(HeaderLine { cells: cells.collect() });
    }

    fn close(&mut self) {
        self.done.extend(self.open.take());
    }

    /// Blocks in the order of the file, and the lines that follow the last.
    pub(crate) fn finish(mut self) -> (Vec<Block>, usize) {
        self.close();
        if self.done.is_empty() && self.run.rows.len() >= text_columns::FEWEST && self.open_run().is_ok() {
            self.close();
        }
        (self.done, self.header.len() + self.lost_header)
    }
}

fn text(cell: &Cell) -> String {
    match cell {
        Cell::Empty => String::new(),
        Cell::Real(value) => value.to_string(),
        Cell::Clock(value) => date_and_time(*value),
        Cell::Complex([re, im]) => format!("{re}{im:+}j"),
        Cell::Word(word) => word.clone(),
        Cell::Span(_, text) => text.to_string(),
    }
}
