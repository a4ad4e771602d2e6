//! Symbols of the stages, drawn by lines of our own.

use crate::window::app::view::Stage;
use egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, pos2};

/// Draws the symbol of a stage into a square.
pub(crate) fn stage(painter: &Painter, stage: Stage, rect: Rect, colour: Color32) {
    let pen = Stroke::new(1.5, colour);
    // Coordinates in the square from 0 to 1, y upwards.
    let point = |x: f32, y: f32| pos2(rect.left() + x * rect.width(), rect.bottom() - y * rect.height());
    let line = |points: &[(f32, f32)]| {
        let points: Vec<Pos2> = points.iter().map(|&(x, y)| point(x, y)).collect();
        painter.add(Shape::line(points, pen));
    };
    let bar = |x: f32, height: f32| {
        painter.rect_filled(Rect::from_two_pos(point(x, 0.08), point(x + 0.2, height)), 0.5, colour)
    };
    match stage {
        Stage::Measure => {
            let wave: Vec<(f32, f32)> = (0..=24)
                .map(|k| k as f32 / 24.0)
                .map(|x| (x, 0.5 + 0.38 * (std::f32::consts::TAU * 1.5 * x).sin()))
                .collect();
            line(&wave);
        }
        Stage::Structure => {
            line(&[(0.06, 0.1), (0.06, 0.9)]);
            let beam: Vec<(f32, f32)> =
                (0..=12).map(|k| k as f32 / 12.0).map(|x| (0.06 + 0.94 * x, 0.4 + 0.42 * x * x)).collect();
            line(&beam);
        }
        Stage::Pattern => {
            line(&[(0.0, 0.5), (0.34, 0.5)]);
            line(&[(0.72, 0.86), (0.34, 0.86), (0.34, 0.14), (0.72, 0.14)]);
            line(&[(0.56, 0.72), (0.56, 0.28)]);
            line(&[(0.56, 0.5), (1.0, 0.5)]);
        }
        Stage::Select => line(&[(0.0, 0.92), (0.3, 0.92), (0.3, 0.5), (0.65, 0.5), (0.65, 0.14), (1.0, 0.14)]),
        Stage::Result => {
            bar(0.06, 0.45);
            bar(0.40, 0.92);
            bar(0.74, 0.62);
        }
        Stage::Explain => {
            // A magnifying glass.
            let ring = (0..=20).map(|k| std::f32::consts::TAU * k as f32 / 20.0);
            line(&ring.map(|a| (0.40 + 0.32 * a.cos(), 0.60 + 0.32 * a.sin())).collect::<Vec<_>>());
            line(&[(0.64, 0.36), (0.96, 0.04)]);
        }
    }
}

/// The program's icon, of which `assets/icons/dashpot.svg` is the drawing; nothing where it cannot be read.
pub(crate) fn application() -> egui::IconData {
    let png = include_bytes!("../../../assets/icons/128.png");
    image::load_from_memory(png).map_or_else(
        |_| egui::IconData::default(),
        |icon| {
            let (width, height) = (icon.width(), icon.height());
            egui::IconData { rgba: icon.into_rgba8().into_raw(), width, height }
        },
    )
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_icon_is_a_light_symbol_on_a_dark_ground_with_round_corners() {
        let icon = super::application();
        assert_eq!((icon.width, icon.height), (128, 128));
        let pixel = |x: u32, y: u32| icon.rgba[4 * (y * icon.width + x) as usize..][..4].to_vec();
        assert_eq!(pixel(0, 0)[3], 0, "corners are clear");
        assert!(pixel(64, 85)[3] == 255 && pixel(64, 85)[0] < 100);
        assert!(pixel(30, 52)[0] > 240, "the rod is light");
    }
}
