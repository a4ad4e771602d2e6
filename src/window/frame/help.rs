//! Help: the list of keys, the tour of ten steps, and what the program is.

use super::desk::Desk;
use super::panes::Pane;
use crate::window::app::ask::Ask;
use crate::window::app::commands::TABLE;
use crate::window::app::view::{Stage, View};
use crate::window::appearance::theme::{Palette, size, space};
use crate::window::appearance::widgets::UiExt;
use crate::window::language::{t, tr};
use egui::{Context, Grid, Id, LayerId, Order, Rect, RichText, ScrollArea, StrokeKind, Window, pos2, vec2};

/// Shows what is open of it.
pub(crate) fn show(ctx: &Context, view: &mut View) {
    keys(ctx, &mut view.keys);
    about(ctx, &mut view.about);
}

fn keys(ctx: &Context, open: &mut bool) {
    Window::new(t!("Keys")).open(open).resizable(false).collapsible(false).show(ctx, |ui| {
        ScrollArea::vertical().max_height(560.0).show(ui, |ui| {
            Grid::new("keys").num_columns(3).spacing([space::L, space::XS]).show(ui, |ui| {
                for entry in &TABLE {
                    let Some(keys) = entry.keys else { continue };
                    ui.label(ui.ctx().format_shortcut(&keys));
                    ui.label(tr(entry.label));
                    ui.hint(entry.tooltip);
                    ui.end_row();
                }
            });
        });
        ui.add_space(space::S);
        ui.hint("On the schematic: Tab goes from DOF to DOF and from source to source, Enter is a click.");
        ui.hint("In plots: drag pans, right drag zooms into a box, double click shows all again; Backspace goes back to what was");
        ui.hint("in sight before, Shift+Backspace on. Ctrl+C copies the values of the plot or table under the pointer.");
    });
}

fn about(ctx: &Context, open: &mut bool) {
    Window::new(t!("About Dashpot")).open(open).resizable(false).collapsible(false).show(ctx, |ui| {
        ui.set_max_width(420.0);
        ui.label(RichText::new(t!("Dashpot")).size(size::FIGURE));
        ui.hint(format!("Version {}", env!("CARGO_PKG_VERSION")));
        ui.add_space(space::S);
        ui.label(t!("Tells where a structure loses its energy, how much and by which mechanism."));
        ui.add_space(space::S);
        ui.label(t!(
            "Over a period of steady vibration what the exciter puts in is what the dampers take out: G c = e."
        ));
        ui.hint("After M. Prandina, Spatial Damping Identification, University of Liverpool 2010.");
        ui.hint("MIT or Apache-2.0.");
    });
}

/// A step of the tour.
#[derive(Clone, Copy)]
pub(crate) struct TourStep {
    /// The stage that is shown.
    stage: Stage,
    /// The pane that it points at.
    pane: Option<Pane>,
    title: &'static str,
    text: &'static str,
}

/// The tour.
pub(crate) const TOUR: [TourStep; 10] = [
    TourStep {
        stage: Stage::Measure,
        pane: Some(Pane::Runs),
        title: "1 of 10: the runs",
        text: "Each row is a steady-state test: one frequency, one level. Noise and harmonics are measured, flags say in words \
         what is wrong. Untick a run to leave it out; all results follow by themselves.",
    },
    TourStep {
        stage: Stage::Measure,
        pane: Some(Pane::Record),
        title: "2 of 10: record and fit",
        text: "The measured channel in blue, the fitted harmonics in orange, what is left over under them. A residual with a \
         pattern means that the fit misses something.",
    },
    TourStep {
        stage: Stage::Structure,
        pane: Some(Pane::Modes),
        title: "3 of 10: the structure",
        text: "Natural frequencies beside the runs that are near them. Click a mode to see its shape on the schematic; Space \
         makes it move. Parameters, in the next tab, can be edited.",
    },
    TourStep {
        stage: Stage::Pattern,
        pane: Some(Pane::Laws),
        title: "4 of 10: the laws",
        text: "What might lose energy, in the symbols that engineers draw. Choose a law here, then draw it on the schematic; the \
         buttons below add a whole family at once.",
    },
    TourStep {
        stage: Stage::Pattern,
        pane: Some(Pane::Schematic),
        title: "5 of 10: draw the pattern",
        text: "Click a DOF: a source to the ground. Drag from DOF to DOF: between them. Sweep over a span: a chain. Click a source \
         again to make it candidate, forced, known or off.",
    },
    TourStep {
        stage: Stage::Select,
        pane: Some(Pane::Steps),
        title: "6 of 10: step by step",
        text: "One row per number of sources: the best set, its coefficients with deviations, the angle between measured and \
         identified energies. The arrow keys step.",
    },
    TourStep {
        stage: Stage::Select,
        pane: Some(Pane::Set),
        title: "7 of 10: alternatives",
        text: "Other sets of the same size, next best first. Click one to branch from it, or force a source that you know to be \
         there. Undo goes back.",
    },
    TourStep {
        stage: Stage::Result,
        pane: Some(Pane::Matrix),
        title: "8 of 10: the damping matrix",
        text: "What was identified, as a map or as bars in space that the mouse turns. File > Export hands it to NASTRAN, \
         Abaqus, MATLAB and others.",
    },
    TourStep {
        stage: Stage::Result,
        pane: Some(Pane::Bode),
        title: "9 of 10: does the model fit?",
        text: "Measured points on the model's curve: receptance, mobility or accelerance. Nyquist, hysteresis and damping ratios \
         are in the tabs beside it.",
    },
    TourStep {
        stage: Stage::Result,
        pane: None,
        title: "10 of 10: make it yours",
        text: "The stage Explain compares model and measurement, says which effect the model lacks and shows how far the error \
         falls with it. File > New makes a project of your own, and records are dropped on the window. Panes can be moved by \
         their titles; View > Reset layout puts them back. F1 lists the keys.",
    },
];

