//! Reports as PDF, read back.
#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests")]
use super::face::Face;
use super::{Front, document};
use crate::control::Control;
use crate::plots::drawing::Drawing;
use crate::report::Request;
use crate::report::logo::{Logo, written};
use crate::report::page::Page;
use crate::report::section::Section;
use ecolor::Color32;
use emath::{Align2, pos2, vec2};
use flate2::read::ZlibDecoder;
use std::io::Read as _;

/// The operators of all pages: pages choose a face, other streams do not.
fn pages(pdf: &[u8]) -> Vec<Vec<u8>> {
    streams(pdf).into_iter().filter(|text| text.windows(3).any(|w| w == b" Tf")).collect()
}

/// All streams, unpacked.
fn streams(pdf: &[u8]) -> Vec<Vec<u8>> {
    let find = |from: usize, what: &[u8]| pdf[from..].windows(what.len()).position(|w| w == what).map(|k| from + k);
    let mut streams = Vec::new();
    let mut at = 0;
    while let Some(start) = find(at, b"stream\n") {
        let end = find(start, b"endstream").unwrap();
        let mut text = Vec::new();
        let read = ZlibDecoder::new(&pdf[start + 7..end]).read_to_end(&mut text).is_ok();
        if read {
            streams.push(text);
        }
        at = end + 9;
    }
    streams
}

/// The strings that a page shows, as the numbers of their glyphs: literal with escapes, or hexadecimal.
fn shown(page: &[u8]) -> Vec<Vec<u8>> {
    let mut strings = Vec::new();
    let mut at = 0;
    while at < page.len() {
        let (string, end) = match page[at] {
            b'(' => literal(page, at + 1),
            b'<' => {
                let end = at + page[at..].iter().position(|b| *b == b'>').unwrap();
                let digits = std::str::from_utf8(&page[at + 1..end]).unwrap();
                (
                    (0..digits.len() / 2).map(|k| u8::from_str_radix(&digits[2 * k..2 * k + 2], 16).unwrap()).collect(),
                    end,
                )
            }
            _ => {
                at += 1;
                continue;
            }
        };
        strings.push(string);
        at = end + 1;
    }
    strings
}

/// A literal string from its first byte on, and where its bracket closes.
fn literal(page: &[u8], mut at: usize) -> (Vec<u8>, usize) {
    let (mut text, mut open) = (Vec::new(), 1);
    loop {
        match page[at] {
            b'\\' => {
                let octal = page[at + 1..at + 4].iter().all(|b| (b'0'..=b'7').contains(b));
                let known = [(b'n', b'\n'), (b'r', b'\r'), (b't', b'\t'), (b'b', 8), (b'f', 12)];
                let letter = page[at + 1];
                text.push(if octal {
                    page[at + 1..at + 4].iter().fold(0_u8, |sum, b| sum.wrapping_mul(8).wrapping_add(b - b'0'))
                } else {
                    known.iter().find(|(l, _)| *l == letter).map_or(letter, |(_, byte)| *byte)
                });
                at += if octal { 4 } else { 2 };
                continue;
            }
            b'(' => open += 1,
            b')' => open -= 1,
            _ => {}
        }
        if open == 0 {
            return (text, at);
        }
        text.push(page[at]);
        at += 1;
    }
}

/// The glyphs of every page one after the other, those of blanks left out: how text is broken into lines does not matter.
fn glyphs(pdf: &[u8]) -> Vec<Vec<u8>> {
    let blank = Face::built_in().unwrap().encode(" ");
    let of_page = |page: Vec<u8>| {
        let all = shown(&page).concat();
        all.chunks(2).filter(|glyph| *glyph != blank).flatten().copied().collect()
    };
    pages(pdf).into_iter().map(of_page).collect()
}

/// Whether a page holds a text.
fn holds(page: &[u8], text: &str) -> bool {
    let plain: String = text.split_whitespace().collect();
    let wanted = Face::built_in().unwrap().encode(&plain);
    wanted.is_empty() || page.windows(wanted.len()).any(|w| w == wanted)
}

fn sample(rows: usize) -> Page {
    let mut page = Page::default();
    page.chapter(Section::Ratios, "Damping ratios");
    let row = |k: usize| vec![format!("mode {k}"), "0.1072 ± 0.0021 N·s/m".to_owned()];
    page.table("Ratios", &["Mode", "Value|"], &(0..rows).map(row).collect::<Vec<_>>());
    let mut drawing = Drawing::new(vec2(900.0, 500.0), Color32::WHITE, "Bode diagram");
    drawing.words(pos2(10.0, 10.0), Align2::LEFT_TOP, "ζ = 2 %, −90°", 12.0, Color32::BLACK);
    page.drawing(&drawing, "");
    page
}

