//! Plots: one style for all, and the series of each kind.

pub mod angle;
pub mod bars;
pub mod bode;
pub mod drawing;
pub mod energy;
pub mod export;
pub mod figure;
pub mod heatmap;
pub mod hysteresis;
pub mod localisation;
pub mod log;
pub mod polyline;
pub mod pyramid;
pub mod record;
pub mod sheet;
pub mod show;
pub mod spectrum;
pub mod svg;
pub mod ticks;

use super::theme::{Palette, size, space};
use super::widgets::UiExt;
use egui::{Color32, FontId, Ui, vec2};
use egui_plot::{AxisHints, Corner, HPlacement, Line, Plot, PlotPoints};

/// A plot in the program's style: labelled axes, drag pans, right drag zooms a box, double click resets.
pub fn frame<'a>(ui: &Ui, id: &str, x: &'a str, y: &'a str) -> Plot<'a> {
    let palette = ui.palette();
    Plot::new(id.to_owned())
        .custom_x_axes(vec![axis(AxisHints::new_x(), palette, x).min_thickness(if x.is_empty() { 14.0 } else { 32.0 })])
        .custom_y_axes(vec![upright(palette, y).min_thickness(52.0)])
        .grid_color(palette.grid)
        .cursor_color(palette.weak)
        .set_margin_fraction(vec2(0.0, 0.08))
        .allow_scroll(false)
        .show_background(false)
        .show_axes([!x.is_empty(), true])
}

/// An axis with small type.
pub fn axis<'a>(hints: AxisHints<'a>, palette: &Palette, label: &str) -> AxisHints<'a> {
    let label = egui::RichText::new(label).size(size::SMALL).color(palette.weak);
    hints
        .label(label)
        .tick_label_color(palette.weak)
        .tick_label_font(FontId::proportional(size::SMALL))
        .label_spacing(egui::Rangef::new(22.0, 34.0))
        .formatter(|mark, _| tick(mark.value, mark.step_size))
}

/// A vertical axis at the left; lines of text lie closer than words beside each other.
pub fn upright<'a>(palette: &Palette, label: &str) -> AxisHints<'a> {
    let hints = axis(AxisHints::new_y(), palette, label).placement(HPlacement::Left);
    hints.label_spacing(egui::Rangef::new(13.0, 20.0))
}

/// A number at a grid line, with as many digits as the step asks for.
pub fn tick(value: f64, step: f64) -> String {
    if value.abs() < 1e-9 * step {
        return "0".to_owned();
    }
    let text = if (1e-3..1e5).contains(&value.abs()) {
        let decimals = (-step.log10().floor()).clamp(0.0, 6.0) as usize;
        format!("{value:.decimals$}")
    } else {
        let digits = (value.abs().log10().floor() - step.log10().floor()).clamp(0.0, 4.0) as usize;
        format!("{value:.digits$e}")
    };
    text.replace('-', "−")
}

/// A curve.
pub fn curve<'a>(name: &str, points: impl Into<PlotPoints<'a>>, colour: Color32, width: f32) -> Line<'a> {
    Line::new(name, points).color(colour).width(width).allow_hover(false)
}

/// The read-out in the corner of a plot.
pub fn readout<'a>(x: &'a str, y: &'a str) -> (Corner, egui_plot::CoordinatesFormatter<'a>) {
    let text = move |p: &egui_plot::PlotPoint, _: &egui_plot::PlotBounds| {
        let digits = super::format::significant;
        format!("{x} {}   {y} {}", digits(p.x, 4), digits(p.y, 4))
    };
    (Corner::RightTop, egui_plot::CoordinatesFormatter::new(text))
}

/// A row of keys to curves above a plot.
pub fn keys(ui: &mut Ui, entries: &[(Color32, &str)]) {
    ui.horizontal_wrapped(|ui| {
        for (colour, name) in entries {
            ui.key(*colour, name);
            ui.add_space(space::S);
        }
    });
}

#[cfg(test)]
mod tests {
    use super::tick;

    #[test]
    fn ticks_show_what_their_step_asks_for() {
        assert_eq!(tick(0.25, 0.05), "0.25");
        assert_eq!(tick(-20.0, 10.0), "−20");
        assert_eq!(tick(1e-17, 0.1), "0");
        assert_eq!(tick(2.5e-6, 5e-7), "2.5e−6");
        assert_eq!(tick(120_000.0, 20_000.0), "1.2e5");
    }
}
