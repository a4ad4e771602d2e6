//! Notifications that stay until they are closed, and the list of all messages.

use crate::window::app::ask::{Ask, Message};
use crate::window::appearance::theme::{self, Palette, space};
use crate::window::appearance::widgets::UiExt;
use crate::window::language::{t, tr};
use egui::{Align, Align2, Area, Context, Frame, Id, Label, Layout, Margin, Order, RichText, ScrollArea, Window, vec2};

/// Shows a failure that was not closed yet.
pub(crate) fn show(ctx: &Context, message: Option<&Message>, asks: &mut Vec<Ask>) {
    if let Some(message) = message.filter(|m| m.failed) {
        card(ctx, message, asks);
    }
}

/// The list of all messages, where it is open.
pub(crate) fn list(ctx: &Context, messages: &[Message], open: &mut bool) {
    Window::new(t!("Messages")).open(open).default_size([520.0, 260.0]).collapsible(false).show(ctx, |ui| {
        if messages.is_empty() {
            ui.hint("Nothing has been said yet.");
            return;
        }
        if ui.button(t!("Copy all")).clicked() {
            let lines: Vec<&str> = messages.iter().map(|m| m.text.as_str()).collect();
            ui.ctx().copy_text(lines.join("\n"));
        }
        ScrollArea::vertical().auto_shrink(false).stick_to_bottom(true).show(ui, |ui| {
            for message in messages {
                let colour = if message.failed { ui.palette().error } else { ui.palette().ink };
                ui.add(Label::new(RichText::new(tr(&message.text)).color(colour)).wrap());
            }
        });
    });
}

fn card(ctx: &Context, message: &Message, asks: &mut Vec<Ask>) {
    let text = &message.text;
    let palette = Palette::of(&ctx.global_style().visuals);
    Area::new(Id::unique("notice")).order(Order::Foreground).anchor(Align2::RIGHT_BOTTOM, vec2(-14.0, -44.0)).show(
        ctx,
        |ui| {
            Frame::new()
                .fill(palette.pane)
                .stroke(theme::pen(palette.error))
                .corner_radius(egui::CornerRadius::same(6))
                .inner_margin(Margin::same(12))
                .show(ui, |ui| {
                    ui.set_width(380.0);
                    ui.add(Label::new(RichText::new(tr(text)).color(palette.ink)).wrap());
                    ui.add_space(space::XS);
                    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                        if ui.button(t!("Close")).clicked() {
                            asks.push(Ask::Dismiss);
                        }
                        if ui.button(t!("Copy")).clicked() {
                            ui.ctx().copy_text(text.to_owned());
                        }
                        if let Some(project) = &message.restore
                            && ui.primary("Restore").clicked()
                        {
                            asks.push(Ask::Open(project.clone()));
                        }
                    });
                });
        },
    );
}
