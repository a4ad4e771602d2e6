//! The time limit of the search for what is missing: its setting, and what is said where a search was ended before its time.

use super::request::Request;
use crate::window::app::Ask;
use crate::window::appearance::theme::space;
use crate::window::appearance::widgets::UiExt;
use crate::window::language::{t, tr};
use egui::{ComboBox, RichText, Role, Ui, WidgetInfo};

/// Limits that are offered, s.
const LIMITS: [Option<f64>; 6] = [None, Some(2.0), Some(5.0), Some(15.0), Some(60.0), Some(300.0)];

fn name(limit_s: Option<f64>) -> String {
    limit_s.map_or_else(|| "no limit".to_owned(), |s| format!("{s:.0} s"))
}

/// The setting.
pub(super) fn setting(ui: &mut Ui, limit_s: Option<f64>, asks: &mut Vec<Ask>) {
    ui.add_space(space::XS);
    ui.horizontal(|ui| {
        ui.hint("Time limit of the search");
        let mut chosen = limit_s;
        let list =
            ComboBox::from_id_salt("time limit").selected_text(tr(name(limit_s))).width(76.0).show_ui(ui, |ui| {
                for limit in LIMITS {
                    ui.selectable_value(&mut chosen, limit, tr(name(limit)));
                }
            });
        let said = || {
            let mut info = WidgetInfo::labeled(Role::ComboBox, true, t!("Time limit of the search"));
            info.current_text_value = Some(name(limit_s));
            info
        };
        list.response.widget_info(said);
        list.response.on_hover_text(t!("After this time a search answers with the best that it has found so far."));
        if chosen != limit_s {
            asks.push(Ask::Explain(Request::Limit(chosen)));
        }
    });
}

/// The setting, and a button that ends the search now.
pub(super) fn while_searching(ui: &mut Ui, limit_s: Option<f64>, asks: &mut Vec<Ask>) {
    setting(ui, limit_s, asks);
    let tip = "Ends the search with the best that it has found so far.";
    if ui.button(t!("Answer with the best so far")).on_hover_text(tr(tip)).clicked() {
        asks.push(Ask::Explain(Request::Hurry));
    }
    ui.add_space(space::XS);
}

/// What is said of an answer that a limit cut short.
pub(super) fn best_so_far(ui: &mut Ui, asks: &mut Vec<Ask>) {
    ui.horizontal_wrapped(|ui| {
        let said = "The search was ended before its time: this is the best so far.";
        ui.label(RichText::new(tr(said)).color(ui.palette().warning));
        let tip = "Searches again without a time limit.";
        if ui.button(t!("Search to the end")).on_hover_text(tr(tip)).clicked() {
            asks.push(Ask::Explain(Request::SearchOn));
        }
    });
    ui.add_space(space::XS);
}
