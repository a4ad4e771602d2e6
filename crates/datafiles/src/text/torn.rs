//! Decimal commas between columns that are separated by commas: every number is torn in two.
//!
//! ```text
//! Time [s],Force [N]
//! 0,001,12,5
//! ```

use super::decode::rows;
use super::dialect::{Dialect, Separator};

/// Rows that are looked at.
const LOOKED_AT: usize = 100;
/// Fewest of them.
const FEWEST: usize = 4;

/// Line of the first row of a table that is torn, and what is wrong with it: whole numbers alone, twice as many in most rows as there
/// are names above them, and never more. Numbers without a fraction are not torn, so that rows may have fewer.
pub(super) fn decimal_commas(text: &str, dialect: Dialect) -> Option<(u64, String)> {
    if dialect != (Dialect { separator: Separator::Letter(','), comma: false }) || text.contains('"') {
        return None;
    }
    let filled = || rows(text).filter(|(_, row)| !row.trim().is_empty());
    let is_row = |row: &str| row.split(',').all(is_whole);
    let begins = filled().position(|(_, row)| is_row(&row))?;
    let (_, header) = filled().nth(begins.checked_sub(1)?)?;
    let names = header.split(',').filter(|name| name.chars().any(char::is_alphabetic)).count();
    let widths: Vec<(u64, Option<usize>)> = filled()
        .skip(begins)
        .take(LOOKED_AT)
        .map(|(line, row)| (line, is_row(&row).then(|| row.split(',').count())))
        .collect();
    let twice = widths.iter().filter(|(_, width)| *width == Some(2 * names)).count();
    let fits = |(_, width): &(u64, Option<usize>)| width.is_some_and(|width| (names..=2 * names).contains(&width));
    let torn = names > 1 && widths.len() >= FEWEST && 2 * twice > widths.len() && widths.iter().all(fits);
    torn.then(|| {
        let problem = format!(
            "the rows have {} cells below {names} names: a comma stands in the numbers and between them; export with a decimal point, or \
             with semicolons between the columns",
            2 * names
        );
        (widths[0].0, problem)
    })
}

/// Whether a cell is a piece of a number that is torn at its decimal comma: digits, with a sign, or with an exponent behind them.
fn is_whole(cell: &str) -> bool {
    let cell = cell.trim();
    let (digits, exponent) = cell.split_once(['e', 'E']).unwrap_or((cell, "0"));
    let all_digits = |text: &str| {
        let text = text.strip_prefix(['+', '-']).unwrap_or(text);
        !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit())
    };
    all_digits(digits) && all_digits(exponent)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    fn told(text: &str) -> Option<(u64, String)> {
        decimal_commas(text, Dialect::sniff(text).unwrap())
    }

    #[test]
    fn numbers_that_their_separator_tears_are_refused() {
        let rows: String = (0..9).map(|i| format!("0,{i:03},-12,{}e-1\n", 5 * i)).collect();
        let (line, problem) = told(&format!("rig 3\nTime [s],Force [N]\n{rows}")).unwrap();
        assert_eq!(line, 3);
        assert!(problem.starts_with("the rows have 4 cells below 2 names: a comma stands in the numbers"), "{problem}");
        // A number without a fraction has no comma to be torn at.
        assert!(told(&format!("Time [s],Force [N]\n0,000,12\n{rows}")).is_some());
    }

    #[test]
    fn tables_of_whole_numbers_are_none() {
        let four: String = (0..9).map(|i| format!("{i},{},7,3\n", 2 * i)).collect();
        for head in ["Time,a,b,c\n", "Rig,3\nTime,a,b,c\n", "", "one name\n"] {
            assert_eq!(told(&format!("{head}{four}")), None, "{head}");
        }
        let real: String = (0..9).map(|i| format!("{i}.5,1,7,3\n")).collect();
        assert_eq!(told(&format!("Time,Force\n{real}")), None);
    }
}
