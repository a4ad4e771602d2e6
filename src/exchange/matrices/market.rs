//! Matrix Market files (`.mtx`): `coordinate` or `array`, `real` or `integer`, `general` or `symmetric`.
//!
//! Indices count from 1; `array` lists columns one after the other, of a symmetric matrix their lower triangle only.

use super::error::{TableError, TableProblem, number, quote};
use crate::structure::MOST_DOFS;
use faer::Mat;

/// Reads a square matrix from the text of a file called `file` in messages.
pub fn parse_market(text: &str, file: &str) -> Result<Mat<f64>, TableError> {
    let mut lines = text.lines().enumerate().map(|(i, line)| (i + 1, line.trim()));
    let (coordinate, symmetric) =
        banner(lines.next().map_or("", |(_, line)| line)).map_err(|problem| TableError::line(file, 1, problem))?;
    let mut rest = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('%'));
    let (at, sizes) = rest.next().ok_or_else(|| TableError::file(file, TableProblem::Empty))?;
    let (n, entries) = size(sizes, coordinate, symmetric).map_err(|problem| TableError::line(file, at, problem))?;
    // A number and its separator take two bytes: a header alone asks for no memory.
    if !coordinate && entries > text.len() / 2 + 1 {
        let found = rest.flat_map(|(_, line)| line.split_whitespace()).count();
        return Err(TableError::file(file, TableProblem::Count { found, expected: entries }));
    }
    let mut builder = Builder { matrix: Mat::zeros(n, n), symmetric, seen: vec![false; n * n] };
    let mut cursor = if n == 0 { None } else { Some((0, 0)) };
    let mut found = 0;
    for (at, line) in rest {
        let wrong = |problem| TableError::line(file, at, problem);
        if coordinate {
            builder.coordinate(line).map_err(wrong)?;
            found += 1;
        } else {
            for word in line.split_whitespace() {
                let (row, column) =
                    cursor.ok_or_else(|| wrong(TableProblem::Count { found: found + 1, expected: entries }))?;
                builder.set(row, column, number(word).map_err(wrong)?);
                cursor = next(row, column, n, symmetric);
                found += 1;
            }
        }
        if found > entries {
            return Err(wrong(TableProblem::Count { found, expected: entries }));
        }
    }
    if found != entries {
        return Err(TableError::file(file, TableProblem::Count { found, expected: entries }));
    }
    Ok(builder.matrix)
}

/// Whether the file is `coordinate` and whether it is `symmetric`.
pub(super) fn banner(line: &str) -> Result<(bool, bool), TableProblem> {
    let lower = line.to_lowercase();
    let words: Vec<&str> = lower.split_whitespace().collect();
    let ["%%matrixmarket", "matrix", layout, field, symmetry] = words[..] else {
        return Err(TableProblem::NoBanner { found: quote(line) });
    };
    let refuse = |found: &str, allowed| TableProblem::NotRead { found: quote(found), allowed };
    let coordinate = match layout {
        "coordinate" => true,
        "array" => false,
        other => return Err(refuse(other, "coordinate or array")),
    };
    if !["real", "integer", "double"].contains(&field) {
        return Err(refuse(field, "real or integer"));
    }
    match symmetry {
        "general" => Ok((coordinate, false)),
        "symmetric" => Ok((coordinate, true)),
        other => Err(refuse(other, "general or symmetric")),
    }
}

/// Rows of the square matrix, and the number of entries that follow.
fn size(line: &str, coordinate: bool, symmetric: bool) -> Result<(usize, usize), TableProblem> {
    size_below(line, coordinate, symmetric, MOST_DOFS)
}

/// [`size`] with another limit of the number of rows.
pub(super) fn size_below(
    line: &str,
    coordinate: bool,
    symmetric: bool,
    most: usize,
) -> Result<(usize, usize), TableProblem> {
    let expected = if coordinate { "rows, columns and entries" } else { "rows and columns" };
    let bad = || TableProblem::BadSize { expected, found: quote(line) };
    let sizes = line.split_whitespace().map(str::parse).collect::<Result<Vec<usize>, _>>().map_err(|_| bad())?;
    let (rows, columns, entries) = match (coordinate, &sizes[..]) {
        (true, &[rows, columns, entries]) => (rows, columns, Some(entries)),
        (false, &[rows, columns]) => (rows, columns, None),
        _ => return Err(bad()),
    };
    if rows != columns {
        return Err(TableProblem::NotSquare { rows, columns });
    }
    if rows > most {
        return Err(TableProblem::TooLarge { rows, most });
    }
    if rows == 0 {
        return Err(TableProblem::Empty);
    }
    Ok((rows, entries.unwrap_or(if symmetric { rows * (rows + 1) / 2 } else { rows * rows })))
}