/// The step of the tour that is open, beside the pane that it points at.
pub(crate) fn tour(ctx: &Context, view: &mut View, desk: &mut Desk) {
    let Some(step) = view.tour else { return };
    let TourStep { stage, pane, title, text } = TOUR[step.min(TOUR.len() - 1)];
    if view.tour_shown != Some(step) {
        view.tour_shown = Some(step);
        view.stage = stage;
        if let Some(pane) = pane {
            desk.set_open(stage, pane, true);
        }
        ctx.request_repaint();
        return;
    }
    let target = pane.and_then(|pane| desk.rect(stage, pane));
    let palette = Palette::of(&ctx.global_style().visuals);
    if let Some(rect) = target {
        let painter = ctx.layer_painter(LayerId::new(Order::Foreground, Id::unique("tour frame")));
        painter.rect_stroke(rect.expand(2.0), 6.0, egui::Stroke::new(3.0, palette.accent), StrokeKind::Outside);
    }
    let response = Window::new(t!("Tour"))
        .id(Id::unique("tour"))
        .title_bar(false)
        .resizable(false)
        .order(Order::Tooltip)
        .fixed_pos(beside(target, ctx.content_rect()))
        .show(ctx, |ui| card(ui, step, title, text));
    match response.and_then(|r| r.inner).unwrap_or(Turn::Stay) {
        Turn::Stay => {}
        Turn::Back => view.tour = Some(step.saturating_sub(1)),
        Turn::Next if step + 1 < TOUR.len() => view.tour = Some(step + 1),
        Turn::Next | Turn::End => (view.tour, view.tour_shown) = (None, None),
    }
}

/// Without a project the tour begins on the sample.
pub(crate) fn begin_tour(view: &mut View, asks: &mut Vec<Ask>) {
    if let Some(folder) = super::start::samples_folder() {
        asks.push(Ask::Open(folder.join("cantilever-case-2").join("project.toml")));
    } else {
        view.tour = None;
        asks.push(Ask::Refuse("The samples are not here: open a project, then take the tour on it.".to_owned()));
    }
}

enum Turn {
    Stay,
    Back,
    Next,
    End,
}

fn card(ui: &mut egui::Ui, step: usize, title: &str, text: &str) -> Turn {
    ui.set_width(CARD - 30.0);
    ui.label(RichText::new(tr(title)).size(size::HEADING).strong());
    ui.add_space(space::XS);
    ui.label(tr(text));
    ui.add_space(space::S);
    let mut turn = Turn::Stay;
    ui.horizontal(|ui| {
        let last = step + 1 == TOUR.len();
        if ui.primary(if last { "Finish" } else { "Next" }).clicked() {
            turn = Turn::Next;
        }
        if ui.add_enabled(step > 0, egui::Button::new(t!("Back"))).clicked() {
            turn = Turn::Back;
        }
        if !last && ui.button(t!("End tour")).clicked() {
            turn = Turn::End;
        }
    });
    turn
}

/// Width of the card, points.
const CARD: f32 = 360.0;

/// Where the card stands: right of what it points at, else left of it, else above it, else in the middle.
fn beside(target: Option<Rect>, screen: Rect) -> egui::Pos2 {
    let height = 190.0;
    let Some(r) = target else { return screen.center() - vec2(0.5 * CARD, 0.5 * height) };
    let y = r.top().clamp(screen.top() + 8.0, screen.bottom() - height - 30.0);
    if r.right() + CARD + 20.0 < screen.right() {
        pos2(r.right() + 12.0, y)
    } else if r.left() - CARD - 20.0 > screen.left() {
        pos2(r.left() - CARD - 12.0, y)
    } else {
        let above = r.top() - height > screen.top() + 90.0;
        let y = if above { r.top() - height } else { r.bottom() + 12.0 };
        pos2(r.center().x - 0.5 * CARD, y)
    }
}

#[cfg(test)]
mod tests {
    use super::{CARD, TOUR, TourStep, beside};
    use egui::{Rect, pos2, vec2};

    #[test]
    fn the_card_never_covers_what_it_points_at_and_stays_on_the_screen() {
        let screen = Rect::from_min_size(pos2(0.0, 0.0), vec2(1440.0, 900.0));
        for target in [
            Rect::from_min_max(pos2(6.0, 430.0), pos2(460.0, 860.0)),
            Rect::from_min_max(pos2(700.0, 430.0), pos2(1100.0, 860.0)),
            Rect::from_min_max(pos2(6.0, 76.0), pos2(1130.0, 426.0)),
        ] {
            let card = Rect::from_min_size(beside(Some(target), screen), vec2(CARD, 180.0));
            assert!(screen.contains_rect(card), "{card:?}");
            assert!(!card.intersects(target), "{card:?} covers {target:?}");
        }
    }

    #[test]
    fn the_tour_has_ten_numbered_steps() {
        for (k, TourStep { title, .. }) in TOUR.iter().enumerate() {
            assert!(title.starts_with(&format!("{} of 10", k + 1)));
        }
    }
}
