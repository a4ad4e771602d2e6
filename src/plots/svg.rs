//! A drawing as SVG 1.1: text stays text, every group is named, what lies outside an area is clipped there.

use super::drawing::{Drawing, Mark, Stroke};
use ecolor::Color32;
use emath::{Align, Align2, Pos2};
use std::fmt::Write as _;

/// Writes a drawing.
pub(crate) fn write(drawing: &Drawing) -> String {
    let (w, h) = (drawing.size.x, drawing.size.y);
    let mut svg = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    svg += &format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\" \
         font-family=\"Ubuntu, 'DejaVu Sans', Helvetica, Arial, sans-serif\">\n"
    );
    svg += &format!("<title>{}</title>\n", escaped(&drawing.title));
    svg += &format!("<rect width=\"{w}\" height=\"{h}\" {}/>\n", fill(drawing.ground));
    for (k, mark) in drawing.marks.iter().enumerate() {
        self::mark(&mut svg, mark, k);
    }
    svg += "</svg>\n";
    svg
}

fn mark(svg: &mut String, mark: &Mark, k: usize) {
    match mark {
        Mark::Line { points, stroke, dashed } => {
            let dash = if *dashed { " stroke-dasharray=\"6 4\"" } else { "" };
            let (points, stroke) = (list(points), line(*stroke));
            *svg +=
                &format!("<polyline points=\"{points}\" fill=\"none\" {stroke} stroke-linejoin=\"round\"{dash}/>\n");
        }
        Mark::Area { points, fill: inside, stroke } => {
            *svg += &format!("<polygon points=\"{}\" {} {}/>\n", list(points), fill(*inside), line(*stroke));
        }
        Mark::Disc { centre, radius, fill: inside, stroke } => {
            let (x, y) = (number(centre.x), number(centre.y));
            let (inside, stroke) = (fill(*inside), line(*stroke));
            *svg += &format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{}\" {inside} {stroke}/>\n", number(*radius));
        }
        Mark::Words { at, align, text, size, colour, upright } => {
            words(svg, *at, *align, text, *size, *colour, *upright);
        }
        Mark::Inside(rect, name) => {
            let (x, y, w, h) = (rect.left(), rect.top(), rect.width(), rect.height());
            *svg += &format!(
                "<clipPath id=\"area{k}\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>\n",
                number(x),
                number(y),
                number(w),
                number(h)
            );
            *svg += &format!("<g clip-path=\"url(#area{k})\"><desc>{}</desc>\n", escaped(name));
        }
        Mark::Whole => *svg += "</g>\n",
    }
}

fn words(svg: &mut String, at: Pos2, align: Align2, text: &str, size: f32, colour: Color32, upright: bool) {
    if text.is_empty() {
        return;
    }
    let anchor = match align.x() {
        Align::Min => "start",
        Align::Center => "middle",
        Align::Max => "end",
    };
    // The baseline by hand: not every reader knows `dominant-baseline`.
    let down = match align.y() {
        Align::Min => 0.8,
        Align::Center => 0.34,
        Align::Max => -0.2,
    } * size;
    let (x, y) = (number(at.x), number(at.y));
    let turn = if upright { format!(" transform=\"rotate(-90 {x} {y})\"") } else { String::new() };
    let place = format!("x=\"{x}\" y=\"{y}\" dy=\"{}\"", number(down));
    let (ink, text) = (fill(colour), escaped(text));
    let _ = writeln!(svg, "<text {place} font-size=\"{size}\" text-anchor=\"{anchor}\" {ink}{turn}>{text}</text>");
}

fn list(points: &[Pos2]) -> String {
    points.iter().map(|p| format!("{},{}", number(p.x), number(p.y))).collect::<Vec<_>>().join(" ")
}

