//! The few parts of HTML that a report is made of: one file without anything outside it.

use crate::plots::drawing::Drawing;
use crate::plots::svg;

const STYLE: &str = "body{font:15px/1.45 Ubuntu,'DejaVu Sans',Helvetica,Arial,sans-serif;color:#16191d;max-width:960px;\
margin:32px auto;padding:0 20px}h1{font-weight:500;margin-bottom:4px}h2{font-weight:500;margin:34px 0 8px;border-bottom:1px \
solid #d5dade}h3{font-weight:500;margin:20px 0 4px}table{border-collapse:collapse;font-variant-numeric:tabular-nums}td,th{padding:3px 14px 3px 0;text-align:left;\
vertical-align:top}th{font-weight:500;color:#5c6670;border-bottom:1px solid #d5dade}td.n,th.n{text-align:right}p.s{color:#5c6670}\
p.w{color:#8a5a00}img{max-width:100%;margin:8px 0;border:1px solid #e6e9ec}@media print{h2{break-after:avoid}img{break-inside:\
avoid}}";

/// A page under way.
#[derive(Debug, Default)]
pub struct Page {
    body: String,
}

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

impl Page {
    /// Adds a chapter's title.
    pub fn chapter(&mut self, title: &str) {
        self.body += &format!("<h2>{}</h2>\n", escaped(title));
    }

    /// Adds the title of a part of a chapter.
    pub fn section(&mut self, title: &str) {
        self.body += &format!("<h3>{}</h3>\n", escaped(title));
    }

    /// Adds a sentence.
    pub fn sentence(&mut self, text: &str) {
        self.body += &format!("<p>{}</p>\n", escaped(text));
    }

    /// Adds a sentence of second rank.
    pub fn remark(&mut self, text: &str) {
        self.body += &format!("<p class=\"s\">{}</p>\n", escaped(text));
    }

    /// Adds a sentence that should not be missed.
    pub fn warning(&mut self, text: &str) {
        self.body += &format!("<p class=\"w\">{}</p>\n", escaped(text));
    }

    /// Adds a table; columns whose name ends in a bar `|` hold numbers and stand right.
    pub fn table(&mut self, head: &[&str], rows: &[Vec<String>]) {
        let class = |k: usize| if head[k].ends_with('|') { " class=\"n\"" } else { "" };
        let name = |k: usize| escaped(head[k].trim_end_matches('|'));
        let names: String = (0..head.len()).map(|k| format!("<th{}>{}</th>", class(k), name(k))).collect();
        self.body += &format!("<table>\n<tr>{names}</tr>\n");
        for row in rows {
            let cells: String =
                row.iter().enumerate().map(|(k, text)| format!("<td{}>{}</td>", class(k), escaped(text))).collect();
            self.body += &format!("<tr>{cells}</tr>\n");
        }
        self.body += "</table>\n";
    }

    /// Adds a drawing.
    pub fn drawing(&mut self, drawing: &Drawing) {
        let (w, h) = (drawing.size.x, drawing.size.y);
        let title = escaped(&drawing.title);
        self.body +=
            &format!("<img alt=\"{title}\" width=\"{w}\" height=\"{h}\" src=\"{}\">\n", escaped(&address(drawing)));
    }

    /// The whole file.
    pub fn finish(self, title: &str) -> String {
        let (title, body) = (escaped(title), self.body);
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{title}</title>\n\
             <style>{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n{body}</body>\n</html>\n"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::{Page, address};
    use crate::plots::drawing::Drawing;
    use ecolor::Color32;
    use emath::vec2;

    #[test]
    fn markup_in_names_stays_text() {
        let mut page = Page::default();
        page.table(&["a", "b|"], &[vec!["<1>".into(), "2 & 3".into()]]);
        let text = page.finish("x < y");
        assert!(text.contains("<td>&lt;1&gt;</td><td class=\"n\">2 &amp; 3</td>"), "{text}");
        assert!(text.contains("<title>x &lt; y</title>"));
    }

    #[test]
    fn a_drawing_is_part_of_the_page() {
        let text = address(&Drawing::new(vec2(10.0, 10.0), Color32::WHITE, "50 % of #1"));
        assert!(text.starts_with("data:image/svg+xml,%3C") && !text.contains(['#', '<', '"', '\n']), "{text}");
    }
}
