//! Aligned columns of text, and numbers with as many digits as a reader needs.

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

/// Four significant digits, plain between 0.001 and 99999, else with an exponent.
pub(super) fn number(value: f64) -> String {
    digits(value, 4)
}

/// That many significant digits.
pub(super) fn digits(value: f64, digits: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let magnitude = value.abs().log10().floor() as i32;
    if (-4..5).contains(&magnitude) {
        format!("{value:.*}", usize::try_from(digits - 1 - magnitude).unwrap_or(0))
    } else {
        format!("{value:.*e}", usize::try_from(digits - 1).unwrap_or(0))
    }
}

#[cfg(test)]
mod tests {
    use super::{digits, number, table};

    #[test]
    fn numbers_keep_their_significant_digits() {
        assert_eq!(number(0.107_12), "0.1071");
        assert_eq!(number(12_345.6), "12346");
        assert_eq!(number(1.0e-7), "1.000e-7");
        assert_eq!(digits(6.4983, 3), "6.50");
        assert_eq!(number(0.0), "0");
    }

    #[test]
    fn columns_line_up() {
        let rows = [["run", "Hz"], ["a.csv", "10.4"], ["long-name.csv", "1671"]].map(|r| r.map(str::to_owned).to_vec());
        let text = table(&rows);
        assert_eq!(text, "  run              Hz\n  a.csv          10.4\n  long-name.csv  1671\n");
    }
}