fn titled(title: &str) -> Front {
    Front { title: title.to_owned(), summary: "It rubs.".to_owned(), ..Front::default() }
}

#[test]
fn pages_hold_the_text_that_was_given() {
    let pdf = document(&titled("Cantilever"), &sample(3).finish()).unwrap();
    assert!(pdf.starts_with(b"%PDF-1.") && pdf.ends_with(b"%%EOF"));
    assert!(pdf.windows(10).any(|w| w == b"Cantilever"), "the title");
    let pages = glyphs(&pdf);
    assert!(holds(&pages[0], "Cantilever") && holds(&pages[0], "It rubs.") && holds(&pages[0], "Signature"));
    for text in
        ["Damping ratios", "mode 2", "0.1072 ± 0.0021 N·s/m", "Figure 1. Bode diagram", "ζ = 2 %, −90°", "2 of 2"]
    {
        assert!(holds(&pages[1], text), "{text}");
    }
    assert!(!holds(&pages[1], "nothing of the kind"));
}

#[test]
fn the_contents_say_on_which_page_a_chapter_is() {
    let mut page = Page::default();
    for section in Section::ALL {
        page.chapter(section, section.words());
        let rows: Vec<Vec<String>> = (0..40).map(|k| vec![format!("row {k}")]).collect();
        page.table("Rows", &["Row"], &rows);
    }
    let pdf = document(&titled("Long"), &page.finish()).unwrap();
    let pages = glyphs(&pdf);
    assert!(pages.len() > 8, "{} pages", pages.len());
    for (k, section) in Section::ALL.into_iter().enumerate() {
        let title = format!("{}  {}", k + 1, section.words());
        let at = (1..pages.len()).find(|p| holds(&pages[*p], &title)).unwrap() + 1;
        assert!(holds(&pages[0], &format!("{title} {at}")), "{title} is on page {at}");
    }
    let text = String::from_utf8_lossy(&pdf);
    assert!(text.matches("/Dest").count() == Section::ALL.len(), "a bookmark a chapter");
}

#[test]
fn a_logo_is_drawn_in_its_colours() {
    let png = written(2, 1, png::ColorType::Rgb, &[250, 1, 2, 3, 4, 251]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("logo.png");
    std::fs::write(&path, png).unwrap();
    let front = Front { logo: Some(Logo::read(&path).unwrap()), ..titled("With a logo") };
    let pdf = document(&front, &sample(3).finish()).unwrap();
    let text = String::from_utf8_lossy(&pdf);
    assert!(text.contains("/Subtype /Image") && text.contains("/Width 2") && text.contains("/DeviceRGB"));
    assert!(streams(&pdf).iter().any(|s| *s == [250, 1, 2, 3, 4, 251]), "the points");
    assert!(pages(&pdf)[0].windows(8).any(|w| w == b"/Logo Do"), "drawn on the first page");
}

/// The same project as HTML and as PDF: all that is said stands in both.
#[test]
fn both_forms_say_the_same() {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("sample-data/cantilever-harmonics/project.toml");
    let project = crate::exchange::project::load(&file, &Control::unattended()).unwrap();
    // The search would take long, and is written with the same parts as the rest.
    let sections = [
        Section::Structure,
        Section::Measurements,
        Section::Energy,
        Section::Ratios,
        Section::Methods,
        Section::Settings,
    ];
    let request = Request { sections: sections.to_vec(), ..Request::default() };
    let content =
        crate::report::Content::complete(&project, crate::report::Known::default(), &request, &Control::unattended());
    let front = crate::report::front(&content, &request, request.title_page(), None);
    let parts = crate::report::parts(&content, &request, &Control::unattended());
    let all = glyphs(&document(&front, &parts).unwrap()).concat();
    let html = crate::report::html::document(&front, &parts);
    let body = &html[html.find("<body>").unwrap()..];
    let mut said = 0;
    for piece in body.split('<').filter_map(|piece| piece.split_once('>')) {
        let text = piece.1.replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", "\"").replace("&amp;", "&");
        said += usize::from(!text.trim().is_empty());
        // A long table repeats its head on the next page, between two lines of a cell that is broken there.
        assert!(text.split_whitespace().all(|word| holds(&all, word)), "{text}");
    }
    assert!(said > 100, "{said} texts");
}

#[test]
fn a_long_table_goes_on_over_the_page_under_its_head() {
    let pdf = document(&titled("Long"), &sample(200).finish()).unwrap();
    assert!(pages(&pdf).len() >= 4, "{} pages", pages(&pdf).len());
}
