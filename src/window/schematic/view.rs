//! The schematic as a widget: joins model, layout, hit test and paint, and gives back intents.

use super::gesture::{self, Drag, Intent};
use super::hit::{self, Target};
use super::paint::{self, Marks};
use super::{Camera, Layout, Scene};
use crate::display::format;
use crate::effects::Effect;
use crate::window::appearance::theme::{self, Palette};
use crate::window::appearance::widgets::{elided, width};
use crate::window::language::{t, tr};
use crate::window::solid::{self, wire::Wire};
use egui::{CursorIcon, Key, Pos2, Rect, Response, Role, Sense, Ui, Vec2, WidgetInfo, pos2, vec2};

/// Points about a node of a wire model within which it is pointed at.
const NODE_REACH: f32 = 4.0;
/// Height of the caption and of the letter above an arrow, and half the width of that letter, points.
const CAPTION: f32 = 36.0;
const ARROW: f32 = 14.0;
/// Height of a pane below which the caption stands where it covers nothing or not at all, and distance of the caption from its edges,
/// there and elsewhere, points.
const LOW: f32 = 140.0;
const ASIDE: [f32; 2] = [5.0, 12.0];
/// What stands between the parts of a caption.
pub(crate) const SEPARATOR: &str = "   ·   ";

/// What the widget remembers between frames; neither saved nor undone.
#[derive(Debug, Clone, Default)]
pub struct ViewState {
    /// Direction of view of a wire model; `None` is the one from which it fills the pane best.
    pub camera: Option<Camera>,
    /// A drag in progress.
    pub drag: Option<Drag>,
    /// What the menu that is open is about.
    pub menu: Option<Target>,
}

/// What to show.
#[derive(Debug, Clone, Copy)]
pub(crate) struct View<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Displacement per DOF.
    pub shape: Option<&'a [f64]>,
    /// The translation that is drawn at the fixed size.
    pub largest: f64,
    /// Share per DOF.
    pub shares: Option<&'a [f32]>,
    /// Whether the shares are those of the model's error, not of the energy.
    pub errors: bool,
    /// Selected DOF or source slot.
    pub selected: Option<Target>,
    /// The law that clicks and drags draw; `None` where the pattern is not edited.
    pub law: Option<Effect>,
    /// A line in the top left corner: what is shown.
    pub caption: &'a str,
}

