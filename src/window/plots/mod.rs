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

use super::theme::{Palette, size};
use super::widgets::UiExt;
use egui::{Color32, FontId, Ui};
use egui_plot::{AxisHints, Line, Plot, PlotPoints};

/// A plot in the program's style: drag pans, right drag zooms a box, double click shows all.
fn frame<'a>(ui: &Ui, id: &str) -> Plot<'a> {
    let palette = ui.palette();
    Plot::new(id.to_owned())
        .grid_color(palette.grid)
        .cursor_color(palette.weak)
        .allow_scroll(false)
        .show_background(false)
}

/// An axis with small type.
fn axis<'a>(hints: AxisHints<'a>, palette: &Palette, label: &str) -> AxisHints<'a> {
    let label = egui::RichText::new(label).size(size::SMALL).color(palette.weak);
    hints
        .label(label)
        .tick_label_color(palette.weak)
        .tick_label_font(FontId::proportional(size::SMALL))
        .label_spacing(egui::Rangef::new(22.0, 34.0))
        .formatter(|mark, _| tick(mark.value, mark.step_size))
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
fn curve<'a>(name: &str, points: impl Into<PlotPoints<'a>>, colour: Color32, width: f32) -> Line<'a> {
    Line::new(name, points).color(colour).width(width).allow_hover(false)
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
