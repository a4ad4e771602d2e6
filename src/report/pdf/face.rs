//! The face of a PDF: the one of the window (Ubuntu Light, Ubuntu Font Licence 1.0), embedded whole; glyphs by their numbers.

use super::deflate::compressed;
use pdf_writer::types::{CidFontType, FontFlags, SystemInfo, UnicodeCmap};
use pdf_writer::{Filter, Name, Pdf, Rect, Ref, Str};
use std::cell::RefCell;
use std::collections::BTreeMap;

/// Name of the face in the resources of a page.
pub(super) const FACE: Name<'static> = Name(b"F1");
const NAME: Name<'static> = Name(b"Ubuntu-Light");
const IDENTITY: SystemInfo<'static> = SystemInfo { registry: Str(b"Adobe"), ordering: Str(b"Identity"), supplement: 0 };

/// The built-in face cannot be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the type of the report cannot be read; this is an error of dashpot, write the report as .html")]
pub(crate) struct FontError;

/// A face and which of its glyphs were used.
pub(super) struct Face {
    face: ttf_parser::Face<'static>,
    used: RefCell<BTreeMap<u16, char>>,
}

impl Face {
    /// The face of the window.
    ///
    /// # Errors
    /// [`FontError`].
    pub(super) fn built_in() -> Result<Self, FontError> {
        let face = ttf_parser::Face::parse(epaint_default_fonts::UBUNTU_LIGHT, 0).map_err(|_| FontError)?;
        Ok(Self { face, used: RefCell::default() })
    }

    /// The glyph of a character; one like it or a question mark where the face has none.
    fn glyph(&self, c: char) -> u16 {
        let like = match c {
            '−' | '‐' => '-',
            '≤' => '<',
            '≥' => '>',
            _ => '?',
        };
        let glyph_of = |c: char| self.face.glyph_index(c).map(|g| g.0);
        let glyph = glyph_of(c).or_else(|| glyph_of(like)).unwrap_or(0);
        self.used.borrow_mut().entry(glyph).or_insert(c);
        glyph
    }

    /// Thousandths of the size that a glyph is wide.
    fn advance(&self, glyph: u16) -> f32 {
        let units = f32::from(self.face.units_per_em());
        f32::from(self.face.glyph_hor_advance(ttf_parser::GlyphId(glyph)).unwrap_or(0)) * 1000.0 / units
    }

    /// Width of a text of `size` points.
    pub(super) fn width(&self, text: &str, size: f32) -> f32 {
        text.chars().map(|c| self.advance(self.glyph(c))).sum::<f32>() * size / 1000.0
    }

    /// A text as the numbers of its glyphs.
    pub(super) fn encode(&self, text: &str) -> Vec<u8> {
        text.chars().flat_map(|c| self.glyph(c).to_be_bytes()).collect()
    }

    /// Text in lines of at most `room` points, broken between words, and within a word that is longer.
    pub(super) fn lines(&self, text: &str, size: f32, room: f32) -> Vec<String> {
        let mut lines = vec![String::new()];
        for word in text.split_whitespace() {
            let last = lines.last().map_or("", String::as_str);
            let joined = if last.is_empty() { word.to_owned() } else { format!("{last} {word}") };
            if self.width(&joined, size) <= room {
                lines.pop();
                lines.push(joined);
                continue;
            }
            if last.is_empty() {
                lines.pop();
            }
            lines.extend(self.pieces(word, size, room));
        }
        lines
    }

    fn pieces(&self, word: &str, size: f32, room: f32) -> Vec<String> {
        let mut pieces = vec![String::new()];
        for c in word.chars() {
            let mut longer = pieces.last().cloned().unwrap_or_default();
            longer.push(c);
            pieces.pop();
            if self.width(&longer, size) > room && longer.chars().count() > 1 {
                // The path of a file is broken between its folders.
                let folders = longer.rfind('/').map(|at| at + 1).filter(|end| *end < longer.len());
                let rest = longer.split_off(folders.unwrap_or(longer.len() - c.len_utf8()));
                pieces.extend([longer, rest]);
            } else {
                pieces.push(longer);
            }
        }
        pieces
    }

    /// Writes the face into a file, as five objects from `first` on; gives back the font.
    pub(super) fn embed(&self, pdf: &mut Pdf, first: i32) -> Ref {
        let [font, cid, descriptor, file, unicode] = [0, 1, 2, 3, 4].map(|k| Ref::new(first + k));
        pdf.type0_font(font)
            .base_font(NAME)
            .encoding_predefined(Name(b"Identity-H"))
            .descendant_font(cid)
            .to_unicode(unicode);
        let mut own = pdf.cid_font(cid);
        own.subtype(CidFontType::Type2).base_font(NAME).system_info(IDENTITY).font_descriptor(descriptor);
        own.default_width(0.0).cid_to_gid_map_predefined(Name(b"Identity"));
        let used = self.used.borrow();
        let mut widths = own.widths();
        for &glyph in used.keys() {
            widths.consecutive(glyph, [self.advance(glyph)]);
        }
        drop(widths);
        drop(own);
        self.describe(pdf, descriptor, file);
        let bytes = compressed(epaint_default_fonts::UBUNTU_LIGHT);
        let mut stream = pdf.stream(file, &bytes);
        stream.filter(Filter::FlateDecode);
        stream.pair(Name(b"Length1"), epaint_default_fonts::UBUNTU_LIGHT.len() as i32);
        drop(stream);
        let mut map = UnicodeCmap::<u16>::new(Name(b"Dashpot"), IDENTITY);
        used.iter().for_each(|(&glyph, &c)| map.pair(glyph, c));
        let map = map.finish();
        pdf.cmap(unicode, map.as_slice());
        font
    }

    fn describe(&self, pdf: &mut Pdf, descriptor: Ref, file: Ref) {
        let scale = 1000.0 / f32::from(self.face.units_per_em());
        let thousandths = |v: i16| scale * f32::from(v);
        let bounds = self.face.global_bounding_box();
        let [x0, y0, x1, y1] = [bounds.x_min, bounds.y_min, bounds.x_max, bounds.y_max].map(thousandths);
        pdf.font_descriptor(descriptor)
            .name(NAME)
            .flags(FontFlags::NON_SYMBOLIC)
            .bbox(Rect::new(x0, y0, x1, y1))
            .italic_angle(0.0)
            .ascent(thousandths(self.face.ascender()))
            .descent(thousandths(self.face.descender()))
            .cap_height(thousandths(self.face.capital_height().unwrap_or_else(|| self.face.ascender())))
            .stem_v(60.0)
            .font_file2(file);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::Face;

    #[test]
    fn lines_are_broken_between_words_and_within_long_ones() {
        let face = Face::built_in().unwrap();
        let text = "The model explains the data: error 0.249 %, noise floor 0.242 %.";
        let lines = face.lines(text, 10.0, 120.0);
        assert!(lines.len() > 2 && lines.join(" ") == text, "{lines:?}");
        assert!(lines.iter().all(|l| face.width(l, 10.0) <= 120.0));
        let lines = face.lines(&"x".repeat(100), 10.0, 60.0);
        assert!(lines.len() > 5 && lines.concat().len() == 100);
    }

    #[test]
    fn the_signs_of_the_field_are_there() {
        let face = Face::built_in().unwrap();
        for c in "±·²³µ°ζηδωΔχ–−".chars() {
            assert!(c == '−' || face.face.glyph_index(c).is_some(), "{c}");
        }
    }
}
