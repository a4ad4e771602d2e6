//! The tables beside a report: every table and the values of every figure as CSV in one ZIP file.

use super::content::Content;
use super::page::{Part, Table};
use crate::plots::figure::csv;
use crate::plots::tables;
use std::io::{Cursor, Write as _};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// Name and content of every file: the tables and figures as they are numbered in the report, then results with all digits.
pub(super) fn files(parts: &[Part], content: &Content<'_>) -> Vec<(String, String)> {
    let numbered = parts.iter().filter_map(|part| match part {
        Part::Table(number, table) => Some((name("table", *number, &table.title), csv(&with_tabs(table)))),
        Part::Figure(number, drawing, values) => Some((name("figure", *number, &drawing.title), values.clone())),
        _ => None,
    });
    numbered.chain(results(content)).collect()
}

/// Results in SI units with all digits.
fn results(content: &Content<'_>) -> Vec<(String, String)> {
    let p = content.project;
    let mut list = vec![("values-runs", tables::runs(p)), ("values-sources", tables::sources(p))];
    list.extend(p.structure.modes().ok().map(|modes| ("values-natural-frequencies", tables::modes(&modes))));
    if let Ok(outcome) = &content.outcome {
        list.push(("values-identified", tables::coefficients(p, outcome)));
        list.push(("values-steps", tables::steps(p, outcome)));
        list.push(("values-damping-ratios", tables::damping(outcome)));
    }
    list.into_iter().map(|(name, table)| (format!("{name}.csv"), csv(&table))).collect()
}

/// `table-03-damping-ratios.csv`.
fn name(kind: &str, number: usize, title: &str) -> String {
    let plain: String = title.to_lowercase().chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
    let words: Vec<&str> = plain.split('-').filter(|word| !word.is_empty()).take(6).collect();
    format!("{kind}-{number:02}-{}.csv", words.join("-"))
}

fn with_tabs(table: &Table) -> String {
    let plain = |text: &str| text.replace(['\t', '\n', '\r'], " ");
    let head: Vec<String> = table.head.iter().map(|h| plain(h.trim_end_matches('|'))).collect();
    let rows = table.rows.iter().map(|row| row.iter().map(|cell| plain(cell)).collect());
    std::iter::once(head).chain(rows).map(|cells: Vec<String>| cells.join("\t") + "\n").collect()
}

/// The files as one ZIP file.
///
/// # Errors
/// One line where a file is too large for the format.
pub(super) fn zipped(files: &[(String, String)]) -> Result<Vec<u8>, String> {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated);
    for (name, text) in files {
        writer.start_file(name.as_str(), options).map_err(|e| e.to_string())?;
        writer.write_all(text.as_bytes()).map_err(|e| e.to_string())?;
    }
    writer.finish().map(Cursor::into_inner).map_err(|e| e.to_string())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::{Table, name, with_tabs, zipped};
    use std::io::{Cursor, Read as _};

    #[test]
    fn what_is_packed_is_unpacked() {
        let files = [("a.csv".to_owned(), "x,y\n1,2\n".repeat(1000)), ("b.csv".to_owned(), String::new())];
        let mut archive = zip::ZipArchive::new(Cursor::new(zipped(&files).unwrap())).unwrap();
        for (name, text) in files {
            let mut read = String::new();
            archive.by_name(&name).unwrap().read_to_string(&mut read).unwrap();
            assert_eq!(read, text);
        }
    }

    #[test]
    fn a_cell_stays_one_cell() {
        let row = vec!["Law, place".to_owned(), "2\tN".to_owned()];
        let table = Table { title: "t".to_owned(), head: vec!["What".to_owned(), "Size|".to_owned()], rows: vec![row] };
        assert_eq!(crate::plots::figure::csv(&with_tabs(&table)), "What,Size\n\"Law, place\",2 N\n");
        assert_eq!(name("table", 3, "Bode diagram: x/f, 7 → 1"), "table-03-bode-diagram-x-f-7-1.csv");
    }
}