/// To a thousandth of a point.
fn number(v: f32) -> String {
    let text = format!("{v:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn fill(colour: Color32) -> String {
    if colour.a() == 0 { "fill=\"none\"".to_owned() } else { paint("fill", colour) }
}

fn line(stroke: Stroke) -> String {
    if stroke.width <= 0.0 || stroke.color.a() == 0 {
        return "stroke=\"none\"".to_owned();
    }
    format!("{} stroke-width=\"{}\"", paint("stroke", stroke.color), number(stroke.width))
}

fn paint(what: &str, colour: Color32) -> String {
    let [r, g, b, a] = colour.to_srgba_unmultiplied();
    let solid = format!("{what}=\"#{r:02x}{g:02x}{b:02x}\"");
    if a == 255 { solid } else { format!("{solid} {what}-opacity=\"{}\"", number(f32::from(a) / 255.0)) }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::write;
    use crate::plots::figure::{Axis, Figure, Look};
    use crate::plots::sheet::{Panel, Sheet, inner};
    use crate::plots::style::Palette;
    use emath::{Rect, pos2, vec2};
    use quick_xml::Reader;
    use quick_xml::events::Event;

    fn sheet() -> Sheet {
        let palette = Palette::light();
        let model: Vec<[f64; 2]> = (1..40).map(|k| [f64::from(k), 1e-3 / f64::from(k).powi(2)]).collect();
        let figure = Figure::new("Receptance <7, 19>", Axis::log("Frequency", "Hz"), Axis::log("Magnitude", "m/N"))
            .points("model", palette.model, Look::Line(1.8), model)
            .points("measured", palette.measured, Look::Dots(4.0), vec![[2.0, 2.4e-4], [10.0, 1.1e-5]])
            .deviation(vec![1e-5, 2e-6]);
        let bounds = figure.bounds();
        Sheet { title: "Bode & more".to_owned(), columns: 1, panels: vec![Panel { figure, bounds }] }
    }

    /// Every element with its attributes; fails where it is not well formed.
    fn elements(svg: &str) -> Vec<(String, Vec<(String, String)>)> {
        let mut reader = Reader::from_str(svg);
        let mut found = Vec::new();
        loop {
            match reader.read_event().unwrap() {
                Event::Start(e) | Event::Empty(e) => {
                    let text = |b: &[u8]| String::from_utf8(b.to_vec()).unwrap();
                    let pairs = e.attributes().map(|a| a.unwrap()).map(|a| (text(a.key.as_ref()), text(&a.value)));
                    found.push((text(e.name().as_ref()), pairs.collect()));
                }
                Event::Eof => return found,
                _ => {}
            }
        }
    }

    fn attribute(element: &(String, Vec<(String, String)>), name: &str) -> Option<f64> {
        element.1.iter().find(|(k, _)| k == name).and_then(|(_, v)| v.parse().ok())
    }

    #[test]
    fn a_file_is_well_formed_and_holds_every_point_at_its_place() {
        let sheet = sheet();
        let size = vec2(800.0, 500.0);
        let svg = write(&sheet.drawing(size, Palette::light()));
        let elements = elements(&svg);
        let panel = &sheet.panels[0];
        let area = inner(Rect::from_min_max(pos2(0.0, 34.0), size.to_pos2()));
        // Back from places on the paper to values.
        let value = |x: f64, y: f64| {
            let share = [
                (x - f64::from(area.left())) / f64::from(area.width()),
                (f64::from(area.bottom()) - y) / f64::from(area.height()),
            ];
            let place = [0, 1].map(|k| panel.bounds[k][0] + share[k] * (panel.bounds[k][1] - panel.bounds[k][0]));
            [panel.figure.x.value(place[0]), panel.figure.y.value(place[1])]
        };
        let near = |a: [f64; 2], b: [f64; 2]| (0..2).all(|k| (a[k] / b[k] - 1.0).abs() < 1e-3);
        let circles: Vec<[f64; 2]> =
            elements.iter().filter_map(|e| Some(value(attribute(e, "cx")?, attribute(e, "cy")?))).collect();
        for wanted in [[2.0, 2.4e-4], [10.0, 1.1e-5]] {
            assert!(circles.iter().any(|c| near(*c, wanted)), "{wanted:?} in {circles:?}");
        }
        let longest = elements
            .iter()
            .filter(|e| e.0 == "polyline")
            .map(|e| e.1.iter().find(|(k, _)| k == "points").unwrap().1.clone())
            .max_by_key(String::len)
            .unwrap();
        let curve: Vec<[f64; 2]> = longest
            .split(' ')
            .map(|p| p.split_once(',').map(|(x, y)| value(x.parse().unwrap(), y.parse().unwrap())).unwrap())
            .collect();
        assert_eq!(curve.len(), 39);
        for (k, point) in curve.iter().enumerate() {
            let x = (k + 1) as f64;
            assert!(near(*point, [x, 1e-3 / (x * x)]), "{point:?}");
        }
    }

    #[test]
    fn labels_units_and_special_letters_are_written() {
        let svg = write(&sheet().drawing(vec2(800.0, 500.0), Palette::light()));
        for text in ["Frequency, Hz", "Magnitude, m/N", "Receptance &lt;7, 19&gt;", "Bode &amp; more", ">measured<"] {
            assert!(svg.contains(text), "{text}");
        }
    }
}
