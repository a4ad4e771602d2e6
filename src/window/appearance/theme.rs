//! The looks of the window, in one file: type scale, spacing and the visuals of every widget, light and dark. Colours and
//! sizes of type are those of the plots.

use crate::plots::style;
pub use crate::plots::style::{Palette, size};
use crate::window::language::numbers;
use egui::style::NumberFormatter;
use egui::{Color32, CornerRadius, FontFamily, FontId, Margin, Shadow, Stroke, Style, TextStyle, Theme, Visuals};

/// Distances in points.
pub mod space {
    /// Between a symbol and its text.
    pub const XS: f32 = 4.0;
    /// Between widgets.
    pub const S: f32 = 8.0;
    /// Inside cards and panes.
    pub const M: f32 = 12.0;
    /// Between groups.
    pub const L: f32 = 18.0;
    /// Around the start screen.
    pub const XL: f32 = 28.0;
    /// Height of a row in a table.
    pub const ROW: f32 = 24.0;
    /// Gap between two panes.
    pub const GAP: f32 = 6.0;
}

impl Palette {
    /// The palette of the theme in force.
    pub fn of(visuals: &Visuals) -> &'static Self {
        if visuals.dark_mode { Self::dark() } else { Self::light() }
    }
}

/// Thin line.
pub fn hair(colour: Color32) -> Stroke {
    style::hair(colour).into()
}

/// Line of symbols.
pub fn pen(colour: Color32) -> Stroke {
    style::pen(colour).into()
}

/// Line of the structure and of curves that matter.
pub fn bold(colour: Color32) -> Stroke {
    style::bold(colour).into()
}

/// Font of `size` points.
pub fn font(size: f32) -> FontId {
    FontId::new(size, FontFamily::Proportional)
}

/// Installs both themes. Called once.
pub fn install(ctx: &egui::Context) {
    ctx.set_style_of(Theme::Light, widgets(Palette::light(), Visuals::light()));
    ctx.set_style_of(Theme::Dark, widgets(Palette::dark(), Visuals::dark()));
}

fn widgets(palette: &Palette, base: Visuals) -> Style {
    let mut style = Style { visuals: visuals(palette, base), ..Style::default() };
    style.text_styles = [
        (TextStyle::Small, font(size::SMALL)),
        (TextStyle::Body, font(size::BODY)),
        (TextStyle::Button, font(size::BODY)),
        (TextStyle::Heading, font(size::HEADING)),
        (TextStyle::Monospace, FontId::new(size::BODY - 1.0, FontFamily::Monospace)),
    ]
    .into();
    style.animation_time = 0.08;
    style.number_formatter = NumberFormatter::new(numbers::formatted);
    let spacing = &mut style.spacing;
    spacing.item_spacing = egui::vec2(space::S, 5.0);
    spacing.button_padding = egui::vec2(10.0, 4.0);
    spacing.interact_size.y = 24.0;
    spacing.menu_margin = Margin::same(6);
    spacing.window_margin = Margin::same(14);
    spacing.scroll = egui::style::ScrollStyle::thin();
    style
}

fn visuals(palette: &Palette, base: Visuals) -> Visuals {
    let mut v = base;
    v.override_text_color = None;
    v.weak_text_color = Some(palette.weak);
    v.panel_fill = palette.pane;
    v.window_fill = palette.pane;
    v.window_stroke = hair(palette.line);
    v.window_corner_radius = CornerRadius::same(8);
    v.menu_corner_radius = CornerRadius::same(6);
    v.extreme_bg_color = palette.canvas;
    v.faint_bg_color = palette.raised.gamma_multiply(0.55);
    v.code_bg_color = palette.raised;
    v.hyperlink_color = palette.accent;
    v.warn_fg_color = palette.warning;
    v.error_fg_color = palette.error;
    v.selection.bg_fill = palette.accent_faint;
    v.selection.stroke = hair(palette.accent);
    v.window_shadow = Shadow { offset: [0, 6], blur: 22, spread: 0, color: Color32::from_black_alpha(50) };
    v.popup_shadow = Shadow { offset: [0, 3], blur: 10, spread: 0, color: Color32::from_black_alpha(40) };
    for (widget, fill, line, text) in [
        (&mut v.widgets.noninteractive, palette.pane, palette.line, palette.ink),
        (&mut v.widgets.inactive, palette.raised, palette.line, palette.ink),
        (&mut v.widgets.hovered, palette.accent_faint, palette.accent, palette.ink),
        (&mut v.widgets.active, palette.accent_faint, palette.accent, palette.accent),
        (&mut v.widgets.open, palette.raised, palette.accent, palette.ink),
    ] {
        widget.bg_fill = fill;
        widget.weak_bg_fill = fill;
        widget.bg_stroke = hair(line);
        widget.fg_stroke = hair(text);
        widget.corner_radius = CornerRadius::same(5);
        widget.expansion = 0.0;
    }
    v
}
