//! What is asked before unsaved changes are left behind.

use crate::window::app::ask::Ask;
use crate::window::app::leaving::Changes;
use crate::window::appearance::theme::{size, space};
use crate::window::appearance::widgets::UiExt;
use crate::window::language::{t, tf};
use egui::{Context, Frame, Id, Margin, Modal, RichText};

/// Asks what becomes of the changes of the project with this title.
pub(crate) fn show(ctx: &Context, title: &str, asks: &mut Vec<Ask>) {
    let frame = Frame::popup(&ctx.global_style()).inner_margin(Margin::same(18));
    let modal = Modal::new(Id::unique("leave")).frame(frame).show(ctx, |ui| {
        ui.set_width(360.0);
        ui.label(RichText::new(t!("Save the changes?")).size(size::HEADING));
        ui.add_space(space::XS);
        ui.label(tf!("\"{title}\" has changes that are not saved."));
        ui.add_space(space::M);
        ui.horizontal(|ui| {
            if ui.primary("Save").clicked() {
                asks.push(Ask::Leave(Changes::Save));
            }
            if ui.button(t!("Discard")).clicked() {
                asks.push(Ask::Leave(Changes::Discard));
            }
            if ui.button(t!("Stay")).clicked() {
                asks.push(Ask::Leave(Changes::Keep));
            }
        });
    });
    if modal.should_close() {
        asks.push(Ask::Leave(Changes::Keep));
    }
}
