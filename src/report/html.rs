//! A report as HTML: one file without anything outside it.

use super::front::{Front, KIND, SIGNATURES};
use super::logo::Logo;
use super::page::{Part, Table, chapters};
use crate::plots::drawing::Drawing;
use crate::plots::svg;

const STYLE: &str = "body{font:15px/1.45 Ubuntu,'DejaVu Sans',Helvetica,Arial,sans-serif;color:#16191d;max-width:960px;\
margin:32px auto;padding:0 20px;counter-reset:chapter}h1{font-weight:500;margin-bottom:4px}h2{font-weight:500;margin:34px 0 8px;border-bottom:1px \
solid #d5dade}h2::before{counter-increment:chapter;content:counter(chapter)'\\2002'}h3{font-weight:500;margin:20px 0 4px}\
table{border-collapse:collapse;font-variant-numeric:tabular-nums;margin:10px 0}caption{text-align:left;color:#5c6670;padding-bottom:3px}\
td,th{padding:3px 14px 3px 0;text-align:left;vertical-align:top;overflow-wrap:anywhere}th{font-weight:500;color:#5c6670;border-bottom:1px solid #d5dade}\
td.n,th.n{text-align:right;overflow-wrap:normal}p.s{color:#5c6670}p.w{color:#8a5a00}figure{margin:8px 0}figcaption{color:#5c6670}figure img{max-width:100%;\
border:1px solid #e6e9ec}header{border-bottom:1px solid #d5dade;padding-bottom:20px;margin-bottom:20px}header img{max-height:90px;max-width:260px;width:auto;height:auto;float:right}\
nav a{color:inherit;text-decoration:none}nav b,p.f{font-weight:500}.sign{display:grid;grid-template-columns:1fr 1fr;gap:44px 60px;margin-top:50px}\
.sign span{border-top:1px solid #5c6670;color:#5c6670;font-size:13px}@media print{header{break-after:page;border:0}h2,h3,caption{break-after:avoid}\
figure{break-inside:avoid}@page{margin:18mm;@bottom-right{content:counter(page) ' of ' counter(pages)}}}";

/// What HTML takes for markup, written out.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Bytes as an address that holds them whole.
fn address(kind: &str, bytes: &[u8]) -> String {
    let mut text = format!("data:image/{kind},");
    for &byte in bytes {
        if byte.is_ascii_alphanumeric() || b" -_.,:;/=()'!*".contains(&byte) {
            text.push(char::from(byte));
        } else {
            text += &format!("%{byte:02X}");
        }
    }
    text
}

/// A drawing so: names inside one drawing cannot meet those of another.
fn drawn(drawing: &Drawing) -> String {
    address("svg+xml", svg::write(drawing).as_bytes())
}

fn written(part: &Part) -> String {
    match part {
        Part::Chapter(number, title) => format!("<a id=\"chapter-{number}\"></a>\n<h2>{}</h2>\n", escaped(title)),
        Part::Section(title) => format!("<h3>{}</h3>\n", escaped(title)),
        Part::Sentence(text) => format!("<p>{}</p>\n", escaped(text)),
        Part::Remark(text) => format!("<p class=\"s\">{}</p>\n", escaped(text)),
        Part::Warning(text) => format!("<p class=\"w\">{}</p>\n", escaped(text)),
        Part::Table(number, of) => table(*number, of),
        Part::Figure(number, drawing, _) => figure(*number, drawing),
    }
}

fn table(number: usize, Table { title, head, rows }: &Table) -> String {
    let class = |k: usize| if head[k].ends_with('|') { " class=\"n\"" } else { "" };
    let name = |k: usize| escaped(head[k].trim_end_matches('|'));
    let names: String = (0..head.len()).map(|k| format!("<th{}>{}</th>", class(k), name(k))).collect();
    let mut text = format!("<table>\n<caption>Table {number}. {}</caption>\n<tr>{names}</tr>\n", escaped(title));
    for row in rows {
        let cells: String =
            row.iter().enumerate().map(|(k, text)| format!("<td{}>{}</td>", class(k), escaped(text))).collect();
        text += &format!("<tr>{cells}</tr>\n");
    }
    text + "</table>\n"
}

fn figure(number: usize, drawing: &Drawing) -> String {
    let (w, h) = (drawing.size.x, drawing.size.y);
    let (title, address) = (escaped(&drawing.title), escaped(&drawn(drawing)));
    format!(
        "<figure><img alt=\"{title}\" width=\"{w}\" height=\"{h}\" src=\"{address}\">\
         <figcaption>Figure {number}. {title}</figcaption></figure>\n"
    )
}

/// The title page: what it is, contents, lines to sign.
fn head(front: &Front, parts: &[Part]) -> String {
    let logo = front.logo.as_ref().map_or_else(String::new, |Logo { png, size: [w, h], .. }| {
        format!("<img alt=\"Logo\" width=\"{w}\" height=\"{h}\" src=\"{}\">\n", escaped(&address("png", png)))
    });
    let row = |(name, value): &(&str, String)| format!("<tr><th>{name}</th><td>{}</td></tr>\n", escaped(value));
    let rows: String = front.rows.iter().map(row).collect();
    let item = |(k, title): (usize, &str)| format!("<li><a href=\"#chapter-{k}\">{}</a></li>\n", escaped(title));
    let contents: String = chapters(parts).map(item).collect();
    let lines: String = SIGNATURES.map(|name| format!("<span>{name}</span>")).concat();
    format!(
        "<header>\n{logo}<h1>{}</h1>\n<p class=\"s\">{KIND}</p>\n<table>\n{rows}</table>\n<p class=\"f\">Summary</p>\n<p>{}</p>\n\
         <nav><b>Contents</b>\n<ol>\n{contents}</ol>\n</nav>\n<div class=\"sign\">{lines}</div>\n</header>\n",
        escaped(&front.title),
        escaped(&front.summary)
    )
}

/// The whole file.
pub(super) fn document(front: &Front, parts: &[Part]) -> String {
    let (title, body) = (escaped(&front.title), parts.iter().map(written).collect::<String>());
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{title}</title>\n\
         <style>{STYLE}</style>\n</head>\n<body>\n{}{body}</body>\n</html>\n",
        head(front, parts)
    )
}

#[cfg(test)]
mod tests {
    use super::super::page::Page;
    use super::{Front, document, drawn};
    use crate::plots::drawing::Drawing;
    use ecolor::Color32;
    use emath::vec2;

    #[test]
    fn markup_in_names_stays_text() {
        let mut page = Page::default();
        page.table("t", &["a", "b|"], &[vec!["<1>".into(), "2 & 3".into()]]);
        let front = Front { title: "x < y".to_owned(), ..Front::default() };
        let text = document(&front, &page.finish());
        assert!(text.contains("<td>&lt;1&gt;</td><td class=\"n\">2 &amp; 3</td>"), "{text}");
        assert!(text.contains("<title>x &lt; y</title>"));
    }

    #[test]
    fn a_drawing_is_part_of_the_page() {
        let text = drawn(&Drawing::new(vec2(10.0, 10.0), Color32::WHITE, "50 % of #1"));
        assert!(text.starts_with("data:image/svg+xml,%3C") && !text.contains(['#', '<', '"', '\n']), "{text}");
    }
}
