//! Aligned columns of text, and numbers with as many digits as a reader needs.

pub(super) use crate::math::numerals::{significant, with_deviation};

/// Lines of `rows` in columns as wide as their widest cell, two spaces apart; the first row is the head.
pub(super) fn table(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |j: usize| rows.iter().filter_map(|row| row.get(j)).map(|cell| cell.chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().enumerate().map(|(j, cell)| {
            let space = " ".repeat(widths[j].saturating_sub(cell.chars().count()));
            // Words to the left, numbers to the right.
            if is_number(cell) || j > 0 && rows.iter().skip(1).any(|r| r.get(j).is_some_and(|c| is_number(c))) {
                format!("{space}{cell}")
            } else {
                format!("{cell}{space}")
            }
        });
        format!("  {}\n", cells.collect::<Vec<_>>().join("  ").trim_end())
    };
    rows.iter().map(line).collect()
}

fn is_number(cell: &str) -> bool {
    cell.starts_with(|c: char| c.is_ascii_digit() || c == '-' && cell.len() > 1)
}

/// Four significant digits.
pub(super) fn number(value: f64) -> String {
    significant(value, 4)
}

#[cfg(test)]
mod tests {
    use super::table;

    #[test]
    fn columns_line_up() {
        let rows = [["run", "Hz"], ["a.csv", "10.4"], ["long-name.csv", "1671"]].map(|r| r.map(str::to_owned).to_vec());
        let text = table(&rows);
        assert_eq!(text, "  run              Hz\n  a.csv          10.4\n  long-name.csv  1671\n");
    }
}