/// The place after (row, column) in the order of an `array`, while there is one.
fn next(row: usize, column: usize, n: usize, symmetric: bool) -> Option<(usize, usize)> {
    if row + 1 < n {
        return Some((row + 1, column));
    }
    (column + 1 < n).then(|| (if symmetric { column + 1 } else { 0 }, column + 1))
}

struct Builder {
    matrix: Mat<f64>,
    symmetric: bool,
    seen: Vec<bool>,
}

impl Builder {
    fn set(&mut self, row: usize, column: usize, value: f64) {
        self.matrix[(row, column)] = value;
        if self.symmetric {
            self.matrix[(column, row)] = value;
        }
    }

    fn coordinate(&mut self, line: &str) -> Result<(), TableProblem> {
        let bad = || TableProblem::BadEntry { expected: "row column value", found: quote(line) };
        let words: Vec<&str> = line.split_whitespace().collect();
        let [row, column, value] = words[..] else { return Err(bad()) };
        let (row, column): (usize, usize) = (row.parse().map_err(|_| bad())?, column.parse().map_err(|_| bad())?);
        let size = self.matrix.nrows();
        if row == 0 || column == 0 || row > size || column > size {
            return Err(TableProblem::Outside { row, column, size });
        }
        if self.symmetric && column > row {
            return Err(TableProblem::AboveDiagonal { row, column });
        }
        if std::mem::replace(&mut self.seen[(row - 1) * size + column - 1], true) {
            return Err(TableProblem::EntryTwice { row, column });
        }
        self.set(row - 1, column - 1, number(value)?);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use faer::mat;

    #[test]
    fn both_layouts_and_symmetries() {
        let expected = mat![[2.0, -1.5], [-1.5, 3e-3]];
        for text in [
            "%%MatrixMarket matrix coordinate real symmetric\n% a comment\n\n2 2 3\n1 1 2\n2 1 -1.5\n2 2 3.0E-3\n",
            "%%MatrixMarket matrix coordinate real general\r\n2 2 4\r\n1 1 2\r\n2 1 -1.5\r\n1 2 -1.5\r\n2 2 3.0D-3\r\n",
            "%%MatrixMarket matrix array real symmetric\n2 2\n2\n-1.5\n3e-3\n",
            "%%matrixmarket MATRIX array real general\n2 2\n2 -1.5\n-1.5 3e-3",
        ] {
            assert_eq!(parse_market(text, "a").unwrap(), expected, "{text}");
        }
    }

    #[test]
    fn errors_name_the_line() {
        let message = |text: &str| parse_market(text, "k.mtx").unwrap_err().to_string();
        let head = "%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n";
        assert_eq!(
            message(&format!("{head}1 1 2\n1 2 5\n")),
            "k.mtx:4: entry (1, 2) lies above the diagonal of a symmetric matrix; give the lower triangle only"
        );
        assert_eq!(message(&format!("{head}1 1 2\n1 1 5\n")), "k.mtx:4: entry (1, 1) is given twice; leave one out");
        assert!(message(&format!("{head}3 1 2\n")).starts_with("k.mtx:3: entry (3, 1) lies outside the 2 x 2 matrix"));
        assert_eq!(message(&format!("{head}1 1 nan\n")), "k.mtx:3: \"nan\" is not a finite number");
        assert!(message(&format!("{head}1 1 2\n")).contains("there are 1 entries but the sizes promise 2"));
        assert!(message("%%MatrixMarket matrix coordinate complex general\n").contains("\"complex\" matrices"));
        assert!(message("1,2\n").starts_with("k.mtx:1: the first line must be"));
        assert!(
            message("%%MatrixMarket matrix array real general\n2 2\n1 2 3 4 5\n").starts_with("k.mtx:3: there are 5")
        );
        assert!(message("%%MatrixMarket matrix array real general\n2 3\n").contains("2 x 3; it must be square"));
    }
}
