//! The title page of a PDF: logo, title, what was tested by whom, what was found, contents with page numbers, lines to sign.

use super::paper::{BODY, HEIGHT, INK, LEFT, Paper, ROOM, SECTION, SMALL, TITLE, TOP, WEAK, WIDTH};
use crate::report::front::{Front, KIND, SIGNATURES};
use crate::report::logo::Logo;
use pdf_writer::Name;

/// Name of the logo in the resources of a page.
pub(super) const LOGO: Name<'static> = Name(b"Logo");
/// Largest width and height of a logo, points.
const LARGEST: [f32; 2] = [170.0, 70.0];
/// Where the values of the rows begin.
const VALUES: f32 = LEFT + 110.0;
/// Height of the four lines to sign.
const SIGNED: f32 = 110.0;

/// Draws it; `contents` are number, title and page, from 1, of every chapter.
pub(super) fn draw(paper: &mut Paper<'_>, front: &Front, contents: &[(usize, String, usize)]) {
    if let Some(logo) = &front.logo {
        picture(paper, logo);
    }
    paper.at = TOP + LARGEST[1] + 20.0;
    paper.paragraph(&front.title, TITLE, INK);
    paper.paragraph(KIND, SECTION, WEAK);
    paper.at += 14.0;
    for (name, value) in &front.rows {
        row(paper, name, value);
    }
    paper.at += 12.0;
    paper.paragraph("Summary", SECTION, INK);
    paper.paragraph(&front.summary, BODY, INK);
    paper.at += 10.0;
    paper.paragraph("Contents", SECTION, INK);
    for (number, title, page) in contents {
        entry(paper, &format!("{number}  {title}"), &page.to_string());
    }
    paper.need(SIGNED);
    paper.at = paper.at.max(HEIGHT - 60.0 - SIGNED);
    signatures(paper);
}

/// The logo at the upper right.
fn picture(paper: &mut Paper<'_>, logo: &Logo) {
    let [w, h] = logo.size.map(|v| v as f32);
    let scale = (LARGEST[0] / w).min(LARGEST[1] / h);
    let [w, h] = [scale * w, scale * h];
    let page = paper.page();
    page.save_state();
    page.transform([w, 0.0, 0.0, h, WIDTH - LEFT - w, HEIGHT - TOP - h + 16.0]);
    page.x_object(LOGO);
    page.restore_state();
}

fn row(paper: &mut Paper<'_>, name: &str, value: &str) {
    let leading = 1.45 * BODY;
    let lines = paper.face.lines(value, BODY, WIDTH - LEFT - VALUES);
    paper.need(leading * lines.len() as f32);
    paper.text(name, BODY, WEAK, LEFT, paper.at + BODY);
    for line in lines {
        paper.text(&line, BODY, INK, VALUES, paper.at + BODY);
        paper.at += leading;
    }
}

/// A title, and its page at the right.
fn entry(paper: &mut Paper<'_>, title: &str, page: &str) {
    let leading = 1.4 * BODY;
    paper.need(leading);
    let x = WIDTH - LEFT - paper.face.width(page, BODY);
    paper.text(title, BODY, INK, LEFT, paper.at + BODY);
    paper.text(page, BODY, INK, x, paper.at + BODY);
    paper.at += leading;
}

/// Two rows of two lines.
fn signatures(paper: &mut Paper<'_>) {
    for pair in SIGNATURES.chunks(2) {
        paper.at += 40.0;
        for (k, name) in pair.iter().enumerate() {
            let (x, y) = (LEFT + 0.55 * ROOM * k as f32, HEIGHT - paper.at);
            let page = paper.page();
            page.set_stroke_rgb(0.36, 0.4, 0.44).set_line_width(0.6);
            page.move_to(x, y).line_to(x + 0.45 * ROOM, y).stroke();
            paper.text(name, SMALL, WEAK, x, paper.at + 11.0);
        }
        paper.at += 11.0;
    }
}
