//! Runs that do not fit the others: said before all else, each left out by one click.

use super::request::Request;
use crate::diagnosis::Diagnosis;
use crate::display::format::in_words;
use crate::measurement::Run;
use crate::window::app::Ask;
use crate::window::appearance::theme::space;
use crate::window::appearance::widgets::UiExt;
use crate::window::language::tr;
use egui::{Align, Layout, RichText, Ui};

/// Shows the faults with the error with and without their runs.
pub(super) fn show(ui: &mut Ui, diagnosis: &Diagnosis, runs: &[Run], asks: &mut Vec<Ask>) {
    let Some(first) = diagnosis.run_faults.first() else { return };
    ui.title("Runs first", "what follows is without them");
    for (k, fault) in diagnosis.run_faults.iter().enumerate() {
        ui.horizontal(|ui| {
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let tip = "The run is not used any more; its record stays where it is. Undo takes it back.";
                if ui.primary("Leave out").on_hover_text(tr(tip)).clicked() {
                    asks.push(Ask::Explain(Request::LeaveOut(k)));
                }
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                    ui.add(egui::Label::new(RichText::new(tr(fault.words(runs))).color(ui.palette().missing)).wrap());
                });
            });
        });
    }
    let [before, after] = [first.error_before, first.error_after].map(in_words);
    ui.hint(format!("What is found leaves {before} with all runs, {after} without."));
    ui.add_space(space::XS);
}
