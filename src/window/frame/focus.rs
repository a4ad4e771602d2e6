//! The ring about what has the focus of the keyboard, whatever it is.

use crate::window::appearance::theme::{Palette, bold};
use egui::{Context, Id, Key, LayerId, Order, Rect, StrokeKind};

/// Keys that carry the focus on.
const CARRY: [Key; 5] = [Key::Tab, Key::ArrowUp, Key::ArrowDown, Key::ArrowLeft, Key::ArrowRight];

/// Room between what has the focus and its ring, points.
const ROOM: f32 = 2.0;

/// Shows it where the keyboard moved the focus last (`by_keyboard`); a press of the pointer hides it.
pub(crate) fn show(ctx: &Context, by_keyboard: &mut bool) {
    let (pointed, carried) = ctx.input(|i| (i.pointer.any_pressed(), CARRY.iter().any(|key| i.key_pressed(*key))));
    *by_keyboard = (*by_keyboard || carried) && !pointed;
    if let Some(rect) = focused(ctx).filter(|_| *by_keyboard) {
        let painter = ctx.layer_painter(LayerId::new(Order::Tooltip, Id::unique("focus")));
        let colour = Palette::of(&ctx.global_style().visuals).accent;
        painter.rect_stroke(rect.expand(ROOM), 4.0, bold(colour), StrokeKind::Middle);
    }
}

/// Where what has the focus is in sight.
fn focused(ctx: &Context) -> Option<Rect> {
    let id = ctx.memory(egui::Memory::focused)?;
    ctx.read_response(id).map(|response| response.interact_rect).filter(Rect::is_positive)
}
