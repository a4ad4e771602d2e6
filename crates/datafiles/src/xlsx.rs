//! Spreadsheets (`.xlsx`): each sheet is a table. Cells are streamed, so that a lone cell in the last row costs nothing.

use crate::contents::{Contents, Format};
use crate::error::{Fault, Read};
use crate::source::Source;
use crate::table::{Block, Blocks, Cell, TableSource, finish};
use calamine::{DataRef, Reader, Xlsx};
use std::io::{Read as Bytes, Seek};

/// Most cells of a sheet that are read.
const MOST_CELLS: usize = 200_000_000;
/// Furthest column that is read.
const LAST_COLUMN: u32 = 20_000;

/// Opens a spreadsheet.
pub(crate) fn open(reader: impl Bytes + Seek) -> Read<(Contents, Box<dyn Source>)> {
    let wrong =
        |error: calamine::XlsxError| Fault::new(format!("is no readable spreadsheet ({error}); save it again as XLSX"));
    let mut book: Xlsx<_> = Xlsx::new(reader).map_err(wrong)?;
    let mut contents = Contents::new(Format::Xlsx);
    let mut sources = Vec::new();
    for name in book.sheet_names() {
        let within = |fault: Fault| fault.within(format!("sheet \"{name}\""));
        let mut cells = match book.worksheet_cells_reader(&name) {
            Ok(cells) => cells,
            Err(calamine::XlsxError::NotAWorksheet(what)) => {
                contents.notes.push(format!("sheet \"{name}\" is a {what} and was passed over").into());
                continue;
            }
            Err(error) => return Err(within(wrong(error))),
        };
        let mut rows = Rows::default();
        while let Some(next) = cells.next_cell().map_err(|error| within(wrong(error)))? {
            let (row, column) = next.get_position();
            rows.take(row, column, value(next.get_value())).map_err(within)?;
        }
        let (blocks, _) = rows.finish().map_err(within)?;
        if blocks.is_empty() {
            contents.notes.push(format!("sheet \"{name}\" has no row of numbers and was passed over").into());
        }
        let (sets, columns) = finish(&name, blocks);
        contents.sets.extend(sets);
        sources.extend(columns);
    }
    if contents.sets.is_empty() {
        return Err(Fault::new("no sheet has a row of numbers; save the measurement with its samples"));
    }
    Ok((contents, Box::new(TableSource { sets: sources })))
}

/// Gathers cells into rows.
#[derive(Default)]
struct Rows {
    blocks: Blocks,
    row: Option<u32>,
    cells: Vec<Cell>,
    count: usize,
}

impl Rows {
    fn take(&mut self, row: u32, column: u32, cell: Cell) -> Read<()> {
        if cell.is_empty() {
            return Ok(());
        }
        if self.row != Some(row) {
            if self.row.is_some_and(|before| row < before) {
                return Err(Fault::line(u64::from(row) + 1, "the rows are not in their order; save the sheet again"));
            }
            // Rows that are not there are blank.
            let blank = self.row.is_some_and(|before| row > before + 1);
            self.flush()?;
            if blank {
                self.blocks.push(u64::from(row), &[])?;
            }
            self.row = Some(row);
        }
        self.count += 1;
        if column > LAST_COLUMN || self.count > MOST_CELLS {
            return Err(Fault::line(u64::from(row) + 1, "has too many cells to be read; save the measurement alone"));
        }
        self.cells.resize(self.cells.len().max(column as usize + 1), Cell::Empty);
        self.cells[column as usize] = cell;
        Ok(())
    }

    fn flush(&mut self) -> Read<()> {
        if let Some(row) = self.row {
            self.blocks.push(u64::from(row) + 1, &self.cells)?;
        }
        self.cells.clear();
        Ok(())
    }

    fn finish(mut self) -> Read<(Vec<Block>, usize)> {
        self.flush()?;
        Ok(self.blocks.finish())
    }
}

fn value(data: &DataRef<'_>) -> Cell {
    match data {
        DataRef::Int(value) => Cell::Real(*value as f64),
        DataRef::Float(value) => Cell::Real(*value),
        DataRef::String(text) => word(text),
        DataRef::SharedString(text) => word(text),
        DataRef::Bool(value) => Cell::Real(f64::from(u8::from(*value))),
        DataRef::DateTime(date) => Cell::Clock(since_1970(date.as_f64()) * 86400.0),
        DataRef::DateTimeIso(text) | DataRef::DurationIso(text) => word(text),
        DataRef::Error(_) => Cell::Real(f64::NAN),
        DataRef::Empty => Cell::Empty,
    }
}

/// Days since 1970 of days since 1900; a span of time as it is.
fn since_1970(days: f64) -> f64 {
    // No test lasts 55 years: what is longer is a date.
    if days < 20_000.0 { days } else { days - 25_569.0 }
}

/// Text of a cell; numbers that were stored as text count as numbers.
fn word(text: &str) -> Cell {
    match Cell::parse(text, false) {
        Cell::Word(_) => Cell::parse(text, true),
        other => other,
    }
}
