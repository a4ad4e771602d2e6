//! The schematic pane: what it shows at the stage that is open.

use crate::effects::State;
use crate::exchange::Project;
use crate::identify::Estimate;
use crate::window::app::{App, Ask};
use crate::window::commands::Command;
use crate::window::format;
use crate::window::schematic::Scene;
use crate::window::schematic::hit::Target;
use crate::window::schematic::view::View;
use crate::window::stages::select;
use crate::window::view::Stage;
use egui::Ui;
use std::sync::Arc;

/// Shows the schematic.
pub fn show(ui: &mut Ui, app: &mut App, asks: &mut Vec<Ask>) {
    let Some(document) = &app.document else { return };
    let mut scene = app.derived.scene(document);
    let outcome = app.derived.known_outcome(document).and_then(|o| o.as_ref().ok());
    let mut shares = None;
    if let (Some(outcome), Stage::Select | Stage::Result) = (outcome, app.view.stage) {
        let estimates = match (app.view.stage, select::current(&app.view, outcome)) {
            (Stage::Select, Some(step)) => &step.sources,
            _ => &outcome.sources,
        };
        scene = Arc::new(identified(&scene, &document.project, estimates));
        let total: Vec<f32> = outcome.results.energy_percent.iter().map(|v| 0.01 * *v as f32).collect();
        shares = (app.view.stage == Stage::Result).then_some(total);
    }
    let (shape, caption) = shape(ui, app);
    let shape = shape.map(|s| s.iter().map(|v| v * app.view.phase.cos()).collect::<Vec<f64>>());
    let slot = |index: usize| scene.sources.iter().position(|s| s.index == index).map(Target::Source);
    let selected = app.view.source.and_then(slot).or(app.view.dof.map(Target::Dof));
    let law = (app.view.stage == Stage::Pattern).then_some(app.view.law).filter(|law| law.law().is_some());
    let view =
        View { scene: &scene, shape: shape.as_deref(), shares: shares.as_deref(), selected, law, caption: &caption };
    let intents = view.show(ui, &mut app.view.schematic);
    asks.extend(intents.into_iter().map(Ask::Schematic));
}

/// The scene with the values that were identified.
fn identified(scene: &Scene, p: &Project, estimates: &[Estimate]) -> Scene {
    let mut scene = scene.clone();
    for estimate in estimates {
        let Some(source) = p.sources.get(estimate.source).filter(|s| s.state != State::Known) else { continue };
        if let Some(drawn) = scene.sources.iter_mut().find(|s| s.index == estimate.source) {
            drawn.identified = Some(crate::window::stages::coefficient(source, estimate));
        }
    }
    scene
}

/// The shape that the stage is about, and what it is.
fn shape(ui: &Ui, app: &mut App) -> (Option<Vec<f64>>, String) {
    let Some(document) = &app.document else { return (None, String::new()) };
    if app.view.stage == Stage::Pattern {
        let verb = "Click a DOF: source to ground  ·  drag to another DOF: between them  ·  sweep: chain  ·  click again: state";
        return (None, verb.to_owned());
    }
    if !app.view.shape || app.view.stage != Stage::Structure {
        return (None, String::new());
    }
    match app.derived.modes(ui.ctx(), document) {
        Some(Ok(modes)) if app.view.mode < modes.len() => {
            let frequency = format::with_unit(modes.frequency_hz(app.view.mode), "Hz");
            (
                Some(crate::window::stages::structure::upright(
                    modes.shape(app.view.mode),
                    &document.project.structure.translations(),
                )),
                format!("Mode {}   {frequency}", app.view.mode + 1),
            )
        }
        _ => (None, String::new()),
    }
}

/// Whether the shape is shown and moves, at the right of the pane's title.
pub fn switches(ui: &mut Ui, app: &App, asks: &mut Vec<Ask>) {
    if app.view.stage == Stage::Pattern {
        return;
    }
    for (command, on) in [(Command::Animate, app.view.animate), (Command::Shape, app.view.shape)] {
        let label = if command == Command::Shape { "Deflect" } else { "Animate" };
        if ui.selectable_label(on, label).on_hover_text(command.entry().tooltip).clicked() {
            asks.push(Ask::Command(command));
        }
    }
}
