//! Horizontal bars with a name at the left and a figure at the right: shares of energy.

use super::drawing::{Drawing, Stroke};
use super::style::{Palette, size};
use crate::display::format;
use ecolor::Color32;
use emath::{Align2, Rect, pos2, vec2};

/// One bar.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Bar {
    /// At the left.
    pub name: String,
    /// Share from 0 to 1.
    pub share: f64,
    /// Colour.
    pub colour: Color32,
}

impl Bar {
    /// Part of the track that is filled: the share itself, so that 34 % fill 34 % of it.
    pub(crate) fn filled(&self) -> f32 {
        self.share.abs().min(1.0) as f32
    }
}

/// Height of a row.
pub(crate) const ROW: f32 = 24.0;

/// Bars under each other on paper.
pub(crate) fn draw(bars: &[Bar], title: &str, name_width: f32, palette: &Palette) -> Drawing {
    let size = vec2(720.0, 56.0 + ROW * bars.len() as f32);
    let mut drawing = Drawing::new(size, palette.canvas, title);
    drawing.words(pos2(16.0, 20.0), Align2::LEFT_CENTER, title, size::HEADING, palette.ink);
    for (k, bar) in bars.iter().enumerate() {
        let y = 52.0 + ROW * k as f32;
        let (left, right) = (16.0 + name_width, size.x - 90.0);
        drawing.words(pos2(16.0, y), Align2::LEFT_CENTER, bar.name.clone(), size::BODY, palette.ink);
        let figure = format::percent(bar.share);
        drawing.words(pos2(size.x - 16.0, y), Align2::RIGHT_CENTER, figure, size::BODY, palette.ink);
        let end = left + (right - left) * bar.filled();
        let rect = Rect::from_min_max(pos2(left, y - 6.0), pos2(end.max(left + 1.0), y + 6.0));
        let track = Rect::from_min_max(pos2(left, y - 6.0), pos2(right, y + 6.0));
        drawing.rect(track, palette.raised, Stroke::NONE);
        drawing.rect(rect, bar.colour, Stroke::NONE);
    }
    drawing
}

/// Names and shares as a table with tabs.
pub(crate) fn table(bars: &[Bar]) -> String {
    bars.iter().fold("name\tshare, %\n".to_owned(), |text, b| text + &format!("{}\t{:e}\n", b.name, 100.0 * b.share))
}

#[cfg(test)]
mod tests {
    use super::{Bar, draw};
    use crate::plots::drawing::Mark;
    use crate::plots::style::Palette;

    #[test]
    fn a_share_fills_its_part_of_the_track() {
        let palette = Palette::light();
        let bar = |share| Bar { name: "a".to_owned(), share, colour: palette.model };
        let drawing = draw(&[bar(0.66), bar(0.34)], "Energy", 200.0, palette);
        let areas: Vec<f32> = drawing
            .marks
            .iter()
            .filter_map(|m| if let Mark::Area { points, .. } = m { Some(points[1].x - points[0].x) } else { None })
            .collect();
        assert_eq!(areas.len(), 4, "a track and a bar each");
        assert!((areas[1] / areas[0] - 0.66).abs() < 1e-3 && (areas[3] / areas[2] - 0.34).abs() < 1e-3, "{areas:?}");
    }
}