impl View<'_> {
    /// Shows the schematic in all the room there is; gives back what was asked for.
    pub(crate) fn show(&self, ui: &mut Ui, state: &mut ViewState) -> Vec<Intent> {
        let palette = Palette::of(ui.visuals());
        let (area, canvas) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        canvas.widget_info(|| WidgetInfo::labeled(Role::Image, true, t!("Schematic")));
        let camera = state.camera.unwrap_or_else(|| Layout::home(self.scene, area));
        let layout = Layout::at_scale(self.scene, area, camera, self.shape, self.largest);
        let mut intents = self.handles(ui, &canvas, &layout);
        let hovered = canvas.hover_pos().and_then(|p| hit::at(&layout, p));
        self.gestures(ui, &canvas, &layout, state, &mut intents);
        if canvas.secondary_clicked() {
            state.menu = hovered;
        }
        canvas.context_menu(|ui| super::menu::show(ui, self.scene, state.menu, &mut intents));
        if Layout::turns(self.scene) {
            turn(ui, &canvas, state, camera);
        }
        if hovered.is_some() {
            ui.set_cursor_icon(CursorIcon::PointingHand);
        }
        let drag = state.drag;
        let rubber = drag.and_then(|d| self.rubber(&layout, &d));
        let marks = Marks {
            hovered,
            selected: self.selected,
            shares: self.shares,
            errors: self.errors,
            rubber,
            span: drag.and_then(|d| d.span()),
            editing: self.law.is_some(),
            in_space: layout.space.is_some() && solid::available(ui.ctx()),
        };
        let painter = ui.painter_at(area);
        painter.rect_filled(area, 6.0, palette.canvas);
        if let Some(space) = layout.space.as_ref().filter(|_| marks.in_space) {
            let wire = Wire { scene: self.scene, space, shares: self.shares, errors: self.errors };
            wire.paint(&painter, palette, canvas.id.with("wire"), area);
        }
        paint::paint(&painter, palette, self.scene, &layout, &marks);
        let is_told = self.caption(ui, &layout, area);
        let node = canvas.hover_pos().filter(|_| hovered.is_none()).and_then(|at| self.node_at(&layout, at));
        self.tooltip(&canvas, hovered, node, drag.is_some());
        if !is_told && drag.is_none() && hovered.is_none() {
            canvas.on_hover_text_at_pointer(tr(self.caption));
        }
        intents
    }

    /// What is shown, beside the arrows that stand as high: before the first, else behind the last, else cut short with dots. Gives
    /// back whether it is told: in a low pane only where it covers nothing, for the head of the window and the cards tell it too.
    fn caption(&self, ui: &Ui, layout: &Layout, area: Rect) -> bool {
        let is_low = area.height() < LOW;
        let corner = area.left_top() + vec2(ASIDE[1], ASIDE[usize::from(!is_low)]);
        let high = |ends: &&[Pos2; 2]| ends[0].y.min(ends[1].y) < corner.y + CAPTION && ends[0].x > corner.x;
        let arrows: Vec<&[Pos2; 2]> = layout.exciters.iter().map(|(_, ends)| ends).filter(high).collect();
        let edge = area.right() - theme::space::S;
        let first = arrows.iter().map(|e| e[0].x.min(e[1].x) - ARROW).fold(edge, f32::min);
        let last = arrows.iter().map(|e| e[0].x.max(e[1].x) + ARROW).fold(corner.x, f32::max);
        let (font, weak) = (theme::font(theme::size::SMALL), Palette::of(ui.visuals()).weak);
        let wanted = width(ui, self.caption, font.clone());
        let behind = wanted > first - corner.x && edge - last > first - corner.x;
        let (start, end) = if behind { (last, edge) } else { (corner.x, first) };
        let middle = pos2(start, corner.y + 0.5 * theme::size::SMALL + 2.0);
        // What stands first is told elsewhere too, and goes where there is no room for all.
        let fits = |text: &&str| width(ui, text, font.clone()) <= end - start;
        let shorter =
            std::iter::successors(Some(self.caption), |text| text.split_once(SEPARATOR).map(|(_, rest)| rest));
        let all: Vec<&str> = shorter.collect();
        let text = all.iter().copied().find(fits).unwrap_or_else(|| all.last().copied().unwrap_or_default());
        if text.is_empty() {
            return true;
        }
        // A structure in space, a halo or, in a low pane, the symbol of a source may reach behind the words.
        let size = vec2(width(ui, text, font.clone()).min(end - start), theme::size::SMALL + 4.0);
        let rect = Rect::from_min_size(middle - vec2(0.0, 0.5 * size.y), size);
        if is_low && layout.covers(rect) {
            return false;
        }
        ui.painter().rect_filled(rect.expand(3.0), 3.0, Palette::of(ui.visuals()).canvas.gamma_multiply(0.85));
        elided(ui, text, font, weak, middle, end - start);
        true
    }

    /// A node in the accessibility tree for every DOF and source, reached by Tab and pressed with Enter.
    fn handles(&self, ui: &mut Ui, canvas: &Response, layout: &Layout) -> Vec<Intent> {
        let mut intents = Vec::new();
        for handle in &layout.handles {
            let rect = Rect::from_center_size(handle.pos, Vec2::splat(2.0 * handle.radius));
            let label = self.scene.describe(handle.dof);
            self.node(ui, canvas.id.with(("dof", handle.dof)), rect, label, Target::Dof(handle.dof), &mut intents);
        }
        for source in &layout.sources {
            let Some(part) = source.parts.first() else { continue };
            let middle = part.glyph[0] + (part.glyph[1] - part.glyph[0]) / 2.0;
            let rect = Rect::from_center_size(middle, Vec2::splat(16.0));
            let target = Target::Source(source.slot);
            self.node(ui, canvas.id.with(("source", source.slot)), rect, self.name(source.slot), target, &mut intents);
        }
        intents
    }

    fn node(&self, ui: &Ui, id: egui::Id, rect: Rect, label: String, target: Target, intents: &mut Vec<Intent>) {
        let response = ui.interact(rect, id, Sense::focusable_noninteractive());
        response.widget_info(|| WidgetInfo::labeled(Role::Button, true, tr(&label)));
        if response.has_focus() {
            ui.painter().circle_stroke(
                rect.center(),
                0.5 * rect.width() + 5.0,
                theme::pen(Palette::of(ui.visuals()).accent),
            );
            if ui.input(|i| i.key_pressed(Key::Enter)) {
                intents.push(gesture::click(self.scene, Some(target), self.selected, self.law.is_some()));
            }
        }
    }

    fn gestures(&self, ui: &Ui, canvas: &Response, layout: &Layout, state: &mut ViewState, intents: &mut Vec<Intent>) {
        let pointer = canvas.interact_pointer_pos();
        if canvas.clicked()
            && let Some(at) = pointer
        {
            intents.push(gesture::click(self.scene, hit::at(layout, at), self.selected, self.law.is_some()));
        }
        if canvas.drag_started()
            && let Some(start) = ui.input(|i| i.pointer.press_origin())
        {
            let drag = Drag::begin(layout, start);
            let turns = Layout::turns(self.scene) && drag.from.is_none();
            state.drag = (self.law.is_some() && !turns).then_some(drag);
        }
        if let (Some(drag), Some(now)) = (&mut state.drag, pointer) {
            drag.now = now;
        }
        if canvas.drag_stopped()
            && let Some(drag) = state.drag.take()
            && let Some(dofs) = drag.dofs(layout)
        {
            intents.push(Intent::Draw(dofs));
        }
    }

    fn rubber(&self, layout: &Layout, drag: &Drag) -> Option<(Effect, [Pos2; 2])> {
        let from = layout.handle(drag.from?)?.pos;
        let to = hit::dof(layout, drag.now).and_then(|d| layout.handle(d)).map_or(drag.now, |h| h.pos);
        Some((self.law?, [from, to]))
    }

    /// The node of a wire model that is nearest to the eye under the pointer.
    fn node_at(&self, layout: &Layout, at: Pos2) -> Option<usize> {
        let space = layout.space.as_ref()?;
        let wire = Wire { scene: self.scene, space, shares: self.shares, errors: self.errors };
        wire.pick(&space.projection.ray(at, wire.reach()), NODE_REACH)
    }

    fn tooltip(&self, canvas: &Response, hovered: Option<Target>, node: Option<usize>, dragging: bool) {
        let text = match (hovered.filter(|_| !dragging), node) {
            (Some(Target::Dof(dof)), _) => self.scene.describe(dof),
            (Some(Target::Source(slot)), _) => self.name(slot),
            (None, Some(node)) if !dragging => {
                let node = &self.scene.nodes[node];
                let [x, y, z] = node.position.map(|v| format::significant(v, 4));
                format!("Node {} at ({x}, {y}, {z}) m", node.label)
            }
            _ => return,
        };
        canvas.clone().on_hover_text_at_pointer(tr(text));
    }

    /// What a source is, in words: `Source viscous dashpot at DOF 7, candidate`.
    fn name(&self, slot: usize) -> String {
        let source = &self.scene.sources[slot];
        let state = if source.suggested { "suggested" } else { source.state.word() };
        let value = source.identified.as_ref().map_or_else(String::new, |v| format!(", {v}"));
        format!("Source {}, {state}{value}", source.name)
    }
}

/// A drag that draws nothing turns a wire model, the wheel magnifies it, a double click goes back.
fn turn(ui: &Ui, canvas: &Response, state: &mut ViewState, mut camera: Camera) {
    let before = camera;
    if canvas.dragged() && state.drag.is_none() {
        camera.turn(canvas.drag_delta());
    }
    if canvas.hovered() {
        camera.zoom_by(ui.input(|i| i.smooth_scroll_delta().y));
    }
    if camera != before {
        state.camera = Some(camera);
    }
    if canvas.double_clicked() {
        state.camera = None;
    }
}
