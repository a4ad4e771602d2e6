//! Large Matrix Market files of layout `coordinate`, as `scipy.io.mmwrite` and others write them, entry by entry: for models that
//! are reduced.

use super::error::{TableError, TableProblem, number, quote};
use super::market::{banner, size_below};
use dashpot_fe_files::Matrix;

/// Most rows of a model.
const MOST_ROWS: usize = 10_000_000;

/// Largest difference of mirrored entries, as a part of the largest entry.
const ASYMMETRY: f64 = 1e-9;

/// Reads a file of layout `coordinate`; none where it has another one.
///
/// Of a general file the mean of mirrored entries is taken, which is each of them where the matrix is symmetric.
pub(super) fn parse_sparse_market(text: &str, file: &str) -> Result<Option<Matrix>, TableError> {
    let mut lines = text.lines().enumerate().map(|(i, line)| (i + 1, line.trim()));
    let first = lines.next().map_or("", |(_, line)| line);
    let Ok((true, symmetric)) = banner(first) else { return Ok(None) };
    let mut rest = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('%'));
    let (at, sizes) = rest.next().ok_or_else(|| TableError::file(file, TableProblem::Empty))?;
    let (size, expected) =
        size_below(sizes, true, symmetric, MOST_ROWS).map_err(|problem| TableError::line(file, at, problem))?;
    // A line has six bytes at least: no length in a header asks for more than the file may hold.
    let mut entries = Vec::with_capacity(expected.min(text.len() / 6 + 1));
    for (at, line) in rest {
        let wrong = |problem| TableError::line(file, at, problem);
        let (row, column, value) = entry(line, size).map_err(wrong)?;
        if symmetric && column > row {
            return Err(wrong(TableProblem::AboveDiagonal { row: row + 1, column: column + 1 }));
        }
        let part = if symmetric || row == column { 1.0 } else { 0.5 };
        entries.push((row.max(column), row.min(column), part * value, row < column));
    }
    if entries.len() != expected {
        return Err(TableError::file(file, TableProblem::Count { found: entries.len(), expected }));
    }
    entries.sort_unstable_by_key(|&(row, column, _, above)| (column, row, above));
    let place = |&(row, column, _, above): &(usize, usize, f64, bool)| (row, column, above);
    if let Some(pair) = entries.windows(2).find(|pair| place(&pair[0]) == place(&pair[1])) {
        let (low, high, above) = (pair[0].0 + 1, pair[0].1 + 1, pair[0].3);
        let (row, column) = if above { (high, low) } else { (low, high) };
        return Err(TableError::file(file, TableProblem::EntryTwice { row, column }));
    }
    if !symmetric {
        mirrored(&entries).map_err(|problem| TableError::file(file, problem))?;
    }
    let entries = entries.into_iter().map(|(row, column, value, _)| (row, column, value)).collect();
    Ok(Some(Matrix { name: String::new(), size, dofs: None, entries }))
}

/// Refuses a general matrix whose triangles differ by more than rounding; halves of mirrored entries stand side by side.
fn mirrored(entries: &[(usize, usize, f64, bool)]) -> Result<(), TableProblem> {
    let largest = entries.iter().fold(0.0_f64, |largest, entry| largest.max(entry.2.abs()));
    let mut rest = entries.iter().filter(|(row, column, ..)| row != column).peekable();
    while let Some(&(row, column, value, _)) = rest.next() {
        let other = rest.next_if(|other| (other.0, other.1) == (row, column)).map_or(0.0, |other| other.2);
        if (value - other).abs() > ASYMMETRY * largest {
            return Err(TableProblem::NotSymmetric { row: row + 1, column: column + 1 });
        }
    }
    Ok(())
}

/// `row column value`, counted from 0.
fn entry(line: &str, size: usize) -> Result<(usize, usize, f64), TableProblem> {
    let bad = || TableProblem::BadEntry { expected: "row column value", found: quote(line) };
    let mut words = line.split_whitespace();
    let mut index = || words.next().and_then(|word| word.parse::<usize>().ok()).ok_or_else(bad);
    let (row, column) = (index()?, index()?);
    let (Some(value), None) = (words.next(), words.next()) else { return Err(bad()) };
    if row == 0 || column == 0 || row > size || column > size {
        return Err(TableProblem::Outside { row, column, size });
    }
    Ok((row - 1, column - 1, number(value)?))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::super::market::parse_market;
    use super::*;

    fn full(matrix: &Matrix) -> Vec<Vec<f64>> {
        let mut full = vec![vec![0.0; matrix.size]; matrix.size];
        for &(i, j, value) in &matrix.entries {
            full[i][j] += value;
            if i != j {
                full[j][i] += value;
            }
        }
        full
    }

    #[test]
    fn entries_are_those_of_the_dense_reader() {
        for text in [
            "%%MatrixMarket matrix coordinate real symmetric\n% x\n3 3 4\n1 1 2\n2 1 -1.5\n3 3 1e-3\n3 2 4\n",
            "%%MatrixMarket matrix coordinate real general\n3 3 6\n1 1 2\n2 1 -1.5\n1 2 -1.5\n3 3 1D-3\n3 2 4\n2 3 4\n",
        ] {
            let (sparse, dense) = (parse_sparse_market(text, "a").unwrap().unwrap(), parse_market(text, "a").unwrap());
            let rows = full(&sparse);
            assert!((0..9).all(|k| rows[k / 3][k % 3] == dense[(k / 3, k % 3)]), "{rows:?}");
        }
        assert_eq!(parse_sparse_market("%%MatrixMarket matrix array real general\n1 1\n2\n", "a"), Ok(None));
    }

    #[test]
    fn errors_name_line_or_entry_and_large_headers_ask_for_no_memory() {
        let message = |text: &str| parse_sparse_market(text, "k.mtx").unwrap_err().to_string();
        let head = "%%MatrixMarket matrix coordinate real general\n";
        assert!(message(&format!("{head}2 2 2\n1 3 2\n")).starts_with("k.mtx:3: entry (1, 3) lies outside"));
        assert!(message(&format!("{head}2 2 2\n2 1 2\n2 1 2\n")).contains("entry (2, 1) is given twice"));
        assert!(message(&format!("{head}2 2 3\n1 1 2\n2 1 1\n2 2 1\n")).contains("(2, 1) and (1, 2) differ"));
        assert!(message(&format!("{head}9000000 9000000 90000000000\n1 1 2\n")).contains("there are 1 entries"));
        assert!(message(&format!("{head}90000000 90000000 1\n1 1 2\n")).contains("10000000"));
        assert!(message(&format!("{head}2 2 1\n1 1 2 3\n")).starts_with("k.mtx:3"));
    }
}
