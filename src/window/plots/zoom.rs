//! What is in sight of a plot: the way back and on through what was zoomed into, and limits that are typed.
//!
//! Plots of one stack have one history, as they move together. Only what the user does makes a step of it; other data move
//! the limits too, but there is no way back to data that are gone.

use crate::plots::figure::{Axis, Figure, Scale, Ticks};
use crate::window::appearance::theme::space;
use crate::window::appearance::widgets::UiExt;
use crate::window::language::{numbers, t, tf, tr};
use egui::{Context, DragValue, Grid, Id, Key, Modifiers, Response, Ui, Window};
use egui_plot::{PlotBounds, PlotUi};

/// Steps that are kept.
const MOST: usize = 50;
/// Share of a range by which limits must differ to be others.
const SAME: f64 = 1e-9;

/// First and last place along x and along y.
pub(crate) type Sight = [[f64; 2]; 2];

/// What is asked of the plots of a stack.
#[derive(Debug, Clone, PartialEq)]
enum Want {
    /// Everything in sight.
    All,
    /// These limits, a pair a plot.
    These(Vec<Sight>),
}

/// The history of a stack, kept from frame to frame.
#[derive(Debug, Clone, Default)]
struct Kept {
    past: Vec<Vec<Sight>>,
    future: Vec<Vec<Sight>>,
    now: Vec<Sight>,
    want: Option<Want>,
    /// Whether the user has moved something since the last step.
    touched: bool,
    /// Whether limits are being typed.
    typing: bool,
}

impl Kept {
    fn of(ctx: &Context, id: Id) -> Self {
        ctx.data(|d| d.get_temp(id)).unwrap_or_default()
    }

    fn keep(self, ctx: &Context, id: Id) {
        ctx.data_mut(|d| d.insert_temp(id, self));
    }

    /// What is in sight now becomes a step, where it is another.
    fn step(&mut self, now: Vec<Sight>) {
        let others = now.len() != self.now.len() || now.iter().zip(&self.now).any(|(a, b)| differ(a, b));
        if self.touched && others && !self.now.is_empty() {
            self.past.push(std::mem::take(&mut self.now));
            self.past.drain(..self.past.len().saturating_sub(MOST));
            self.future.clear();
        }
        (self.now, self.touched) = (now, false);
    }

    /// One step back or on.
    fn go(&mut self, back: bool) {
        let (from, to) = if back { (&mut self.past, &mut self.future) } else { (&mut self.future, &mut self.past) };
        if let Some(sights) = from.pop() {
            to.push(std::mem::replace(&mut self.now, sights.clone()));
            self.want = Some(Want::These(sights));
        }
    }
}

fn differ(a: &Sight, b: &Sight) -> bool {
    let axis = |a: [f64; 2], b: [f64; 2]| {
        let span = (a[1] - a[0]).abs().max((b[1] - b[0]).abs());
        (a[0] - b[0]).abs() > SAME * span || (a[1] - b[1]).abs() > SAME * span
    };
    axis(a[0], b[0]) || axis(a[1], b[1])
}

/// The history of the plots that are drawn now.
pub(crate) struct Zoom {
    id: Id,
    wanted: Option<Want>,
}

impl Zoom {
    /// Before the plots of the stack `name` are drawn.
    pub(crate) fn begin(ctx: &Context, name: &str) -> Self {
        let id = Id::NULL.with(("zoom", name));
        let mut kept = Kept::of(ctx, id);
        let wanted = kept.want.take();
        if wanted.is_some() {
            kept.keep(ctx, id);
        }
        Self { id, wanted }
    }

    /// Moves the plot number `k` to what was asked for.
    pub(crate) fn apply(&self, plot: &mut PlotUi<'_>, k: usize) {
        match &self.wanted {
            None => {}
            Some(Want::All) => plot.set_auto_bounds(true),
            Some(Want::These(sights)) => {
                if let Some([x, y]) = sights.get(k) {
                    plot.set_plot_bounds(PlotBounds::from_min_max([x[0], y[0]], [x[1], y[1]]));
                }
            }
        }
    }

    /// The limits that were asked for of what is drawn as cells; `whole` is everything.
    pub(super) fn placed(&self, whole: Sight) -> Option<Sight> {
        match self.wanted.as_ref()? {
            Want::All => Some(whole),
            Want::These(sights) => sights.first().copied(),
        }
    }

    /// After the plots are drawn: takes the steps of the user, his keys, and shows the window of limits.
    pub(crate) fn end(self, ui: &Ui, plots: &[(&Response, &Figure, Sight)]) {
        let ctx = ui.ctx();
        let mut kept = Kept::of(ctx, self.id);
        let before = (kept.past.len(), kept.future.len(), kept.typing, kept.touched);
        let moved = |r: &Response| r.dragged() || r.drag_stopped() || r.double_clicked();
        kept.touched |= plots.iter().any(|(r, ..)| moved(r));
        let now: Vec<Sight> = plots.iter().map(|p| p.2).collect();
        let asked = self.wanted.is_some();
        if asked || !ctx.input(|i| i.pointer.any_down()) {
            kept.step(now.clone());
        }
        if plots.iter().any(|(r, ..)| r.hovered()) && !ctx.egui_wants_keyboard_input() {
            let pressed = |m: Modifiers| ctx.input_mut(|i| i.consume_key(m, Key::Backspace));
            if pressed(Modifiers::SHIFT) {
                kept.go(false);
            } else if pressed(Modifiers::NONE) {
                kept.go(true);
            }
        }
        if kept.typing {
            limits(ctx, self.id, &mut kept, plots);
        }
        let typed = plots.iter().any(|(_, f, _)| !is_named(&f.x) || !is_named(&f.y));
        for (response, ..) in plots {
            ctx.data_mut(|d| d.insert_temp(response.id.with("its zoom"), (self.id, typed)));
        }
        if kept.want.is_some() || before != (kept.past.len(), kept.future.len(), kept.typing, kept.touched) {
            ctx.request_repaint();
        }
        kept.keep(ctx, self.id);
    }
}

