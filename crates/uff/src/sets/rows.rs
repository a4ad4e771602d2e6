//! Rows of numbers under records of labels: what data sets 55 and 2414 hold after their headers.

use super::elements::integers;
use crate::body::{Body, Odd};
use crate::error::{Error, Problem};
use crate::warning::Fault;

/// Numbers of a full line.
const PER_LINE: usize = 6;

/// Longer rows are not filled with zeros: a short file must not grow to many numbers.
const MOST_FILLED: usize = 64;

/// Rows of numbers, each after a record of labels.
pub(crate) struct Rows {
    pub labels: Vec<Vec<i64>>,
    pub numbers: Vec<f64>,
    /// Where each row begins in `numbers`; one entry more than rows.
    pub starts: Vec<usize>,
}

/// Reads records of at least `width` labels, each followed by as many numbers as `row` says for it.
pub(crate) fn read_rows(body: &mut Body<'_>, width: usize, row: impl Fn(&[i64]) -> usize) -> Result<Rows, Error> {
    let mut rows = Rows { labels: Vec::new(), numbers: Vec::new(), starts: vec![0] };
    let mut all = Odd::default();
    while let Some(line) = body.line() {
        let labels = integers(body, line)?;
        if labels.len() < width {
            let problem = Problem::Short { record: "the record before values", needed: width, found: labels.len() };
            return Err(body.error(line, problem));
        }
        let wanted = row(&labels);
        let mut numbers = Vec::with_capacity(wanted.min(body.rest().len() / 2 + 1));
        let mut odd = Odd::default();
        let mut last = line;
        while numbers.len() < wanted {
            let Some(next) = body.line() else { break };
            let full = numbers.len() % PER_LINE == 0 && wanted - numbers.len() == 1;
            if !numbers.is_empty() && !full && is_label(next.bytes) {
                body.back_to(next);
                break;
            }
            body.reals_of(next, wanted, &mut numbers, &mut odd)?;
            last = next;
        }
        if let Some((line, more)) = odd.surplus {
            let problem = Problem::TooMany { expected: wanted, found: wanted + more as usize };
            return Err(body.error(line, problem));
        }
        all.join(odd);
        let found = numbers.len();
        if found < wanted {
            if wanted > MOST_FILLED {
                let problem = Problem::Short { record: "a row of values", needed: wanted, found };
                return Err(body.error(last, problem));
            }
            numbers.resize(wanted, 0.0);
            body.warn(last, Fault::ShortRow { expected: wanted, found });
        }
        rows.labels.push(labels);
        rows.numbers.extend(numbers);
        rows.starts.push(rows.numbers.len());
    }
    all.tell(body);
    Ok(rows)
}

/// Whether a line holds a single whole number in the columns of a label.
fn is_label(line: &[u8]) -> bool {
    const WIDTH: usize = 10;
    let text = crate::number::trim(line);
    text.len() <= WIDTH && text.iter().all(u8::is_ascii_digit)
}
