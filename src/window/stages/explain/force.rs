//! The missing force over displacement and over velocity, in the card of its suggestion or where nothing is suggested.

use super::scene::Scene;
use crate::diagnosis::candidates::restoring_force::RestoringForce;
use crate::effects::{Place, Source};
use crate::plots::figure::Figure;
use crate::plots::restoring_force::{caption, figures, maps, title};
use crate::plots::sheet::{Panel, Sheet};
use crate::session::validation::is_component;
use crate::structure::Structure;
use crate::window::appearance::widgets::UiExt;
use crate::window::language::tr;
use crate::window::plots::export;
use crate::window::plots::show::{self, key_row};
use egui::{Align, Layout, Ui, vec2};

/// Height of the plots.
const PLOTS: f32 = 176.0;
/// Least width of a plot; below twice of it they stand above each other.
const LEAST: f32 = 170.0;

/// Shows the force of `source`, or at the place that explains most; says so while it is computed.
pub(super) fn show(ui: &mut Ui, scene: &Scene<'_>, source: Option<&Source>) {
    if source.is_some_and(|s| !matches!(s.place, Place::Dofs(_))) || is_component(&scene.document.project) {
        return;
    }
    match scene.explained.force(scene.document, source) {
        Some(Ok(force)) => {
            if let Some(force) = force.as_ref() {
                plots(ui, force, &scene.document.project.structure);
            }
        }
        Some(Err(error)) => drop(ui.hint(format!("The missing force cannot be drawn: {error}"))),
        None => drop(ui.hint("The missing force is being drawn.")),
    }
}

fn plots(ui: &mut Ui, force: &RestoringForce, structure: &Structure) {
    let palette = ui.palette();
    let mut figures: Vec<Figure> = figures(force, structure, palette).into();
    let above = figures.len();
    figures.extend(maps(force, structure, palette));
    let title = title(force, structure);
    ui.hint(format!("{title} over displacement and velocity")).on_hover_text(tr(caption(force)));
    key_row(ui, figures.iter().take(1));
    let columns = if ui.available_width() >= 2.0 * LEAST { 2 } else { 1 };
    let width = ui.available_width() / columns as f32 - 4.0;
    let (mut panels, mut responses) = (Vec::new(), Vec::new());
    let mut show_plot = |ui: &mut Ui, k: usize| {
        let figure = figures[k].clone().displayed();
        // The name of a map stands above it, also where two maps stand beside each other.
        let below = Layout::top_down(Align::Min);
        ui.allocate_ui_with_layout(vec2(width, PLOTS), below, |ui| {
            ui.set_width(width);
            let id = format!("{} {k}", figure.title);
            if k >= above {
                // Of two maps each says whose force it shows.
                ui.hint(figure.title.rsplit(", ").next().unwrap_or_default());
            }
            let place = show::Place { id: &id, height: PLOTS, group: None, ruler: show::RULER };
            let out = place.show(ui, &figure);
            let (low, high) = (out.transform.bounds().min(), out.transform.bounds().max());
            panels.push(Panel { figure, bounds: [[low[0], high[0]], [low[1], high[1]]] });
            responses.push(out.response);
        });
    };
    for (row, keys) in (0..figures.len()).step_by(2).zip([None, figures.get(2)]) {
        if let Some(map) = keys {
            ui.hint("Force as colour over displacement and velocity");
            key_row(ui, std::iter::once(map));
        }
        let plots = row..(row + 2).min(figures.len());
        if columns == 2 {
            ui.horizontal_top(|ui| plots.for_each(|k| show_plot(ui, k)));
        } else {
            plots.for_each(|k| show_plot(ui, k));
        }
    }
    export::offer_sheet(ui, &responses, Sheet { title, columns: 2, panels });
}
