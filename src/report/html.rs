//! A report as HTML: one file without anything outside it.

use super::page::Part;
use crate::plots::drawing::Drawing;
use crate::plots::svg;

const STYLE: &str = "body{font:15px/1.45 Ubuntu,'DejaVu Sans',Helvetica,Arial,sans-serif;color:#16191d;max-width:960px;\
margin:32px auto;padding:0 20px}h1{font-weight:500;margin-bottom:4px}h2{font-weight:500;margin:34px 0 8px;border-bottom:1px \
solid #d5dade}h3{font-weight:500;margin:20px 0 4px}table{border-collapse:collapse;font-variant-numeric:tabular-nums}td,th{padding:3px 14px 3px 0;text-align:left;\
vertical-align:top}th{font-weight:500;color:#5c6670;border-bottom:1px solid #d5dade}td.n,th.n{text-align:right}p.s{color:#5c6670}\
p.w{color:#8a5a00}figure{margin:8px 0}figcaption{color:#5c6670}img{max-width:100%;border:1px solid #e6e9ec}@media print{h2{break-after:avoid}img{break-inside:\
avoid}}";

/// What HTML takes for markup, written out.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A drawing as an address that holds it whole: names inside one drawing cannot meet those of another.
fn address(drawing: &Drawing) -> String {
    let mut text = String::from("data:image/svg+xml,");
    for byte in svg::write(drawing).bytes() {
        if byte.is_ascii_alphanumeric() || b" -_.,:;/=()'!*".contains(&byte) {
            text.push(char::from(byte));
        } else {
            text += &format!("%{byte:02X}");
        }
    }
    text
}

fn written(part: &Part) -> String {
    match part {
        Part::Chapter(title) => format!("<h2>{}</h2>\n", escaped(title)),
        Part::Section(title) => format!("<h3>{}</h3>\n", escaped(title)),
        Part::Sentence(text) => format!("<p>{}</p>\n", escaped(text)),
        Part::Remark(text) => format!("<p class=\"s\">{}</p>\n", escaped(text)),
        Part::Warning(text) => format!("<p class=\"w\">{}</p>\n", escaped(text)),
        Part::Table(head, rows) => table(head, rows),
        Part::Figure(number, drawing) => figure(*number, drawing),
    }
}

fn table(head: &[String], rows: &[Vec<String>]) -> String {
    let class = |k: usize| if head[k].ends_with('|') { " class=\"n\"" } else { "" };
    let name = |k: usize| escaped(head[k].trim_end_matches('|'));
    let names: String = (0..head.len()).map(|k| format!("<th{}>{}</th>", class(k), name(k))).collect();
    let mut text = format!("<table>\n<tr>{names}</tr>\n");
    for row in rows {
        let cells: String =
            row.iter().enumerate().map(|(k, text)| format!("<td{}>{}</td>", class(k), escaped(text))).collect();
        text += &format!("<tr>{cells}</tr>\n");
    }
    text + "</table>\n"
}

fn figure(number: usize, drawing: &Drawing) -> String {
    let (w, h) = (drawing.size.x, drawing.size.y);
    let (title, address) = (escaped(&drawing.title), escaped(&address(drawing)));
    format!(
        "<figure><img alt=\"{title}\" width=\"{w}\" height=\"{h}\" src=\"{address}\">\
         <figcaption>Figure {number}. {title}</figcaption></figure>\n"
    )
}

/// The whole file.
pub(super) fn document(title: &str, parts: &[Part]) -> String {
    let (title, body) = (escaped(title), parts.iter().map(written).collect::<String>());
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{title}</title>\n\
         <style>{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n{body}</body>\n</html>\n"
    )
}

#[cfg(test)]
mod tests {
    use super::super::page::Page;
    use super::{address, document};
    use crate::plots::drawing::Drawing;
    use ecolor::Color32;
    use emath::vec2;

    #[test]
    fn markup_in_names_stays_text() {
        let mut page = Page::default();
        page.table(&["a", "b|"], &[vec!["<1>".into(), "2 & 3".into()]]);
        let text = document("x < y", &page.finish());
        assert!(text.contains("<td>&lt;1&gt;</td><td class=\"n\">2 &amp; 3</td>"), "{text}");
        assert!(text.contains("<title>x &lt; y</title>"));
    }

    #[test]
    fn a_drawing_is_part_of_the_page() {
        let text = address(&Drawing::new(vec2(10.0, 10.0), Color32::WHITE, "50 % of #1"));
        assert!(text.starts_with("data:image/svg+xml,%3C") && !text.contains(['#', '<', '"', '\n']), "{text}");
    }
}
