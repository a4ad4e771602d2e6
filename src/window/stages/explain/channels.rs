//! Channels that were found to read wrongly: said before all else, each mended by one click.

use super::request::Request;
use crate::diagnosis::Diagnosis;
use crate::diagnosis::channels::{ChannelFault, Fault};
use crate::display::format::in_words;
use crate::window::app::Ask;
use crate::window::appearance::theme::space;
use crate::window::appearance::widgets::UiExt;
use crate::window::language::tr;
use egui::{Align, Layout, RichText, Ui};

/// Shows the faults with the error before and after.
pub(super) fn show(ui: &mut Ui, diagnosis: &Diagnosis, asks: &mut Vec<Ask>) {
    if diagnosis.channel_faults.is_empty() {
        return;
    }
    ui.title("Channels first", "what follows is with them mended");
    for (k, fault) in diagnosis.channel_faults.iter().enumerate() {
        ui.horizontal(|ui| {
            let words = fault.words();
            let words = if words.ends_with('?') { words } else { words + "." };
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                if is_mendable(fault) {
                    let tip = "Writes it into the mapping of the channel. Undo takes it back.";
                    if ui.primary("Mend").on_hover_text(tr(tip)).clicked() {
                        asks.push(Ask::Explain(Request::Mend(k)));
                    }
                }
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                    ui.add(egui::Label::new(RichText::new(tr(words)).color(ui.palette().missing)).wrap());
                });
            });
        });
        let [before, after] = [fault.error_before, fault.error_after].map(in_words);
        if is_mendable(fault) {
            ui.hint(format!("Error of all channels {before} before, {after} after: {}.", fault.evidence()));
        } else {
            ui.hint(fault.evidence());
        }
    }
    ui.add_space(space::XS);
}

/// A channel that scatters has no mapping that mends it.
fn is_mendable(fault: &ChannelFault) -> bool {
    !matches!(fault.fault, Fault::Unreliable(_))
}
