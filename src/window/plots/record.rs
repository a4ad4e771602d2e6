//! Records in their panes.

use super::show::Stack;
use crate::measurement::ChannelFit;
use crate::plots::record::{RecordPlot, lane_figures};
use crate::plots::trace::Trace;
use crate::window::appearance::widgets::UiExt;
use egui::Ui;
use std::sync::Arc;

impl RecordPlot<'_> {
    /// Shows record and residual in the room there is.
    pub fn show(&self, ui: &mut Ui) {
        let figures = self.figures(ui.palette());
        Stack { id: self.id, title: &format!("Record, {}", self.id), figures, keys: true }.show(ui);
    }
}

/// Height of a lane below which the lanes are scrolled.
const LANE: f32 = 64.0;

/// Records of all channels of a run under each other on one axis of time.
pub(crate) fn lanes(ui: &mut Ui, run: usize, shown: &[(&ChannelFit, Arc<Trace>)], omega: f64) {
    let figures = lane_figures(ui.palette(), shown, omega);
    let title = format!("Records of run {}", run + 1);
    let height = (LANE * shown.len() as f32).max(ui.available_height() - 8.0);
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.allocate_ui(egui::vec2(ui.available_width(), height), |ui| {
            Stack { id: &title, title: &title, figures, keys: false }.show(ui);
        });
    });
}