/// Entries of the menu of a plot.
pub(crate) fn menu(ui: &mut Ui, plot: &Response) {
    let ctx = ui.ctx().clone();
    let Some((id, typed)) = ctx.data(|d| d.get_temp::<(Id, bool)>(plot.id.with("its zoom"))) else { return };
    let mut kept = Kept::of(&ctx, id);
    let mut chosen = false;
    let mut entry = |ui: &mut Ui, can: bool, label: &str, keys: &str| {
        let button = egui::Button::new(tr(label)).shortcut_text(tr(keys));
        let clicked = ui.add_enabled(can, button).clicked();
        chosen |= clicked;
        clicked
    };
    ui.separator();
    if entry(ui, !kept.past.is_empty(), "Zoom back", "Backspace") {
        kept.go(true);
    }
    if entry(ui, !kept.future.is_empty(), "Zoom on", "Shift+Backspace") {
        kept.go(false);
    }
    if entry(ui, true, "Show all", "double click") {
        (kept.want, kept.touched) = (Some(Want::All), true);
    }
    if typed && entry(ui, true, "Axis limits…", "") {
        kept.typing = true;
    }
    if chosen {
        kept.keep(&ctx, id);
        ctx.request_repaint();
        ui.close();
    }
}

/// The window in which limits are typed, in the units of the axes.
fn limits(ctx: &Context, id: Id, kept: &mut Kept, plots: &[(&Response, &Figure, Sight)]) {
    let mut sights: Vec<Sight> = plots.iter().map(|p| p.2).collect();
    let Some(place) = plots.first().map(|(r, ..)| r.rect) else { return };
    let (mut open, mut close, mut all, mut typed) = (true, false, false, false);
    let window = Window::new(t!("Axis limits")).id(id.with("limits")).collapsible(false).resizable(false);
    window.default_pos(place.left_top()).open(&mut open).show(ctx, |ui| {
        Grid::new("limits").num_columns(4).spacing([space::S, space::XS]).show(ui, |ui| {
            for name in ["Axis", "From", "To", "Unit"] {
                ui.hint(name);
            }
            ui.end_row();
            let mut x = sights.first().map_or([0.0, 1.0], |s| s[0]);
            if plots.first().is_some_and(|(_, f, _)| row(ui, &f.x, &mut x)) {
                typed = true;
                sights.iter_mut().for_each(|s| s[0] = x);
            }
            for ((_, figure, _), sight) in plots.iter().zip(&mut sights) {
                typed |= row(ui, &figure.y, &mut sight[1]);
            }
        });
        ui.add_space(space::S);
        ui.horizontal(|ui| {
            all = ui.button(t!("Show all")).clicked();
            close = ui.button(t!("Close")).clicked();
        });
    });
    kept.typing = open && !close;
    if typed || all {
        kept.want = Some(if all { Want::All } else { Want::These(sights) });
        kept.touched = true;
    }
}

/// Whether names stand along an axis in place of numbers.
fn is_named(axis: &Axis) -> bool {
    matches!(axis.ticks, Ticks::Names(_))
}

/// The limits of an axis; true when one was changed to another that makes sense.
fn row(ui: &mut Ui, axis: &Axis, range: &mut [f64; 2]) -> bool {
    if is_named(axis) {
        return false;
    }
    let read = range.map(|place| crate::display::format::rounded(axis.read(place)));
    let mut ends = read;
    ui.label(tr(&axis.name));
    for (k, name) in ["From", "To"].into_iter().enumerate() {
        let speed = 0.005 * (read[1] - read[0]).abs().max(1e-12);
        let value = ends[k];
        let drag = DragValue::new(&mut ends[k])
            .speed(speed)
            .update_while_editing(false)
            .custom_formatter(|v, _| numbers::editable(v))
            .custom_parser(numbers::typed);
        let label = tf!("{}, {}", axis.name, name.to_lowercase());
        let response = ui.add_sized([92.0, 22.0], drag);
        response.widget_info(|| egui::WidgetInfo {
            label: Some(label.clone()),
            ..egui::WidgetInfo::drag_value(true, value)
        });
    }
    ui.hint(crate::display::format::pretty_unit(&axis.unit));
    ui.end_row();
    let places = ends.map(|v| if axis.scale == Scale::Log { v.log10() } else { v });
    let sensible = places.iter().all(|v| v.is_finite()) && places[1] > places[0];
    if ends == read || !sensible {
        return false;
    }
    // The other end stays where it was, to the last digit.
    for k in 0..2 {
        if ends[k] != read[k] {
            range[k] = places[k];
        }
    }
    true
}
