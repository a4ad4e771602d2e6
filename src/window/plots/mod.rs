//! Plots: one style for all, and the series of each kind.

pub(crate) mod bars;
pub(crate) mod cell_map;
pub(crate) mod charts;
mod corner;
pub(crate) mod cursors;
pub mod export;
pub(crate) mod heatmap;
pub(crate) mod hysteresis;
pub(crate) mod localisation;
pub(crate) mod paint;
pub(crate) mod polyline;
pub(crate) mod record;
pub(crate) mod show;
pub(crate) mod spectrogram;
pub(crate) mod table;
pub(crate) mod zoom;

use crate::plots::ticks::tick;
use crate::window::appearance::theme::{Palette, size};
use crate::window::appearance::widgets::UiExt;
use crate::window::language::tr;
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
    let label = egui::RichText::new(tr(label)).size(size::SMALL).color(palette.weak);
    hints
        .label(label)
        .tick_label_color(palette.weak)
        .tick_label_font(FontId::proportional(size::SMALL))
        .label_spacing(egui::Rangef::new(22.0, 34.0))
        .formatter(|mark, _| tr(tick(mark.value, mark.step_size)))
}

/// A curve.
fn curve<'a>(name: &str, points: impl Into<PlotPoints<'a>>, colour: Color32, width: f32) -> Line<'a> {
    Line::new(name, points).color(colour).width(width).allow_hover(false)
}
