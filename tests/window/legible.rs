//! What cannot be read on the screen: words over other words, and words that a pane cuts off at its side.

use egui::epaint::{ClippedShape, Shape};
use egui::{Rect, vec2};

/// Words where they stand.
struct Words {
    text: String,
    /// All of them.
    rect: Rect,
    /// As far as they are seen.
    seen: Rect,
}

fn collect(shape: &Shape, clip: Rect, all: &mut Vec<Words>) {
    match shape {
        Shape::Vec(shapes) => shapes.iter().for_each(|s| collect(s, clip, all)),
        Shape::Text(text) => {
            // Line by line: the first line of a paragraph may start after other words.
            for row in &text.galley.rows {
                let (words, rect) = (row.text(), row.visuals.mesh_bounds);
                if !words.trim().is_empty() && text.angle == 0.0 {
                    let rect = rect.translate(text.pos.to_vec2() + row.pos.to_vec2());
                    all.push(Words { text: words, rect, seen: rect.intersect(clip) });
                }
            }
        }
        _ => {}
    }
}

/// Pairs of words that lie on each other, and words cut off at the left or right. Those that scroll out of a list above or
/// below are not cut off, nor are words that `scroll` sideways by an arrow or a cursor.
pub(crate) fn faults(shapes: &[ClippedShape], scroll: impl Fn(&str) -> bool) -> Vec<String> {
    let mut all = Vec::new();
    shapes.iter().for_each(|s| collect(&s.shape, s.clip_rect, &mut all));
    all.retain(|w| w.seen.is_positive());
    let mut found = Vec::new();
    for (k, one) in all.iter().enumerate() {
        if one.seen.width() < one.rect.width() - 3.0
            && one.seen.height() > 0.6 * one.rect.height()
            && !scroll(&one.text)
        {
            found.push(format!("\"{}\" is cut off at {:?}", one.text, one.seen));
        }
        for other in &all[k + 1..] {
            let both = one.seen.shrink2(vec2(1.0, 2.0)).intersect(other.seen.shrink2(vec2(1.0, 2.0)));
            if both.width() > 1.0 && both.height() > 2.0 {
                found.push(format!("\"{}\" lies on \"{}\" at {:?}", one.text, other.text, both.min));
            }
        }
    }
    found
}
